//! What `flite -psdur` prints: reader.
//!
//! `phone:END` with spaces between, END in seconds from the start of the sentence; a line is a
//! sentence. A phone starts where the one before it ends. Times start over in each line, so a
//! sentence is moved by the ends of those before it. Flite rounds the ends to milliseconds and up: its
//! sound is 2 to 5 ms shorter than its labels in each sentence (voice kal16: 115 ms shorter,
//! since its last pause is cut), so that labels of many sentences drift late unless the sound's own
//! lengths are known.

use super::sheet::{Piece, Sheet};
use super::text::{decode, peek, wrong};
use super::time::{Time, Unit};
use crate::Labels;
use crate::alphabet::Alphabet;
use crate::error::{Fault, LabelError};
use crate::reader::{Match, ReadOptions, Reader, Source};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Flite;

const EXAMPLE: &str = "pau:0.150 hh:0.210";
const WANTED: &str = "`phone:END`";

impl Reader for Flite {
    fn name(&self) -> &'static str {
        "flite"
    }

    fn about(&self) -> &'static str {
        "flite -psdur: `phone:END`, seconds from the start of each line's sentence"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        let text = peek(source);
        let mut labels = text.split_whitespace();
        let good = labels.by_ref().take(3).filter(|l| label(l).is_ok()).count();
        match good {
            3 => Match::Surely,
            2 if labels.next().is_none() => Match::Likely,
            _ => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut sheet = Sheet::new(source);
        let mut sentence = Time::ZERO;
        for (number, line) in (1_u64..).zip(text.lines()) {
            let refuse = |fault| wrong(source, number, fault);
            let mut start = Time::ZERO;
            for one in line.split_whitespace() {
                let (said, end) = label(one).map_err(refuse)?;
                if end < start {
                    // Sentences that were put into one line.
                    sentence = sentence.plus(start).map_err(refuse)?;
                    start = Time::ZERO;
                }
                let from = sentence.plus(start).map_err(refuse)?;
                let to = sentence.plus(end).map_err(refuse)?;
                let piece = Piece::new(said.to_owned(), from, to, number);
                sheet.phone(piece.map_err(refuse)?)?;
                start = end;
            }
            sentence = sentence.plus(start).map_err(refuse)?;
        }
        sheet.finish(options, Some(Alphabet::Radio), EXAMPLE)
    }
}

/// A label and its end.
fn label(text: &str) -> Result<(&str, Time), Fault> {
    let (said, end) = text.rsplit_once(':').ok_or_else(|| Fault::Shape {
        found: text.to_owned(),
        wanted: WANTED,
    })?;
    let end = Time::parse(end, Unit::Seconds)?;
    if said.is_empty() || end < Time::ZERO {
        let found = text.to_owned();
        return Err(Fault::Shape {
            found,
            wanted: WANTED,
        });
    }
    Ok((said, end))
}
