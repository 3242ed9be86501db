//! Small head movement: sines of different period, each cycle of another size (HABER 5.4).

use super::manner::Manner;
use super::ms;
use super::noise::{Noise, Purpose};
use crate::contact::ease;

/// Head angles, radians, as the controls of the same names.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sway {
    pub(super) yaw: f32,
    pub(super) pitch: f32,
    pub(super) roll: f32,
}

/// A sine: period in ticks, mean amplitude in degrees.
type Wave = (i64, f32);

/// Periods have no common measure, so that the pattern does not come back; amplitudes are a judgement (no
/// figure was found) that keeps a talking head within about 3 degrees.
const YAW: [Wave; 3] = [(ms(11_300), 1.0), (ms(6_170), 0.55), (ms(3_730), 0.3)];
const PITCH: [Wave; 3] = [(ms(9_410), 0.7), (ms(5_230), 0.45), (ms(2_890), 0.3)];
const ROLL: [Wave; 3] = [(ms(13_700), 0.5), (ms(7_930), 0.35), (ms(4_310), 0.2)];

/// How much of the movement there is when idle, listening, thinking and speaking (judgement: who listens
/// holds still).
const SIZES: [f32; 4] = [0.6, 0.45, 0.7, 1.0];

pub(super) fn at(noise: &Noise, ticks: i64, manner: &Manner) -> Sway {
    let size = manner.mean(SIZES);
    Sway {
        yaw: size * sum(noise, ticks, &YAW, 0),
        pitch: size * sum(noise, ticks, &PITCH, 1),
        roll: size * sum(noise, ticks, &ROLL, 2),
    }
}

/// The sum of an axis's waves, radians.
fn sum(noise: &Noise, ticks: i64, waves: &[Wave], axis: i64) -> f32 {
    let mut degrees = 0.0;
    for (i, &(period, amplitude)) in (axis * 16..).zip(waves) {
        let shift = (noise.uniform(Purpose::SwayPhase, i) * period as f32) as i64;
        let ticks = ticks.saturating_add(shift);
        let cycle = ticks.div_euclid(period);
        let share = ticks.rem_euclid(period) as f32 / period as f32;
        // Each cycle has a size of its own, and goes over to that of the next.
        let size = |cycle: i64| {
            let number = cycle.wrapping_mul(64).wrapping_add(i);
            0.4 + 1.2 * noise.uniform(Purpose::SwayAmplitude, number)
        };
        let here = size(cycle);
        let factor = here + (size(cycle.wrapping_add(1)) - here) * ease(share);
        degrees += amplitude * factor * (std::f32::consts::TAU * share).sin();
    }
    degrees.to_radians()
}
