//! The mandible: where it is for an angle, and how it gets there (HABER 4.1).
//!
//! It turns about the axis through the condyles, and the condyles slide forward and a little down
//! their slopes as it turns. Its muscles pull as strongly as they can and no more, so that it has
//! inertia; the teeth and the joint's ligaments stop it without rebound. Chewing's sideways grinding is
//! not here.

use glam::{Affine3A, Quat, Vec3, vec3};

use crate::Control;
use crate::follow::Follow;
use crate::head::about;

/// How far the condyles slide forward as the jaw opens (order of size from Vatikiotis-Bateson and
/// Ostry: translation is linear in rotation; the figure itself is a judgement).
const SLIDE_MM_PER_RAD: f32 = 14.0;
/// Which way: along the front slope of the joint's socket.
const SLIDE: Vec3 = vec3(0.0, -0.3, 1.0);
/// How fast it comes to where it is wanted when its muscles are strong enough (critically damped), 1/s.
const RATE: f32 = 115.0;
/// What its muscles can do to it, rad/s². Papers and tables give no figure for speech; a mandible with the flesh on it
/// has about 0.3 kg some 80 mm from the axis, 0.002 kg m², and 1.2 N m is a twentieth of a hard bite. From
/// this follow 38 ms for nine tenths of a wide vowel's opening or closing (0.2 rad; 31 ms without a bound), where a
/// speaker takes 100.
const ACCELERATION_MAX: f32 = 600.0;

/// The mandible in the skull's frame, for an axis through `condyle`. Beyond its limits it stays at them,
/// so that it slides by 6.3 mm at most.
pub(crate) fn pose(condyle: Vec3, jaw_rad: f32) -> Affine3A {
    let (shut, open) = Control::Jaw.range();
    let angle = jaw_rad.clamp(shut, open);
    Affine3A::from_translation(SLIDE * (angle * SLIDE_MM_PER_RAD))
        * about(condyle, Quat::from_rotation_x(angle))
}

/// Angle and speed, rad and rad/s, a step later.
pub(crate) fn step(angle: f32, speed: f32, wanted: f32, step_s: f32) -> (f32, f32) {
    let (free, free_speed) = Follow::new(RATE, step_s).step(angle, speed, wanted);
    let most = ACCELERATION_MAX * step_s;
    let (angle, speed) = if (free_speed - speed).abs() <= most {
        (free, free_speed)
    } else {
        // More than its muscles can do.
        let speed = speed + (free_speed - speed).clamp(-most, most);
        (angle + speed * step_s, speed)
    };
    // Teeth on teeth, ligaments taut: stopped at once.
    let (shut, open) = Control::Jaw.range();
    if angle < shut {
        (shut, 0.0)
    } else if angle > open {
        (open, 0.0)
    } else {
        (angle, speed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::STEP_S;

    /// Angles, one a step, on the way from one place to another.
    fn way(from: f32, to: f32, steps: usize) -> Vec<f32> {
        let mut now = (from, 0.0);
        let mut go = || {
            now = step(now.0, now.1, to, STEP_S);
            now.0
        };
        (0..steps).map(|_| go()).collect()
    }

    #[test]
    fn teeth_that_meet_stop_it_without_rebound() {
        // From far open and shut with all force: it arrives, never passes 0, and stays.
        for from in [0.02, 0.1, 0.22, 0.45] {
            let way = way(from, 0.0, 200);
            assert!(way.iter().all(|x| *x >= 0.0), "{from}");
            let met = way.iter().position(|x| *x < 1e-3);
            let met = met.unwrap_or(way.len());
            assert!(met < 48, "from {from} within 100 ms, not {met} steps");
            assert!(way[met..].iter().all(|x| *x <= 1e-3), "{from}");
        }
        // Flung shut: what arrives with 5 rad/s stands still on the tooth.
        assert_eq!(step(0.005, -5.0, 0.1, STEP_S), (0.0, 0.0));
        assert_eq!(step(0.449, 5.0, 0.3, STEP_S), (0.45, 0.0));
    }

    #[test]
    fn it_arrives_without_overshoot_and_with_bounded_force() {
        for (from, to) in [(0.0_f32, 0.22_f32), (0.22, 0.05), (0.0, 0.45), (0.1, 0.12)] {
            let way = way(from, to, 300);
            let span = (to - from).abs();
            let past = way.iter().map(|x| (x - to) * (to - from).signum());
            let past = past.fold(f32::MIN, f32::max);
            assert!(past < 0.01 * span, "{from} to {to}: {past} beyond");
            assert!((way[299] - to).abs() < 1e-4);
            let speeds: Vec<f32> = way.windows(2).map(|w| (w[1] - w[0]) / STEP_S).collect();
            for w in speeds.windows(2) {
                assert!((w[1] - w[0]).abs() / STEP_S <= ACCELERATION_MAX * 1.01);
            }
        }
    }

    #[test]
    fn it_stays_within_its_limits() {
        let condyle = vec3(0.0, 13.0, 25.0);
        let slid = |angle| pose(condyle, angle).transform_point3(condyle) - condyle;
        assert_eq!(slid(0.0), Vec3::ZERO);
        assert_eq!(slid(-1.0), Vec3::ZERO);
        assert_eq!(slid(2.0), slid(0.45));
        assert!((slid(0.45).z - 6.3).abs() < 1e-3 && slid(0.45).y < 0.0);
        // Linear in between, as measured in speakers.
        assert!((slid(0.2) - slid(0.1) * 2.0).length() < 1e-4);
    }
}
