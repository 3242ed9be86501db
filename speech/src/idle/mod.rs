//! A face that is alive between the words (HABER 5.4): blinks as peaks at randomised intervals, small
//! head movement as sines of different period and randomised amplitude, and, beyond the paper, eyes
//! that mostly look at the viewer and glance away now and then.
//!
//! Everything is a function of the seed and the tick alone, with nothing carried from one call to the
//! next: an export repeats, a rewind finds what was there, and any tick may be asked for first. It does
//! not react to anything; nods, brows and listening are not here.

mod blink;
mod gaze;
mod noise;
mod sway;

use mouthpiece_phonemes::TICK_RATE;
use mouthpiece_rig::{Control, Controls};

use noise::Noise;

/// The small movements of one head.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Idle {
    noise: Noise,
}

impl Idle {
    /// Movements that follow from `seed`.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self {
            noise: Noise::new(seed),
        }
    }

    /// Adds what lids, eyes and head do at `ticks` to `controls`. `speaking` is 0 for a silent face and 1
    /// for one in mid sentence ([`Track::speaking_at`](crate::Track::speaking_at)); it should not jump.
    pub fn add(&self, ticks: i64, speaking: f32, controls: &mut Controls) {
        let speaking = if speaking.is_finite() {
            speaking.clamp(0.0, 1.0)
        } else {
            0.0
        };
        let head = sway::at(&self.noise, ticks, speaking);
        let glance = gaze::at(&self.noise, ticks, speaking);
        let blink = blink::at(&self.noise, ticks, speaking);
        // Who looks down lowers the lids with the eyes.
        let lid = blink.max((-glance.pitch * LID_PER_GAZE_RAD).clamp(0.0, 0.4));
        for side in [Control::LidL, Control::LidR] {
            // Eyes that are wide open (below 0) blink from there.
            let wide = controls[side].min(0.0);
            controls[side] = controls[side].max(wide + (1.0 - wide) * lid);
        }
        controls[Control::HeadYaw] += head.yaw;
        controls[Control::HeadPitch] += head.pitch;
        controls[Control::HeadRoll] += head.roll;
        // The eyes stay on the viewer while the head moves (the vestibulo-ocular reflex).
        controls[Control::GazeYaw] += glance.yaw - head.yaw;
        controls[Control::GazePitch] += glance.pitch - head.pitch;
        *controls = controls.clamped();
    }
}

/// How far the lids go down per radian of gaze (judgement).
const LID_PER_GAZE_RAD: f32 = 0.9;

/// Milliseconds as ticks.
const fn ms(ms: i64) -> i64 {
    ms * TICK_RATE / 1000
}

#[cfg(test)]
mod tests;
