//! ARKit's 52 blend shapes, and the angles of head and eyes that Live Link Face puts behind them.
//!
//! A shape is 0 at rest and 1 at its extreme. Jaw and lips go by what the simulated mesh does, so
//! that lips which touch there touch on the other avatar; what only a muscle can do goes by that
//! muscle. Left and right are the subject's. Cheeks are never puffed, and the tongue stays in.

use mouthpiece_rig::{Control, Controls, Muscle};

use super::face::{Face, PRESS_MM};

/// How many shapes there are.
pub const COUNT: usize = 52;

/// A shape's name and its value, before it is held within 0 and 1.
type Shape = (&'static str, fn(&Face<'_>) -> f32);

/// A row a shape, in Live Link Face's order; behind it what it is read off, its scale, and why.
const SHAPES: [Shape; COUNT] = [
    // Lid control (1: closed) and the orbicularis' palpebral part, which closes the same lids.
    ("EyeBlinkLeft", |f| f.blink(true)),
    // Gaze over its range, 0.45 rad up or down and 0.6 rad aside: as far as eyes go without the head.
    ("EyeLookDownLeft", |f| -f.look(Control::GazePitch)),
    // In is towards the nose: for the left eye to the subject's right.
    ("EyeLookInLeft", |f| -f.look(Control::GazeYaw)),
    ("EyeLookOutLeft", |f| f.look(Control::GazeYaw)),
    ("EyeLookUpLeft", |f| f.look(Control::GazePitch)),
    // The orbital part of the orbicularis oculi narrows the eye without closing it.
    ("EyeSquintLeft", |f| {
        f.belly(Muscle::OrbicularisOculiOrbital, true)
    }),
    // Lid control below 0, over its lowest (-0.4).
    ("EyeWideLeft", |f| f.wide(true)),
    ("EyeBlinkRight", |f| f.blink(false)),
    ("EyeLookDownRight", |f| -f.look(Control::GazePitch)),
    ("EyeLookInRight", |f| f.look(Control::GazeYaw)),
    ("EyeLookOutRight", |f| -f.look(Control::GazeYaw)),
    ("EyeLookUpRight", |f| f.look(Control::GazePitch)),
    ("EyeSquintRight", |f| {
        f.belly(Muscle::OrbicularisOculiOrbital, false)
    }),
    ("EyeWideRight", |f| f.wide(false)),
    // The jaw turns about one axis; the slide that goes with it is part of JawOpen there too.
    ("JawForward", |_| 0.0),
    ("JawRight", |_| 0.0),
    ("JawLeft", |_| 0.0),
    // Jaw angle as measured over 0.45 rad, the jaw's limit.
    ("JawOpen", |f| f.jaw_open()),
    // JawOpen times the share of the jaw's gap that the lips close; equals JawOpen where they touch.
    ("MouthClose", |f| f.close()),
    // Roundness (mean of narrowing over 25 % and protrusion over 4 mm) that is open: gap over 8 mm.
    ("MouthFunnel", |f| f.round() * f.open()),
    // The rest of the roundness: a pout is the same lips nearer to each other.
    ("MouthPucker", |f| f.round() * (1.0 - f.open())),
    // Difference of risorius and buccinator, left less right: they pull the corners to their side.
    ("MouthRight", |f| -f.sideways()),
    ("MouthLeft", |f| f.sideways()),
    // Zygomaticus major, and 0.3 of the minor, which raises more lip than corner.
    ("MouthSmileLeft", |f| f.smile(true)),
    ("MouthSmileRight", |f| f.smile(false)),
    // Depressor anguli oris: the only one that draws the corner down.
    ("MouthFrownLeft", |f| {
        f.belly(Muscle::DepressorAnguliOris, true)
    }),
    ("MouthFrownRight", |f| {
        f.belly(Muscle::DepressorAnguliOris, false)
    }),
    // Buccinator: draws the corner back against the teeth.
    ("MouthDimpleLeft", |f| f.belly(Muscle::Buccinator, true)),
    ("MouthDimpleRight", |f| f.belly(Muscle::Buccinator, false)),
    // Risorius and half the platysma, but no more than the mouth did widen, over 20 %.
    ("MouthStretchLeft", |f| f.stretch(true)),
    ("MouthStretchRight", |f| f.stretch(false)),
    // Protrusion below 0 is a lip tucked in; -1 is all of it (/f v/ tuck the lower one).
    ("MouthRollLower", |f| -f.is[Control::ProtrusionInferior]),
    ("MouthRollUpper", |f| -f.is[Control::ProtrusionSuperior]),
    // Mentalis pushes the lower lip up, and with it, half as far, an upper lip that it touches.
    ("MouthShrugLower", |f| f.both(Muscle::Mentalis)),
    ("MouthShrugUpper", |f| {
        0.5 * f.both(Muscle::Mentalis) * (1.0 - f.gap_mm() / PRESS_MM).max(0.0)
    }),
    // The lesser half of the orbicularis oris, where lips are within 1 mm: it takes both to press.
    ("MouthPressLeft", |f| f.press()),
    ("MouthPressRight", |f| f.press()),
    // Depressor labii inferioris: the lower lip away from the teeth, the jaw apart.
    ("MouthLowerDownLeft", |f| {
        f.belly(Muscle::DepressorLabiiInferioris, true)
    }),
    ("MouthLowerDownRight", |f| {
        f.belly(Muscle::DepressorLabiiInferioris, false)
    }),
    // Levator labii superioris, and half of the one that shares itself between lip and nose.
    ("MouthUpperUpLeft", |f| f.upper_up(true)),
    ("MouthUpperUpRight", |f| f.upper_up(false)),
    // Corrugator, with half of each of the two that only draw the brow's inner end down.
    ("BrowDownLeft", |f| f.brow_down(true)),
    ("BrowDownRight", |f| f.brow_down(false)),
    // Frontalis by its parts; ARKit has one shape for both inner ends.
    ("BrowInnerUp", |f| f.both(Muscle::FrontalisInner)),
    ("BrowOuterUpLeft", |f| f.belly(Muscle::FrontalisOuter, true)),
    ("BrowOuterUpRight", |f| {
        f.belly(Muscle::FrontalisOuter, false)
    }),
    // The head's cheeks hold no air.
    ("CheekPuff", |_| 0.0),
    // Orbital part of the orbicularis oculi, or half the smile that lifts the cheek.
    ("CheekSquintLeft", |f| f.cheek(true)),
    ("CheekSquintRight", |f| f.cheek(false)),
    // Levator labii superioris alaeque nasi, and half the nasalis: the wing up, the bridge wrinkled.
    ("NoseSneerLeft", |f| f.sneer(true)),
    ("NoseSneerRight", |f| f.sneer(false)),
    // Speech puts the tongue between the teeth at most; ARKit's shape is far beyond the lips.
    ("TongueOut", |_| 0.0),
];

/// The shapes' names, as Live Link Face writes them; ARKit's own begin with a small letter.
pub fn names() -> impl Iterator<Item = &'static str> {
    SHAPES.iter().map(|(name, _)| *name)
}

/// The values of the shapes, each within 0 and 1, in the order of [`names`].
pub fn shapes(face: &Face<'_>) -> [f32; COUNT] {
    // Adding 0 makes of -0 a plain one.
    SHAPES.map(|(_, value)| value(face).clamp(0.0, 1.0) + 0.0)
}

/// Names of [`angles`].
pub const ANGLES: [&str; 9] = [
    "HeadYaw",
    "HeadPitch",
    "HeadRoll",
    "LeftEyeYaw",
    "LeftEyePitch",
    "LeftEyeRoll",
    "RightEyeYaw",
    "RightEyePitch",
    "RightEyeRoll",
];

/// The angles of head and eyes in Live Link Face's sense: radians, yaw to the subject's right, pitch
/// down, roll to the left shoulder.
///
/// Epic documents neither unit nor sign. Recordings that users have published settle both for the
/// eyes: `EyeLookUp` of 0.47 goes with a pitch of -0.205, which is a gaze of 25 degrees where the shape
/// is 1 (77 if the unit were half turns, as in the engine's own first publisher), and the yaw falls as
/// the eyes go to the subject's left. The engine turns head and eyes into angles by the same code.
pub fn angles(is: &Controls) -> [f32; 9] {
    let eye = [-is[Control::GazeYaw], -is[Control::GazePitch], 0.0];
    let head = [
        -is[Control::HeadYaw],
        -is[Control::HeadPitch],
        is[Control::HeadRoll],
    ];
    let mut all = [0.0; 9];
    for (to, from) in all.chunks_exact_mut(3).zip([head, eye, eye]) {
        to.copy_from_slice(&from);
    }
    // Of -0 a plain one.
    all.map(|angle| angle + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::avatar::face::Reader;
    use crate::avatar::tests::held;
    use mouthpiece_phonemes::Phone;
    use mouthpiece_rig::Head;
    use std::sync::Arc;

    fn shape(values: &[f32; COUNT], name: &str) -> f32 {
        let found = SHAPES.iter().position(|(known, _)| *known == name);
        values[found.unwrap()]
    }

    #[test]
    fn phones_have_the_shapes_that_they_are_known_by() {
        let (head, frames) = held(&[Phone::M, Phone::P, Phone::B, Phone::Aa, Phone::Uw, Phone::F]);
        let reader = Reader::new(&head);
        let all: Vec<_> = frames.iter().map(|f| shapes(&reader.face(f))).collect();
        let [m, p, b, aa, uw, f] = all.as_slice() else {
            panic!()
        };
        for closed in [m, p, b] {
            let (jaw, close) = (shape(closed, "JawOpen"), shape(closed, "MouthClose"));
            assert!((jaw - close).abs() < 0.01, "jaw {jaw}, close {close}");
            assert!(shape(closed, "MouthFunnel") < 0.05);
        }
        assert!(shape(m, "MouthPressLeft") > 0.1);
        assert!(shape(aa, "JawOpen") > 0.2);
        assert!(shape(aa, "MouthClose") < 0.02);
        let round = |s| shape(s, "MouthFunnel") + shape(s, "MouthPucker");
        assert!(
            round(uw) > 0.6 && round(aa) < 0.2,
            "{} {}",
            round(uw),
            round(aa)
        );
        assert!(shape(f, "MouthRollLower") > 0.2);
        assert!(all.iter().flatten().all(|v| (0.0..=1.0).contains(v)));
    }

    #[test]
    fn left_is_the_subjects_left() {
        let mut head = Head::reference().unwrap().rest_frame();
        head.state[Control::LidL] = 1.0;
        head.state[Control::GazeYaw] = 0.3;
        head.state[Control::ZygomaticusMajor] = 0.5;
        head.state[Control::ZygomaticusMajorSide] = 0.5;
        let reader = Reader::new(&Arc::new(Head::reference().unwrap()));
        let values = shapes(&reader.face(&head));
        for (name, expected) in [
            ("EyeBlinkLeft", 1.0),
            ("EyeBlinkRight", 0.0),
            ("EyeLookOutLeft", 0.5),
            ("EyeLookInRight", 0.5),
            ("EyeLookInLeft", 0.0),
            ("MouthSmileLeft", 1.0),
            ("MouthSmileRight", 0.0),
        ] {
            assert!((shape(&values, name) - expected).abs() < 1e-5, "{name}");
        }
    }

    #[test]
    fn angles_have_the_signs_of_published_recordings() {
        let mut is = Controls::default();
        is[Control::GazeYaw] = 0.2;
        is[Control::GazePitch] = 0.1;
        is[Control::HeadRoll] = 0.05;
        let all = angles(&is);
        assert_eq!(all, [0.0, 0.0, 0.05, -0.2, -0.1, 0.0, -0.2, -0.1, 0.0]);
    }
}
