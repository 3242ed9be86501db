//! Blinks: 17 a minute at rest, 26 in conversation (Bentivoglio et al. 1997), down in about 90 ms and
//! up in about 240 (VanderWerf et al. 2003).

use super::ms;
use super::noise::{Events, Noise, Purpose};
use crate::contact::ease;

const RATE_TALKING: f32 = 26.0;
const RATE_REST: f32 = 17.0;
const DOWN: i64 = ms(90);
const UP: i64 = ms(240);

/// The intervals' spread is a judgement; published is that rates over people are log-normal.
const BLINKS: Events = Events {
    purpose: Purpose::BlinkInterval,
    mean_s: 60.0 / RATE_TALKING,
    sigma: 0.6,
    least_s: 0.5,
};

/// Closing of the lids, 0..1. A face at rest leaves out some of the blinks of one that talks, so that the
/// rest stay where they are when it begins to.
pub(super) fn at(noise: &Noise, ticks: i64, speaking: f32) -> f32 {
    let rest = RATE_REST / RATE_TALKING;
    let kept = rest + (1.0 - rest) * speaking;
    let mut lid = 0.0_f32;
    BLINKS.begun(noise, ticks, |number, since| {
        if since < DOWN + UP {
            let down = ease(since as f32 / DOWN as f32);
            let up = ease((since - DOWN) as f32 / UP as f32);
            lid = lid.max((down - up) * shown(noise, Purpose::BlinkKeep, number, kept));
        }
    });
    lid
}

/// 1 for the share `kept` of all events, 0 for the others, and a little between, so that an event under
/// way does not vanish at once when `kept` changes.
pub(super) fn shown(noise: &Noise, purpose: Purpose, number: i64, kept: f32) -> f32 {
    ((kept - noise.uniform(purpose, number)) / 0.04 + 1.0).clamp(0.0, 1.0)
}
