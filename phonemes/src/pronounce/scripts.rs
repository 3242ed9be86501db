//! Letters that English does not have, as letters or sounds that it has.
//!
//! Accents are taken off Latin letters. Greek and Cyrillic letters sound one by one, near to how
//! modern Greek and Russian read them. Of other scripts nothing is known but how dense they are: a
//! character of Chinese, Japanese or Korean is a syllable, of any other half of one. So a mouth moves
//! for as long as the word lasts, and does not close where it should not.

use unicode_normalization::UnicodeNormalization;

use super::WORD_CHARS_MAX;
use crate::Phone;

/// What a character is to the rules.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Plain {
    /// One of a to z.
    English(u8),
    /// A sound.
    Other(&'static [Phone]),
}

/// Latin letters that no decomposition takes apart.
const LATIN: [(char, &[u8]); 12] = [
    ('ß', b"ss"),
    ('æ', b"e"),
    ('œ', b"e"),
    ('ø', b"o"),
    ('đ', b"d"),
    ('ð', b"th"),
    ('þ', b"th"),
    ('ł', b"l"),
    ('ħ', b"h"),
    ('ı', b"i"),
    ('ŋ', b"ng"),
    ('ə', b"a"),
];

/// Greek and Cyrillic letters.
const LETTERS: [(&str, &[Phone]); 34] = {
    use Phone::{
        Aa, Ao, B, Ch, D, Dh, Eh, F, G, Hh, Hv, Ih, Ix, Iy, K, L, M, N, P, R, S, Sh, T, Th, Uw, V,
        Y, Z, Zh,
    };
    [
        ("αа", &[Aa]),
        ("βв", &[V]),
        ("б", &[B]),
        ("γ", &[Hv]),
        ("гґ", &[G]),
        ("δ", &[Dh]),
        ("д", &[D]),
        ("εэє", &[Eh]),
        ("е", &[Y, Eh]),
        ("ё", &[Y, Ao]),
        ("жђ", &[Zh]),
        ("ζз", &[Z]),
        ("ηιυи", &[Iy]),
        ("ії", &[Iy]),
        ("йј", &[Y]),
        ("θ", &[Th]),
        ("κк", &[K]),
        ("λлљ", &[L]),
        ("μм", &[M]),
        ("νнњ", &[N]),
        ("ξ", &[K, S]),
        ("οωо", &[Ao]),
        ("πп", &[P]),
        ("ρр", &[R]),
        ("σςс", &[S]),
        ("τт", &[T]),
        ("уў", &[Uw]),
        ("φф", &[F]),
        ("χх", &[Hh]),
        ("ψ", &[P, S]),
        ("ц", &[T, S]),
        ("чћ", &[Ch]),
        ("шщ", &[Sh]),
        ("ы", &[Ix, Ih]),
    ]
};

/// The last two letters of Cyrillic.
const MORE: [(char, &[Phone]); 2] = [('ю', &[Phone::Y, Phone::Uw]), ('я', &[Phone::Y, Phone::Aa])];

/// A syllable that says nothing of the lips.
const SYLLABLE: [Phone; 2] = [Phone::D, Phone::Ah];

/// The word's letters in order.
pub(super) fn plain(word: &str) -> Vec<Plain> {
    let mut letters = Vec::new();
    for c in word.chars().take(WORD_CHARS_MAX) {
        for c in c.to_lowercase() {
            add(c, &mut letters);
        }
    }
    letters
}

fn add(c: char, letters: &mut Vec<Plain>) {
    if let Some((_, row)) = LATIN.iter().find(|row| row.0 == c) {
        letters.extend(row.iter().map(|letter| Plain::English(*letter)));
        return;
    }
    // `й` comes apart like `é`, but is a letter of its own.
    if let Some(sound) = known(c) {
        letters.push(Plain::Other(sound));
        return;
    }
    for c in std::iter::once(c).nfd() {
        let next = if c.is_ascii_alphabetic() {
            Plain::English(c.to_ascii_lowercase() as u8)
        } else if let Some(sound) = known(c) {
            Plain::Other(sound)
        } else if is_syllable(c) {
            Plain::Other(&SYLLABLE)
        } else if c.is_alphabetic() && !is_sign(c) {
            // Consonant and vowel in turn.
            let after_consonant = letters.last() == Some(&Plain::Other(&SYLLABLE[..1]));
            Plain::Other(if after_consonant {
                &SYLLABLE[1..]
            } else {
                &SYLLABLE[..1]
            })
        } else {
            continue;
        };
        letters.push(next);
    }
}

fn known(c: char) -> Option<&'static [Phone]> {
    let row = LETTERS.iter().find(|(letters, _)| letters.contains(c));
    let row = row.map(|row| row.1);
    row.or_else(|| MORE.iter().find(|row| row.0 == c).map(|row| row.1))
}

/// The hard and the soft sign of Cyrillic sound nothing.
fn is_sign(c: char) -> bool {
    matches!(c, 'ъ' | 'ь')
}

/// Kana, ideographs and the first letters of Korean syllables taken apart.
fn is_syllable(c: char) -> bool {
    matches!(c, '\u{3041}'..='\u{30ff}' | '\u{3400}'..='\u{9fff}' | '\u{f900}'..='\u{faff}'
        | '\u{1100}'..='\u{1112}' | '\u{20000}'..='\u{3ffff}')
}
