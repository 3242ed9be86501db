//! Words made of words that a dictionary knows: with an ending, or of two.
//!
//! How an ending sounds after which phone is school grammar (plural, possessive, past). Where two
//! words make one, the first keeps the main stress.

use super::{Said, stress};
use crate::{Phone, Stress};

/// What a word is, of words that `known` has; `None` where it is not made of any.
pub(super) fn made_of(word: &str, known: &impl Fn(&str) -> Option<Vec<Said>>) -> Option<Vec<Said>> {
    ended(word, known).or_else(|| compound(word, known))
}

/// Shortest word that takes an ending or begins a compound; shorter ones ("in", "a") are found in
/// words that they do not make.
const PART_LETTERS_MIN: usize = 3;

/// Shortest second part of a compound: "ion" and "ant" end too many words.
const SECOND_LETTERS_MIN: usize = 4;

/// An ending's letters, what stood there instead of it, and its sound.
const ENDINGS: [(&str, &[&str], Sound); 14] = [
    ("'s", &[""], Sound::S),
    ("s'", &["", "s"], Sound::S),
    ("ies", &["y"], Sound::S),
    ("es", &["e", ""], Sound::S),
    ("s", &[""], Sound::S),
    ("ied", &["y"], Sound::D),
    ("ed", &["e", ""], Sound::D),
    ("ing", &["", "e"], Sound::Of(&[Phone::Ix, Phone::Ng])),
    ("in'", &["", "e"], Sound::Of(&[Phone::Ix, Phone::N])),
    ("ly", &[""], Sound::Of(&[Phone::L, Phone::Iy])),
    ("er", &["", "e"], Sound::Of(&[Phone::Axr])),
    ("ness", &[""], Sound::Of(&[Phone::N, Phone::Ax, Phone::S])),
    ("less", &[""], Sound::Of(&[Phone::L, Phone::Ax, Phone::S])),
    ("ful", &[""], Sound::Of(&[Phone::F, Phone::Ax, Phone::L])),
];

/// How an ending sounds.
#[derive(Clone, Copy, Debug)]
enum Sound {
    /// As plurals do.
    S,
    /// As pasts do.
    D,
    /// Always so.
    Of(&'static [Phone]),
}

fn ended(word: &str, known: &impl Fn(&str) -> Option<Vec<Said>>) -> Option<Vec<Said>> {
    for (letters, instead, sound) in ENDINGS {
        let Some(stem) = word.strip_suffix(letters) else {
            continue;
        };
        let whole = instead.iter().map(|end| format!("{stem}{end}"));
        // "stopped", "running": the last letter is doubled.
        let mut ends = stem.chars().rev();
        let doubled = ends.next().filter(|last| ends.next() == Some(*last));
        let single = doubled.map(|last| stem[..stem.len() - last.len_utf8()].to_owned());
        for stem in whole.chain(single) {
            if stem.len() < PART_LETTERS_MIN {
                continue;
            }
            if let Some(mut said) = known(&stem) {
                sound.add(&mut said);
                return Some(said);
            }
        }
    }
    None
}

impl Sound {
    fn add(self, said: &mut Vec<Said>) {
        use Phone::{Ch, D, F, Hh, Ix, Jh, K, P, S, Sh, T, Th, Z, Zh};
        let last = said.last().map(|s| s.0);
        let voiceless = matches!(last, Some(P | T | K | F | Th | S | Sh | Ch | Hh));
        let phones: &[Phone] = match self {
            Self::S if matches!(last, Some(S | Z | Sh | Zh | Ch | Jh)) => &[Ix, Z],
            Self::D if matches!(last, Some(T | D)) => &[Ix, D],
            Self::S if voiceless => &[S],
            Self::S => &[Z],
            Self::D if voiceless => &[T],
            Self::D => &[D],
            Self::Of(phones) => phones,
        };
        said.extend(phones.iter().map(|phone| {
            let stress = phone.is_vowel().then_some(Stress::Unstressed);
            (*phone, stress)
        }));
    }
}

/// Two words in one; the longest first.
fn compound(word: &str, known: &impl Fn(&str) -> Option<Vec<Said>>) -> Option<Vec<Said>> {
    let last = word.len().checked_sub(SECOND_LETTERS_MIN)?;
    for at in (PART_LETTERS_MIN..=last).rev() {
        let Some((one, other)) = word.split_at_checked(at) else {
            continue;
        };
        if let (Some(mut said), Some(mut second)) = (known(one), known(other)) {
            stress::lower(&mut second);
            said.extend(second);
            return Some(said);
        }
    }
    None
}
