//! Words and their phones: the common ones built in, and a dictionary that a user names.
//!
//! The common words are an excerpt of the CMU Pronouncing Dictionary; see `data/README.md`.

use std::collections::HashMap;
use std::sync::OnceLock;

use super::Said;
use crate::limits::LABELS_MAX;
use crate::{Alphabet, Note, Notes};

static COMMON: &str = include_str!("../../data/common_words.txt");

/// The phones of a common word.
pub(super) fn common(word: &str) -> Option<Vec<Said>> {
    static LINES: OnceLock<Vec<&str>> = OnceLock::new();
    let lines = LINES.get_or_init(|| COMMON.lines().collect());
    let found = find(lines, word)?;
    Some(said(Alphabet::Arpabet, found.split(' '), |_, _| ()))
}

/// The rest of the line that begins with `key`, of sorted lines.
pub(super) fn find<'a>(lines: &[&'a str], key: &str) -> Option<&'a str> {
    let parts = |line: &'a str| line.split_once(' ').unwrap_or((line, ""));
    let at = lines.binary_search_by(|line| parts(line).0.cmp(key)).ok()?;
    lines.get(at).map(|line| parts(line).1)
}

/// The phones that symbols stand for; what each was is told to `note`.
fn said<'a>(
    alphabet: Alphabet,
    symbols: impl Iterator<Item = &'a str>,
    mut note: impl FnMut(&str, crate::Spoken),
) -> Vec<Said> {
    let mut said = Vec::new();
    for symbol in symbols {
        let spoken = alphabet.spoken(symbol);
        note(symbol, spoken);
        said.extend(spoken.phones.iter().map(|phone| (*phone, spoken.stress)));
    }
    said
}

/// A dictionary that a user gave.
#[derive(Clone, Debug, Default)]
pub(super) struct Lexicon {
    words: HashMap<String, Vec<Said>>,
}

/// Lines whose symbols tell the alphabet.
const LINES_LOOKED_AT: usize = 2000;

impl Lexicon {
    pub(super) fn get(&self, word: &str) -> Option<Vec<Said>> {
        self.words.get(word).cloned()
    }

    /// Adds the lines of a dictionary; of a word's several pronunciations the first counts.
    pub(super) fn add(&mut self, text: &str) -> Vec<Note> {
        let mut notes = Notes::default();
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let looked_at = text.lines().take(LINES_LOOKED_AT).filter_map(entry);
        let alphabet = Alphabet::guess(looked_at.flat_map(|(_, symbols)| symbols));
        let mut empty = (0_u64, 0_u64);
        for (number, line) in (1..).zip(text.lines()) {
            if self.words.len() >= LABELS_MAX {
                notes.push(Note::at(number, "too many words; the rest is left out"));
                break;
            }
            let blank = line.trim().is_empty() || line.starts_with(";;;") || line.starts_with('#');
            let Some((word, symbols)) = entry(line) else {
                if !blank {
                    empty = (empty.0 + 1, if empty.0 == 0 { number } else { empty.1 });
                }
                continue;
            };
            let word = word.to_lowercase();
            self.words.entry(word).or_insert_with(|| {
                said(alphabet, symbols, |symbol, spoken| {
                    notes.symbol(alphabet, symbol, spoken, Some(number));
                })
            });
        }
        if let (1.., line) = empty {
            let text = format!(
                "{} lines are no word with its phones and are left out",
                empty.0
            );
            notes.push(Note::at(line, text));
        }
        notes.finish()
    }
}

/// A line's word and symbols; `None` for a comment, or where there is no symbol.
fn entry(line: &str) -> Option<(&str, impl Iterator<Item = &str>)> {
    if line.starts_with(";;;") || line.starts_with('#') {
        return None;
    }
    let mut fields = line.split(" #").next()?.split_whitespace();
    let word = fields.next()?;
    // `READ(2)` is another way to say `READ`; there is a word `(` in some dictionaries.
    let word = word
        .find('(')
        .filter(|at| *at > 0)
        .map_or(word, |at| &word[..at]);
    let mut symbols = fields.skip_while(|f| f.parse::<f64>().is_ok()).peekable();
    symbols.peek()?;
    Some((word, symbols))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Phone;

    #[test]
    fn common_words_are_sorted_and_all_their_phones_are_known() {
        let lines: Vec<&str> = COMMON.lines().collect();
        assert!(
            lines
                .windows(2)
                .all(|pair| pair[0].split(' ').next() < pair[1].split(' ').next())
        );
        for line in lines {
            let (word, phones) = line.split_once(' ').unwrap();
            for symbol in phones.split(' ') {
                assert!(Alphabet::Arpabet.spoken(symbol).exact, "{word}: {symbol}");
            }
            assert!(common(word).is_some(), "{word}");
        }
    }

    #[test]
    fn dictionaries_of_several_programs_are_read() {
        let first = |text: &str, word: &str| {
            let mut lexicon = Lexicon::default();
            let notes = lexicon.add(text);
            assert_eq!(notes, [], "{text}");
            let said = lexicon.get(word).unwrap();
            said.iter().map(|s| s.0).collect::<Vec<_>>()
        };
        let cmu = ";;; a comment\nBOB  B AA1 B\nBOB(2)  B OW1 B # rare\n";
        assert_eq!(first(cmu, "bob"), [Phone::B, Phone::Aa, Phone::B]);
        let montreal = "bob\t0.99\t0.12\t1.0\t0.3\tb ɑ b\r\n";
        assert_eq!(first(montreal, "bob"), [Phone::B, Phone::Aa, Phone::B]);
    }

    #[test]
    fn what_a_dictionary_holds_beside_words_is_noted() {
        let mut lexicon = Lexicon::default();
        let notes = lexicon.add("bob\nbib B IH1 XYZ\n\n");
        assert_eq!(notes.len(), 2);
        assert!(notes[0].to_string().starts_with("line 1: 1 lines"));
        assert!(lexicon.get("bib").is_some());
    }
}
