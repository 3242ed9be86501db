//! Which alphabet a list of symbols is in.
//!
//! Each symbol votes for every alphabet that would write it so; most votes win. Labels of one file
//! hold enough symbols that only one alphabet has. Where two write all of them (plain `b d iy`), they
//! also mean the same by them.

use super::{Alphabet, codes, espeak, ipa, xsampa};

/// Votes are equal: the first of these. Small letters are radio's first,
/// capitals ARPAbet's, and TIMIT's only where a code is neither's.
const ORDER: [Alphabet; 6] = [
    Alphabet::Radio,
    Alphabet::Arpabet,
    Alphabet::Timit,
    Alphabet::XSampa,
    Alphabet::Espeak,
    Alphabet::Ipa,
];

/// So many labels say enough of a file.
const SYMBOLS_MAX: usize = 10_000;

pub(super) fn guess<'a>(symbols: impl IntoIterator<Item = &'a str>) -> Alphabet {
    let mut votes = [0_u32; ORDER.len()];
    for symbol in symbols.into_iter().take(SYMBOLS_MAX) {
        let symbol = symbol.trim();
        // Every alphabet has the same marks for pauses; only TIMIT's name it.
        if codes::pause(symbol).is_some() && !matches!(symbol, "h#" | "epi" | "H#") {
            continue;
        }
        for (count, alphabet) in votes.iter_mut().zip(ORDER) {
            *count += u32::from(writes(alphabet, symbol));
        }
    }
    let most = votes.iter().max().copied().unwrap_or(0);
    if most == 0 {
        return Alphabet::Timit;
    }
    let best = votes.iter().position(|count| *count == most);
    best.map_or(Alphabet::Timit, |best| ORDER[best])
}

/// Whether the alphabet would write a phone of English like this.
fn writes(alphabet: Alphabet, symbol: &str) -> bool {
    let lower = !symbol.contains(|c: char| c.is_ascii_uppercase());
    match alphabet {
        Alphabet::Arpabet => codes::arpabet(symbol).is_some(),
        Alphabet::Radio => lower && codes::is_radio(symbol),
        Alphabet::Timit => codes::timit(symbol).is_some(),
        Alphabet::Ipa => {
            !symbol.contains(|c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '@')
                && ipa::ipa(symbol).is_some_and(|spoken| spoken.exact)
        }
        Alphabet::XSampa => {
            symbol.is_ascii() && xsampa::xsampa(symbol).is_some_and(|spoken| spoken.exact)
        }
        Alphabet::Espeak => {
            symbol.is_ascii() && espeak::espeak(symbol).is_some_and(|spoken| spoken.exact)
        }
    }
}
