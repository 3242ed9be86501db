//! JSON as label files need it: which keys a file has, and values that know their line and keep
//! their numbers as written.

use std::collections::BTreeSet;

use serde::Deserialize;
use serde_json::value::RawValue;

use super::time::{Time, Unit};
use crate::error::{Fault, LabelError, LineError, clip};
use crate::reader::Source;

/// Keys looked at: every format shows its own in its first few labels.
const KEYS_MAX: usize = 600;

/// Longest key of any format known here; longer ones tell nothing.
const KEY_BYTES_MAX: usize = 64;

/// What a file that may be JSON begins with.
#[derive(Debug)]
pub(super) struct Peek<'a> {
    /// Its first byte: `{` or `[`.
    pub(super) opening: u8,
    keys: BTreeSet<&'a [u8]>,
}

impl<'a> Peek<'a> {
    /// `None` where the file does not begin as JSON does.
    pub(super) fn at(source: &Source<'a>) -> Option<Self> {
        let bytes = source.bytes;
        let bytes = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(bytes);
        let bytes = bytes.trim_ascii_start();
        let opening = *bytes.first()?;
        if opening != b'{' && opening != b'[' {
            return None;
        }
        let mut keys = BTreeSet::new();
        let mut rest = bytes;
        for _ in 0..KEYS_MAX {
            let Some((key, after)) = next_key(rest) else {
                break;
            };
            if key.len() <= KEY_BYTES_MAX {
                keys.insert(key);
            }
            rest = after;
        }
        Some(Self { opening, keys })
    }

    /// Whether one of the values looked at has this key.
    pub(super) fn has(&self, key: &str) -> bool {
        self.keys.contains(key.as_bytes())
    }

    /// Whether it has all of them.
    pub(super) fn has_all(&self, keys: &[&str]) -> bool {
        keys.iter().all(|key| self.has(key))
    }

    /// Whether it has one of them.
    pub(super) fn has_any(&self, keys: &[&str]) -> bool {
        keys.iter().any(|key| self.has(key))
    }
}

/// The next string that a colon follows, and what comes after it.
fn next_key(mut bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    loop {
        let open = bytes.iter().position(|b| *b == b'"')?;
        let text = bytes.get(open + 1..)?;
        let mut end = 0;
        loop {
            match *text.get(end)? {
                b'"' => break,
                b'\\' => end += 2,
                _ => end += 1,
            }
        }
        bytes = &text[end + 1..];
        if bytes.trim_ascii_start().first() == Some(&b':') {
            return Some((&text[..end], bytes));
        }
    }
}

/// A JSON text and the way from its values to their lines. Values must be asked for in the order
/// in which they stand; any other order costs time, no more.
#[derive(Debug)]
pub(super) struct Document<'a> {
    text: &'a str,
    name: &'a str,
    /// What the format's values look like, for messages.
    wanted: &'static str,
    at: usize,
    line: u64,
}

impl<'a> Document<'a> {
    pub(super) fn new(source: &Source<'a>, text: &'a str, wanted: &'static str) -> Self {
        Self {
            text,
            name: source.name,
            wanted,
            at: 0,
            line: 1,
        }
    }

    /// The whole text as one value.
    pub(super) fn whole<T: Deserialize<'a>>(&self) -> Result<T, LabelError> {
        serde_json::from_str(self.text).map_err(|e| self.refuse(1, &e))
    }

    /// The whole text as values that follow one another, one a line or not.
    pub(super) fn values(&self) -> impl Iterator<Item = Result<&'a RawValue, LabelError>> {
        let values = serde_json::Deserializer::from_str(self.text).into_iter::<&RawValue>();
        values.map(|value| value.map_err(|e| self.refuse(1, &e)))
    }

    /// One of its values, and the line where it begins.
    pub(super) fn item<T: Deserialize<'a>>(
        &mut self,
        raw: &'a RawValue,
    ) -> Result<(u64, T), LabelError> {
        let line = self.line_of(raw);
        let value = serde_json::from_str(raw.get()).map_err(|e| self.refuse(line, &e))?;
        Ok((line, value))
    }

    /// The line where a value begins.
    pub(super) fn line_of(&mut self, raw: &RawValue) -> u64 {
        let start = self.text.as_ptr() as usize;
        let at = (raw.get().as_ptr() as usize).wrapping_sub(start);
        if at > self.text.len() {
            return self.line;
        }
        if at < self.at {
            (self.at, self.line) = (0, 1);
        }
        let between = self.text.as_bytes().get(self.at..at).unwrap_or_default();
        self.line += between.iter().filter(|b| **b == b'\n').count() as u64;
        self.at = at;
        self.line
    }

    /// A fault in a value of `line`.
    pub(super) fn wrong(&self, line: u64, fault: Fault) -> LabelError {
        LabelError::Line {
            file: self.name.to_owned(),
            error: LineError { line, fault },
            cut_off: false,
        }
    }

    /// A value of `line` that is not as it should be.
    pub(super) fn refused(&self, line: u64, reason: &str) -> LabelError {
        let reason = reason.to_owned();
        let wanted = self.wanted;
        self.wrong(line, Fault::Json { reason, wanted })
    }

    /// What the parser says, without what it says of places, and short.
    fn refuse(&self, first_line: u64, error: &serde_json::Error) -> LabelError {
        let said = error.to_string();
        let reason = said.split(" at line ").next().unwrap_or_default();
        let line = first_line + (error.line() as u64).saturating_sub(1);
        let reason = if reason.chars().count() > REASON_CHARS_MAX {
            clip(reason)
        } else {
            reason.chars().flat_map(char::escape_debug).collect()
        };
        LabelError::Line {
            file: self.name.to_owned(),
            cut_off: error.is_eof(),
            error: LineError {
                line,
                fault: Fault::Json {
                    reason,
                    wanted: self.wanted,
                },
            },
        }
    }
}

/// A parser's reason repeats what stands in the file; longer ones are cut.
const REASON_CHARS_MAX: usize = 80;

/// The time that a JSON value holds: a number, or a string that holds one.
pub(super) fn time(raw: &RawValue, unit: Unit) -> Result<Time, Fault> {
    let text = raw.get();
    let bare = text.strip_prefix('"').and_then(|t| t.strip_suffix('"'));
    Time::parse(bare.unwrap_or(text), unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(text: &str) -> Source<'_> {
        Source {
            name: "x.json",
            bytes: text.as_bytes(),
        }
    }

    #[test]
    fn keys_are_told_from_values() {
        let peek = Peek::at(&source(
            "\u{feff} [{\"a\": \"b\", \"c\\\"d\" : {\"e\":[\":\", \"f\"]}}",
        ));
        let peek = peek.unwrap();
        assert!(peek.has_all(&["a", "c\\\"d", "e"]));
        assert!(!peek.has_any(&["b", ":", "f"]));
        assert!(Peek::at(&source("hello")).is_none());
        assert!(Peek::at(&source("{\"endless")).is_some());
    }

    #[test]
    fn values_know_their_lines() {
        let text = "[\n1,\n\n2.5, 3]";
        let source = source(text);
        let mut document = Document::new(&source, text, "numbers");
        let values: Vec<&RawValue> = document.whole().unwrap();
        let lines: Vec<u64> = values.iter().map(|v| document.line_of(v)).collect();
        assert_eq!(lines, [2, 4, 4]);
        assert_eq!(document.line_of(values[0]), 2);
        let said = document.item::<String>(values[1]).unwrap_err().to_string();
        assert!(said.starts_with("x.json, line 4: not the JSON"), "{said}");
        assert!(said.ends_with("write numbers"), "{said}");
    }
}
