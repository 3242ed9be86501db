//! Words as Whisper and WhisperX time them, in JSON: reader.
//!
//! `words` (or `word_segments`, or a list), or `segments` that hold `words` or `chars`: `word` or `text`,
//! `start` and `end` in seconds, the end exclusive. Times come from recognition and are some
//! 20 to 100 ms off; a word may begin before the one before it ends. Words without times (numbers, in
//! WhisperX) take the time between their neighbours, or none. Phones come from pronunciation,
//! unless words have `phones` with times of their own.

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
use crate::note::Note;
use crate::reader::{Match, ReadOptions, Reader, Source};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Whisper;

const EXAMPLE: &str = r#"{"words": [{"word": "a", "start": 0, "end": 0.1}]}"#;

#[derive(Deserialize)]
struct File<'a> {
    #[serde(borrow, default)]
    words: Option<Vec<&'a RawValue>>,
    #[serde(borrow, default)]
    segments: Option<Vec<&'a RawValue>>,
    #[serde(borrow, default)]
    word_segments: Option<Vec<&'a RawValue>>,
}

#[derive(Deserialize)]
struct Segment<'a> {
    #[serde(borrow, default)]
    words: Option<Vec<&'a RawValue>>,
    #[serde(borrow, default)]
    chars: Option<Vec<&'a RawValue>>,
}

#[derive(Deserialize)]
struct Timed<'a> {
    #[serde(borrow, alias = "text", alias = "char", alias = "phone")]
    word: Cow<'a, str>,
    #[serde(borrow, default)]
    start: Option<&'a RawValue>,
    #[serde(borrow, default)]
    end: Option<&'a RawValue>,
    #[serde(borrow, default)]
    phones: Option<Vec<&'a RawValue>>,
}

impl Reader for Whisper {
    fn name(&self) -> &'static str {
        "whisper"
    }

    fn about(&self) -> &'static str {
        "JSON of Whisper, WhisperX and others that time words, in seconds"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        let Some(keys) = Peek::at(source) else {
            return Match::No;
        };
        let foreign = [
            "case",
            "alignedWord",
            "startOffset",
            "entries",
            "phone",
            "duration",
        ];
        let timed = keys.has_all(&["start", "end"]) && keys.has_any(&["word", "text", "char"]);
        let held = keys.has_any(&["words", "segments", "word_segments"]);
        match timed && (held || keys.opening == b'[') {
            true if keys.has_any(&["words", "word_segments", "chars"]) && keys.has("score") => {
                Match::Surely
            }
            true if keys.has_any(&foreign) => Match::Perhaps,
            true => Match::Likely,
            false => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut reading = Reading {
            document: Document::new(source, &text, EXAMPLE),
            sheet: Sheet::new(source),
            words: Vec::new(),
        };
        if text.trim_start().starts_with('[') {
            let words = reading.document.whole::<Vec<&RawValue>>()?;
            reading.words(words)?;
        } else {
            let file = reading.document.whole::<File<'_>>()?;
            let segments = file.segments.unwrap_or_default();
            // Files that have both say the same twice.
            match (file.words, file.word_segments) {
                (Some(words), _) => reading.words(words)?,
                (None, Some(words)) if segments.is_empty() => reading.words(words)?,
                _ => reading.segments(segments)?,
            }
        }
        reading.place()?;
        reading.sheet.finish(options, None, EXAMPLE)
    }
}

struct Reading<'a> {
    document: Document<'a>,
    sheet: Sheet<'a>,
    words: Vec<Word>,
}

impl<'a> Reading<'a> {
    fn segments(&mut self, segments: Vec<&'a RawValue>) -> Result<(), LabelError> {
        for raw in segments {
            let (_, segment) = self.document.item::<Segment<'_>>(raw)?;
            match (segment.words, segment.chars) {
                (Some(words), _) => self.words(words)?,
                (None, Some(chars)) => self.chars(chars)?,
                (None, None) => self.words(vec![raw])?,
            }
        }
        Ok(())
    }

    fn words(&mut self, words: Vec<&'a RawValue>) -> Result<(), LabelError> {
        for raw in words {
            let (line, word) = self.document.item::<Timed<'_>>(raw)?;
            let times = self.times(&word, line)?;
            let text = word.word.trim().to_owned();
            self.words.push(Word { text, times, line });
            for raw in word.phones.unwrap_or_default() {
                let (line, phone) = self.document.item::<Timed<'_>>(raw)?;
                if let Some((start, end)) = self.times(&phone, line)? {
                    let piece = Piece::new(phone.word.into_owned(), start, end, line);
                    let piece = piece.map_err(|f| self.document.wrong(line, f))?;
                    self.sheet.phone(piece)?;
                }
            }
        }
        Ok(())
    }

    fn chars(&mut self, chars: Vec<&'a RawValue>) -> Result<(), LabelError> {
        let mut letters = Letters::default();
        for raw in chars {
            let (line, one) = self.document.item::<Timed<'_>>(raw)?;
            let times = self.times(&one, line)?;
            self.words.extend(letters.push(&one.word, times, line));
        }
        self.words.extend(letters.finish());
        Ok(())
    }

    fn times(&self, timed: &Timed<'_>, line: u64) -> Result<Option<(Time, Time)>, LabelError> {
        let (Some(start), Some(end)) = (timed.start, timed.end) else {
            return Ok(None);
        };
        let read = |raw| time(raw, Unit::Seconds).map_err(|f| self.document.wrong(line, f));
        Ok(Some((read(start)?, read(end)?)))
    }

    /// Gives words without times the time between their neighbours.
    fn place(&mut self) -> Result<(), LabelError> {
        let words = std::mem::take(&mut self.words);
        let mut last_end = Time::ZERO;
        let mut untimed: Option<(u64, usize)> = None;
        let mut waiting: Vec<(String, u64)> = Vec::new();
        for word in words {
            let Some((start, end)) = word.times else {
                untimed = Some(untimed.map_or((word.line, 1), |(line, n)| (line, n + 1)));
                waiting.push((word.text, word.line));
                continue;
            };
            self.fill(&mut waiting, last_end, start)?;
            let piece = Piece::new(word.text, start, end, word.line);
            let piece = piece.map_err(|f| self.document.wrong(word.line, f))?;
            self.sheet.word(piece)?;
            last_end = last_end.max(end);
        }
        if let Some((line, count)) = untimed {
            let text = format!("words without times ({count}) get the time between others, if any");
            self.sheet.notes.push(Note::at(line, text));
        }
        Ok(())
    }

    /// Words that wait between two instants, as one label that their words share.
    fn fill(
        &mut self,
        waiting: &mut Vec<(String, u64)>,
        from: Time,
        to: Time,
    ) -> Result<(), LabelError> {
        let Some((_, line)) = waiting.first() else {
            return Ok(());
        };
        let line = *line;
        let texts: Vec<&str> = waiting.iter().map(|(text, _)| text.as_str()).collect();
        let text = texts.join(" ");
        waiting.clear();
        if from >= to {
            return Ok(());
        }
        let piece = Piece::new(text, from, to, line);
        self.sheet
            .word(piece.map_err(|f| self.document.wrong(line, f))?)
    }
}
