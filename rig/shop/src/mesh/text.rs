//! Lines and numbers of text formats, as bytes: comments need not be UTF-8, lines may end as on any
//! system.

use super::error::{Fault, Found};

/// The lines of a file with their numbers.
pub(crate) struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
}

impl<'a> Lines<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self {
            rest: bytes,
            number: 0,
        }
    }

    /// What has not been read.
    pub(crate) fn rest(&self) -> &'a [u8] {
        self.rest
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        self.number += 1;
        let end = self.rest.iter().position(|&b| b == b'\n' || b == b'\r');
        let (line, mut rest) = match end {
            Some(end) => (&self.rest[..end], &self.rest[end..]),
            None => (self.rest, &self.rest[self.rest.len()..]),
        };
        rest = rest
            .strip_prefix(b"\r\n")
            .or_else(|| rest.strip_prefix(b"\n"))
            .or_else(|| rest.strip_prefix(b"\r"))
            .unwrap_or(rest);
        self.rest = rest;
        Some((self.number, line))
    }
}

/// Words of a line, parted by blanks.
pub(crate) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|b| matches!(b, b' ' | b'\t' | 0x0b | 0x0c))
        .filter(|word| !word.is_empty())
}

/// A word of a file as text for a message, cut to what one can read.
pub(crate) fn quote(word: &[u8]) -> String {
    const LONGEST: usize = 60;
    let text: String = String::from_utf8_lossy(word)
        .chars()
        .take(LONGEST)
        .map(|c| if c.is_control() { '?' } else { c })
        .collect();
    if text.len() < word.len() {
        text + "…"
    } else {
        text
    }
}

/// A word as a number; NaN and infinity pass, the caller names the vertex.
pub(crate) fn number(word: &[u8], what: &'static str, line: usize) -> Result<f64, Found> {
    let parsed = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
    parsed.ok_or_else(|| {
        let lower = word.to_ascii_lowercase();
        // C libraries write -nan(ind), 1.#IND, 1.#QNAN and 1.#INF.
        let has = |part: &[u8]| lower.windows(part.len()).any(|w| w == part);
        let mend = if has(b".#") || has(b"nan") {
            "it stands for no number (NaN or infinity); remove that vertex or export the scan again"
        } else if word.contains(&b',') {
            "write decimals with a point"
        } else {
            "mend the line or export the scan again"
        };
        Found::line(
            line,
            Fault::NotANumber {
                what,
                found: quote(word),
                mend,
            },
        )
    })
}

/// A word as an integer.
pub(crate) fn integer(word: &[u8], what: &'static str, line: usize) -> Result<i64, Found> {
    let parsed = std::str::from_utf8(word).ok().and_then(|w| w.parse().ok());
    parsed.ok_or_else(|| {
        Found::line(
            line,
            Fault::NotANumber {
                what,
                found: quote(word),
                mend: "it must be a whole number; export the scan again",
            },
        )
    })
}
