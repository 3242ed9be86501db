//! What `.PHN` and `.WRD` files have in common: reading line by line, telling them from other
//! files, writing times.

use super::{EXAMPLE, Kind};
use crate::Phone;
use crate::error::{Fault, LabelError, LineError};
use crate::limits::{LABELS_MAX, LINE_BYTES_MAX};
use crate::lines::Lines;
use crate::reader::Source;
use crate::tick::{SampleRate, TICKS_MAX};
use crate::writer::WriteError;

/// What `parse` makes of each line, blank ones (`None`) left out; or the first thing wrong.
pub(super) fn gather<T>(
    source: &Source<'_>,
    mut parse: impl FnMut(&str) -> Result<Option<T>, Fault>,
) -> Result<Vec<T>, LabelError> {
    let file = || source.name.to_owned();
    let mut labels = Vec::new();
    let mut wrong: Option<LabelError> = None;
    let mut lines = Lines::default();
    let mut cut_off = false;
    let mut each = |cut_off: bool, line: u64, text: Result<&str, Fault>| {
        if wrong.is_some() {
            return;
        }
        match text.and_then(&mut parse) {
            Ok(Some(_)) if labels.len() == LABELS_MAX => {
                wrong = Some(LabelError::TooMany { file: file(), line });
            }
            Ok(Some(label)) => labels.push(label),
            Ok(None) => {}
            Err(fault) => {
                wrong = Some(LabelError::Line {
                    file: file(),
                    error: LineError { line, fault },
                    cut_off,
                });
            }
        }
    };
    lines.push(source.bytes, |line, text| each(cut_off, line, text));
    cut_off = true;
    lines.finish(|line, text| each(cut_off, line, text));
    match wrong {
        Some(error) => Err(error),
        None if labels.is_empty() => Err(LabelError::Empty {
            file: file(),
            example: EXAMPLE,
        }),
        None => Ok(labels),
    }
}

/// Lines that tell what a file holds.
const LINES_LOOKED_AT: usize = 20;

/// What the first lines look like: how many have TIMIT's shape, and how many of those name a
/// phone. `None` where the first line that is not blank has another shape.
pub(super) fn shape(bytes: &[u8]) -> Option<(usize, usize)> {
    let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
    let lines = bytes.trim_ascii_start().split(|b| *b == b'\n');
    let labels = lines.take(LINES_LOOKED_AT).map_while(label);
    let (all, phones) = labels.fold((0, 0), |(all, phones), label| {
        (
            all + 1,
            phones + usize::from(Phone::from_code(label).is_some()),
        )
    });
    (all > 0).then_some((all, phones))
}

/// The first word after two numbers.
fn label(line: &[u8]) -> Option<&str> {
    let line = line.get(..LINE_BYTES_MAX.min(line.len()))?;
    let mut fields = std::str::from_utf8(line).ok()?.split_whitespace();
    for _ in 0..2 {
        fields.next()?.parse::<i64>().ok()?;
    }
    fields.next()
}

/// The samples that a label's line gives, checked so that reading them back gives the label.
pub(super) fn samples(
    kind: Kind,
    number: usize,
    (start, end): (i64, i64),
    rate: SampleRate,
) -> Result<(i64, i64), WriteError> {
    let refuse = |reason| {
        Err(WriteError::Label {
            kind: kind.one(),
            number,
            reason,
        })
    };
    if start < 0 {
        return refuse("starts before 0; shift the labels");
    }
    if end > TICKS_MAX {
        return refuse("ends after 24 hours; split the labels");
    }
    let (first, last) = (rate.samples(start), rate.samples(end));
    if end <= start || last <= first {
        return refuse("is shorter than a sample; drop it or write at a higher rate");
    }
    Ok((first, last))
}
