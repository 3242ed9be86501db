//! What a reader had to guess or change to make labels of a file.
//!
//! Readers hand notes on with the labels that they made; `mouthpiece labels` prints them beside
//! the warnings of [`check`](crate::check()). What cannot be used at all is an error instead.
//! Each kind is told once, with its count, so that a strange file does not flood a terminal.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::alphabet::{Alphabet, Spoken};
use crate::error::clip;

/// One guess or change, and where it was first made.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Note {
    /// The line, from 1, in formats that have lines.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line: Option<u64>,
    /// What was found and what was made of it.
    pub text: String,
}

impl Note {
    /// A note on a whole file.
    pub fn new(text: impl Into<String>) -> Self {
        let text = text.into();
        Self { line: None, text }
    }

    /// A note on one line of it.
    pub fn at(line: u64, text: impl Into<String>) -> Self {
        let line = Some(line);
        let text = text.into();
        Self { line, text }
    }
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        f.write_str(&self.text)
    }
}

/// Different symbols that notes name one by one; a file with more is in another alphabet, and one
/// note says how many more there were.
const SYMBOLS_MAX: usize = 20;

/// Gathers notes while a file is read.
#[derive(Clone, Debug, Default)]
pub struct Notes {
    notes: Vec<Note>,
    guessed: Vec<Guess>,
    more: usize,
}

/// A symbol that the alphabet does not know.
#[derive(Clone, Debug)]
struct Guess {
    symbol: String,
    alphabet: Alphabet,
    spoken: Spoken,
    line: Option<u64>,
    count: usize,
}

impl Notes {
    /// Adds a note as it is.
    pub fn push(&mut self, note: Note) {
        self.notes.push(note);
    }

    /// Remembers a symbol that had to be guessed; does nothing where `spoken` is exact.
    pub fn symbol(&mut self, alphabet: Alphabet, symbol: &str, spoken: Spoken, line: Option<u64>) {
        if spoken.exact {
            return;
        }
        if let Some(known) = self.guessed.iter_mut().find(|g| g.symbol == symbol) {
            known.count += 1;
        } else if self.guessed.len() < SYMBOLS_MAX {
            self.guessed.push(Guess {
                symbol: symbol.to_owned(),
                alphabet,
                spoken,
                line,
                count: 1,
            });
        } else {
            self.more += 1;
        }
    }

    /// All notes, those on symbols last.
    pub fn finish(self) -> Vec<Note> {
        let mut notes = self.notes;
        notes.extend(self.guessed.into_iter().map(Guess::note));
        if self.more > 0 {
            notes.push(Note::new(format!(
                "{} more labels with other unknown symbols; check which alphabet they are in",
                self.more
            )));
        }
        notes
    }
}

impl Guess {
    fn note(self) -> Note {
        let phones: Vec<&str> = self.spoken.phones.iter().map(|p| p.code()).collect();
        let times = match self.count {
            1 => String::new(),
            count => format!(" ({count} times)"),
        };
        let text = format!(
            "`{}`{times} is no symbol of {} known here; taken for `{}`, which is nearest",
            clip(&self.symbol),
            self.alphabet.about(),
            phones.join(" "),
        );
        Note {
            line: self.line,
            text,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_symbol_is_told_once_and_what_is_known_never() {
        let mut notes = Notes::default();
        for line in 1..=3 {
            let spoken = Alphabet::Ipa.spoken("ɬ");
            notes.symbol(Alphabet::Ipa, "ɬ", spoken, Some(line));
            let spoken = Alphabet::Ipa.spoken("b");
            notes.symbol(Alphabet::Ipa, "b", spoken, Some(line));
        }
        let notes = notes.finish();
        assert_eq!(notes.len(), 1);
        let text = notes[0].to_string();
        assert!(text.starts_with("line 1: `ɬ` (3 times)"), "{text}");
    }

    #[test]
    fn a_file_of_nonsense_gives_few_notes() {
        let mut notes = Notes::default();
        for n in 0..1000 {
            let symbol = format!("<{n}>");
            let spoken = Alphabet::Timit.spoken(&symbol);
            notes.symbol(Alphabet::Timit, &symbol, spoken, None);
        }
        assert!(notes.finish().len() <= SYMBOLS_MAX + 1);
    }
}
