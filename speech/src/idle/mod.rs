//! A face that is alive between the words (HABER 5.4): blinks as peaks at randomised intervals, small
//! head movement as sines of different period and randomised amplitude; and, beyond the paper, eyes that
//! mostly look at the viewer and glance away now and then, breath, swallowing, and what goes with speech:
//! nods, brows, blinks at phrases' ends.
//!
//! | module | does |
//! |---|---|
//! | [`manner`] | idle, listening, thinking, speaking, and the way between |
//! | [`blink`], [`gaze`], [`sway`], [`breath`], [`swallow`], [`listen`] | what goes on by itself |
//! | [`gesture`] | what goes with an utterance |
//! | [`noise`] | numbers and events by seed |
//!
//! Everything is a function of the seed, the tick and the utterance, with nothing carried from one call
//! to the next: an export repeats, a rewind finds what was there, and any tick may be asked for first.

mod blink;
mod breath;
mod gaze;
mod gesture;
mod listen;
mod manner;
mod noise;
mod swallow;
mod sway;

use mouthpiece_phonemes::TICK_RATE;
use mouthpiece_rig::{Control, Controls};

use crate::track::Track;
pub use manner::{Manner, State, States};
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

    /// Adds what lids, eyes, head and breath do by themselves at `ticks` to `controls`. `manner` should not
    /// jump ([`States`] and [`Track::speaking_at`] do not).
    pub fn add(&self, ticks: i64, manner: &Manner, controls: &mut Controls) {
        let noise = &self.noise;
        let head = sway::at(noise, ticks, manner);
        let glance = gaze::at(noise, ticks, manner);
        let blink = blink::at(noise, ticks, manner);
        let silent = 1.0 - manner.of(State::Speaking);
        let breath = breath::at(noise, ticks);
        let nod = listen::at(noise, ticks) * manner.of(State::Listening);
        swallow::at_rest(noise, ticks, silent * silent, controls);
        controls[Control::DilatorNaris] += 0.12 * breath.intake * silent;
        for control in [Control::FrontalisInner, Control::FrontalisOuter] {
            controls[control] += listen::brows(noise, ticks) * silent;
        }
        // Who thinks frowns a little.
        controls[Control::CorrugatorSupercilii] += 0.12 * manner.of(State::Thinking);
        // Who looks down lowers the lids with the eyes.
        let lid = blink.max((-glance.pitch * LID_PER_GAZE_RAD).clamp(0.0, 0.4));
        lower_lids(lid, controls);
        let pitch = head.pitch + BREATH_RAD * breath.chest * silent - nod;
        controls[Control::HeadYaw] += head.yaw;
        controls[Control::HeadPitch] += pitch;
        controls[Control::HeadRoll] += head.roll;
        // The eyes stay on the viewer while the head moves (the vestibulo-ocular reflex).
        controls[Control::GazeYaw] += glance.yaw - head.yaw;
        controls[Control::GazePitch] += glance.pitch - pitch;
        *controls = controls.clamped();
    }

    /// Adds what goes with an utterance at `ticks` of its own time, `share` of it.
    pub fn accompany(&self, track: &Track, ticks: i64, share: f32, controls: &mut Controls) {
        if share > 0.0 {
            gesture::add(&self.noise, track, ticks, share.min(1.0), controls);
            *controls = controls.clamped();
        }
    }
}

/// How far the lids go down per radian of gaze (judgement).
const LID_PER_GAZE_RAD: f32 = 0.9;
/// How far the head rises with a breath: 0.35 degrees (judgement: seen, not noticed).
const BREATH_RAD: f32 = 0.0061;

/// Lowers both lids by at least `lid`; eyes that are wide open (below 0) blink from there.
fn lower_lids(lid: f32, controls: &mut Controls) {
    for side in [Control::LidL, Control::LidR] {
        let wide = controls[side].min(0.0);
        controls[side] = controls[side].max(wide + (1.0 - wide) * lid);
    }
}

/// Milliseconds as ticks.
const fn ms(ms: i64) -> i64 {
    ms * TICK_RATE / 1000
}

#[cfg(test)]
mod tests;
