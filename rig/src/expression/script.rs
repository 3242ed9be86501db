//! Key frames of expressions, and the smooth way between them.
//!
//! Each muscle goes from key to key along a monotone cubic (Fritsch and Butland 1984: slopes by the
//! harmonic mean of the neighbouring rises, none at a turning point), so that its speed never jumps and
//! it never leaves the range of its keys. Before the first key and after the last a face holds still.

use std::fmt;
use std::path::Path;

use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use super::settings::{Bellies, Settings};
use super::{ExpressionError, Library, text};
use crate::{Control, Controls, TICK_RATE};

/// A script is no longer than this, s.
const SECONDS_MAX: f64 = 24.0 * 3600.0;

/// A face led through time.
#[derive(Clone, Debug, PartialEq)]
pub struct Script {
    /// In order of time; at least one.
    keys: Vec<Key>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Key {
    ticks: i64,
    face: Bellies,
    /// Per tick.
    slope: [f32; Control::COUNT],
}

/// A script as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Script")]
struct Written {
    keys: Keys,
}

/// A key as it is written.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Key")]
struct WrittenKey {
    time_s: f64,
    #[serde(default)]
    expression: Option<Named>,
    #[serde(default)]
    muscles: Option<Settings>,
    #[serde(default = "full")]
    weight: f32,
}

fn full() -> f32 {
    1.0
}

/// An expression of the built-in library, named.
struct Named(&'static Controls);

impl<'de> Deserialize<'de> for Named {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let library = Library::built_in().map_err(D::Error::custom)?;
        let expression = library.get(&name).map_err(D::Error::custom)?;
        Ok(Self(expression.controls()))
    }
}

/// Keys that were checked one by one, so that a complaint has the line of its key.
struct Keys(Vec<Key>);

impl<'de> Deserialize<'de> for Keys {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Ordered;
        impl<'de> Visitor<'de> for Ordered {
            type Value = Keys;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of keys, as {\"time_s\": 0.5, \"expression\": \"happiness\"}")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Keys, A::Error> {
                let mut keys: Vec<Key> = Vec::new();
                while let Some(written) = seq.next_element::<WrittenKey>()? {
                    let key = written.key().map_err(A::Error::custom)?;
                    if keys.last().is_some_and(|last| last.ticks >= key.ticks) {
                        return Err(A::Error::custom(format!(
                            "the key at {} s does not come after the one before it; put keys in order of time",
                            written.time_s
                        )));
                    }
                    keys.push(key);
                }
                if keys.is_empty() {
                    return Err(A::Error::custom(
                        "a script without keys; give at least one, as {\"time_s\": 0, \"expression\": \"smile\"}",
                    ));
                }
                Ok(Keys(keys))
            }
        }
        deserializer.deserialize_seq(Ordered)
    }
}

impl WrittenKey {
    fn key(&self) -> Result<Key, String> {
        let time_s = self.time_s;
        if !(0.0..=SECONDS_MAX).contains(&time_s) {
            return Err(format!(
                "time_s goes from 0 to {SECONDS_MAX}, not to {time_s}; times are in seconds"
            ));
        }
        if !(0.0..=1.0).contains(&self.weight) {
            return Err(format!(
                "the weight at {time_s} s goes from 0 to 1, not to {}; choose a value within",
                self.weight
            ));
        }
        let controls = match (&self.expression, &self.muscles) {
            (Some(named), None) => named.0,
            (None, Some(settings)) => &settings.0,
            _ => {
                return Err(format!(
                    "the key at {time_s} s must have either `expression` or `muscles`"
                ));
            }
        };
        let face = Bellies::from(controls);
        Ok(Key {
            // The only rounding of time there is.
            ticks: (time_s * TICK_RATE as f64).round() as i64,
            face: Bellies(face.0.map(|value| value * self.weight)),
            slope: [0.0; Control::COUNT],
        })
    }
}

impl Script {
    /// Reads a `.json` or `.ron` file.
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
        let Written {
            keys: Keys(mut keys),
        } = text::parse(name, text)?;
        for i in 1..keys.len().saturating_sub(1) {
            let (before, after) = (
                keys[i].rise_from(&keys[i - 1]),
                keys[i + 1].rise_from(&keys[i]),
            );
            let spans = (
                (keys[i].ticks - keys[i - 1].ticks) as f32,
                (keys[i + 1].ticks - keys[i].ticks) as f32,
            );
            keys[i].slope = std::array::from_fn(|c| slope((before[c], after[c]), spans));
        }
        Ok(Self { keys })
    }

    /// When the last key is reached; the face stays as it says.
    #[must_use]
    pub fn end(&self) -> i64 {
        self.keys.last().map_or(0, |key| key.ticks)
    }

    /// The face at `ticks`, for [`Controls::express`] at full weight.
    #[must_use]
    pub fn controls_at(&self, ticks: i64) -> Controls {
        let next = self.keys.partition_point(|key| key.ticks <= ticks);
        let face = match (
            next.checked_sub(1).map(|i| &self.keys[i]),
            self.keys.get(next),
        ) {
            (Some(a), Some(b)) => a.between(b, ticks),
            (Some(only), None) | (None, Some(only)) => only.face,
            (None, None) => return Controls::default(),
        };
        Controls::from(&face)
    }
}

impl Key {
    /// Per tick.
    fn rise_from(&self, before: &Self) -> [f32; Control::COUNT] {
        let span = (self.ticks - before.ticks) as f32;
        std::array::from_fn(|c| (self.face.0[c] - before.face.0[c]) / span)
    }

    /// The cubic between two keys with their slopes (Hermite's form).
    fn between(&self, next: &Self, ticks: i64) -> Bellies {
        let span = (next.ticks - self.ticks) as f32;
        let x = (ticks - self.ticks) as f32 / span;
        let risen = x * x * (3.0 - 2.0 * x);
        let (leaving, coming) = (x * (1.0 - x) * (1.0 - x) * span, x * x * (x - 1.0) * span);
        Bellies(std::array::from_fn(|c| {
            let (a, b) = (self.face.0[c], next.face.0[c]);
            let value = a + (b - a) * risen + leaving * self.slope[c] + coming * next.slope[c];
            // Only the last bit can be outside.
            value.clamp(a.min(b), a.max(b))
        }))
    }
}

/// Fritsch and Butland's slope at a key between two rises over two spans.
fn slope((before, after): (f32, f32), spans: (f32, f32)) -> f32 {
    if before * after <= 0.0 {
        return 0.0;
    }
    let weights = (2.0 * spans.1 + spans.0, spans.1 + 2.0 * spans.0);
    (weights.0 + weights.1) / (weights.0 / before + weights.1 / after)
}
