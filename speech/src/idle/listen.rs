//! Small signs of attention: nods of who listens, brows that go up now and then in silence (38 % of brow
//! movements come while not speaking: Cave, Guaitella et al.). Rates and sizes are a judgement.

use super::breath::bump;
use super::ms;
use super::noise::{Events, Noise, Purpose};

const NODS: Events = Events {
    purpose: Purpose::BackchannelInterval,
    mean_s: 9.0,
    sigma: 0.5,
    least_s: 3.0,
};
/// Two dips.
const NOD: i64 = ms(380);

const BROWS: Events = Events {
    purpose: Purpose::RestBrowInterval,
    mean_s: 14.0,
    sigma: 0.6,
    least_s: 3.0,
};
const BROW: i64 = ms(520);

/// How far the head is down in a listener's nod, radians.
pub(super) fn at(noise: &Noise, ticks: i64) -> f32 {
    let mut down = 0.0;
    NODS.begun(noise, ticks, |number, since| {
        let size = 1.2 + 1.6 * noise.uniform(Purpose::BackchannelSize, number);
        let dips = bump(since as f32 / NOD as f32) + 0.55 * bump((since - NOD) as f32 / NOD as f32);
        down += size.to_radians() * dips;
    });
    down
}

/// Contraction of the frontalis at rest.
pub(super) fn brows(noise: &Noise, ticks: i64) -> f32 {
    let mut up = 0.0;
    BROWS.begun(noise, ticks, |number, since| {
        let size = 0.06 + 0.14 * noise.uniform(Purpose::RestBrowSize, number);
        up += size * bump(since as f32 / BROW as f32);
    });
    up
}
