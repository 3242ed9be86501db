//! MBROLA's `.pho` files: reader.
//!
//! A line a phone: `symbol milliseconds [percent hertz]…`. Only lengths: a phone starts where the one
//! before it ends, the first at 0; lengths are summed exactly before they are rounded. What
//! follows a `;` is a comment, a `#` alone flushes the engine and says nothing, pitch is left out.
//! Symbols are SAMPA unless another alphabet is named, `_` is silence.

use super::sheet::{Piece, Sheet};
use super::text::{decode, lines, peek, wrong};
use super::time::{Time, Unit};
use crate::Labels;
use crate::alphabet::Alphabet;
use crate::error::{Fault, LabelError};
use crate::reader::{Match, ReadOptions, Reader, Source};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Mbrola;

const EXAMPLE: &str = "h 60 0 120";
const WANTED: &str = "`symbol milliseconds`";

/// Lines that tell the format.
const LINES_LOOKED_AT: usize = 50;

impl Reader for Mbrola {
    fn name(&self) -> &'static str {
        "mbrola"
    }

    fn about(&self) -> &'static str {
        "MBROLA .pho: lines `symbol milliseconds [percent hertz]…`"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        let text = peek(source);
        let whole = text.len() >= source.bytes.len();
        // The last line looked at may be cut.
        let count = text.lines().count();
        let shown = text.lines().take(if whole {
            count
        } else {
            count.saturating_sub(1)
        });
        let mut labels = shown.filter_map(bare).take(LINES_LOOKED_AT);
        let good = labels.clone().count() > 0 && labels.all(is_label);
        match (source.has_extension("pho"), good) {
            (true, true) => Match::Surely,
            (true, false) => Match::Perhaps,
            (false, true) if lines(&text).any(|(_, l)| l.starts_with("_ ")) => Match::Likely,
            (false, true) => Match::Perhaps,
            (false, false) => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut sheet = Sheet::new(source);
        let mut start = Time::ZERO;
        for (number, line) in (1_u64..).zip(text.lines()) {
            let Some(line) = bare(line) else {
                continue;
            };
            let refuse = |fault| wrong(source, number, fault);
            let (said, length) = label(line).map_err(refuse)?;
            let end = start.plus(length).map_err(refuse)?;
            let piece = Piece::new(said.to_owned(), start, end, number);
            sheet.phone(piece.map_err(refuse)?)?;
            start = end;
        }
        sheet.finish(options, Some(Alphabet::XSampa), EXAMPLE)
    }
}

/// The line without its comment; nothing where that is all, or for a flush.
fn bare(line: &str) -> Option<&str> {
    let line = line.split(';').next().unwrap_or_default().trim();
    (!line.is_empty() && line != "#").then_some(line)
}

/// A symbol and its length.
fn label(line: &str) -> Result<(&str, Time), Fault> {
    let mut fields = line.split_whitespace();
    let said = fields.next().unwrap_or_default();
    let Some(length) = fields.next() else {
        let found = line.to_owned();
        return Err(Fault::Shape {
            found,
            wanted: WANTED,
        });
    };
    Ok((said, Time::parse(length, Unit::Milliseconds)?))
}

/// Whether a line is a symbol, a length and pairs of numbers, as no prose is.
fn is_label(line: &str) -> bool {
    let mut fields = line.split_whitespace();
    let symbol = fields.next().unwrap_or_default();
    let is_number = |text: &str| Time::parse(text, Unit::Milliseconds).is_ok();
    // Some programs write pitch in brackets.
    let brackets = |c: char| matches!(c, '(' | ')' | ',');
    let mut numbers = fields
        .flat_map(|f| f.split(brackets))
        .filter(|f| !f.is_empty());
    !is_number(symbol) && numbers.clone().count() % 2 == 1 && numbers.all(is_number)
}
