//! TIMIT `.WRD` files: reader and writer.
//!
//! They look like `.PHN` files but for their last field, and words may overlap.

use std::io::Write;

use super::Kind;
use super::file::{gather, samples, shape};
use super::line::{Order, parse};
use crate::error::{Fault, LabelError};
use crate::limits::LINE_BYTES_MAX;
use crate::reader::{Match, ReadOptions, Reader, Source};
use crate::tick::SampleRate;
use crate::writer::{WriteError, Writer};
use crate::{Labels, Word};

/// The format of `.WRD` files.
#[derive(Clone, Copy, Debug)]
pub struct Words;

/// Two times of at most 20 digits, two spaces and a line break share the line with the word.
const WORD_BYTES_MAX: usize = LINE_BYTES_MAX - 2 * 20 - 3;

impl Reader for Words {
    fn name(&self) -> &'static str {
        "timit-words"
    }

    fn about(&self) -> &'static str {
        "TIMIT .WRD: lines `start end word`, in samples of 16 kHz"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        if source.has_extension("wrd") {
            return Match::Surely;
        }
        match shape(source.bytes) {
            Some(_) => Match::Perhaps,
            None => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let mut order = Order::default();
        Ok(Labels {
            words: gather(source, |text| word(text, options.rate, &mut order))?,
            ..Labels::default()
        })
    }
}

/// The word that a line holds. Starts may be equal, and it may overlap the one before it.
fn word(text: &str, rate: SampleRate, order: &mut Order) -> Result<Option<Word>, Fault> {
    let Some(line) = parse(text, rate, "start end word")? else {
        return Ok(None);
    };
    order.follow(line.span, true)?;
    Ok(Some(Word {
        text: line.label.to_owned(),
        start: line.span.start,
        end: line.span.end,
    }))
}

impl Writer for Words {
    fn name(&self) -> &'static str {
        Reader::name(self)
    }

    fn write(
        &self,
        labels: &Labels,
        rate: SampleRate,
        out: &mut dyn Write,
    ) -> Result<(), WriteError> {
        if labels.words.is_empty() {
            return Err(WriteError::Nothing(Kind::Word.many()));
        }
        let mut last_start = 0;
        for (index, word) in labels.words.iter().enumerate() {
            let number = index + 1;
            let (start, end) = samples(Kind::Word, number, (word.start, word.end), rate)?;
            if let Some(reason) = unwritable(&word.text, word.start < last_start) {
                let kind = Kind::Word.one();
                return Err(WriteError::Label {
                    kind,
                    number,
                    reason,
                });
            }
            last_start = word.start;
            writeln!(out, "{start} {end} {}", word.text)?;
        }
        Ok(())
    }
}

/// Why a line cannot hold this word.
fn unwritable(text: &str, unsorted: bool) -> Option<&'static str> {
    if unsorted {
        Some("starts before the one before it; sort them")
    } else if text.is_empty() || text.trim() != text {
        Some("is empty or has white space around it; trim it")
    } else if text.chars().any(|c| c.is_control() && c != '\t') {
        Some("holds a line break or control character; remove it")
    } else if text.len() > WORD_BYTES_MAX {
        Some("is longer than a line may be; shorten it")
    } else {
        None
    }
}
