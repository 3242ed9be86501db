//! Moves label boundaries to where the sound changes.
//!
//! Engines' times are those of their synthesis, which is not quite when a phone sounds: flite's and
//! festival's vowels still sound some 15 ms into the closure that follows and have one label for
//! closure and release, Piper's consonants begin up to 60 ms before their label, and an aligner's
//! boundaries are multiples of 10 ms. An eye sees lips that meet late. Given the right phones in
//! the right order at about the right time, this finds the boundaries, none moved by more than
//! `reach`, that make each label even within and fit for its class ([`cost`]), by dynamic programming
//! over frames of 5 ms ([`spectrum`]). espeak-ng's times are exact and stay as they are.

mod cost;
mod spectrum;

use mouthpiece_phonemes::{Phone, Segment};

use cost::Cost;
use spectrum::{HOP_TICKS, bands};

/// No label is made shorter: 15 ms.
const FRAMES_MIN: usize = 3;

/// How much of a stop's one label is its closure, to begin the search with.
const CLOSURE_SHARE: i64 = 62;

/// What a stop after a pause takes of it for its closure: 40 ms, at most half.
const PAUSE_TICKS: i64 = 1920;

/// What the way to a place may cost by its distance from where the engine put it: 40 ms off costs half a unit.
const FAR_FRAMES: f32 = 8.0;

/// Stops and affricates apart into closure and release, and boundaries up to `reach` ticks better.
/// `segments` are contiguous and cover `sound`.
pub fn refine(segments: &mut Vec<Segment>, sound: &[f32], reach: i64) {
    let parted = part(segments);
    *segments = match place(&parted, sound, reach) {
        Some(bounds) => moved(&parted, &bounds, sound.len() as i64),
        // Labels too dense for frames of 5 ms keep their times.
        None => parted,
    };
}

/// Gives every stop and affricate a closure of its own.
fn part(segments: &[Segment]) -> Vec<Segment> {
    let mut out: Vec<Segment> = Vec::with_capacity(segments.len() * 2);
    for segment in segments {
        let last = out.last_mut();
        let Some(phone) = segment.phone.closure() else {
            out.push(*segment);
            continue;
        };
        if last.as_ref().is_some_and(|last| last.phone.is_closure()) {
            out.push(*segment);
            continue;
        }
        let mut start = segment.start;
        let mut burst = start + segment.duration() * CLOSURE_SHARE / 100;
        if let Some(last) = last.filter(|last| last.phone.is_silence()) {
            let taken = PAUSE_TICKS.min(last.duration() / 2);
            last.end -= taken;
            (start, burst) = (start - taken, start + segment.duration() / 4);
        }
        let release = Segment {
            start: burst,
            ..*segment
        };
        out.push(Segment {
            phone,
            start,
            end: burst,
            stress: segment.stress,
        });
        out.push(release);
    }
    out.retain(|s| s.end > s.start);
    out
}

/// The frame at which each label but the first begins, none where there is no way.
fn place(segments: &[Segment], sound: &[f32], reach: i64) -> Option<Vec<usize>> {
    let frames = bands(sound);
    let loud = frames.iter().flatten().copied().fold(0.0, f32::max);
    let reach = usize::try_from(reach / HOP_TICKS).ok()?;
    let guesses = segments.iter().skip(1).map(|s| {
        let frame = (s.start + HOP_TICKS / 2) / HOP_TICKS;
        usize::try_from(frame).unwrap_or(0)
    });
    let guesses: Vec<usize> = guesses.collect();

    // The cheapest way to have the label before end at each place, and for each label, where it began.
    let mut best: Vec<(usize, f32)> = vec![(0, 0.0)];
    let mut trails: Vec<Vec<(usize, usize)>> = Vec::with_capacity(segments.len());
    for (number, segment) in segments.iter().enumerate() {
        let (low, high) = match guesses.get(number) {
            Some(&guess) => (
                guess.saturating_sub(reach).max(1),
                (guess + reach).min(frames.len().saturating_sub(1)),
            ),
            None => (frames.len(), frames.len()),
        };
        let from = best.first()?.0;
        let cost = Cost::new(segment.phone, &frames, loud, from, high);
        let mut step = Vec::new();
        let mut trail = Vec::new();
        for end in low..=high {
            let ways = best
                .iter()
                .filter(|(start, _)| end >= start + FRAMES_MIN)
                .map(|&(start, so_far)| (start, so_far + cost.of(start, end)));
            let Some((start, price)) = ways.min_by(|a, b| a.1.total_cmp(&b.1)) else {
                continue;
            };
            let off = guesses.get(number).map_or(0.0, |&g| g as f32 - end as f32);
            step.push((end, price + 0.5 * (off / FAR_FRAMES).powi(2)));
            trail.push((end, start));
        }
        best = step;
        trails.push(trail);
    }

    let mut bounds = Vec::with_capacity(segments.len());
    let mut at = best.first()?.0;
    for trail in trails.iter().rev() {
        at = trail.iter().find(|(end, _)| *end == at)?.1;
        bounds.push(at);
    }
    bounds.reverse();
    bounds.remove(0);
    Some(bounds)
}

/// `segments` with new boundaries.
fn moved(segments: &[Segment], bounds: &[usize], end: i64) -> Vec<Segment> {
    let starts = bounds.iter().map(|&frame| frame as i64 * HOP_TICKS);
    let mut out: Vec<Segment> = Vec::with_capacity(segments.len());
    for (segment, start) in segments.iter().zip(std::iter::once(0).chain(starts)) {
        if let Some(last) = out.last_mut() {
            last.end = start;
        }
        out.push(Segment {
            start,
            end,
            ..*segment
        });
    }
    out
}

/// Phones that stand for silence or the closed part of a voiceless stop.
const fn is_voiceless_closure(phone: Phone) -> bool {
    matches!(phone, Phone::Pcl | Phone::Tcl | Phone::Kcl)
}

#[cfg(test)]
mod tests;
