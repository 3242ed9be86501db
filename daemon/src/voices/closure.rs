//! Measures the silence before a burst, for [`close_before_bursts`].
//!
//! espeak-ng stamps /p t k/ and affricates, and many a /b d g/, at the burst, after 20 to 60 ms of
//! digital silence. A stop whose closure is voiced keeps its one label; speech parts that itself.

use mouthpiece_phonemes::{Segment, close_before_bursts};

/// What still counts as silence: digital silence, with what our resampler's filter adds at its edges.
const SILENCE: f32 = 0.002;

/// The filter's ringing before a burst.
const EDGE_TICKS: usize = 96;

/// Less silence than this is the gap between two periods of a voice: 12 ms.
const CLOSURE_TICKS_MIN: i64 = 576;

/// More than this is a pause, of which the closure is the end: 60 ms, the longest closure that
/// espeak-ng makes within a phrase.
const CLOSURE_TICKS_MAX: usize = 2880;

/// The same segments, with the silence before each release as its closure.
pub fn split(segments: &[Segment], sound: &[f32]) -> Vec<Segment> {
    close_before_bursts(segments, |segment| silence_before(sound, segment.start))
}

/// Ticks of silence that end at tick `at`, as far as a closure lasts; 0 for less than one.
fn silence_before(sound: &[f32], at: i64) -> i64 {
    let end = usize::try_from(at).unwrap_or(0).min(sound.len());
    let before = sound.get(..end).unwrap_or(&[]);
    let edge = &before[before.len().saturating_sub(EDGE_TICKS)..];
    let within = &before[..before.len() - edge.len()];
    let silent = within.iter().rev().take(CLOSURE_TICKS_MAX - EDGE_TICKS);
    let silent = silent.take_while(|x| x.abs() <= SILENCE).count();
    let closed = (silent + edge.len()) as i64;
    if silent > 0 && closed >= CLOSURE_TICKS_MIN {
        closed
    } else {
        0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mouthpiece_phonemes::Phone;
    use proptest::prelude::*;

    /// A vowel, 40 ms of silence and a burst: the silence becomes the closure.
    #[test]
    fn silence_before_a_burst_is_the_closure() {
        let mut sound = vec![0.3; 9600];
        sound[4800 - 1920..4800].fill(0.0);
        let spoken = [
            Segment::new(Phone::Aa, 0, 4800),
            Segment::new(Phone::P, 4800, 6000),
        ];
        let want = [
            Segment::new(Phone::Aa, 0, 2880),
            Segment::new(Phone::Pcl, 2880, 4800),
            Segment::new(Phone::P, 4800, 6000),
        ];
        assert_eq!(split(&spoken, &sound), want);
        // A voiced closure has no silence; its label stays whole.
        let voiced = [
            Segment::new(Phone::Aa, 0, 2000),
            Segment::new(Phone::B, 2000, 2800),
        ];
        assert_eq!(split(&voiced, &sound), voiced);
        // Of a long pause only the end is the closure.
        let silence = vec![0.0; 9600];
        let after_pause = [
            Segment::new(Phone::Pau, 0, 4800),
            Segment::new(Phone::K, 4800, 6000),
        ];
        assert_eq!(
            split(&after_pause, &silence)[0].end,
            4800 - CLOSURE_TICKS_MAX as i64
        );
    }

    proptest! {
        /// Labels stay in order and cover what they covered, whatever the sound.
        #[test]
        fn nothing_is_lost(
            phones in prop::collection::vec((0usize..61, 1i64..3000), 1..20),
            sound in prop::collection::vec(prop::sample::select(vec![0.0f32, 0.0, 0.0, 0.5]), 0..40),
        ) {
            let sound: Vec<f32> = sound.into_iter().flat_map(|x| [x; 500]).collect();
            let mut at = 0;
            let segments: Vec<_> = phones.into_iter().map(|(phone, ticks)| {
                let segment = Segment::new(Phone::ALL[phone], at, at + ticks);
                at += ticks;
                segment
            }).collect();
            let mut end = 0;
            for s in split(&segments, &sound) {
                prop_assert_eq!(s.start, end);
                prop_assert!(s.end > s.start);
                end = s.end;
            }
            prop_assert_eq!(end, at);
        }
    }
}
