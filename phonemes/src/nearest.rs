//! Which phone codes an unknown one most resembles, so that an error can name the mend.
//!
//! By edit distance, after a few symbols that other alphabets use for what TIMIT has. This only
//! words messages; it never maps a label.

use crate::Phone;

/// Symbols that other label sets use where the spelling says nothing of the phone.
const FOREIGN: [(&str, &[Phone]); 8] = [
    ("sil", &[Phone::HSharp, Phone::Pau]),
    ("sp", &[Phone::Pau]),
    ("spn", &[Phone::Pau]),
    ("#h", &[Phone::HSharp]),
    ("h", &[Phone::Hh]),
    ("brth", &[Phone::Pau]),
    ("vcl", &[Phone::Bcl, Phone::Dcl, Phone::Gcl]),
    ("cl", &[Phone::Pcl, Phone::Tcl, Phone::Kcl]),
];

/// At most this many suggestions: a sentence, not a table.
const SUGGESTIONS_MAX: usize = 3;

/// Longer symbols resemble no code; also bounds the work that a hostile line can ask for.
const CODE_BYTES_MAX: usize = 16;

/// The codes nearest to `code`, best first; none where it is too long to be a code.
pub fn nearest(code: &str) -> Vec<Phone> {
    let lower = code.to_lowercase();
    if let Some((_, phones)) = FOREIGN.iter().find(|(symbol, _)| *symbol == lower) {
        return phones.to_vec();
    }
    if lower.len() > CODE_BYTES_MAX {
        return Vec::new();
    }
    // A stress digit, as in ARPAbet's AH0, is no part of the spelling.
    let bare = lower.trim_end_matches(|c: char| c.is_ascii_digit());
    let mut ranked: Vec<(usize, Phone)> = Phone::ALL
        .into_iter()
        .map(|phone| (distance(bare.as_bytes(), phone.code().as_bytes()), phone))
        .collect();
    ranked.sort();
    let best = ranked.first().map_or(0, |first| first.0);
    let near = ranked.into_iter().take_while(|(d, _)| *d == best);
    near.map(|(_, phone)| phone).take(SUGGESTIONS_MAX).collect()
}

/// The same as text for a message: `` `pcl`, `tcl` ``.
pub(crate) fn listed(code: &str) -> String {
    let near = nearest(code);
    if near.is_empty() {
        return "`h#`, `aa` or `pcl`".to_owned();
    }
    let quoted: Vec<String> = near.iter().map(|p| format!("`{p}`")).collect();
    quoted.join(", ")
}

/// Edits (one character inserted, removed or changed) that turn `a` into `b`.
fn distance(a: &[u8], b: &[u8]) -> usize {
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.iter().enumerate() {
        let mut diagonal = i;
        if let Some(first) = row.first_mut() {
            *first = i + 1;
        }
        for (j, y) in b.iter().enumerate() {
            let change = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = change.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}
