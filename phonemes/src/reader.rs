//! Where every label format meets the rest: a reader per format, chosen by name or by looking.
//!
//! A new format is one type that implements [`Reader`] and one line in [`READERS`]. A reader gets
//! the whole file as bytes (formats differ in encoding and in where their times are to be found)
//! and gives [`Labels`] in order. Live streams have parsers of their own, as
//! [`TimitStream`](crate::timit::TimitStream).

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;

use crate::error::LabelError;
use crate::limits::FILE_BYTES_MAX;
use crate::pronounce::Pronouncer;
use crate::tick::SampleRate;
use crate::{Alphabet, Labels, formats, timit};

/// Every format that can be read, most telling first.
pub static READERS: [&dyn Reader; 17] = [
    &timit::Phones,
    &timit::Words,
    &formats::TextGrid,
    &formats::Xlabel,
    &formats::Hts,
    &formats::Flite,
    &formats::Mbrola,
    &formats::Espeak,
    &formats::Piper,
    &formats::Gentle,
    &formats::TiersJson,
    &formats::Whisper,
    &formats::Characters,
    &formats::Azure,
    &formats::Polly,
    &formats::Rhubarb,
    &formats::Ndjson,
];

/// A label file in memory.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// What messages call it, and whose ending hints at the format: its path, or `<stdin>`.
    pub name: &'a str,
    /// All of it.
    pub bytes: &'a [u8],
}

impl Source<'_> {
    /// Whether the name ends in `.extension`, in capitals or not.
    pub fn has_extension(&self, extension: &str) -> bool {
        let own = Path::new(self.name).extension();
        own.is_some_and(|own| own.eq_ignore_ascii_case(extension))
    }
}

/// What a file itself does not say. Formats take from it what they need.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct ReadOptions {
    /// What the numbers count, in formats that count samples.
    pub rate: SampleRate,
    /// What phones are written in, in formats that leave it open; `None` goes by the symbols.
    pub alphabet: Option<Alphabet>,
    /// Which tier to read, by its name or its number from 1, in formats that have tiers.
    pub tier: Option<String>,
    /// How words sound, in formats that hold words alone; `None` goes by the words built in.
    pub pronouncer: Option<Arc<Pronouncer>>,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self::at(SampleRate::TIMIT)
    }
}

impl ReadOptions {
    /// The defaults, with samples counted at another rate.
    pub fn at(rate: SampleRate) -> Self {
        Self {
            rate,
            alphabet: None,
            tier: None,
            pronouncer: None,
        }
    }
}

/// How sure a reader is that a file is in its format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Match {
    /// It is not.
    No,
    /// It could be read, but other formats look like this too.
    Perhaps,
    /// Its content says so.
    Likely,
    /// Its name says so, or content that no other format has.
    Surely,
}

/// Reads one label format.
pub trait Reader: Sync {
    /// The word by which users ask for the format.
    fn name(&self) -> &'static str;

    /// What the format is, for help texts: a few words.
    fn about(&self) -> &'static str;

    /// Whether a file looks like this format.
    fn detect(&self, source: &Source<'_>) -> Match;

    /// Reads the file, or says what is wrong where.
    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError>;
}

/// The reader of a format by its name.
pub fn reader(name: &str) -> Result<&'static dyn Reader, LabelError> {
    let named = READERS.iter().find(|reader| reader.name() == name);
    named.copied().ok_or_else(|| LabelError::UnknownFormat {
        name: name.to_owned(),
        known: known(),
    })
}

/// The reader that is surest of a file; of equals the first in [`READERS`].
pub fn detect(source: &Source<'_>) -> Result<&'static dyn Reader, LabelError> {
    let mut best: (Match, Option<&'static dyn Reader>) = (Match::No, None);
    for reader in READERS {
        let sure = reader.detect(source);
        if sure > best.0 {
            best = (sure, Some(reader));
        }
    }
    best.1.ok_or_else(|| LabelError::Unrecognised {
        file: source.name.to_owned(),
        known: known(),
    })
}

/// Reads labels in the format `from`, or in the one that they appear to be in.
pub fn read(
    source: &Source<'_>,
    from: Option<&str>,
    options: &ReadOptions,
) -> Result<Labels, LabelError> {
    if source.bytes.trim_ascii().is_empty() {
        return Err(LabelError::Empty {
            file: source.name.to_owned(),
            example: timit::EXAMPLE,
        });
    }
    let reader = match from {
        Some(name) => reader(name)?,
        None => detect(source)?,
    };
    reader.read(source, options)
}

/// The same from a file.
pub fn read_file(
    path: &Path,
    from: Option<&str>,
    options: &ReadOptions,
) -> Result<Labels, LabelError> {
    let name = path.display().to_string();
    let file = File::open(path).map_err(|source| LabelError::Unreadable {
        file: name.clone(),
        source,
    })?;
    read_from(&name, file, from, options)
}

/// The same from anything that can be read to its end, such as standard input.
pub fn read_from(
    name: &str,
    input: impl Read,
    from: Option<&str>,
    options: &ReadOptions,
) -> Result<Labels, LabelError> {
    let bytes = slurp(input).map_err(|source| LabelError::Unreadable {
        file: name.to_owned(),
        source,
    })?;
    if bytes.len() as u64 > FILE_BYTES_MAX {
        return Err(LabelError::TooLarge {
            file: name.to_owned(),
        });
    }
    let bytes = &bytes;
    read(&Source { name, bytes }, from, options)
}

/// Reads to the end, or to one byte past what is allowed.
fn slurp(input: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    input.take(FILE_BYTES_MAX + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn known() -> String {
    let names: Vec<String> = READERS.iter().map(|r| format!("`{}`", r.name())).collect();
    names.join(", ")
}
