//! On sound made here, whose boundaries are known.

use proptest::prelude::*;

use super::*;

/// A vowel-like buzz from `start` to `end`, with silence where nothing sounds.
fn buzz(sound: &mut [f32], start: usize, end: usize) {
    for (i, x) in sound.iter_mut().enumerate().take(end).skip(start) {
        let phase = i as f32 / 48_000.0 * std::f32::consts::TAU;
        *x = 0.2 * (phase * 120.0).sin()
            + 0.2 * (phase * 600.0).sin()
            + 0.05 * (phase * 1500.0).sin();
    }
}

/// "aba" whose labels are 30 ms late: the closure is found where the sound is silent.
#[test]
fn a_closure_moves_to_the_silence() {
    let mut sound = vec![0.0; 48_000];
    buzz(&mut sound, 9600, 19_200);
    buzz(&mut sound, 24_000, 38_400);
    let late = 1440;
    let mut segments = vec![
        Segment::new(Phone::HSharp, 0, 9600 + late),
        Segment::new(Phone::Aa, 9600 + late, 19_200 + late),
        Segment::new(Phone::B, 19_200 + late, 24_960 + late),
        Segment::new(Phone::Aa, 24_960 + late, 38_400 + late),
        Segment::new(Phone::HSharp, 38_400 + late, 48_000),
    ];
    refine(&mut segments, &sound, 1920);
    let phones: Vec<_> = segments.iter().map(|s| s.phone).collect();
    assert_eq!(
        phones,
        [
            Phone::HSharp,
            Phone::Aa,
            Phone::Bcl,
            Phone::B,
            Phone::Aa,
            Phone::HSharp
        ]
    );
    for (got, want) in [(segments[1].start, 9600), (segments[2].start, 19_200)] {
        assert!((got - want).abs() <= 2 * HOP_TICKS, "{got} {want}");
    }
    assert!((segments[5].start - 38_400).abs() <= 3 * HOP_TICKS);
}

proptest! {
    /// Whatever labels and sound there are, labels cover the sound and keep their order.
    #[test]
    fn labels_still_cover_the_sound(
        phones in prop::collection::vec((0usize..61, 1i64..9000), 1..12),
        loud in prop::collection::vec(any::<bool>(), 1..20),
        reach in 0i64..5000,
    ) {
        let mut at = 0;
        let mut segments: Vec<_> = phones.iter().map(|&(phone, ticks)| {
            let segment = Segment::new(Phone::ALL[phone], at, at + ticks);
            at += ticks;
            segment
        }).collect();
        let mut sound = vec![0.0; at as usize];
        for (k, _) in loud.iter().enumerate().filter(|(_, loud)| **loud) {
            let part = sound.len() / loud.len();
            buzz(&mut sound, k * part, (k + 1) * part);
        }
        refine(&mut segments, &sound, reach);
        let mut end = 0;
        for s in &segments {
            prop_assert_eq!(s.start, end);
            prop_assert!(s.end > s.start);
            end = s.end;
        }
        prop_assert_eq!(end, at);
        let kept: Vec<_> = segments.iter().map(|s| s.phone).filter(|p| !p.is_closure()).collect();
        let given: Vec<_> = phones.iter().map(|&(p, _)| Phone::ALL[p]).filter(|p| !p.is_closure()).collect();
        // A label of a tick or two may go where its neighbour's closure comes from it.
        prop_assert!(kept.len() <= given.len());
    }
}
