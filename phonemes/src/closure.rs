//! The silence before a burst, given to the stop that it belongs to.
//!
//! Some voices (espeak-ng) stamp a stop at its burst: the silence before it, in which lips or tongue
//! are closed, stands under the name of the phone before. TIMIT has a label of its own for it, so
//! that is what it becomes. A stop whose closure is voiced keeps its one label. For readers that
//! know how long the silence usually is, and for whoever has the sound and can measure it.

use crate::Segment;

/// What the closure is taken from keeps this part of its time: one over it.
const KEPT: i64 = 4;

/// The same segments, with the `silence` ticks before each release as its closure; 0 where there is
/// none.
pub fn close_before_bursts(
    segments: &[Segment],
    silence: impl Fn(&Segment) -> i64,
) -> Vec<Segment> {
    let mut out: Vec<Segment> = Vec::with_capacity(segments.len() * 2);
    for segment in segments {
        let silent = silence(segment);
        if let Some(phone) = segment.phone.closure()
            && silent > 0
            && !out.last().is_some_and(|last| last.phone.is_closure())
        {
            let mut start = segment.start.saturating_sub(silent);
            match out.last_mut() {
                Some(last) => {
                    start = start.max(last.start + last.duration() / KEPT);
                    last.end = last.end.min(start);
                }
                None => start = start.max(0),
            }
            out.push(Segment {
                phone,
                start,
                end: segment.start,
                stress: segment.stress,
            });
        }
        out.push(*segment);
    }
    out.retain(|s| s.end > s.start);
    out
}
