//! Rules from letters to phones, for words that no dictionary has.
//!
//! Learned from the CMU dictionary (`data/make_rules.py`; the method is Daelemans and van den
//! Bosch's IGTree): a rule is a letter with some of its neighbours, and the one that knows most
//! neighbours counts.

use std::sync::OnceLock;

use super::Said;
use super::lexicon::find;
use super::scripts;
use crate::Alphabet;

static RULES: &str = include_str!("../../data/letters.txt");

/// Neighbours in the order in which rules know them, as in `make_rules.py`.
const ORDER: [isize; 9] = [1, -1, 2, -2, 3, -3, 4, -4, 5];

/// Where there is no neighbour.
const EDGE: u8 = b'-';

/// What a word sounds like, letter by letter. Letters of other scripts sound as they do there, roughly; what is no letter is silent.
pub(super) fn sounds(word: &str) -> Vec<Said> {
    let plain = scripts::plain(word);
    let mut sounds = Vec::with_capacity(plain.len());
    for (at, letter) in plain.iter().enumerate() {
        match letter {
            scripts::Plain::English(_) => sounds.extend(sound(&plain, at)),
            scripts::Plain::Other(phones) => sounds.extend(phones.iter().map(|p| (*p, None))),
        }
    }
    sounds
}

/// The phones of the letter at `at`.
fn sound(word: &[scripts::Plain], at: usize) -> Vec<Said> {
    static LINES: OnceLock<Vec<&str>> = OnceLock::new();
    let lines = LINES.get_or_init(|| RULES.lines().collect());
    let letter = |at: Option<usize>| match at.and_then(|at| word.get(at)) {
        Some(scripts::Plain::English(letter)) => *letter,
        _ => EDGE,
    };
    let mut key = String::with_capacity(ORDER.len() + 1);
    key.push(char::from(letter(Some(at))));
    for step in ORDER {
        key.push(char::from(letter(at.checked_add_signed(step))));
    }
    let keys = (1..=key.len()).rev().filter_map(|length| key.get(..length));
    let phones = keys
        .into_iter()
        .find_map(|key| find(lines, key))
        .unwrap_or("");
    let symbols = phones.split(' ').filter(|symbol| !symbol.is_empty());
    let spoken = symbols.map(|symbol| Alphabet::Arpabet.spoken(symbol));
    spoken
        .map(|spoken| (spoken.phones[0], spoken.stress))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_sorted_and_every_letter_has_one() {
        let keys: Vec<&str> = RULES
            .lines()
            .map(|line| line.split(' ').next().unwrap())
            .collect();
        assert!(keys.windows(2).all(|pair| pair[0] < pair[1]));
        for letter in "abcdefghijklmnopqrstuvwxyz".split_terminator("").skip(1) {
            assert!(keys.binary_search(&letter).is_ok(), "{letter}");
        }
        for line in RULES.lines() {
            let symbols = line.split(' ').skip(1);
            assert!(
                symbols.clone().all(|s| Alphabet::Arpabet.spoken(s).exact),
                "{line}"
            );
        }
    }
}
