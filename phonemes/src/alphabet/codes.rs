//! The alphabets whose symbols are letter codes: TIMIT's own, ARPAbet, and radio codes.
//!
//! Read in any case. Sources: TIMIT's `phoncode.doc`; the CMU dictionary's phone list, whose
//! digits mark stress on vowels; festival's `radio` phone set, which flite's US voices use too.
//! ARPAbet has no letters for reduced vowels: without stress `AH`, `IH` and `ER` are TIMIT's
//! `ax`, `ix` and `axr`.

use super::{PhoneList, Spoken};
use crate::{Phone, Stress};

/// Marks for silence, breath and noise in all kinds of label files.
const PAUSES: [(&str, Phone); 33] = [
    ("", Phone::Pau),
    ("sil", Phone::Pau),
    ("silence", Phone::Pau),
    ("<sil>", Phone::Pau),
    ("sp", Phone::Pau),
    ("<sp>", Phone::Pau),
    ("ssil", Phone::Pau),
    ("spn", Phone::Pau),
    ("||", Phone::Pau),
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

/// Where in its word a phone is, as Kaldi marks it: begin, inside, end, alone.
const PLACES: [&str; 4] = ["_b", "_i", "_e", "_s"];

/// ARPAbet, with or without stress.
pub(super) fn arpabet(symbol: &str) -> Option<Spoken> {
    let mut lower = lower(symbol)?;
    if PLACES.iter().any(|place| lower.ends_with(place)) {
        lower.truncate(lower.len() - 2);
    }
    if let Some(pause) = pause(&lower) {
        return Some(pause);
    }
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

/// Festival's radio phones, and `hh`'s other name in some of its lexicons. Those of TIMIT that
/// are not among them are TIMIT's alone.
const RADIO: &str = "aa ae ah ao aw ax axr ay b brth ch d dh dx eh el em en er ey f g h# hh hv ih iy \
     jh k l m n ng nx ow oy p pau r s sh t th uh uw v w y z zh";

/// Whether festival's radio set has this code.
pub(super) fn is_radio(symbol: &str) -> bool {
    RADIO.split_whitespace().any(|code| code == symbol)
}

/// Festival's and flite's codes; HTS labels may carry stress digits too.
pub(super) fn radio(symbol: &str) -> Option<Spoken> {
    timit(symbol).or_else(|| arpabet(symbol))
}

/// An unknown symbol as a row of codes, longest first (`tsh` is `t sh`); `None` unless codes spell
/// all of it.
pub(super) fn spelled(symbol: &str) -> Option<Spoken> {
    let lower = lower(symbol)?;
    let mut rest = lower.trim_end_matches(|c: char| c.is_ascii_digit());
    let mut phones: Vec<Phone> = Vec::new();
    while !rest.is_empty() {
        let ends = (1..=rest.len().min(4))
            .rev()
            .filter_map(|end| rest.get(..end));
        let mut codes = ends.filter_map(|code| Phone::from_code(code).map(|phone| (code, phone)));
        let (code, phone) = codes.next()?;
        if phones.last() != Some(&phone) {
            phones.push(phone);
        }
        rest = &rest[code.len()..];
    }
    Some(Spoken {
        phones: PhoneList::of(&phones)?,
        stress: None,
        exact: false,
    })
}
