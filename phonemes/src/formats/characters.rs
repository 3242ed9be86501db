//! Timed characters, as cloud voices (ElevenLabs and others after it) give them in JSON: reader.
//!
//! `characters` with `character_start_times_seconds` and `character_end_times_seconds`, or `chars` with
//! `charStartTimesMs` and `charDurationsMs`; alone or as `alignment`, or as
//! `normalized_alignment`, which says what was spoken (`2` as `two`) and is preferred. Several
//! objects may follow one another, as streams give them; one whose times start over is moved to
//! the end of the one before it. Characters become words, and words phones by pronunciation: a
//! letter's own time says little, since most voices spread a word's time over its letters.

use std::borrow::Cow;

use serde::Deserialize;
use serde_json::value::RawValue;

use super::json::{Document, Peek, time};
use super::letters::{Letters, Word};
use super::sheet::{Piece, Sheet};
use super::text::decode;
use super::time::{Time, Unit};
use crate::Labels;
use crate::error::LabelError;
use crate::reader::{Match, ReadOptions, Reader, Source};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Characters;

const EXAMPLE: &str = r#"{"characters": ["a"], "character_start_times_seconds": [0], "character_end_times_seconds": [0.1]}"#;

#[derive(Deserialize)]
struct Answer<'a> {
    #[serde(borrow, default, alias = "normalizedAlignment")]
    normalized_alignment: Option<&'a RawValue>,
    #[serde(borrow, default)]
    alignment: Option<&'a RawValue>,
}

#[derive(Deserialize)]
struct Alignment<'a> {
    #[serde(borrow, alias = "chars")]
    characters: Vec<Cow<'a, str>>,
    #[serde(borrow, default)]
    character_start_times_seconds: Option<Vec<&'a RawValue>>,
    #[serde(borrow, default)]
    character_end_times_seconds: Option<Vec<&'a RawValue>>,
    #[serde(
        borrow,
        default,
        rename = "charStartTimesMs",
        alias = "char_start_times_ms"
    )]
    starts_ms: Option<Vec<&'a RawValue>>,
    #[serde(
        borrow,
        default,
        rename = "charDurationsMs",
        alias = "charsDurationsMs",
        alias = "char_durations_ms"
    )]
    durations_ms: Option<Vec<&'a RawValue>>,
}

impl Reader for Characters {
    fn name(&self) -> &'static str {
        "characters"
    }

    fn about(&self) -> &'static str {
        "JSON of voices that time characters (ElevenLabs): `character_start_times_seconds`"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        let own = [
            "character_start_times_seconds",
            "charStartTimesMs",
            "char_start_times_ms",
        ];
        match Peek::at(source) {
            Some(keys) if keys.has_any(&own) => Match::Surely,
            _ => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut document = Document::new(source, &text, EXAMPLE);
        let mut sheet = Sheet::new(source);
        let values: Vec<&RawValue> = document.values().collect::<Result<_, _>>()?;
        let mut offset = Time::ZERO;
        let mut end = Time::ZERO;
        let mut letters = Letters::default();
        for raw in values {
            let (line, answer) = document.item::<Answer<'_>>(raw)?;
            let held = answer.normalized_alignment.or(answer.alignment);
            if held.is_none() && !raw.get().contains("\"char") {
                // A piece of sound without text.
                continue;
            }
            let (line, alignment) = match held {
                Some(held) => document.item::<Alignment<'_>>(held)?,
                None => (line, document.item::<Alignment<'_>>(raw)?.1),
            };
            let times = alignment.times(&document, line)?;
            if times
                .first()
                .is_some_and(|(start, _)| *start < end.minus(offset))
            {
                offset = end;
            }
            for (letter, (start, stop)) in alignment.characters.iter().zip(times) {
                let wrong = |fault| document.wrong(line, fault);
                let start = start.plus(offset).map_err(wrong)?;
                let stop = stop.plus(offset).map_err(wrong)?;
                end = end.max(stop);
                if let Some(word) = letters.push(letter, Some((start, stop)), line) {
                    add(&mut sheet, &document, word)?;
                }
            }
        }
        if let Some(word) = letters.finish() {
            add(&mut sheet, &document, word)?;
        }
        sheet.finish(options, None, EXAMPLE)
    }
}

fn add(sheet: &mut Sheet<'_>, document: &Document<'_>, word: Word) -> Result<(), LabelError> {
    let Some((start, end)) = word.times else {
        return Ok(());
    };
    let piece = Piece::new(word.text, start, end, word.line);
    sheet.word(piece.map_err(|fault| document.wrong(word.line, fault))?)
}

impl Alignment<'_> {
    /// Start and end of each character.
    fn times(&self, document: &Document<'_>, line: u64) -> Result<Vec<(Time, Time)>, LabelError> {
        let seconds = (
            &self.character_start_times_seconds,
            &self.character_end_times_seconds,
        );
        let (starts, others, unit) = match (seconds, &self.starts_ms, &self.durations_ms) {
            ((Some(starts), Some(ends)), ..) => (starts, ends, Unit::Seconds),
            (_, Some(starts), Some(lengths)) => (starts, lengths, Unit::Milliseconds),
            _ => return Err(document.refused(line, "characters without start and end times")),
        };
        if starts.len() != self.characters.len() || others.len() != starts.len() {
            return Err(document.refused(line, "lists of different length"));
        }
        let both = starts.iter().zip(others);
        both.map(|(start, other)| {
            let start = time(start, unit).map_err(|f| document.wrong(line, f))?;
            let other = time(other, unit).map_err(|f| document.wrong(line, f))?;
            let end = match unit {
                Unit::Seconds => other,
                _ => start.plus(other).map_err(|f| document.wrong(line, f))?,
            };
            Ok((start, end))
        })
        .collect()
    }
}
