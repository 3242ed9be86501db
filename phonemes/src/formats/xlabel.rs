//! ESPS xlabel files, as xwaves, festival and HTS tools write them: reader and writer.
//!
//! A header that a line of `#` ends, then a line a label: `end colour label`. Ends are decimal
//! seconds; a label starts where the one before it ends, the first at 0, so there are no gaps and a
//! word includes the pause before it. The colour means nothing. Of several fields (`separator ;`)
//! the first is the label. Festival's last label ends some 30 ms before its sound does.

use std::io::Write;

use super::sheet::{Piece, Sheet};
use super::text::{decode, lines, peek, wrong};
use super::time::{Time, Unit, seconds};
use super::write::{self, Spans};
use crate::error::{Fault, LabelError};
use crate::reader::{Match, ReadOptions, Reader, Source};
use crate::tick::SampleRate;
use crate::writer::{WriteError, Writer};
use crate::{Labels, Phone};

/// The format.
#[derive(Clone, Copy, Debug)]
pub struct Xlabel;

const EXAMPLE: &str = "0.2200 100 pau";
const WANTED: &str = "`end colour label`";

impl Reader for Xlabel {
    fn name(&self) -> &'static str {
        "xlabel"
    }

    fn about(&self) -> &'static str {
        "ESPS xlabel, festival: after a `#`, lines `end colour label`, in seconds"
    }

    fn detect(&self, source: &Source<'_>) -> Match {
        let text = peek(source);
        let mut body = lines(&text)
            .skip_while(|(_, line)| *line != "#")
            .skip(1)
            .map(|(_, line)| label(line).is_ok());
        match body.next() {
            Some(true) => Match::Surely,
            _ => Match::No,
        }
    }

    fn read(&self, source: &Source<'_>, options: &ReadOptions) -> Result<Labels, LabelError> {
        let text = decode(source)?;
        let mut sheet = Sheet::new(source);
        let header = lines(&text)
            .find(|(_, line)| *line == "#")
            .map_or(0, |(n, _)| n);
        let mut start = Time::ZERO;
        for (number, line) in lines(&text).filter(|(n, _)| *n > header) {
            let (end, said) = label(line).map_err(|fault| wrong(source, number, fault))?;
            // Labels that end before 0 leave the next one to begin there.
            let piece = Piece::new(said.to_owned(), start.min(end), end, number);
            if end < start {
                let (start, end) = (start.to_string(), end.to_string());
                return Err(wrong(source, number, Fault::Backwards { start, end }));
            }
            sheet.phone(piece.map_err(|fault| wrong(source, number, fault))?)?;
            start = end;
        }
        sheet.phones_or_words(options);
        sheet.finish(options, None, EXAMPLE)
    }
}

/// The end and the label of a line.
fn label(line: &str) -> Result<(Time, &str), Fault> {
    let mut fields = line.splitn(3, char::is_whitespace);
    let end = Time::parse(fields.next().unwrap_or_default(), Unit::Seconds)?;
    let rest = fields.next().unwrap_or_default();
    // More than one space may part the fields.
    let (colour, said) = match (rest, fields.next()) {
        ("", Some(rest)) => rest
            .trim_start()
            .split_once(char::is_whitespace)
            .unwrap_or((rest.trim_start(), "")),
        (colour, said) => (colour, said.unwrap_or_default()),
    };
    if colour.is_empty() || !colour.bytes().all(|b| b.is_ascii_digit() || b == b'-') {
        let found = line.to_owned();
        return Err(Fault::Shape {
            found,
            wanted: WANTED,
        });
    }
    let said = said.split(';').next().unwrap_or_default();
    Ok((end, said.trim()))
}

impl Writer for Xlabel {
    fn name(&self) -> &'static str {
        Reader::name(self)
    }

    /// Phones, or words where there are none; gaps become `pau`. Times keep every tick apart.
    fn write(
        &self,
        labels: &Labels,
        _rate: SampleRate,
        out: &mut dyn Write,
    ) -> Result<(), WriteError> {
        let spans = match Spans::phones(labels)? {
            Some(phones) => phones,
            None => Spans::words(labels)?.ok_or(WriteError::Nothing("phones or words"))?,
        };
        writeln!(out, "#")?;
        for (number, (_, end, label)) in (1..).zip(spans.filled(Phone::Pau.code())) {
            if label.contains(';') || write::has_breaks(label) {
                return Err(WriteError::Label {
                    kind: spans.kind,
                    number,
                    reason: "holds a `;` or a line break; remove it",
                });
            }
            writeln!(out, "{} 100 {label}", seconds(end))?;
        }
        Ok(())
    }
}
