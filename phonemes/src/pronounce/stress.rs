//! One main stress a word.
//!
//! Rules look at letters nearby and may stress a word twice or never. Stress is what speech opens
//! the mouth for and nods at, so a word has it once: where the rules put it first, else on the first
//! full vowel, else on the first vowel, which then is a full one.

use super::Said;
use crate::{Phone, Stress};

/// Leaves one primary stress; every vowel gets a mark, consonants none.
pub(super) fn settle(said: &mut [Said]) {
    let first = |test: fn(&Said) -> bool| said.iter().position(test);
    let main = first(|s| s.1 == Some(Stress::Primary))
        .or_else(|| first(|s| s.1 == Some(Stress::Secondary)))
        .or_else(|| first(|s| s.0.is_vowel() && !is_reduced(s.0)))
        .or_else(|| first(|s| s.0.is_vowel()));
    for (at, (phone, stress)) in said.iter_mut().enumerate() {
        *stress = match *stress {
            _ if !phone.is_vowel() => None,
            _ if Some(at) == main => Some(Stress::Primary),
            Some(Stress::Primary | Stress::Secondary) => Some(Stress::Secondary),
            _ => Some(Stress::Unstressed),
        };
        if Some(at) == main {
            *phone = full(*phone);
        }
    }
}

/// A vowel that only unstressed syllables have.
const fn is_reduced(phone: Phone) -> bool {
    matches!(phone, Phone::Ax | Phone::Ix | Phone::Axr | Phone::AxH)
}

/// What a reduced vowel is where it has the main stress, in a word of one syllable.
const fn full(phone: Phone) -> Phone {
    match phone {
        Phone::Ax | Phone::AxH => Phone::Ah,
        Phone::Ix => Phone::Ih,
        Phone::Axr => Phone::Er,
        other => other,
    }
}

/// The same phones with all their stress a step lower, as the second part of a compound has it.
pub(super) fn lower(said: &mut [Said]) {
    for (_, stress) in said {
        if *stress == Some(Stress::Primary) {
            *stress = Some(Stress::Secondary);
        }
    }
}
