//! Blinks: 17 a minute at rest, 26 in conversation (Bentivoglio et al. 1997), down in about 90 ms and
//! up in about 240 (VanderWerf et al. 2003). Those of a talking face that go with phrases' ends are
//! [`super::gesture`]'s; here are the others, which do not know of phrases.

use super::manner::Manner;
use super::ms;
use super::noise::{Events, Noise, Purpose};
use crate::contact::ease;

/// The most that any state has, a minute.
const RATE: f32 = 26.0;
/// Idle, listening, thinking, speaking, a minute: at rest and in conversation as published; who speaks gets
/// the rest from phrases' ends. Listening and thinking are a judgement between.
const RATES: [f32; 4] = [17.0, 20.0, 24.0, 17.0];
const DOWN: i64 = ms(90);
const UP: i64 = ms(240);

/// The intervals' spread is a judgement; published is that rates over people are log-normal.
const BLINKS: Events = Events {
    purpose: Purpose::BlinkInterval,
    mean_s: 60.0 / RATE,
    sigma: 0.6,
    least_s: 0.5,
};

/// Closing of the lids, 0..1. Each state leaves out some of the same blinks, so that the others stay where
/// they are when it changes.
pub(super) fn at(noise: &Noise, ticks: i64, manner: &Manner) -> f32 {
    let kept = manner.mean(RATES) / RATE;
    let mut lid = 0.0_f32;
    BLINKS.begun(noise, ticks, |number, since| {
        if since < DOWN + UP {
            lid = lid.max(closing(since) * shown(noise, Purpose::BlinkKeep, number, kept));
        }
    });
    lid
}

/// Closing of the lids `since` ticks after a blink began.
pub(super) fn closing(since: i64) -> f32 {
    let down = ease(since as f32 / DOWN as f32);
    down - ease(since.saturating_sub(DOWN) as f32 / UP as f32)
}

/// 1 for the share `kept` of all events, 0 for the others, and a little between, so that an event under
/// way does not vanish at once when `kept` changes.
pub(super) fn shown(noise: &Noise, purpose: Purpose, number: i64, kept: f32) -> f32 {
    ((kept - noise.uniform(purpose, number)) / 0.04 + 1.0).clamp(0.0, 1.0)
}
