//! Makes labels end where the sound does, and leaves no hole between them.
//!
//! Engines' last label and their sound rarely agree: flite's kal16 leaves the end of its last pause
//! out of the sound (114 ms on average), its other voices round up by some 2 ms, and festival's
//! last label ends some 30 ms before its sound. All of that is silence, so the last pause is cut or
//! drawn out; a phone that sounds keeps its end, unless the sound itself ends before.

use mouthpiece_phonemes::{Phone, Segment};

/// Fits contiguous `segments` to a sound of `ticks`.
pub fn fit(segments: &mut Vec<Segment>, ticks: i64) {
    super::in_order(segments);
    segments.retain(|s| s.start < ticks);
    // Holes are silence; one pause is as good as two.
    let mut whole: Vec<Segment> = Vec::with_capacity(segments.len() + 2);
    let end = Segment::new(Phone::HSharp, ticks, ticks);
    for next in segments.drain(..).chain([end]) {
        let at = whole.last().map_or(0, |s| s.end);
        if next.start > at {
            match whole.last_mut() {
                Some(last) if last.phone.is_silence() => last.end = next.start,
                _ => whole.push(Segment::new(Phone::HSharp, at, next.start)),
            }
        }
        match whole.last_mut() {
            Some(last) if last.phone.is_silence() && next.phone.is_silence() => {
                last.end = last.end.max(next.end);
            }
            _ => whole.push(next),
        }
    }
    for edge in [whole.len().saturating_sub(1), 0] {
        if let Some(edge) = whole.get_mut(edge)
            && edge.phone.is_silence()
        {
            edge.phone = Phone::HSharp;
        }
    }
    whole.retain_mut(|s| {
        s.end = s.end.min(ticks);
        s.end > s.start
    });
    *segments = whole;
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn segment(phone: Phone, start: i64, end: i64) -> Segment {
        Segment::new(phone, start, end)
    }

    #[test]
    fn the_last_pause_gives_way_or_is_drawn_out() {
        use Phone::{Aa, HSharp, Pau};
        let spoken = vec![
            segment(Pau, 0, 100),
            segment(Aa, 100, 900),
            segment(Pau, 900, 2000),
        ];
        let want = |end| {
            vec![
                segment(HSharp, 0, 100),
                segment(Aa, 100, 900),
                segment(HSharp, 900, end),
            ]
        };
        for end in [1500, 2500] {
            let mut segments = spoken.clone();
            fit(&mut segments, end);
            assert_eq!(segments, want(end));
        }
        let mut segments = spoken;
        fit(&mut segments, 800);
        assert_eq!(
            segments,
            want(900)[..1]
                .iter()
                .copied()
                .chain([segment(Aa, 100, 800)])
                .collect::<Vec<_>>()
        );
    }

    proptest! {
        /// Whatever an engine says, labels cover the sound, each tick once.
        #[test]
        fn labels_cover_the_sound(
            labels in prop::collection::vec((0usize..61, -50i64..900, -50i64..400), 0..20),
            ticks in 1i64..1000,
        ) {
            let mut segments: Vec<_> = labels.into_iter()
                .map(|(phone, start, length)| segment(Phone::ALL[phone], start, start + length))
                .collect();
            fit(&mut segments, ticks);
            let mut at = 0;
            for s in &segments {
                prop_assert_eq!(s.start, at);
                prop_assert!(s.end > s.start);
                at = s.end;
            }
            prop_assert_eq!(at, ticks);
        }
    }
}
