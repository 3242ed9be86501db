//! Gentle's JSON: reader.
//!
//! `words`, each with `start` and `end` in seconds and `phones` that have durations only: a phone
//! starts where the one before it ends, the first with its word. Phones are ARPAbet in small
//! letters with their place in the word behind them (`hh_B`). Words that Gentle did not find in
//! the sound have no times and are left out; between words there are gaps, not labels.

use std::borrow::Cow;

use serde::Deserialize;
use serde_json::value::RawValue;

use super::json::{Document, Peek, time};
use super::sheet::{Piece, Sheet};
use super::text::decode;
use super::time::Unit;
use crate::Labels;
use crate::alphabet::Alphabet;
use crate::error::LabelError;
use crate::note::Note;
use crate::reader::{Match, ReadOptions, Reader, Source};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Gentle;

const EXAMPLE: &str = r#"{"words": [{"word": "a", "start": 0, "end": 0.1, "phones": []}]}"#;

#[derive(Deserialize)]
struct File<'a> {
    #[serde(borrow)]
    words: Vec<&'a RawValue>,
}

#[derive(Deserialize)]
struct Word<'a> {
    #[serde(borrow)]
    word: Cow<'a, str>,
    #[serde(borrow)]
    start: Option<&'a RawValue>,
    #[serde(borrow)]
    end: Option<&'a RawValue>,
    #[serde(borrow, default)]
    phones: Vec<&'a RawValue>,
}

#[derive(Deserialize)]
struct Phone<'a> {
    #[serde(borrow)]
    phone: Cow<'a, str>,
    #[serde(borrow)]
    duration: &'a RawValue,
}

impl Reader for Gentle {
    fn name(&self) -> &'static str {
        "gentle"
    }

    fn about(&self) -> &'static str {
        "Gentle's JSON: words in seconds, phones by their durations"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        let keys = Peek::at(source).filter(|k| k.opening == b'{' && k.has("words"));
        let own = ["case", "alignedWord", "startOffset"];
        match keys {
            Some(k) if k.has_any(&own) || k.has_all(&["phones", "duration"]) => Match::Surely,
            _ => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut document = Document::new(source, &text, EXAMPLE);
        let mut sheet = Sheet::new(source);
        let mut unfound: Option<(u64, usize)> = None;
        for raw in document.whole::<File<'_>>()?.words {
            let (line, word) = document.item::<Word<'_>>(raw)?;
            let (Some(start), Some(end)) = (word.start, word.end) else {
                unfound = Some(unfound.map_or((line, 1), |(first, n)| (first, n + 1)));
                continue;
            };
            let start = time(start, Unit::Seconds).map_err(|f| document.wrong(line, f))?;
            let end = time(end, Unit::Seconds).map_err(|f| document.wrong(line, f))?;
            let said = word.word.into_owned();
            let piece = Piece::new(said, start, end, line);
            sheet.word(piece.map_err(|f| document.wrong(line, f))?)?;
            let mut at = start;
            for raw in word.phones {
                let (line, phone) = document.item::<Phone<'_>>(raw)?;
                let refuse = |fault| document.wrong(line, fault);
                let length = time(phone.duration, Unit::Seconds).map_err(refuse)?;
                let until = at.plus(length).map_err(refuse)?;
                let symbol = bare(&phone.phone).to_owned();
                let piece = Piece::new(symbol, at, until, line);
                sheet.phone(piece.map_err(refuse)?)?;
                at = until;
            }
        }
        if let Some((line, count)) = unfound {
            let text = format!(
                "words not found in the sound ({count}) are left out; the mouth rests there"
            );
            sheet.notes.push(Note::at(line, text));
        }
        sheet.finish(options, Some(Alphabet::Arpabet), EXAMPLE)
    }
}

/// A phone without its place in the word.
fn bare(phone: &str) -> &str {
    match phone.rsplit_once('_') {
        Some((bare, "B" | "I" | "E" | "S")) if !bare.is_empty() => bare,
        _ => phone,
    }
}
