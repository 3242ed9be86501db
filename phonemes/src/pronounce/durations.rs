//! How long each phone takes, and how phones share the time of their word.
//!
//! Klatt's model as MITalk has it (Allen, Hunnicutt and Klatt, "From Text to Speech", 1987): a
//! phone has a shortest and an inherent duration, and what a word has beyond the sum of the first
//! goes to phones by the difference of the two; so vowels stretch and consonants hardly do. The
//! syllable before a pause is 1.4 times as long (Klatt 1976).

use super::Said;
use crate::{Phone, Stress, TICK_RATE};

/// Shortest and inherent duration in milliseconds. MITalk's, but for `ux axr ax-h hv eng nx q`, which
/// it does not tell apart (judgement, after their neighbours).
const ROWS: [(Phone, i64, i64); 52] = [
    (Phone::Iy, 55, 155),
    (Phone::Ih, 40, 135),
    (Phone::Eh, 70, 150),
    (Phone::Ey, 100, 190),
    (Phone::Ae, 80, 230),
    (Phone::Aa, 100, 240),
    (Phone::Aw, 100, 260),
    (Phone::Ay, 150, 250),
    (Phone::Ah, 60, 140),
    (Phone::Ao, 100, 240),
    (Phone::Oy, 150, 280),
    (Phone::Ow, 80, 220),
    (Phone::Uh, 60, 160),
    (Phone::Uw, 70, 210),
    (Phone::Ux, 70, 210),
    (Phone::Er, 80, 180),
    (Phone::Ax, 60, 120),
    (Phone::Ix, 60, 110),
    (Phone::Axr, 60, 130),
    (Phone::AxH, 30, 60),
    (Phone::L, 40, 80),
    (Phone::R, 30, 80),
    (Phone::W, 60, 80),
    (Phone::Y, 40, 80),
    (Phone::Hh, 20, 80),
    (Phone::Hv, 20, 80),
    (Phone::El, 110, 260),
    (Phone::M, 60, 70),
    (Phone::N, 50, 60),
    (Phone::Ng, 60, 95),
    (Phone::Em, 110, 170),
    (Phone::En, 100, 170),
    (Phone::Eng, 100, 170),
    (Phone::Nx, 20, 30),
    (Phone::S, 60, 105),
    (Phone::Sh, 80, 105),
    (Phone::Z, 40, 75),
    (Phone::Zh, 40, 70),
    (Phone::F, 80, 100),
    (Phone::Th, 60, 90),
    (Phone::V, 40, 60),
    (Phone::Dh, 30, 50),
    (Phone::Jh, 50, 70),
    (Phone::Ch, 50, 70),
    (Phone::B, 60, 85),
    (Phone::D, 50, 75),
    (Phone::G, 60, 80),
    (Phone::P, 50, 90),
    (Phone::T, 50, 75),
    (Phone::K, 60, 80),
    (Phone::Dx, 20, 20),
    (Phone::Q, 30, 40),
];

/// Closures and pauses, which no dictionary has, if ever one is asked for.
const OTHERS: (i64, i64) = (40, 60);

/// Shortest and inherent duration of a phone in ticks. Only vowels with a mark of primary stress, or
/// none at all, have all of theirs; unstressed syllables are two thirds of it.
fn of(said: Said) -> (i64, i64) {
    let (phone, stress) = said;
    let row = ROWS.iter().find(|row| row.0 == phone);
    let (least, whole) = row.map_or(OTHERS, |row| (row.1, row.2));
    let whole = match stress {
        Some(Stress::Unstressed) => least.max(whole * 2 / 3),
        _ => whole,
    };
    (least * TICK_RATE / 1000, whole * TICK_RATE / 1000)
}

/// Words are stretched to this much of their inherent length and no more: what a word's time has
/// beyond it is a pause that the source counted in.
const STRETCH_MAX: i64 = 2;

/// Numerator and denominator of the lengthening before a pause.
const FINAL: (i64, i64) = (7, 5);

/// How far phones are taken to be alike: a model of one speaker's durations knows others only so
/// far. In words of one person and two voices whose phones are labelled, inner ends of phones are
/// wrong by 18 to 20 ms with this share, by 18 to 23 with none, by 22 to 29 were all phones alike.
const ALIKE: (i64, i64) = (2, 5);

/// Where each phone ends, in ticks from the start of their common time, and where that is used up:
/// `ticks`, or earlier where the phones leave a pause. Ends rise, and the last is that point.
pub(super) fn ends(said: &[Said], ticks: i64, before_pause: bool) -> Vec<i64> {
    let mut rows: Vec<(i64, i64)> = said.iter().map(|said| of(*said)).collect();
    if before_pause && let Some(last) = said.iter().rposition(|(phone, _)| phone.is_vowel()) {
        rows[last].1 = rows[last].1 * FINAL.0 / FINAL.1;
    }
    let least: i64 = rows.iter().map(|row| row.0).sum();
    let whole: i64 = rows.iter().map(|row| row.1).sum();
    let ticks = ticks.clamp(0, STRETCH_MAX * whole);
    let spare = (ticks - least).max(0);
    let room = (whole - least).max(1);
    let (mut shortest, mut stretch) = (0, 0);
    let count = rows.len() as i64;
    let mut ends = Vec::with_capacity(rows.len());
    for (number, row) in (1..).zip(&rows) {
        shortest += row.0;
        stretch += row.1 - row.0;
        let by_phone = if ticks < least {
            ticks * shortest / least.max(1)
        } else {
            shortest + spare * stretch / room
        };
        let alike = ticks * number / count;
        ends.push((by_phone * (ALIKE.1 - ALIKE.0) + alike * ALIKE.0) / ALIKE.1);
    }
    // A word whose phones cannot stretch still fills its time.
    if let Some(last) = ends.last_mut() {
        *last = ticks;
    }
    ends
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_phone_that_is_not_a_closure_or_silence_has_a_duration() {
        for phone in Phone::ALL {
            let timed = ROWS.iter().any(|row| row.0 == phone && row.1 <= row.2);
            assert_eq!(timed, !phone.is_closure() && !phone.is_silence(), "{phone}");
        }
    }

    #[test]
    fn vowels_stretch_more_than_consonants() {
        let bob = [(Phone::B, None), (Phone::Aa, None), (Phone::B, None)];
        let share = |ms: i64| {
            let ends = ends(&bob, ms * 48, false);
            (ends[1] - ends[0]) * 100 / ends[2]
        };
        assert_eq!(share(100), 40);
        assert!(share(220) < share(400) && share(400) < share(600));
        // 5 s of "bob" are "bob" and a pause.
        assert_eq!(ends(&bob, 5000 * 48, false)[2], 820 * 48);
    }
}
