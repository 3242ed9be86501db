//! Breathing at rest, about 14 a minute: the head rises a little with the chest, the nostrils widen. While
//! the face speaks, breath follows the phrases instead ([`super::gesture`]).
//!
//! Heads have no chest; its rise is shown by what it does to the head. Sizes are a judgement; 12 to 20
//! breaths a minute at rest is textbook physiology.

use super::ms;
use super::noise::{Events, Noise, Purpose};
use crate::contact::ease;

const BREATHS: Events = Events {
    purpose: Purpose::BreathInterval,
    mean_s: 4.3,
    sigma: 0.12,
    least_s: 3.2,
};

const IN: i64 = ms(1500);
const HELD: i64 = ms(150);
const OUT: i64 = ms(2300);

/// What breath does to a face.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Breath {
    /// Air in the chest, 0 to about 1.
    pub(super) chest: f32,
    /// Air going in, 0 to 1.
    pub(super) intake: f32,
}

pub(super) fn at(noise: &Noise, ticks: i64) -> Breath {
    let mut breath = Breath::default();
    BREATHS.begun(noise, ticks, |number, since| {
        if since < IN + HELD + OUT {
            let depth = 0.7 + 0.5 * noise.uniform(Purpose::BreathDepth, number);
            let drawn = ease(since as f32 / IN as f32);
            let let_out = ease((since - IN - HELD) as f32 / OUT as f32);
            breath.chest += depth * (drawn - let_out);
            let swell = since as f32 / IN as f32;
            breath.intake = breath.intake.max(depth * bump(swell));
        }
    });
    breath
}

/// 0 at 0 and 1, 1 between, with no corner.
pub(super) fn bump(share: f32) -> f32 {
    if (0.0..1.0).contains(&share) {
        let s = (std::f32::consts::PI * share).sin();
        s * s
    } else {
        0.0
    }
}
