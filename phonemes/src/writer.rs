//! Where label formats that can be written meet the rest: the counterpart of [`Reader`](crate::Reader).

use std::io::{self, Write};

use thiserror::Error;

use crate::tick::SampleRate;
use crate::{Labels, formats, timit};

/// Every format that can be written.
pub static WRITERS: [&dyn Writer; 5] = [
    &timit::Phones,
    &timit::Words,
    &formats::Xlabel,
    &formats::TextGrid,
    &formats::Ndjson,
];

/// Labels that cannot be written, and why.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// The output refused.
    #[error("cannot write the labels ({0}); check the place and its free space")]
    Io(#[from] io::Error),
    /// Labels of the kind that the format holds are missing.
    #[error("there are no {0} to write; give labels that have {0}, or choose another format")]
    Nothing(&'static str),
    /// The format has no way to say this label.
    #[error("{kind} {number} {reason}")]
    Label {
        /// `phone` or `word`.
        kind: &'static str,
        /// Which label, from 1.
        number: usize,
        /// Why it cannot be said, and the mend.
        reason: &'static str,
    },
    /// The user asked for a format that does not exist.
    #[error("`{name}` is no label format to write; give one of {known}")]
    UnknownFormat {
        /// What was asked for.
        name: String,
        /// The formats that exist.
        known: String,
    },
}

/// Writes one label format.
pub trait Writer: Sync {
    /// The word by which users ask for the format: its reader's.
    fn name(&self) -> &'static str;

    /// Writes the labels; formats that count samples count them at `rate`. Reading the result at
    /// the same rate gives the same labels, as far as [`SampleRate`] is exact and the format can
    /// say what they hold.
    fn write(
        &self,
        labels: &Labels,
        rate: SampleRate,
        out: &mut dyn Write,
    ) -> Result<(), WriteError>;
}

/// The writer of a format by its name.
pub fn writer(name: &str) -> Result<&'static dyn Writer, WriteError> {
    let named = WRITERS.iter().find(|writer| writer.name() == name);
    named.copied().ok_or_else(|| WriteError::UnknownFormat {
        name: name.to_owned(),
        known: WRITERS
            .iter()
            .map(|writer| format!("`{}`", writer.name()))
            .collect::<Vec<_>>()
            .join(", "),
    })
}
