//! Text of either form to values, with the line in every complaint.
//!
//! Both readers ask the values themselves to judge while the text is read (their `Deserialize`), so
//! that what is wrong with a value is known with its line, as a slip of syntax is.

use std::collections::BTreeMap;
use std::fmt;
use std::io::Read as _;
use std::marker::PhantomData;
use std::path::Path;

use ron::extensions::Extensions;
use serde::de::{DeserializeOwned, Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use super::ExpressionError;

/// No library or script is longer: hours of dense keys are shorter.
const BYTES_MAX: u64 = 16 << 20;

/// A file's name as messages show it, and its text.
pub(super) fn load(file: &Path) -> Result<(String, String), ExpressionError> {
    let name = file.display().to_string();
    let large = |file: String| ExpressionError::Large {
        file,
        bytes_max: BYTES_MAX,
    };
    let mut bytes = Vec::new();
    let read =
        std::fs::File::open(file).and_then(|f| f.take(BYTES_MAX + 1).read_to_end(&mut bytes));
    match read {
        Err(source) => Err(ExpressionError::Unreadable { file: name, source }),
        Ok(_) if bytes.len() as u64 > BYTES_MAX => Err(large(name)),
        Ok(_) => match String::from_utf8(bytes) {
            Ok(text) => Ok((name, text)),
            Err(_) => Err(large(name)),
        },
    }
}

/// Reads `text` in the form that `name` ends in.
pub(super) fn parse<T: DeserializeOwned>(name: &str, text: &str) -> Result<T, ExpressionError> {
    let complaint = |line, message: String| ExpressionError::Text {
        file: name.to_owned(),
        line,
        message,
    };
    // Some editors begin a file with a byte-order mark.
    let text = text.trim_start_matches('\u{feff}');
    let ending = Path::new(name).extension().and_then(|e| e.to_str());
    match ending.map(str::to_ascii_lowercase).as_deref() {
        Some("json") => serde_json::from_str(text).map_err(|error| {
            let message = error.to_string();
            // It says the place at its end again.
            let place = format!(" at line {} column {}", error.line(), error.column());
            let message = message.strip_suffix(&place).unwrap_or(&message);
            complaint(error.line(), message.to_owned())
        }),
        Some("ron") => ron::Options::default()
            .with_default_extension(Extensions::IMPLICIT_SOME)
            .from_str(text)
            .map_err(|error| complaint(error.span.start.line, error.code.to_string())),
        _ => Err(ExpressionError::Ending {
            file: name.to_owned(),
        }),
    }
}

/// Which of `names` a mistyped `name` means most likely.
pub(super) fn nearest<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> &'a str {
    // A name of any length costs no more than a long one.
    let name: String = name.chars().take(64).collect();
    names
        .map(|known| (strsim::damerau_levenshtein(&name, known), known))
        .min()
        .map_or("", |(_, known)| known)
}

/// A map that names nothing twice: plain maps would keep the last and say nothing.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Unique<T>(pub(super) BTreeMap<String, T>);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Unique<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = Unique<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("names with their values, as {\"jaw_rad\": 0.1}")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = BTreeMap::new();
                while let Some(name) = map.next_key::<String>()? {
                    if entries.contains_key(&name) {
                        let message = format!("`{name}` is there twice; remove one");
                        return Err(A::Error::custom(message));
                    }
                    let value = map.next_value()?;
                    entries.insert(name, value);
                }
                Ok(Unique(entries))
            }
        }
        deserializer.deserialize_map(Entries(PhantomData))
    }
}
