//! The pieces that Praat reads of a text file: quoted texts, free-standing numbers and flags.
//!
//! All else (`xmin =`, `intervals [3]:`, what follows a `!`) is for people, which is why the long
//! and the short form are read alike.

use std::borrow::Cow;

use super::shape;
use crate::error::Fault;

/// One piece.
#[derive(Debug, PartialEq)]
pub(super) enum Kind<'a> {
    Text(Cow<'a, str>),
    Number(&'a str),
    Flag(&'a str),
}

/// A file while it is read.
#[derive(Debug)]
pub(super) struct Tokens<'a> {
    rest: &'a str,
    /// Where `rest` begins.
    line: u64,
    /// Where the last piece began.
    token_line: u64,
}

impl<'a> Tokens<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self {
            rest: text,
            line: 1,
            token_line: 1,
        }
    }

    /// The line where the last piece began.
    pub(super) fn at_line(&self) -> u64 {
        self.token_line
    }

    /// The next piece, a text.
    pub(super) fn text(&mut self, wanted: &'static str) -> Result<Cow<'a, str>, Fault> {
        match self.next(wanted)? {
            Kind::Text(text) => Ok(text),
            other => Err(shape(&other, wanted)),
        }
    }

    /// The next piece, a number as written.
    pub(super) fn number(&mut self, wanted: &'static str) -> Result<&'a str, Fault> {
        match self.next(wanted)? {
            Kind::Number(number) => Ok(number),
            other => Err(shape(&other, wanted)),
        }
    }

    /// The next piece, how many of something follow.
    pub(super) fn count(&mut self, wanted: &'static str) -> Result<usize, Fault> {
        let number = self.number(wanted)?;
        let count = number.parse::<usize>();
        count.map_err(|_| shape(&Kind::Number(number), wanted))
    }

    /// The next piece, whether something exists.
    pub(super) fn flag(&mut self) -> Result<bool, Fault> {
        let wanted = "<exists> or <absent>";
        match self.next(wanted)? {
            Kind::Flag("exists") => Ok(true),
            Kind::Flag("absent") => Ok(false),
            other => Err(shape(&other, wanted)),
        }
    }

    /// Whether the next piece is a text.
    pub(super) fn peek_is_text(&self) -> bool {
        let mut ahead = Self {
            rest: self.rest,
            ..*self
        };
        matches!(ahead.next(""), Ok(Kind::Text(_)))
    }

    fn next(&mut self, wanted: &'static str) -> Result<Kind<'a>, Fault> {
        loop {
            self.skip(char::is_whitespace);
            self.token_line = self.line;
            let Some(first) = self.rest.chars().next() else {
                return Err(Fault::Ends(wanted));
            };
            match first {
                '"' => return self.quoted(),
                '!' => self.skip(|c| c != '\n'),
                _ => {
                    let word = self.word();
                    let flag = word.strip_prefix('<').and_then(|w| w.strip_suffix('>'));
                    if let Some(flag) = flag {
                        return Ok(Kind::Flag(flag));
                    }
                    let digits = word.trim_start_matches(['-', '+']);
                    if digits.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
                        return Ok(Kind::Number(word));
                    }
                }
            }
        }
    }

    /// What stands up to the next white space.
    fn word(&mut self) -> &'a str {
        let end = self.rest.find(char::is_whitespace);
        let (word, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.rest = rest;
        word
    }

    fn skip(&mut self, while_so: impl Fn(char) -> bool) {
        let end = self.rest.find(|c| !while_so(c));
        let (skipped, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        self.line += breaks(skipped);
        self.rest = rest;
    }

    /// A text in quotation marks; doubled ones stand for one of its own.
    fn quoted(&mut self) -> Result<Kind<'a>, Fault> {
        let body = &self.rest[1..];
        let mut end = 0;
        loop {
            let Some(mark) = body[end..].find('"') else {
                return Err(Fault::Ends("the closing quotation mark of a text"));
            };
            end += mark;
            if !body[end + 1..].starts_with('"') {
                break;
            }
            end += 2;
        }
        let (text, rest) = (&body[..end], &body[end + 1..]);
        self.line += breaks(text);
        self.rest = rest;
        Ok(Kind::Text(match text.contains("\"\"") {
            true => text.replace("\"\"", "\"").into(),
            false => text.into(),
        }))
    }
}

fn breaks(text: &str) -> u64 {
    text.bytes().filter(|b| *b == b'\n').count() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_praat_reads_is_read() {
        let mut tokens = Tokens::new(
            "xmin = 0.5 ! a 7 in passing\ntiers? <exists>\n[3]: \"a \"\"b\"\"\nc\" x2 -0",
        );
        assert_eq!(tokens.number("n"), Ok("0.5"));
        assert_eq!(tokens.flag(), Ok(true));
        assert_eq!(tokens.text("t").unwrap(), "a \"b\"\nc");
        assert_eq!(tokens.at_line(), 3);
        assert_eq!(tokens.number("n"), Ok("-0"));
        assert_eq!(tokens.at_line(), 4);
        assert_eq!(tokens.number("an end"), Err(Fault::Ends("an end")));
    }
}
