//! Expressions as muscle settings, and scripts that lead a face from one to the next.
//!
//! HEADSHOP 3: heads made from one reference share their muscles, so that one animation script serves
//! them all. Here that is one library of named settings ([`Library`], `data/expressions.json`), scripts
//! of key frames over them ([`Script`]), and a way to lay both over what speech wants of the mouth
//! ([`Controls::express`]). For export, stills, the live face, and whoever writes scripts. It moves no
//! skin: settings are controls like any others, and the tissue does the rest. When a face should
//! show what, and brows that follow the stress of a sentence, are not decided here.
//!
//! A script, as `.json`; times count from the beginning of what is said:
//!
//! ```
//! use mouthpiece_rig::{Control, Controls, Script, TICK_RATE};
//!
//! # fn main() -> Result<(), mouthpiece_rig::ExpressionError> {
//! let script = Script::parse("greeting.json", r#"{"keys": [
//!     {"time_s": 0.0, "expression": "neutral"},
//!     {"time_s": 0.6, "expression": "happiness", "weight": 0.8},
//!     {"time_s": 2.0, "muscles": {"frontalis_outer_l": 0.5, "zygomaticus_major": 0.2}}
//! ]}"#)?;
//! let raised = script.controls_at(2 * TICK_RATE);
//! assert_eq!(raised[Control::ZygomaticusMajor], 0.2);
//! # Ok(()) }
//! ```
//!
//! and the same as `.ron`:
//!
//! ```ron
//! (keys: [
//!     (time_s: 0.0, expression: "neutral"),
//!     (time_s: 0.6, expression: "happiness", weight: 0.8),
//!     (time_s: 2.0, muscles: {"frontalis_outer_l": 0.5, "zygomaticus_major": 0.2}),
//! ])
//! ```

mod error;
mod overlay;
mod script;
mod settings;
mod text;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;

use serde::Deserialize;
use serde::de::value::{Error as ValueError, MapDeserializer};

use crate::Controls;
pub use error::ExpressionError;
pub use overlay::Mouth;
pub use script::Script;
use settings::Settings;
use text::Unique;

/// The library that is built in, and the name that its errors would show.
const BUILT_IN: &str = include_str!("../../data/expressions.json");
const BUILT_IN_NAME: &str = "expressions.json";
/// The version of the library's form that this program reads.
const SCHEMA: u32 = 1;

/// A face by name.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expression {
    /// What it looks like and which muscles say so, in a sentence.
    pub about: String,
    muscles: Settings,
}

impl Expression {
    /// What it sets, at full strength; all else is 0.
    #[must_use]
    pub const fn controls(&self) -> &Controls {
        &self.muscles.0
    }
}

impl Controls {
    /// Controls by name, all else 0; a paired muscle's name with `_l` or `_r` behind it is one belly.
    ///
    /// # Errors
    /// Names the control that is unknown, out of its range or there twice.
    pub fn named<'a>(
        values: impl IntoIterator<Item = (&'a str, f32)>,
    ) -> Result<Self, ExpressionError> {
        let map = MapDeserializer::<_, ValueError>::new(values.into_iter());
        let settings = Settings::deserialize(map);
        let settings = settings.map_err(|why| ExpressionError::Setting(why.to_string()))?;
        Ok(settings.0)
    }
}

/// Expressions by name.
#[derive(Clone, Debug, PartialEq)]
pub struct Library {
    expressions: BTreeMap<String, Expression>,
}

/// A library as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    schema: u32,
    expressions: Unique<Expression>,
}

impl Library {
    /// The one that comes with the program.
    ///
    /// # Errors
    /// When the built-in data is damaged, which a test rules out.
    pub fn built_in() -> Result<&'static Self, &'static ExpressionError> {
        static LIBRARY: OnceLock<Result<Library, ExpressionError>> = OnceLock::new();
        LIBRARY
            .get_or_init(|| Self::parse(BUILT_IN_NAME, BUILT_IN))
            .as_ref()
    }

    /// Reads a `.json` or `.ron` file of the form of `data/expressions.json`.
    ///
    /// # Errors
    /// Names the file, the line and the mend.
    pub fn read(file: &Path) -> Result<Self, ExpressionError> {
        let (name, text) = text::load(file)?;
        Self::parse(&name, &text)
    }

    /// Reads the text of such a file; `name` says by its ending which form it has.
    ///
    /// # Errors
    /// Names the file, the line and the mend.
    pub fn parse(name: &str, text: &str) -> Result<Self, ExpressionError> {
        let written: Written = text::parse(name, text)?;
        if written.schema != SCHEMA {
            return Err(ExpressionError::Schema {
                file: name.to_owned(),
                found: written.schema,
            });
        }
        Ok(Self {
            expressions: written.expressions.0,
        })
    }

    /// The expression of that name.
    ///
    /// # Errors
    /// When there is none: lists what there is.
    pub fn get(&self, name: &str) -> Result<&Expression, ExpressionError> {
        self.expressions
            .get(name)
            .ok_or_else(|| ExpressionError::Unknown {
                name: name.to_owned(),
                nearest: text::nearest(name, self.names()).to_owned(),
                known: self.names().collect::<Vec<_>>().join(", "),
            })
    }

    /// All names, in alphabetical order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.expressions.keys().map(String::as_str)
    }
}

#[cfg(test)]
mod tests;
