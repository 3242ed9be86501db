//! A file's bytes as text, whatever encoding its program chose, and its lines with their numbers.
//!
//! UTF-8 with or without a byte order mark, and UTF-16 of either order with one, as Praat writes
//! where a label is not ASCII.

use std::borrow::Cow;

use crate::error::{Fault, LabelError, LineError};
use crate::reader::Source;

/// The whole file as text, without its byte order mark.
pub(super) fn decode<'a>(source: &Source<'a>) -> Result<Cow<'a, str>, LabelError> {
    let utf16 = |big_endian: bool| {
        let units = source.bytes[2..].chunks(2).map(|pair| match *pair {
            [a, b] if big_endian => u16::from_be_bytes([a, b]),
            [a, b] => u16::from_le_bytes([a, b]),
            // Half a unit at the end is no text.
            _ => 0xd800,
        });
        let mut text = String::with_capacity(source.bytes.len() / 2);
        for unit in char::decode_utf16(units) {
            match unit {
                Ok(c) => text.push(c),
                Err(_) => return Err(wrong(source, line_at(&text, text.len()), Fault::NotText)),
            }
        }
        Ok(Cow::Owned(text))
    };
    match source.bytes {
        [0xfe, 0xff, ..] => utf16(true),
        [0xff, 0xfe, ..] => utf16(false),
        bytes => {
            let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
            std::str::from_utf8(bytes).map(Cow::Borrowed).map_err(|e| {
                let good = &bytes[..e.valid_up_to()];
                let line = 1 + good.iter().filter(|b| **b == b'\n').count() as u64;
                wrong(source, line, Fault::NotText)
            })
        }
    }
}

/// The first bytes as text, for detectors, which must be quick and never fail.
pub(super) fn peek<'a>(source: &Source<'a>) -> Cow<'a, str> {
    let bytes = &source.bytes[..source.bytes.len().min(PEEK_BYTES)];
    let name = source.name;
    let head = Source { name, bytes };
    match bytes {
        [0xfe, 0xff, ..] | [0xff, 0xfe, ..] => decode(&head).unwrap_or_default(),
        // The cut may go through a letter; noise has no UTF-8 at its start.
        _ => match bytes.utf8_chunks().next() {
            Some(chunk) if chunk.invalid().is_empty() || chunk.valid().len() + 4 > bytes.len() => {
                let valid = chunk.valid();
                Cow::Borrowed(valid.strip_prefix('\u{feff}').unwrap_or(valid))
            }
            _ => Cow::Borrowed(""),
        },
    }
}

/// So much of a file tells its format: some hundred labels. Even, so that no unit of UTF-16 is cut.
const PEEK_BYTES: usize = 16 << 10;

/// Lines that are not blank, trimmed, with their numbers from 1.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (u64, &str)> {
    let numbered = (1_u64..).zip(text.lines());
    numbered
        .map(|(number, line)| (number, line.trim()))
        .filter(|(_, line)| !line.is_empty())
}

/// The number of the line that holds byte `at`.
pub(super) fn line_at(text: &str, at: usize) -> u64 {
    let before = text.as_bytes().iter().take(at);
    1 + before.filter(|b| **b == b'\n').count() as u64
}

/// The error for a file that has `fault` in `line`.
pub(super) fn wrong(source: &Source<'_>, line: u64, fault: Fault) -> LabelError {
    let breaks = source.bytes.iter().filter(|b| **b == b'\n').count() as u64;
    let within_last = !source.bytes.ends_with(b"\n") && !source.bytes.ends_with(b"\n\0");
    LabelError::Line {
        file: source.name.to_owned(),
        cut_off: within_last && breaks > 0 && line == breaks + 1,
        error: LineError { line, fault },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<String, String> {
        let text = decode(&Source { name: "x", bytes });
        text.map(Cow::into_owned).map_err(|e| e.to_string())
    }

    #[test]
    fn each_encoding_gives_the_same_text() {
        let wanted = Ok("ə\nb".to_owned());
        assert_eq!(read("ə\nb".as_bytes()), wanted);
        assert_eq!(read("\u{feff}ə\nb".as_bytes()), wanted);
        assert_eq!(read(b"\xfe\xff\x02\x59\x00\n\x00b"), wanted);
        assert_eq!(read(b"\xff\xfe\x59\x02\n\x00b\x00"), wanted);
    }

    #[test]
    fn what_is_no_text_is_refused_with_its_line() {
        for bytes in [
            &b"a\nb\xe9c\n"[..],
            b"\xfe\xff\0a\0\n\xd8\x00\0b\0\n",
            b"\xff\xfea\0\n\0b",
        ] {
            let said = read(bytes).unwrap_err();
            assert!(said.starts_with("x, line 2: not text"), "{said}");
        }
    }
}
