//! Late news without a jump: where what was told already and what is known now part, the difference is
//! kept and goes to nothing at a bounded speed.
//!
//! Like all of speech a function of time: an instant, and how far apart the two were then. A rewind to
//! before the next piece of news finds what was there. For whoever shows labels that arrive while they
//! are spoken.

use mouthpiece_phonemes::TICK_RATE;
use mouthpiece_rig::{Control, Controls};

/// Seconds from one end of a control's range to the other, at most. Lips open and close at up to 269 mm/s in
/// fast speech (own measurement on articulograph recordings), 10 mm in 40 ms; this is a little slower.
const FULL_S: f32 = 0.06;

/// A difference that goes to nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Correction {
    since: i64,
    offset: Controls,
}

impl Correction {
    /// From `since` on, at which the controls were `told` and would be `known` without a correction.
    #[must_use]
    pub fn new(since: i64, told: &Controls, known: &Controls) -> Self {
        let mut offset = Controls::default();
        for &control in Control::ALL {
            let apart = told[control] - known[control];
            offset[control] = if apart.is_finite() { apart } else { 0.0 };
        }
        Self { since, offset }
    }

    /// How much `control` changes by this in a tick, at most.
    #[must_use]
    pub fn speed(control: Control) -> f32 {
        let (low, high) = control.range();
        // Half the range of what goes both ways: 0 is where it rests.
        let span = if low < 0.0 { high } else { high - low };
        span / (FULL_S * TICK_RATE as f32)
    }

    /// Adds what is left of it at `ticks`.
    pub fn add(&self, ticks: i64, controls: &mut Controls) {
        let since = ticks.saturating_sub(self.since).max(0) as f32;
        for &control in Control::ALL {
            let offset = self.offset[control];
            if offset != 0.0 {
                let left = (offset.abs() - Self::speed(control) * since).max(0.0);
                controls[control] += left.copysign(offset);
            }
        }
        *controls = controls.clamped();
    }
}
