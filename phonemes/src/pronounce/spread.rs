//! Phones within the times of words.

use super::{Pronouncer, Said, durations};
use crate::{Phone, Segment, TICK_RATE, Word};

/// After a gap of this length or more a word is the last of its phrase.
const PAUSE_TICKS: i64 = TICK_RATE / 10;

pub(super) fn spread(pronouncer: &Pronouncer, words: &[Word]) -> Vec<Segment> {
    let mut out = Vec::new();
    for (at, word) in words.iter().enumerate() {
        let said = pronouncer.pronounce(&word.text);
        let next = words.get(at + 1).map(|next| next.start);
        lay(&said, word.start, word.end, next, &mut out);
    }
    out
}

/// Adds the phones of a word from `start` to `end`, after those that are there. Time that no word
/// takes so long for is a pause.
pub(super) fn lay(said: &[Said], start: i64, end: i64, next: Option<i64>, out: &mut Vec<Segment>) {
    let start = out
        .last()
        .map_or(start, |last: &Segment| start.max(last.end));
    let ticks = end.saturating_sub(start);
    if said.is_empty() || ticks <= 0 {
        return;
    }
    let before_pause = next.is_none_or(|next| next.saturating_sub(end) >= PAUSE_TICKS);
    let mut from = start;
    for ((phone, stress), until) in said.iter().zip(durations::ends(said, ticks, before_pause)) {
        let until = start + until;
        if until > from {
            out.push(Segment {
                phone: *phone,
                start: from,
                end: until,
                stress: *stress,
            });
            from = until;
        }
    }
    if from < end {
        out.push(Segment::new(Phone::Pau, from, end));
    }
}
