//! Which muscles wrinkle which skin: each vertex's share of the zones of wrinkles, and how far each zone is
//! wrinkled for given controls, left and right apart. Zones go by place on the face; HEADSHOP leaves the choice of
//! muscles open, it is anatomy's (a wrinkle runs square to the muscle that makes it).

use glam::{Vec3, vec3};
use mouthpiece_rig::{Control, Controls, Muscle};

use super::landmarks::Landmarks;
use super::ramp;

/// A place's shares of the four zones of one layer.
pub(crate) type Zones = [f32; 4];

/// Shares of inner forehead, outer forehead, smile, chin; and of frown, crow's feet, nose, lips' rays.
pub(crate) fn zones_at(p: Vec3, m: &Landmarks) -> [Zones; 2] {
    let s = m.scale;
    let side = vec3(p.x.abs(), p.y, p.z);
    // Flat in the middle.
    let blot = |centre: Vec3, radius: Vec3| {
        let off = (side - centre) / (radius * s);
        (2.2 * (-off.length_squared()).exp()).min(1.0)
    };
    // Deep shadows of the chart (the back of the head lies under the same longitudes never).
    let front = ramp(m.eye.z - 62.0 * s, m.eye.z - 40.0 * s, p.z);
    let brow = ramp(m.eye.y + 13.0 * s, m.eye.y + 25.0 * s, p.y) * front;
    let outer = ramp(10.0 * s, 27.0 * s, side.x);
    let smile = blot(
        vec3(26.0 * s, m.mouth.y + 13.0 * s, m.mouth.z - 14.0),
        vec3(21.0, 30.0, 40.0),
    ) * ramp(8.0 * s, 15.0 * s, side.x);
    let chin = blot(
        vec3(0.0, m.mouth.y - 27.0 * s, m.mouth.z - 8.0),
        vec3(24.0, 19.0, 34.0),
    ) * ramp(m.mouth.y - 5.0 * s, m.mouth.y - 13.0 * s, p.y);
    let frown = blot(
        vec3(0.0, m.eye.y + 25.0 * s, m.nose.z - 15.0),
        vec3(17.0, 22.0, 34.0),
    );
    let crow = blot(
        vec3(m.eye.x + 13.0 * s, m.eye.y - 5.0 * s, m.eye.z - 4.0),
        vec3(27.0, 19.0, 46.0),
    );
    let nose = blot(
        vec3(0.0, m.eye.y + (m.nose.y - m.eye.y) * 0.30, m.nose.z - 16.0),
        vec3(17.0, 17.0, 34.0),
    );
    let rays = blot(m.mouth, vec3(27.0, 19.0, 34.0));
    [
        [brow * (1.0 - outer), brow * outer, smile, chin],
        [frown, crow * (1.0 - frown), nose * (1.0 - frown), rays],
    ]
}

/// How far the zones are wrinkled, 0..1: the first layer's on the left and right, the second's.
pub(crate) fn wrinkled(controls: &Controls) -> [Zones; 4] {
    let left = sided(controls, true);
    let right = sided(controls, false);
    [left[0], right[0], left[1], right[1]]
}

/// Wrinkles that a face keeps at rest, in a young one little.
const AT_REST: [Zones; 2] = [[0.05, 0.04, 0.14, 0.10], [0.06, 0.06, 0.03, 0.05]];

fn sided(controls: &Controls, left: bool) -> [Zones; 2] {
    let pull = |muscle: Muscle| controls.contraction(muscle, left);
    let lid = controls[if left { Control::LidL } else { Control::LidR }].clamp(0.0, 1.0);
    let pursed =
        0.5 * (pull(Muscle::OrbicularisOrisSuperior) + pull(Muscle::OrbicularisOrisInferior));
    let smiling = 0.75 * pull(Muscle::ZygomaticusMajor)
        + 0.40 * pull(Muscle::ZygomaticusMinor)
        + 0.45 * pull(Muscle::LevatorLabiiSuperioris)
        + 0.40 * pull(Muscle::LevatorLabiiSuperiorisAlaequeNasi)
        + 0.35 * pull(Muscle::LevatorAnguliOris)
        + 0.30 * pull(Muscle::Risorius)
        + 0.20 * pull(Muscle::Buccinator);
    let raised = [
        0.92 * pull(Muscle::FrontalisInner) + 0.15 * pull(Muscle::FrontalisOuter),
        0.92 * pull(Muscle::FrontalisOuter) + 0.15 * pull(Muscle::FrontalisInner),
        smiling,
        0.85 * pull(Muscle::Mentalis) + 0.35 * pull(Muscle::DepressorAnguliOris) + 0.10 * pursed,
    ];
    let drawn = [
        0.95 * pull(Muscle::CorrugatorSupercilii)
            + 0.30 * pull(Muscle::DepressorSupercilii)
            + 0.25 * pull(Muscle::Procerus),
        0.95 * pull(Muscle::OrbicularisOculiOrbital)
            + 0.35 * pull(Muscle::OrbicularisOculiPalpebral)
            + 0.30 * pull(Muscle::ZygomaticusMajor)
            + 0.04 * lid,
        0.70 * pull(Muscle::LevatorLabiiSuperiorisAlaequeNasi)
            + 0.60 * pull(Muscle::Nasalis)
            + 0.80 * pull(Muscle::Procerus),
        0.80 * pursed,
    ];
    let rested = |pull: Zones, rest: Zones| -> Zones {
        // What is not finite is no wrinkle.
        std::array::from_fn(|i| {
            let pull = if pull[i].is_finite() { pull[i] } else { 0.0 };
            (rest[i] + (1.0 - rest[i]) * pull).clamp(0.0, 1.0)
        })
    };
    [rested(raised, AT_REST[0]), rested(drawn, AT_REST[1])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_muscle_wrinkles_its_zone_on_its_side_and_no_other() {
        let rest = wrinkled(&Controls::default());
        let mut controls = Controls::default();
        controls[Control::FrontalisOuter] = 0.5;
        controls[Control::FrontalisOuterSide] = 0.5;
        let now = wrinkled(&controls);
        assert!(now[0][1] > 0.8, "the left brow's lines: {now:?}");
        assert_eq!(now[1], rest[1], "the right side is at rest");
        assert_eq!(now[2..], rest[2..], "no frown");
        controls = Controls::default();
        controls[Control::CorrugatorSupercilii] = 1.0;
        let now = wrinkled(&controls);
        assert!(now[2][0] > 0.9 && now[3][0] > 0.9, "{now:?}");
        assert_eq!(now[..2], rest[..2]);
    }

    #[test]
    fn controls_that_are_no_numbers_wrinkle_nothing() {
        let mut controls = Controls::default();
        controls[Control::FrontalisInner] = f32::NAN;
        assert!(
            wrinkled(&controls)
                .as_flattened()
                .iter()
                .all(|w| w.is_finite())
        );
    }
}
