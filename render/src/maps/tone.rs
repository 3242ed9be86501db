//! The broad properties of skin by place on a face: where it is oily, rough, porous or thin.

use glam::{Vec3, vec3};

use super::landmarks::Landmarks;
use super::ramp;

/// Gloss, depth of the fine structure, how much pores show, translucence, lip; 0..1.
pub(super) type Tone = [f32; 5];

/// Skin of which nothing is known.
pub(super) const PLAIN: Tone = [0.30, 0.5, 0.1, 0.0, 0.0];

/// The tone of a place: where it lies and how red the lips are there.
pub(super) fn tone_at(p: Vec3, red: f32, m: &Landmarks) -> Tone {
    let s = m.scale;
    let side = vec3(p.x.abs(), p.y, p.z);
    // Ellipsoid blots, 1 in the middle.
    let blot =
        |centre: Vec3, radius: Vec3| (-((side - centre) / (radius * s)).length_squared()).exp();
    let drop = |below: f32| m.eye.y - below * (m.eye.y - m.mouth.y);
    let cheek = blot(
        vec3(m.eye.x * 1.22, drop(0.55), m.eye.z),
        vec3(19.0, 18.0, 40.0),
    );
    let tip = blot(m.nose, vec3(15.0, 13.0, 22.0));
    let wing = blot(
        vec3(15.0 * s, m.nose.y - 2.0 * s, m.nose.z - 20.0 * s),
        vec3(7.0, 8.0, 14.0),
    );
    let bridge = blot(
        vec3(0.0, drop(0.15), m.nose.z - 18.0 * s),
        vec3(8.0, 18.0, 22.0),
    );
    let forehead = ramp(m.eye.y + 22.0 * s, m.eye.y + 48.0 * s, p.y)
        * ramp(m.ear_x * 0.95, m.ear_x * 0.5, side.x);
    let bag = blot(
        vec3(m.eye.x - 2.0, m.eye.y - 15.0 * s, m.eye.z + 8.0),
        vec3(15.0, 5.0, 25.0),
    );
    let lid = blot(
        vec3(m.eye.x, m.eye.y + 9.0 * s, m.eye.z + 10.0),
        vec3(17.0, 6.5, 25.0),
    );
    let chin = blot(
        vec3(0.0, m.mouth.y - 30.0 * s, m.mouth.z - 6.0),
        vec3(14.0, 10.0, 20.0),
    );
    let ear = ramp(m.ear_x * 0.74, m.ear_x * 0.86, side.x)
        * ramp(m.eye.z - 48.0, m.eye.z - 58.0, p.z)
        * ramp(m.nose.y - 34.0 * s, m.nose.y - 18.0 * s, p.y)
        * ramp(m.eye.y + 12.0 * s, m.eye.y + 4.0 * s, p.y);
    let neck = ramp(m.mouth.y - 40.0 * s, m.mouth.y - 68.0 * s, p.y);

    let oil = 0.30 + 0.16 * forehead + 0.40 * tip + 0.16 * bridge + 0.14 * chin + 0.08 * lid
        - 0.16 * bag
        - 0.10 * ear
        - 0.14 * neck;
    let depth = 0.80 - 0.45 * lid - 0.25 * bag - 0.1 * ear + 0.15 * tip + 0.10 * cheek;
    let pores = 0.22
        + 0.85 * tip
        + 0.60 * wing
        + 0.55 * cheek
        + 0.25 * forehead
        + 0.35 * chin
        + 0.3 * bridge;
    let thin = (0.95 * ear + 0.5 * wing + 0.3 * tip + 0.25 * lid).min(1.0);
    let depth = depth * (1.0 - 0.85 * ramp(0.2, 0.6, red));
    [oil, depth, pores * (1.0 - ramp(0.1, 0.4, red)), thin, red]
}
