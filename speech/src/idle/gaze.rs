//! Where the eyes look: mostly at the viewer, with small shifts over the viewer's face, and away from it
//! for a moment now and then (Lee, Badler and Badler 2002, "Eyes alive", as digested).

use super::blink::shown;
use super::manner::{Manner, State};
use super::ms;
use super::noise::{Events, Noise, Purpose};
use crate::contact::ease;

/// A direction, radians, up and to the subject's left.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Gaze {
    pub(super) yaw: f32,
    pub(super) pitch: f32,
}

/// Mutual gaze and gaze away while talking, seconds; the same while listening, seconds.
const TALKING: (f32, f32) = (3.1, 0.93);
const LISTENING: (f32, f32) = (7.9, 0.43);
/// The same of a face with nobody to talk to (judgement: it keeps an eye on who may come), and while
/// thinking, when the eyes are away for long as it is.
const IDLE: (f32, f32) = (6.2, 0.6);
const THINKING: (f32, f32) = (9.0, 0.43);
const STATES: [(f32, f32); 4] = [IDLE, LISTENING, THINKING, TALKING];

const GLANCES: Events = Events {
    purpose: Purpose::GlanceInterval,
    mean_s: TALKING.0 + TALKING.1,
    sigma: 0.5,
    least_s: 1.6,
};

/// Longest glance, so that the eyes are back before the next.
const GLANCE_MAX: i64 = ms(1400);

/// Share of glances up, left … in steps of 45 degrees from the subject's right, percent.
const DIRECTIONS: [f32; 8] = [15.54, 6.46, 17.69, 7.44, 16.80, 7.89, 20.38, 7.79];

/// Up and down the eyes go less far than aside, or the lids would hide them (judgement).
const VERTICAL: f32 = 0.6;

/// Length of a fixation on a part of the viewer's face, and how far these are apart, radians (judgement:
/// eyes and mouth of someone a metre away).
const FIXATION: i64 = ms(900);
const FIXATION_RAD: f32 = 0.012;

/// Where the eyes look relative to the viewer.
pub(super) fn at(noise: &Noise, ticks: i64, manner: &Manner) -> Gaze {
    let mut gaze = fixation(noise, ticks);
    let kept = manner.mean(STATES.map(|s| (TALKING.0 + TALKING.1) / (s.0 + s.1)));
    let away_s = manner.mean(STATES.map(|s| s.1));
    let speaking = manner.of(State::Speaking);
    GLANCES.begun(noise, ticks, |number, since| {
        if since < GLANCE_MAX + ms(120) {
            let spread = 0.5 + noise.uniform(Purpose::GlanceLength, number);
            let length = ms((away_s * spread * 1000.0) as i64).min(GLANCE_MAX);
            let size = degrees(noise, number, speaking);
            let duration = saccade(size) as f32;
            let out = ease(since as f32 / duration);
            let back = ease((since - length) as f32 / duration);
            let shown = shown(noise, Purpose::GlanceKeep, number, kept);
            let reach = size.to_radians() * (out - back).max(0.0) * shown;
            let angle = direction(noise.uniform(Purpose::GlanceDirection, number));
            gaze.yaw -= reach * angle.cos();
            gaze.pitch += reach * angle.sin() * VERTICAL;
        }
    });
    let thinking = manner.of(State::Thinking);
    if thinking > 0.0 {
        let thought = thought(noise, ticks);
        gaze.yaw += thought.yaw * thinking;
        gaze.pitch += thought.pitch * thinking;
    }
    gaze
}

/// One look away per cell of this length while thinking.
const THOUGHT: i64 = ms(3100);
/// Up and aside, degrees (judgement; that people look away to think is well known, Glenberg et al. 1998).
const THOUGHT_ASIDE: (f32, f32) = (6.0, 14.0);
const THOUGHT_UP: (f32, f32) = (-1.0, 10.0);

/// Where a thinking face looks: away for most of each cell, then back for a moment.
fn thought(noise: &Noise, ticks: i64) -> Gaze {
    let cell = ticks.div_euclid(THOUGHT);
    let since = ticks.rem_euclid(THOUGHT);
    let uniform = |purpose| noise.uniform(purpose, cell);
    let length = ms(1700) + (uniform(Purpose::ThoughtLength) * ms(1100) as f32) as i64;
    let mix = |range: (f32, f32), share: f32| (range.0 + (range.1 - range.0) * share).to_radians();
    let side = uniform(Purpose::ThoughtSide);
    let sign = if side < 0.5 { -1.0 } else { 1.0 };
    let yaw = sign * mix(THOUGHT_ASIDE, (side * 2.0).fract());
    let pitch = mix(THOUGHT_UP, uniform(Purpose::ThoughtHeight));
    let duration = saccade(yaw.hypot(pitch).to_degrees());
    let away =
        ease(since as f32 / duration as f32) - ease((since - length) as f32 / duration as f32);
    Gaze {
        yaw: yaw * away,
        pitch: pitch * away,
    }
}

/// Size of a glance, degrees: falls off exponentially.
fn degrees(noise: &Noise, number: i64, speaking: f32) -> f32 {
    let percent = 15.0 * (1.0 - noise.uniform(Purpose::GlanceAmplitude, number));
    let cap = 22.7 + (27.5 - 22.7) * speaking;
    (-6.9 * (percent / 15.7).ln()).clamp(0.0, cap)
}

/// How long the eyes take, ticks: 25 ms and 2.4 ms a degree (Becker).
fn saccade(degrees: f32) -> i64 {
    ms(25) + (ms(1) as f32 * 2.4 * degrees) as i64
}

/// One of eight directions for a number from 0 to 1, radians from the subject's right towards up.
fn direction(number: f32) -> f32 {
    let mut left = number * DIRECTIONS.iter().sum::<f32>();
    for (i, share) in DIRECTIONS.iter().enumerate() {
        if left < *share {
            return i as f32 * std::f32::consts::FRAC_PI_4;
        }
        left -= share;
    }
    0.0
}

/// The spot on the viewer's face: one per cell of time, begun at a random part of the cell's first half.
fn fixation(noise: &Noise, ticks: i64) -> Gaze {
    let cell = ticks.div_euclid(FIXATION);
    let onset = noise.uniform(Purpose::FixationOnset, cell) * 0.5 * FIXATION as f32;
    let since = ticks.rem_euclid(FIXATION) - onset as i64;
    let moved = ease(since as f32 / saccade(1.0) as f32);
    let spot = |purpose, cell| (noise.uniform(purpose, cell) * 2.0 - 1.0) * FIXATION_RAD;
    let between = |purpose| {
        let from = spot(purpose, cell.wrapping_sub(1));
        from + (spot(purpose, cell) - from) * moved
    };
    Gaze {
        yaw: between(Purpose::FixationYaw),
        pitch: between(Purpose::FixationPitch),
    }
}
