//! Reads X-SAMPA, and the SAMPA of MBROLA's English voices, by the IPA letters it spells.
//!
//! Symbols are taken longest first (`r\` before `r`, `_}` before `_`). Source: Wells, "Computer-coding
//! the IPA" (1995). ASCII letters that are themselves letters of the IPA need no row.

use super::Spoken;
use super::ipa::ipa;

/// Longest symbol that is looked at.
const BYTES_MAX: usize = 64;

/// X-SAMPA and the IPA that it stands for.
const ROWS: [(&str, &str); 104] = [
    // Vowels.
    ("@`", "ɚ"),
    ("@\\", "ɘ"),
    ("@", "ə"),
    ("3`", "ɝ"),
    ("3\\", "ɞ"),
    ("3", "ɜ"),
    ("r=", "ɚ"),
    ("{", "æ"),
    ("}", "ʉ"),
    ("1", "ɨ"),
    ("2", "ø"),
    ("6", "ɐ"),
    ("7", "ɤ"),
    ("8", "ɵ"),
    ("9", "œ"),
    ("&", "ɶ"),
    ("A", "ɑ"),
    ("E", "ɛ"),
    ("I\\", "ᵻ"),
    ("I", "ɪ"),
    ("M", "ɯ"),
    ("O", "ɔ"),
    ("Q", "ɒ"),
    ("U\\", "ᵿ"),
    ("U", "ʊ"),
    ("V", "ʌ"),
    ("Y", "ʏ"),
    // Consonants.
    ("4", "ɾ"),
    ("5", "ɫ"),
    ("?\\", "ʕ"),
    ("?", "ʔ"),
    ("B\\", "ʙ"),
    ("B", "β"),
    ("C", "ç"),
    ("D", "ð"),
    ("F", "ɱ"),
    ("G\\_<", "ʛ"),
    ("G\\", "ɢ"),
    ("G", "ɣ"),
    ("H\\", "ʜ"),
    ("H", "ɥ"),
    ("J\\_<", "ʄ"),
    ("J\\", "ɟ"),
    ("J", "ɲ"),
    ("K\\", "ɮ"),
    ("K", "ɬ"),
    ("L\\", "ʟ"),
    ("L", "ʎ"),
    ("M\\", "ɰ"),
    ("N\\", "ɴ"),
    ("N", "ŋ"),
    ("O\\", "ʘ"),
    ("P", "ʋ"),
    ("R\\", "ʀ"),
    ("R", "ʁ"),
    ("S", "ʃ"),
    ("T", "θ"),
    ("W", "ʍ"),
    ("X\\", "ħ"),
    ("X", "χ"),
    ("Z", "ʒ"),
    ("b_<", "ɓ"),
    ("d_<", "ɗ"),
    ("d`", "ɖ"),
    ("g_<", "ɠ"),
    ("h\\", "ɦ"),
    ("j\\", "ʝ"),
    ("l\\", "ɺ"),
    ("l`", "ɭ"),
    ("n`", "ɳ"),
    ("p\\", "ɸ"),
    ("r\\`", "ɻ"),
    ("r\\", "ɹ"),
    ("r`", "ɽ"),
    ("s\\", "ɕ"),
    ("s`", "ʂ"),
    ("t`", "ʈ"),
    ("v\\", "ʋ"),
    ("x\\", "ɧ"),
    ("z\\", "ʑ"),
    ("z`", "ʐ"),
    (">\\", "ʡ"),
    ("<\\", "ʢ"),
    ("|\\|\\", "ǁ"),
    ("|\\", "ǀ"),
    ("!\\", "ǃ"),
    ("=\\", "ǂ"),
    // Diacritics.
    ("_}", "\u{31a}"),
    ("_0", "\u{325}"),
    ("_=", "\u{329}"),
    ("=", "\u{329}"),
    ("_~", "\u{303}"),
    ("~", "\u{303}"),
    ("`", "˞"),
    (":\\", "ˑ"),
    (":", "ː"),
    ("%", "ˌ"),
    ("\"", "ˈ"),
    ("'", "ʲ"),
    ("-", ""),
    ("^", ""),
    ("!", ""),
    (".", ""),
    ("|", ""),
];

/// The phones of a symbol; `None` where nothing of it is known.
pub(super) fn xsampa(symbol: &str) -> Option<Spoken> {
    if symbol.len() > BYTES_MAX {
        return None;
    }
    let mut letters = String::new();
    let mut rest = symbol;
    while let Some(first) = rest.chars().next() {
        let row = ROWS.iter().find(|(code, _)| rest.starts_with(code));
        if let Some((code, letter)) = row {
            letters.push_str(letter);
            rest = &rest[code.len()..];
        } else if let Some(diacritic) = rest.strip_prefix('_') {
            // Any other diacritic is an allophone's: the letter and its backslash.
            let mut chars = diacritic.chars();
            chars.next();
            rest = chars.as_str();
        } else {
            letters.push(first);
            rest = &rest[first.len_utf8()..];
        }
    }
    ipa(&letters)
}
