//! Phoneme alignments of Piper's voices, as JSON: reader.
//!
//! A list of `[start, end, symbol]` in seconds, one after the other without gaps, ends exclusive. The
//! voice speaks signs of IPA, each with a duration of its own, marks included. So here a mark of
//! stress belongs to what follows, one of length to what stands before it, signs that are one phone
//! together (`e` `ɪ`) are one label, and a space is no pause unless it lasts as long as one: each of
//! the sounds around it gets half of its time. Alignments are whole frames of the voice (5.8 or 11.6 ms),
//! and their sum is the sound's length exactly.

use std::borrow::Cow;

use serde_json::value::RawValue;

use super::json::{Document, Peek, time};
use super::sheet::{Piece, Sheet};
use super::text::decode;
use super::time::{Time, Unit, seconds};
use crate::Labels;
use crate::alphabet::{Alphabet, Timed, join};
use crate::error::{Fault, LabelError};
use crate::limits::LABELS_MAX;
use crate::reader::{Match, ReadOptions, Reader, Source};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Piper;

const EXAMPLE: &str = r#"[[0, 0.1, "h"]]"#;

/// A space that lasts longer is a pause.
const SPACE_MAX: Time = Time::milliseconds(80);

impl Reader for Piper {
    fn name(&self) -> &'static str {
        "piper"
    }

    fn about(&self) -> &'static str {
        "Piper's phoneme alignments as JSON: lists `[start, end, symbol]`, in seconds"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        let Some(_) = Peek::at(source).filter(|p| p.opening == b'[') else {
            return Match::No;
        };
        let bytes = source.bytes.iter().filter(|b| !b.is_ascii_whitespace());
        let mut bytes = bytes.skip_while(|b| **b != b'[').skip(1).copied();
        match (bytes.next(), bytes.next()) {
            (Some(b'['), Some(b'0'..=b'9')) => Match::Surely,
            _ => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut document = Document::new(source, &text, EXAMPLE);
        let mut sheet = Sheet::new(source);
        let alphabet = options.alphabet.unwrap_or(Alphabet::Ipa);
        let mut signs: Vec<(Cow<'_, str>, i64, i64)> = Vec::new();
        for raw in document.whole::<Vec<&RawValue>>()? {
            let (line, fields) = document.item::<Vec<&RawValue>>(raw)?;
            let [start, end, symbol] = fields[..] else {
                return Err(document.refused(line, "an entry without start, end and symbol"));
            };
            if signs.len() == LABELS_MAX {
                let file = source.name.to_owned();
                return Err(LabelError::TooMany { file, line });
            }
            let mut symbol = document.item::<Cow<'_, str>>(symbol)?.1;
            let start = time(start, Unit::Seconds).map_err(|f| document.wrong(line, f))?;
            let end = time(end, Unit::Seconds).map_err(|f| document.wrong(line, f))?;
            let last = signs.last().map_or(0, |last| last.2);
            if end < start || start.ticks() < last {
                let (start, end) = (seconds(last).max(start), end.min(start));
                let (start, end) = (start.to_string(), end.to_string());
                return Err(document.wrong(line, Fault::Backwards { start, end }));
            }
            if symbol.trim().is_empty() && end.minus(start) > SPACE_MAX {
                symbol = "_".into();
            }
            signs.push((symbol, start.ticks(), end.ticks()));
        }
        let timed: Vec<Timed<'_>> = signs
            .iter()
            .map(|(symbol, start, end)| Timed {
                symbol: symbol.as_ref(),
                start: *start,
                end: *end,
            })
            .collect();
        let mut segments = Vec::new();
        join(alphabet, &timed, &mut segments, &mut sheet.notes);
        for segment in segments {
            sheet.phone(Piece::from(segment))?;
        }
        sheet.finish(options, Some(alphabet), EXAMPLE)
    }
}
