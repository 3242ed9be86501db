//! Reads the mnemonics of espeak-ng's English voices (`a#`, `I2`, `aI3`, `t#`).
//!
//! Most are X-SAMPA's; this holds the rest. Source: the names that its voices en-us, en and
//! en-gb-scotland print (version 1.51, `-x --sep`) beside the IPA that they print for the same
//! words (`--ipa`); the phones are en-us's.

use super::ipa::ipa;
use super::xsampa::xsampa;
use super::{PhoneList, Spoken};
use crate::{Phone, Stress};

/// Longest symbol that is looked at; espeak-ng's own names have at most four bytes.
const BYTES_MAX: usize = 64;

/// Mnemonics and the IPA that they stand for.
const ROWS: [(&str, &str); 50] = [
    ("a", "æ"),
    ("a#", "ə"),
    ("aa", "æ"),
    ("0", "ɑ"),
    ("0#", "ə"),
    ("A:", "ɑ"),
    ("A@", "ɑɹ"),
    ("o@", "ɔɹ"),
    ("O@", "ɔɹ"),
    ("O", "ɔ"),
    ("O2", "ɔ"),
    ("O:", "ɔ"),
    ("e@", "ɛɹ"),
    ("E", "ɛ"),
    ("E2", "ɛ"),
    ("E#", "ə"),
    ("i@", "iə"),
    ("i@3", "ɪɹ"),
    ("I2", "ɪ"),
    ("I#", "ɨ"),
    ("I3", "ɪ"),
    ("IR", "ɪɹ"),
    ("VR", "ʌɹ"),
    ("U@", "ʊɹ"),
    ("aI2", "aɪ"),
    ("aI@", "aɪə"),
    ("aI3", "aɪɚ"),
    ("aU@", "aʊɚ"),
    ("oU#", "oʊ"),
    ("3", "ɚ"),
    ("3:", "ɝ"),
    ("@2", "ə"),
    ("@5", "ə"),
    ("@-", "ə"),
    ("@L", "l\u{329}"),
    ("@l", "l\u{329}"),
    ("@m", "m\u{329}"),
    ("@n", "n\u{329}"),
    ("n-", "n\u{329}"),
    ("m-", "m\u{329}"),
    ("l-", "l\u{329}"),
    ("r", "ɹ"),
    ("r-", "ɹ"),
    ("t#", "ɾ"),
    ("d#", "ɾ"),
    ("t2", "t"),
    ("w#", "ʍ"),
    (";", "j"),
    ("l^", "ʎ"),
    ("n^", "ɲ"),
];

/// Stress and other marks that espeak-ng writes before a mnemonic. Its names of levels: `%%` and
/// `%` unstressed, `,` secondary, `'` primary, `''` emphasised.
const ESPEAK_MARKS: [char; 5] = ['\'', ',', '%', '=', '|'];

/// The phones of a mnemonic; `None` where nothing of it is known.
pub(super) fn espeak(symbol: &str) -> Option<Spoken> {
    if symbol.len() > BYTES_MAX {
        return None;
    }
    let bare = symbol.trim_start_matches(ESPEAK_MARKS);
    let marks = &symbol[..symbol.len() - bare.len()];
    let stress = if marks.contains('\'') {
        Some(Stress::Primary)
    } else if marks.contains(',') {
        Some(Stress::Secondary)
    } else if marks.contains('%') || marks.contains('=') {
        Some(Stress::Unstressed)
    } else {
        None
    };
    if bare.is_empty() {
        // A mark or a word break: no sound of its own.
        let known = !marks.is_empty();
        return known.then(|| Spoken {
            phones: PhoneList::one(Phone::Epi),
            stress,
            exact: true,
        });
    }
    let row = |code: &str| ROWS.iter().find(|row| row.0 == code);
    let mut found = row(bare).and_then(|(_, letters)| ipa(letters));
    if found.is_none() {
        found = xsampa(bare).filter(|spoken| spoken.exact);
    }
    // Variants of a phoneme are numbered or end in a sign: `u#`, `l2`.
    if found.is_none() {
        let stem = bare.trim_end_matches(|c: char| c.is_ascii_digit() || "#-^\"".contains(c));
        let of_stem = row(stem).map_or_else(|| xsampa(stem), |(_, letters)| ipa(letters));
        found = of_stem.map(|spoken| Spoken {
            exact: false,
            ..spoken
        });
    }
    found.map(|spoken| Spoken { stress, ..spoken })
}
