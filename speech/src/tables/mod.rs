//! The data that speech is made from: targets per phone and dominance per class, each row with its
//! source. For whoever tunes a voice or brings tables of their own; the built-in ones are read by
//! the same code.

mod articulation;
mod dominance;
mod error;

use std::collections::BTreeMap;
use std::path::Path;

use mouthpiece_phonemes::Phone;
use mouthpiece_rig::Articulation;

pub(crate) use articulation::posture;
pub use articulation::{ArticulationRow, Glide, Lips, Tongue};
pub use dominance::{
    ClassRow, Contact, ContactTimes, Dominance, DominanceTable, Driven, Group, Opening,
};
pub use error::TableError;

const ARTICULATION: (&str, &str) = (
    "articulation.toml",
    include_str!("../../data/articulation.toml"),
);
const DOMINANCE: (&str, &str) = ("dominance.toml", include_str!("../../data/dominance.toml"));

/// Both tables, checked: all 61 phones are there, every class they name is, every figure lies in
/// its range.
#[derive(Clone, Debug, PartialEq)]
pub struct Tables {
    /// One row per phone, by [`Phone::index`].
    pub articulation: Vec<ArticulationRow>,
    /// Classes, contact and what is driven.
    pub dominance: DominanceTable,
}

impl Tables {
    /// The tables that come with Mouthpiece.
    ///
    /// # Errors
    /// None as released; they go through the same checks as any other.
    pub fn built_in() -> Result<Self, TableError> {
        Self::parse(ARTICULATION, DOMINANCE)
    }

    /// Reads tables from files; what is left out is built in.
    ///
    /// # Errors
    /// When a file cannot be read or does not pass the checks.
    pub fn load(articulation: Option<&Path>, dominance: Option<&Path>) -> Result<Self, TableError> {
        let articulation = articulation.map(read).transpose()?;
        let dominance = dominance.map(read).transpose()?;
        Self::parse(
            articulation
                .as_ref()
                .map_or(ARTICULATION, |(name, text)| (name, text)),
            dominance
                .as_ref()
                .map_or(DOMINANCE, |(name, text)| (name, text)),
        )
    }

    /// Reads tables from text; each comes as (name for errors, TOML).
    ///
    /// # Errors
    /// When a table does not pass the checks.
    pub fn parse(articulation: (&str, &str), dominance: (&str, &str)) -> Result<Self, TableError> {
        let (file, text) = dominance;
        let dominance = from_toml::<DominanceTable>(file, text)?;
        dominance.check(file)?;
        let (file, text) = articulation;
        let mut rows = from_toml::<BTreeMap<String, ArticulationRow>>(file, text)?;
        if let Some(row) = rows.keys().find(|code| Phone::from_code(code).is_none()) {
            return Err(TableError::UnknownPhone {
                file: file.to_owned(),
                row: row.clone(),
            });
        }
        let mut articulation = Vec::with_capacity(Phone::ALL.len());
        for phone in Phone::ALL {
            let row = rows
                .remove(phone.code())
                .ok_or_else(|| TableError::MissingPhone {
                    file: file.to_owned(),
                    row: phone.code(),
                })?;
            row.check(file, phone, &dominance)?;
            articulation.push(row);
        }
        Ok(Self {
            articulation,
            dominance,
        })
    }

    /// The mouths that a head is asked for, with the names of their rows (`ey`, `ey.glide`): of every row that says
    /// anything of the lips.
    #[must_use]
    pub fn mouths(&self) -> Vec<(String, Articulation)> {
        let mut mouths = Vec::new();
        for (phone, row) in Phone::ALL.iter().zip(&self.articulation) {
            if row.lips.is_some() {
                let whole = posture(row.lips.as_ref(), row.jaw_rad, &row.tongue);
                mouths.push((phone.code().to_owned(), whole));
            }
            if let Some(glide) = row.glide.as_ref().filter(|glide| glide.lips.is_some()) {
                let whole = posture(glide.lips.as_ref(), glide.jaw_rad, &glide.tongue);
                mouths.push((format!("{}.glide", phone.code()), whole));
            }
        }
        mouths
    }
}

fn read(path: &Path) -> Result<(String, String), TableError> {
    let name = path.display().to_string();
    match std::fs::read_to_string(path) {
        Ok(text) => Ok((name, text)),
        Err(source) => Err(TableError::Unreadable { file: name, source }),
    }
}

fn from_toml<T: serde::de::DeserializeOwned>(file: &str, text: &str) -> Result<T, TableError> {
    toml::from_str(text).map_err(|error| {
        let at = error.span().map_or(0, |span| span.start).min(text.len());
        TableError::Syntax {
            file: file.to_owned(),
            line: text.as_bytes()[..at]
                .iter()
                .filter(|b| **b == b'\n')
                .count()
                + 1,
            message: error.message().trim().replace('\n', " "),
        }
    })
}

/// A figure that must lie between `min` and `max`, with its name for the error.
struct Figure {
    field: &'static str,
    value: f32,
    min: f32,
    max: f32,
}

fn figure(field: &'static str, value: f32, min: f32, max: f32) -> Figure {
    Figure {
        field,
        value,
        min,
        max,
    }
}

fn in_range(file: &str, row: &str, figures: &[Figure]) -> Result<(), TableError> {
    match figures
        .iter()
        .find(|f| !f.value.is_finite() || f.value < f.min || f.value > f.max)
    {
        None => Ok(()),
        Some(f) => Err(TableError::Range {
            file: file.to_owned(),
            row: row.to_owned(),
            field: f.field.to_owned(),
            value: f.value,
            min: f.min,
            max: f.max,
        }),
    }
}

fn sourced(file: &str, row: &str, source: &str) -> Result<(), TableError> {
    if source.trim().is_empty() {
        return Err(TableError::Unsourced {
            file: file.to_owned(),
            row: row.to_owned(),
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests;
