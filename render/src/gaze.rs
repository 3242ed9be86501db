//! What the eyes do that nobody steers: both turn to one point of gaze, and the pupils answer light and
//! mood (HABER 4.1 gives its eyes a viewing direction and a size of the pupil). For `frame`.
//!
//! It has no memory: a picture depends on its key frame alone, so the fifth of a second that a pupil takes to
//! answer is not in it. Where the eyes look is the rig's and speech's business.

use glam::{Affine3A, Quat, Vec3};
use mouthpiece_rig::{Body, Control, Controls, Head, TICK_RATE};

/// How far from the eyes the point of gaze lies, mm: who stands before a screen.
const GAZE_MM: f32 = 900.0;
/// An eye sees along a line that lies this far to the nose's side of the pupil's axis, radians: 2.8 degrees, the mean of
/// adults (Basmak et al., 2007). Without it, eyes that meet on a near point look crossed.
const SIGHT_RAD: f32 = 0.049;
/// Luminance of a white card in the lamps' full light, cd/m2: a studio's modelling lamps are dim.
const WHITE_NITS: f32 = 4.5;
/// Width of the iris, mm: what the pupil's width is measured against.
const IRIS_MM: f32 = 11.6;
/// How much wider the most excited look makes the pupil, mm.
const MOOD_MM: f32 = 0.7;
/// Half the travel of the pupil's slow unrest, mm.
const HIPPUS_MM: f32 = 0.10;
/// Periods of that unrest, ticks: it never quite repeats, and each is counted apart in integers.
const HIPPUS_TICKS: [i64; 2] = [TICK_RATE * 31 / 10, TICK_RATE * 83 / 10];

/// Turns each eye about its centre from the common direction of `state` to the one point of gaze.
pub(crate) fn converge(head: &Head, bodies: &mut [Affine3A; Body::COUNT]) {
    let skull = bodies[Body::Skull as usize];
    let middle = (head.eyes[0].centre + head.eyes[1].centre) * 0.5;
    // The two bodies are turned alike as they come from the rig: either tells the direction.
    let ahead = bodies[Body::EyeL as usize].transform_vector3(Vec3::Z);
    let point = skull.transform_point3(middle) + ahead.normalize_or(Vec3::Z) * GAZE_MM;
    for (eye, body) in head.eyes.iter().zip([Body::EyeL, Body::EyeR]) {
        let pose = &mut bodies[body as usize];
        let centre = skull.transform_point3(eye.centre);
        // Across the nose is -X in the left eye, +X in the right one.
        let nasal = if body == Body::EyeL { -1.0 } else { 1.0 };
        let sight = pose.transform_vector3(line_of_sight(nasal));
        let wanted = (point - centre).normalize_or(sight);
        let turn = Quat::from_rotation_arc(sight.normalize_or(wanted), wanted);
        if turn.is_finite() {
            let about = Affine3A::from_translation(centre)
                * Affine3A::from_quat(turn)
                * Affine3A::from_translation(-centre);
            *pose = about * *pose;
        }
    }
}

/// The direction an eye sees along, in its own axes.
fn line_of_sight(nasal: f32) -> Vec3 {
    Vec3::new(nasal * SIGHT_RAD.sin(), 0.0, SIGHT_RAD.cos())
}

/// Radius of the pupil in iris radii. `light`: what a white card before the eyes would return.
pub(crate) fn pupil(light: f32, state: &Controls, time: i64) -> f32 {
    // Moon and Spencer, 1944: width of the pupil in a field of that luminance.
    let nits = (light * WHITE_NITS).max(1e-3);
    let mut wide_mm = 4.9 - 3.0 * (0.4 * nits.log10()).tanh();
    wide_mm += MOOD_MM * arousal(state) + HIPPUS_MM * unrest(time);
    (wide_mm / IRIS_MM).clamp(0.15, 0.70)
}

/// How excited the face looks, 0..1, read off the muscles that fear, surprise, anger and joy share.
fn arousal(state: &Controls) -> f32 {
    let lids = (state[Control::LidL] + state[Control::LidR]).min(0.0) * -0.5 / 0.4;
    let brows = 0.35 * state[Control::FrontalisInner]
        + 0.35 * state[Control::FrontalisOuter]
        + 0.30 * state[Control::CorrugatorSupercilii];
    let joy = 0.35 * state[Control::ZygomaticusMajor];
    let sum = 0.6 * lids + brows + joy;
    if sum.is_finite() {
        sum.clamp(0.0, 1.0)
    } else {
        0.0
    }
}

/// -1..1, 0 at time 0.
fn unrest(time: i64) -> f32 {
    let wave = |period: i64| {
        (time.rem_euclid(period) as f32 / period as f32 * std::f32::consts::TAU).sin()
    };
    0.6 * wave(HIPPUS_TICKS[0]) + 0.4 * wave(HIPPUS_TICKS[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_eyes_see_the_same_point_wherever_they_look() {
        let head = Head::reference().unwrap();
        let mut state = Controls::default();
        for (yaw, pitch, head_yaw) in [(0.0, 0.0, 0.0), (0.4, 0.0, 0.3), (-0.3, 0.25, -0.5)] {
            state[Control::GazeYaw] = yaw;
            state[Control::GazePitch] = pitch;
            state[Control::HeadYaw] = head_yaw;
            let mut bodies = head.bodies(&state);
            let parallel = bodies[Body::EyeL as usize].transform_vector3(Vec3::Z);
            converge(&head, &mut bodies);
            let ray = |side: usize, body: Body, nasal: f32| {
                let pose = bodies[body as usize];
                let from = pose.transform_point3(head.eyes[side].centre);
                (from, pose.transform_vector3(line_of_sight(nasal)))
            };
            let (left, right) = (ray(0, Body::EyeL, -1.0), ray(1, Body::EyeR, 1.0));
            // The point that was meant, from each eye.
            let middle = (left.0 + right.0) * 0.5;
            let point = middle + parallel * GAZE_MM;
            for (from, sight) in [left, right] {
                let off = (point - from).angle_between(sight);
                assert!(off < 1e-3, "{off} rad past it at {yaw}, {pitch}");
            }
            assert!(left.1.angle_between(right.1) > 0.05, "they are parallel");
        }
    }

    #[test]
    fn the_pupil_answers_light_and_mood_and_is_never_quite_still() {
        let calm = Controls::default();
        let mut fear = calm;
        fear[Control::LidL] = -0.3;
        fear[Control::LidR] = -0.3;
        fear[Control::FrontalisInner] = 0.8;
        let (dark, lit, glaring) = (
            pupil(0.05, &calm, 0),
            pupil(2.0, &calm, 0),
            pupil(60.0, &calm, 0),
        );
        assert!(dark > lit + 0.05 && lit > glaring + 0.05);
        assert!((0.28..0.42).contains(&lit), "{lit} in the studio");
        assert!(pupil(2.0, &fear, 0) > lit + 0.03);
        let mut last = lit;
        let (mut low, mut high) = (lit, lit);
        for tick in (0..TICK_RATE * 60).step_by(TICK_RATE as usize / 60) {
            let now = pupil(2.0, &calm, tick);
            assert!((now - last).abs() < 1e-3, "it jumps at {tick}");
            (low, high, last) = (low.min(now), high.max(now), now);
        }
        assert!((0.008..0.02).contains(&(high - low)), "{}", high - low);
    }
}
