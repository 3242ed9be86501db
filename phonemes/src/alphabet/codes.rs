//! The alphabets whose symbols are letter codes: TIMIT's own, ARPAbet, and radio codes.
//!
//! Read in any case. Sources: TIMIT's `phoncode.doc`; the CMU dictionary's phone list, whose
//! digits mark stress on vowels; festival's `radio` phone set, which flite's US voices use too.
//! ARPAbet has no letters for reduced vowels: without stress `AH`, `IH` and `ER` are TIMIT's
//! `ax`, `ix` and `axr`.

use super::{PhoneList, Spoken};
use crate::{Phone, Stress};

/// Marks for silence, breath and noise in all kinds of label files.
const PAUSES: [(&str, Phone); 32] = [
    ("", Phone::Pau),
    ("sil", Phone::Pau),
    ("silence", Phone::Pau),
    ("<sil>", Phone::Pau),
    ("sp", Phone::Pau),
    ("<sp>", Phone::Pau),
    ("ssil", Phone::Pau),
    ("spn", Phone::Pau),
    ("nsn", Phone::Pau),
    ("pau", Phone::Pau),
    ("<p:>", Phone::Pau),
    ("_", Phone::Pau),
    ("_:", Phone::Pau),
    ("#", Phone::Pau),
    ("...", Phone::Pau),
    ("brth", Phone::Pau),
    ("breath", Phone::Pau),
    ("+breath+", Phone::Pau),
    ("+noise+", Phone::Pau),
    ("+spn+", Phone::Pau),
    ("<unk>", Phone::Pau),
    ("<eps>", Phone::Epi),
    ("epi", Phone::Epi),
    ("h#", Phone::HSharp),
    ("#h", Phone::HSharp),
    ("<s>", Phone::HSharp),
    ("</s>", Phone::HSharp),
    ("^", Phone::HSharp),
    ("$", Phone::HSharp),
    ("xxx", Phone::Pau),
    ("noise", Phone::Pau),
    ("laugh", Phone::Pau),
];

/// Longest mark or code; anything longer is neither.
const CODE_BYTES_MAX: usize = 10;

/// A mark that sounds nothing.
pub(super) fn pause(symbol: &str) -> Option<Spoken> {
    let lower = lower(symbol)?;
    let (_, phone) = PAUSES.iter().find(|(mark, _)| *mark == lower)?;
    Some(Spoken::exactly(*phone))
}

fn lower(symbol: &str) -> Option<String> {
    (symbol.len() <= CODE_BYTES_MAX).then(|| symbol.to_ascii_lowercase())
}

/// TIMIT's own codes.
pub(super) fn timit(symbol: &str) -> Option<Spoken> {
    Phone::from_code(&lower(symbol)?).map(Spoken::exactly)
}

/// ARPAbet, with or without stress.
pub(super) fn arpabet(symbol: &str) -> Option<Spoken> {
    let lower = lower(symbol)?;
    let bare = lower.trim_end_matches(|c: char| c.is_ascii_digit());
    let stress = match &lower[bare.len()..] {
        "" => None,
        "0" => Some(Stress::Unstressed),
        "1" => Some(Stress::Primary),
        "2" => Some(Stress::Secondary),
        _ => return None,
    };
    let mut phone = Phone::from_code(bare)?;
    // Codes that ARPAbet lacks; its vowels alone carry stress.
    if phone.cmu().is_empty() || phone.is_silence() || (stress.is_some() && !phone.is_vowel()) {
        return None;
    }
    if stress == Some(Stress::Unstressed) {
        phone = match phone {
            Phone::Ah => Phone::Ax,
            Phone::Ih => Phone::Ix,
            Phone::Er => Phone::Axr,
            other => other,
        };
    }
    Some(Spoken {
        stress,
        ..Spoken::exactly(phone)
    })
}

/// Codes of festival's radio set that TIMIT has under another name or not at all.
const RADIO: [(&str, &[Phone]); 6] = [
    ("h", &[Phone::Hh]),
    ("hv", &[Phone::Hv]),
    ("em", &[Phone::Em]),
    ("nx", &[Phone::Nx]),
    ("ll", &[Phone::L]),
    ("ii", &[Phone::Iy]),
];

/// Festival's and flite's codes; HTS labels may carry stress digits too.
pub(super) fn radio(symbol: &str) -> Option<Spoken> {
    let lower = lower(symbol)?;
    if let Some((_, phones)) = RADIO.iter().find(|(code, _)| *code == lower) {
        return Some(Spoken {
            phones: PhoneList::of(phones)?,
            ..Spoken::exactly(Phone::Epi)
        });
    }
    timit(&lower).or_else(|| arpabet(&lower))
}
