//! Our own labels, one JSON object a line: reader, writer, stream.
//!
//! | object | says |
//! |---|---|
//! | `{"start":0.12,"end":0.2,"phone":"hh"}` | a phone: the wire's label, with `"stress":0`, `1` or `2` where known |
//! | `{"start":0.1,"end":0.4,"word":"hello"}` | a word |
//! | `{"alphabet":"ipa","label_rate":16000}` | how the lines after it are written, as in the wire's `begin` |
//! | `{"type":"phones","phones":[…]}` | the wire's message: the labels in it (in files only) |
//!
//! Times are decimal seconds from the start of the sound, or whole samples where `label_rate` was
//! said; ends are exclusive. Phones are TIMIT's, unless another alphabet is named or the symbols
//! of a file fit another better. Six decimals keep every tick apart, so writing loses nothing. Objects
//! of other kinds are left out.

mod object;
mod stream;

use std::io::Write;

use super::json::{Document, Peek};
use super::sheet::{Piece, Said, Sheet};
use super::text::{decode, lines, wrong};
use super::time::seconds;
use super::write::{Spans, has_breaks};
use crate::alphabet::Alphabet;
use crate::error::LabelError;
use crate::reader::{Match, ReadOptions, Reader, Source};
use crate::tick::SampleRate;
use crate::writer::{WriteError, Writer};
use crate::{Labels, Stress};
use object::{Label, Object, Setting};

pub use stream::NdjsonStream;

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Ndjson;

const EXAMPLE: &str = r#"{"start":0,"end":0.12,"phone":"h#"}"#;

/// Keys of formats that also hold phones or words with times, but inside of something.
const CONTAINERS: [&str; 6] = [
    "words",
    "segments",
    "word_segments",
    "tiers",
    "entries",
    "mouthCues",
];

impl Reader for Ndjson {
    fn name(&self) -> &'static str {
        "ndjson"
    }

    fn about(&self) -> &'static str {
        "Mouthpiece's own: a JSON object a line, `start`, `end`, `phone` or `word`, in seconds"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        match Peek::at(source).filter(|k| k.opening == b'{' && !k.has_any(&CONTAINERS)) {
            Some(k) if k.has_all(&["start", "end"]) && k.has_any(&["phone", "word"]) => {
                Match::Surely
            }
            _ => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut sheet = Sheet::new(source);
        let mut setting = Setting::default();
        for (number, line) in lines(&text) {
            let object = Object::parse(line).map_err(|fault| wrong(source, number, fault))?;
            setting
                .take(&object)
                .map_err(|fault| wrong(source, number, fault))?;
            let mut document = Document::new(source, line, EXAMPLE);
            for raw in object.phones.iter().flatten() {
                let (_, held) = document.item::<Object<'_>>(raw)?;
                add(&mut sheet, held.label(&setting), number)?;
            }
            add(&mut sheet, object.label(&setting), number)?;
        }
        sheet.finish(options, setting.alphabet, EXAMPLE)
    }
}

fn add(
    sheet: &mut Sheet<'_>,
    label: Result<Option<Label<'_>>, crate::Fault>,
    line: u64,
) -> Result<(), LabelError> {
    let Some(label) = label.map_err(|fault| sheet.wrong(line, fault))? else {
        return Ok(());
    };
    let piece = Piece {
        said: Said::Text(label.text.into_owned().into()),
        start: label.start,
        end: label.end,
        line,
        stress: label.stress,
    };
    match label.is_word {
        true => sheet.word(piece),
        false => sheet.phone(piece),
    }
}

impl Writer for Ndjson {
    fn name(&self) -> &'static str {
        Reader::name(self)
    }

    /// Phones and words in order of their starts, a word before its phones.
    fn write(
        &self,
        labels: &Labels,
        _rate: SampleRate,
        out: &mut dyn Write,
    ) -> Result<(), WriteError> {
        if labels.segments.is_empty() && labels.words.is_empty() {
            return Err(WriteError::Nothing("phones or words"));
        }
        // Checks times and order; words may overlap here.
        Spans::phones(labels)?;
        writeln!(out, "{{\"alphabet\":\"{}\"}}", Alphabet::Timit.name())?;
        let mut words = (1..).zip(&labels.words).peekable();
        let mut last = 0;
        for segment in labels.segments.iter().map(Some).chain([None]) {
            let before = segment.map_or(i64::MAX, |s| s.start);
            while let Some((number, word)) = words.next_if(|(_, w)| w.start <= before) {
                let reason = match () {
                    () if word.start < last => "starts before the one before it; sort them",
                    () if word.start < 0 || word.end <= word.start => {
                        "does not last from 0 or later to its end; mend it"
                    }
                    () if has_breaks(&word.text) || word.text.contains(char::is_whitespace) => {
                        "is empty or holds white space; make it one word"
                    }
                    () => "",
                };
                if !reason.is_empty() {
                    let kind = "word";
                    return Err(WriteError::Label {
                        kind,
                        number,
                        reason,
                    });
                }
                last = word.start;
                let text = serde_json::Value::from(word.text.as_str());
                let (start, end) = (seconds(word.start), seconds(word.end));
                writeln!(out, "{{\"start\":{start},\"end\":{end},\"word\":{text}}}")?;
            }
            if let Some(segment) = segment {
                let (start, end) = (seconds(segment.start), seconds(segment.end));
                let stress = match segment.stress {
                    None => "",
                    Some(Stress::Unstressed) => ",\"stress\":0",
                    Some(Stress::Primary) => ",\"stress\":1",
                    Some(Stress::Secondary) => ",\"stress\":2",
                };
                let phone = segment.phone;
                writeln!(
                    out,
                    "{{\"start\":{start},\"end\":{end},\"phone\":\"{phone}\"{stress}}}"
                )?;
            }
        }
        Ok(())
    }
}
