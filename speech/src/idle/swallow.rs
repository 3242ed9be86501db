//! Swallowing: the lips press, the jaw closes, the tongue goes to the palate, the head dips. About once a
//! minute at rest (people swallow spontaneously 0.5 to 1.5 times a minute; recalled), and in long pauses.

use mouthpiece_rig::{Control, Controls};

use super::ms;
use super::noise::{Events, Noise, Purpose};
use crate::contact::ease;

const SWALLOWS: Events = Events {
    purpose: Purpose::SwallowInterval,
    mean_s: 55.0,
    sigma: 0.4,
    least_s: 12.0,
};

const PRESS: i64 = ms(220);
const HELD: i64 = ms(260);
const RELEASE: i64 = ms(380);

/// What is pressed, how far at most (judgement).
const PRESSED: [(Control, f32); 5] = [
    (Control::OrbicularisOrisSuperior, 0.22),
    (Control::OrbicularisOrisInferior, 0.22),
    (Control::Mentalis, 0.12),
    (Control::TongueTip, 0.9),
    (Control::TongueBody, 0.8),
];

/// Those at rest, `share` of them.
pub(super) fn at_rest(noise: &Noise, ticks: i64, share: f32, controls: &mut Controls) {
    if share > 0.0 {
        SWALLOWS.begun(noise, ticks, |_, since| add(since, share, controls));
    }
}

/// One that began `since` ticks ago.
pub(super) fn add(since: i64, share: f32, controls: &mut Controls) {
    if !(0..PRESS + HELD + RELEASE).contains(&since) {
        return;
    }
    let press = ease(since as f32 / PRESS as f32);
    let size = share * (press - ease((since - PRESS - HELD) as f32 / RELEASE as f32));
    for (control, most) in PRESSED {
        controls[control] += (most - controls[control]).max(0.0) * size;
    }
    controls[Control::Jaw] *= 1.0 - size;
    controls[Control::HeadPitch] -= 1.2_f32.to_radians() * size;
}
