//! Speech marks of Amazon Polly: reader.
//!
//! One JSON object a line: `time` in milliseconds from the start of the sound, `type`, `value`.
//! Visemes become phones that look alike; words keep their spelling; sentences and SSML marks are
//! left out. Starts only: a shape lasts until the next, a word until the next word or the next silence.
//! (`start` and `end` are places in the text, in bytes, not times.) Without visemes, phones come from
//! the words' pronunciation.

use std::borrow::Cow;

use serde::Deserialize;
use serde_json::value::RawValue;

use super::json::{Document, Peek, time};
use super::sheet::{Piece, Sheet};
use super::text::decode;
use super::time::{Time, Unit};
use super::visemes::Visemes;
use crate::error::LabelError;
use crate::reader::{Match, ReadOptions, Reader, Source};
use crate::{Labels, Phone};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Polly;

const EXAMPLE: &str = r#"{"time": 6, "type": "viseme", "value": "p"}"#;

/// How long the last word is taken to last where no silence ends it.
const LAST_WORD: Time = Time::milliseconds(300);

/// Polly's visemes, as its documentation lists them for English, and the phones taken for them.
const PHONES: [(&str, Phone); 19] = [
    ("sil", Phone::Pau),
    ("p", Phone::M),  // p b m
    ("t", Phone::N),  // t d n l
    ("T", Phone::Dh), // ð θ
    ("S", Phone::Sh), // ʃ tʃ dʒ ʒ
    ("f", Phone::F),  // f v
    ("k", Phone::Ng), // k g h ŋ
    ("r", Phone::R),
    ("s", Phone::S), // s z
    ("i", Phone::Iy),
    ("e", Phone::Ey),
    ("E", Phone::Eh), // ɛ ʌ ɝ
    ("a", Phone::Aa), // ɑ æ aɪ aʊ
    ("o", Phone::Ow),
    ("O", Phone::Ao), // ɔ ɔɪ
    ("u", Phone::Uw), // u ʊ w
    ("@", Phone::Ax),
    ("J", Phone::Y),
    ("B", Phone::M),
];

#[derive(Deserialize)]
struct Mark<'a> {
    #[serde(borrow)]
    time: &'a RawValue,
    #[serde(borrow, rename = "type")]
    kind: Cow<'a, str>,
    #[serde(borrow, default)]
    value: Cow<'a, str>,
}

impl Reader for Polly {
    fn name(&self) -> &'static str {
        "polly"
    }

    fn about(&self) -> &'static str {
        "Amazon Polly's speech marks: a JSON object a line, `time` in ms, `type`, `value`"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        match Peek::at(source) {
            Some(keys) if keys.has_all(&["time", "type", "value"]) => Match::Surely,
            _ => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut document = Document::new(source, &text, EXAMPLE);
        let mut visemes = Visemes::new("Polly's visemes");
        let mut words: Vec<(Time, String, u64)> = Vec::new();
        // Where a word may end: the next word, or silence.
        let mut ends: Vec<Time> = Vec::new();
        let values: Vec<&RawValue> = document.values().collect::<Result<_, _>>()?;
        for raw in values {
            let (line, mark) = document.item::<Mark<'_>>(raw)?;
            let start = time(mark.time, Unit::Milliseconds);
            let start = start.map_err(|fault| document.wrong(line, fault))?;
            match &*mark.kind {
                "viseme" => {
                    let known = PHONES.iter().find(|(symbol, _)| *symbol == mark.value);
                    visemes.push(start, known.map(|(_, phone)| *phone), &mark.value, line);
                    if mark.value == "sil" {
                        ends.push(start);
                    }
                }
                "word" => {
                    words.push((start, mark.value.into_owned(), line));
                    ends.push(start);
                }
                _ => {}
            }
        }
        ends.sort_unstable();
        let mut sheet = Sheet::new(source);
        for (start, said, line) in words {
            let refuse = |fault| document.wrong(line, fault);
            let next = ends.get(ends.partition_point(|end| *end <= start));
            let end = match next {
                Some(end) => *end,
                None => start.plus(LAST_WORD).map_err(refuse)?,
            };
            sheet.word(Piece::new(said, start, end, line).map_err(refuse)?)?;
        }
        visemes.finish(None, &mut sheet)?;
        sheet.finish(options, None, EXAMPLE)
    }
}
