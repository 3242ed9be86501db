//! Values of the configuration that are more than TOML's own types. Each refuses what it cannot be
//! while the file is read, so that the error knows its line.

use std::fmt::Display;
use std::str::FromStr;

use clap::ValueEnum;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::captions::CaptionStyle;
use super::log::Level;
use super::wire::Turns;
use crate::cli::{BackgroundArg, DriveArg, LiveTierArg, Size, SkinArg, StateArg, TissueArg};
use crate::health::Door;

/// A whole number from `MIN` to `MAX`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Whole<const MIN: i64, const MAX: i64>(i64);

impl<const MIN: i64, const MAX: i64> Whole<MIN, MAX> {
    /// `value`, or the bound that is nearest to it.
    pub const fn new(value: i64) -> Self {
        if value < MIN {
            Self(MIN)
        } else if value > MAX {
            Self(MAX)
        } else {
            Self(value)
        }
    }

    pub const fn get(self) -> i64 {
        self.0
    }

    /// The same as a share, where the number counts hundredths.
    pub fn percent(self) -> f32 {
        self.0 as f32 / 100.0
    }
}

impl<'de, const MIN: i64, const MAX: i64> Deserialize<'de> for Whole<MIN, MAX> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let value = i64::deserialize(from)?;
        if (MIN..=MAX).contains(&value) {
            Ok(Self(value))
        } else {
            Err(D::Error::custom(format!(
                "{value} is out of range, write a whole number from {MIN} to {MAX}"
            )))
        }
    }
}

/// How far the picture is turned, clockwise, for a screen that hangs the other way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(into = "i64")]
pub enum Rotation {
    #[default]
    None,
    Quarter,
    Half,
    ThreeQuarters,
}

impl Rotation {
    const ALL: [Self; 4] = [Self::None, Self::Quarter, Self::Half, Self::ThreeQuarters];

    /// Quarters of a turn.
    pub fn quarters(self) -> u32 {
        self as u32
    }
}

impl From<Rotation> for i64 {
    fn from(rotation: Rotation) -> Self {
        Self::from(rotation.quarters()) * 90
    }
}

impl<'de> Deserialize<'de> for Rotation {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let degrees = i64::deserialize(from)?;
        let found = Self::ALL.into_iter().find(|r| i64::from(*r) == degrees);
        found.ok_or_else(|| {
            D::Error::custom(format!("{degrees} is no turn, write 0, 90, 180 or 270"))
        })
    }
}

impl FromStr for Rotation {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL
            .into_iter()
            .find(|r| i64::from(*r).to_string() == text);
        found.ok_or_else(|| "write 0, 90, 180 or 270".into())
    }
}

/// A text, or a list of them.
pub fn one_or_more<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<String>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "write a text or a list of texts")]
    enum Texts {
        One(String),
        More(Vec<String>),
    }
    Ok(match Texts::deserialize(from)? {
        Texts::One(text) => vec![text],
        Texts::More(texts) => texts,
    })
}

/// A value that the command line writes as text is written so in the file, too.
fn text<'de, T, D>(from: D) -> Result<T, D::Error>
where
    T: FromStr,
    T::Err: Display,
    D: Deserializer<'de>,
{
    String::deserialize(from)?.parse().map_err(D::Error::custom)
}

/// A word of the command line is that word in the file.
fn word<'de, T: ValueEnum, D: Deserializer<'de>>(from: D) -> Result<T, D::Error> {
    let word = String::deserialize(from)?;
    T::from_str(&word, false).map_err(|_| {
        let all: Vec<String> = T::value_variants().iter().map(name).collect();
        D::Error::custom(format!("{word:?} is none of {}", all.join(", ")))
    })
}

fn name<T: ValueEnum>(value: &T) -> String {
    let value = value.to_possible_value();
    value.map_or_else(String::new, |v| v.get_name().to_owned())
}

macro_rules! as_text {
    ($($type:ty),+) => {$(
        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                text(from)
            }
        }
        impl Serialize for $type {
            fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                to.collect_str(self)
            }
        }
    )+};
}

macro_rules! as_word {
    ($($type:ty),+) => {$(
        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
                word(from)
            }
        }
        impl Serialize for $type {
            fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
                to.serialize_str(&name(self))
            }
        }
    )+};
}

as_text!(Size, BackgroundArg, Door, DriveArg);
as_word!(
    CaptionStyle,
    Level,
    LiveTierArg,
    SkinArg,
    StateArg,
    TissueArg,
    Turns
);
