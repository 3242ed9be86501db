//! What can be wrong with labels, in one sentence that names the file, the line and the mend.
//!
//! A [`Fault`] is what is wrong in one line, whatever the line came from; a [`LineError`] adds the
//! line's number, a [`LabelError`] the file. Streams report the second, files the third.

use std::io;

use thiserror::Error;

use crate::limits::{FILE_BYTES_MAX, LABELS_MAX, LINE_BYTES_MAX};
use crate::nearest::listed;

/// A label file that cannot be used, and why.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LabelError {
    /// The file cannot be opened or read.
    #[error("{file}: cannot be read ({source}); check the name and who may read it")]
    Unreadable {
        /// The file as the user named it.
        file: String,
        /// What the system said.
        source: io::Error,
    },
    /// More bytes than any label file has.
    #[error("{file}: is larger than {} MiB; give a label file, not the sound", FILE_BYTES_MAX >> 20)]
    TooLarge {
        /// The file as the user named it.
        file: String,
    },
    /// No label at all.
    #[error("{file}: holds no label; give at least one line, such as `{example}`")]
    Empty {
        /// The file as the user named it.
        file: String,
        /// A line in the format that was expected.
        example: &'static str,
    },
    /// More labels than anyone speaks.
    #[error("{file}, line {line}: more than {LABELS_MAX} labels; split the file")]
    TooMany {
        /// The file as the user named it.
        file: String,
        /// The first line too many, from 1.
        line: u64,
    },
    /// A line that cannot be used.
    #[error("{file}, {error}{}", if *.cut_off { " (the file stops in this line, so it may have been cut off)" } else { "" })]
    Line {
        /// The file as the user named it.
        file: String,
        /// Which line, and what is wrong there.
        error: LineError,
        /// The file ends within this line.
        cut_off: bool,
    },
    /// No reader takes the file for its own.
    #[error("{file}: is in no label format known here; name one of {known} if it is one")]
    Unrecognised {
        /// The file as the user named it.
        file: String,
        /// The formats that can be read.
        known: String,
    },
    /// The user asked for a tier that the file lacks.
    #[error("{file}: has no tier `{tier}` of intervals; name one of {known}")]
    NoTier {
        /// The file as the user named it.
        file: String,
        /// What was asked for.
        tier: String,
        /// The tiers that can be read.
        known: String,
    },
    /// The user asked for a format that does not exist.
    #[error("`{name}` is no label format; give one of {known}")]
    UnknownFormat {
        /// What was asked for.
        name: String,
        /// The formats that exist.
        known: String,
    },
}

/// A line that cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("line {line}: {fault}")]
pub struct LineError {
    /// The line, from 1.
    pub line: u64,
    /// What is wrong with it.
    pub fault: Fault,
}

/// What is wrong with a line. Numbers are as they stand in the line.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Fault {
    /// Longer than a label can be.
    #[error("longer than {LINE_BYTES_MAX} bytes; end each label with a line break")]
    TooLong,
    /// Not UTF-8, or control characters.
    #[error("not text; save the labels as UTF-8 text, one label a line")]
    NotText,
    /// A field is missing.
    #[error("{found} of the 3 fields `{wanted}`; add what is missing")]
    Missing {
        /// Fields in the line.
        found: usize,
        /// What the fields should be.
        wanted: &'static str,
    },
    /// Something stands after the last field.
    #[error("`{}` stands after the phone; write only `start end phone`", clip(.0))]
    Extra(String),
    /// A time that is no whole number.
    #[error("`{}` is not a whole number; write times as sample indices", clip(.0))]
    NotWhole(String),
    /// A time before the sound.
    #[error("time {0} is negative; count samples from 0 at the start of the sound")]
    Negative(i64),
    /// A time after any sound.
    #[error("time {} lies beyond 24 hours; write sample indices, and check the rate", clip(.0))]
    TooLate(String),
    /// Ends where it starts, or before.
    #[error("ends at {end} but starts at {start}; put the end after the start")]
    EndsEarly {
        /// The start, as written.
        start: i64,
        /// The end, as written.
        end: i64,
    },
    /// Starts before the label before it starts.
    #[error("starts at {start}, before the previous label's start {previous}; sort by start")]
    Unsorted {
        /// The start, as written.
        start: i64,
        /// The previous label's start.
        previous: i64,
    },
    /// Starts before the label before it ends.
    #[error("starts at {start}, inside the previous label that ends at {previous}; move one")]
    Overlaps {
        /// The start, as written.
        start: i64,
        /// The previous label's end.
        previous: i64,
    },
    /// A time that is no number.
    #[error("`{}` is no time; write {unit}", clip(.text))]
    NotTime {
        /// What stands there.
        text: String,
        /// What should.
        unit: &'static str,
    },
    /// A time after any sound, in a format that does not count samples.
    #[error("time {} lies beyond 24 hours; check its unit", clip(.0))]
    Beyond(String),
    /// Ends before it starts, in a format that does not count samples.
    #[error("ends at {} but starts at {}; put the end after the start", clip(.end), clip(.start))]
    Backwards {
        /// The start, as written.
        start: String,
        /// The end, as written.
        end: String,
    },
    /// Something else than the format has in this place.
    #[error("`{}` stands where {wanted} should; mend the line, or name another format", clip(.found))]
    Shape {
        /// What stands there.
        found: String,
        /// What should.
        wanted: &'static str,
    },
    /// The file is over too soon.
    #[error("the file ends where {0} should stand; save it again, whole")]
    Ends(&'static str),
    /// JSON that is broken, or is not the format's.
    #[error("not the JSON of this format ({reason}); write {wanted}")]
    Json {
        /// What is wrong.
        reason: String,
        /// What should stand there.
        wanted: &'static str,
    },
    /// No such phone.
    #[error("`{}` is not a TIMIT phone code; write one, such as {}", clip(.0), listed(.0))]
    UnknownPhone(String),
}

/// Longest piece of a user's file that a message repeats.
const QUOTE_CHARS_MAX: usize = 24;

/// `text`, shortened and with its invisible characters shown, fit for one line of a terminal.
pub(crate) fn clip(text: &str) -> String {
    let mut out: String = text
        .chars()
        .take(QUOTE_CHARS_MAX)
        .flat_map(char::escape_debug)
        .collect();
    if text.chars().nth(QUOTE_CHARS_MAX).is_some() {
        out.push('…');
    }
    out
}
