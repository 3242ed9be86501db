//! ARKit's 52 blend shapes and the angles of head and eyes, in the layout of Live Link Face's CSV.
//!
//! A shape is 0 at rest and 1 at its extreme. Jaw and lips go by what the simulated mesh does, so
//! that lips which touch there touch on the other avatar; what only a muscle can do goes by that
//! muscle. Left and right are the subject's. Cheeks are never puffed, and the tongue stays in.

use std::fmt::Write as _;
use std::sync::Arc;

use glam::Vec3;
use mouthpiece_rig::{Control, Controls, Head, KeyFrame, Measures, Muscle, lip_level, measure};

use super::{Rows, timecode};
use crate::cli::Fps;

/// Angles behind the shapes, radians: yaw to the subject's left, pitch up, roll to the left shoulder.
const ANGLES: [&str; 9] = [
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

/// Jaw angle that counts as wide open: as far as the head's jaw goes.
const JAW_OPEN_RAD: f32 = 0.45;
/// Share of its width by which a mouth narrows for the roundest vowel (/uw/, measured: 0.22).
const NARROW: f32 = 0.25;
/// How far lips go forward for the roundest sounds, mm (/uw sh/, measured: 3.6 to 3.9).
const FORWARD_MM: f32 = 4.0;
/// Gap at which round lips are a funnel and no longer a pout, mm: twice that of /uw/.
const FUNNEL_MM: f32 = 8.0;
/// Share of its width by which the widest smile widens a mouth.
const WIDE: f32 = 0.2;
/// Gap above which nothing of a press is left, mm.
const PRESS_MM: f32 = 1.0;

/// What a face does at an instant.
struct Face<'a> {
    is: &'a Controls,
    mouth: Measures,
    /// The mouth's width at rest, mm.
    width_mm: f32,
    /// The gap that the jaw alone would open, mm.
    jaw_mm: f32,
}

impl Face<'_> {
    fn belly(&self, muscle: Muscle, left: bool) -> f32 {
        self.is.contraction(muscle, left)
    }

    fn both(&self, muscle: Muscle) -> f32 {
        0.5 * (self.belly(muscle, true) + self.belly(muscle, false))
    }

    /// How much more the left belly pulls than the right one.
    fn aside(&self, muscle: Muscle) -> f32 {
        self.belly(muscle, true) - self.belly(muscle, false)
    }

    fn gap_mm(&self) -> f32 {
        self.mouth.aperture_mm.max(0.0)
    }

    fn jaw_open(&self) -> f32 {
        self.mouth.jaw_rad / JAW_OPEN_RAD
    }

    /// ARKit's mouthClose undoes jawOpen at the lips: both at the same value is a closed mouth.
    fn close(&self) -> f32 {
        if self.jaw_mm <= 0.0 {
            return 0.0;
        }
        self.jaw_open() * (1.0 - self.gap_mm() / self.jaw_mm).clamp(0.0, 1.0)
    }

    fn round(&self) -> f32 {
        let narrow = (1.0 - self.mouth.width_mm / self.width_mm) / NARROW;
        let forward = self.mouth.protrusion_mm / FORWARD_MM;
        (0.5 * (narrow.clamp(0.0, 1.0) + forward.clamp(0.0, 1.0))).clamp(0.0, 1.0)
    }

    fn open(&self) -> f32 {
        (self.gap_mm() / FUNNEL_MM).min(1.0)
    }

    /// A pull outwards counts as far as the mouth did widen: others hold against it.
    fn stretch(&self, left: bool) -> f32 {
        let wide = (self.mouth.width_mm / self.width_mm - 1.0) / WIDE;
        let pull = self.belly(Muscle::Risorius, left) + 0.5 * self.belly(Muscle::Platysma, left);
        pull.min(wide).max(0.0)
    }

    fn press(&self) -> f32 {
        let [upper, lower] = [
            Muscle::OrbicularisOrisSuperior,
            Muscle::OrbicularisOrisInferior,
        ]
        .map(|m| self.both(m));
        upper.min(lower) * (1.0 - self.gap_mm() / PRESS_MM).max(0.0)
    }

    fn blink(&self, left: bool) -> f32 {
        let lid = if left { Control::LidL } else { Control::LidR };
        self.is[lid].max(0.0) + self.belly(Muscle::OrbicularisOculiPalpebral, left)
    }

    fn wide(&self, left: bool) -> f32 {
        let lid = if left { Control::LidL } else { Control::LidR };
        self.is[lid] / lid.range().0
    }

    /// Both eyes look the same way.
    fn look(&self, control: Control) -> f32 {
        self.is[control] / control.range().1
    }

    fn brow_down(&self, left: bool) -> f32 {
        self.belly(Muscle::CorrugatorSupercilii, left)
            + 0.5 * self.belly(Muscle::DepressorSupercilii, left)
            + 0.5 * self.belly(Muscle::Procerus, left)
    }

    fn cheek(&self, left: bool) -> f32 {
        let smile = 0.5 * self.belly(Muscle::ZygomaticusMajor, left);
        self.belly(Muscle::OrbicularisOculiOrbital, left).max(smile)
    }

    fn smile(&self, left: bool) -> f32 {
        self.belly(Muscle::ZygomaticusMajor, left)
            + 0.3 * self.belly(Muscle::ZygomaticusMinor, left)
    }

    fn upper_up(&self, left: bool) -> f32 {
        self.belly(Muscle::LevatorLabiiSuperioris, left)
            + 0.5 * self.belly(Muscle::LevatorLabiiSuperiorisAlaequeNasi, left)
    }

    fn sneer(&self, left: bool) -> f32 {
        self.belly(Muscle::LevatorLabiiSuperiorisAlaequeNasi, left)
            + 0.5 * self.belly(Muscle::Nasalis, left)
    }

    fn sideways(&self) -> f32 {
        0.5 * (self.aside(Muscle::Risorius) + self.aside(Muscle::Buccinator))
    }
}

/// A shape's name and its value, before it is held within 0 and 1.
type Shape = (&'static str, fn(&Face<'_>) -> f32);

/// A row a shape, in Live Link Face's order; behind it what it is read off, its scale, and why.
const SHAPES: [Shape; 52] = [
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

/// A head's blend shapes.
struct Reader {
    head: Arc<Head>,
    width_mm: f32,
    /// Where the lower lip touches the upper one, at rest.
    lip: Vec3,
}

impl Reader {
    fn new(head: &Arc<Head>) -> Self {
        let lower = &head.lips.lower;
        let lip = lower
            .get(lower.len() / 2)
            .and_then(|c| head.skin.mesh.positions.get(c[lip_level::CONTACT] as usize));
        Self {
            head: Arc::clone(head),
            width_mm: measure(head, &head.rest_frame()).width_mm.max(1.0),
            lip: lip.copied().unwrap_or_default(),
        }
    }

    fn shapes(&self, frame: &KeyFrame) -> [f32; 52] {
        let mouth = measure(&self.head, frame);
        let jaw = self.head.mandible(mouth.jaw_rad);
        let face = Face {
            is: &frame.state,
            jaw_mm: self.lip.y - jaw.transform_point3(self.lip).y,
            width_mm: self.width_mm,
            mouth,
        };
        // Adding 0 makes of -0 a plain one.
        SHAPES.map(|(_, value)| value(&face).clamp(0.0, 1.0) + 0.0)
    }
}

/// A recording being written.
pub struct Table {
    reader: Reader,
    rate: Fps,
    text: String,
}

impl Table {
    pub fn new(head: &Arc<Head>, rate: Fps) -> Self {
        let shapes = SHAPES.iter().map(|(name, _)| *name);
        let names: Vec<_> = shapes.chain(ANGLES).collect();
        Self {
            reader: Reader::new(head),
            rate,
            text: format!("Timecode,BlendShapeCount,{}\n", names.join(",")),
        }
    }
}

impl Rows for Table {
    fn row(&mut self, k: u64, frame: &KeyFrame) {
        let count = SHAPES.len() + ANGLES.len();
        let _ = write!(self.text, "{},{count}", timecode(self.rate, k));
        let is = |control| frame.state[control];
        let eye = [is(Control::GazeYaw), is(Control::GazePitch), 0.0];
        let angles = [
            is(Control::HeadYaw),
            is(Control::HeadPitch),
            is(Control::HeadRoll),
        ];
        let values = self.reader.shapes(frame).into_iter();
        for value in values.chain(angles).chain(eye).chain(eye) {
            let _ = write!(self.text, ",{value:.6}");
        }
        self.text.push('\n');
    }

    fn finish(self: Box<Self>) -> String {
        self.text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::avatar::tests::held;
    use mouthpiece_phonemes::Phone;

    fn shape(values: &[f32; 52], name: &str) -> f32 {
        let found = SHAPES.iter().position(|(known, _)| *known == name);
        values[found.unwrap()]
    }

    #[test]
    fn phones_have_the_shapes_that_they_are_known_by() {
        let (head, frames) = held(&[Phone::M, Phone::P, Phone::B, Phone::Aa, Phone::Uw, Phone::F]);
        let reader = Reader::new(&head);
        let all: Vec<_> = frames.iter().map(|f| reader.shapes(f)).collect();
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
        let values = Reader::new(&Arc::new(Head::reference().unwrap())).shapes(&head);
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
    fn columns_are_those_of_live_link_face() {
        let head = Arc::new(Head::reference().unwrap());
        let mut table = Box::new(Table::new(&head, Fps { num: 60, den: 1 }));
        table.row(61, &head.rest_frame());
        let text = table.finish();
        let (header, row) = text.split_once('\n').unwrap();
        let names: Vec<_> = header.split(',').collect();
        assert_eq!(names.len(), 2 + 52 + 9);
        assert_eq!(row.trim_end().split(',').count(), names.len());
        assert!(row.starts_with("00:00:01:01.000,61,0.000000,"));
        let mut sorted = names.clone();
        sorted.sort_unstable();
        sorted.dedup();
        assert_eq!(sorted.len(), names.len());
        for (at, name) in [
            (2, "EyeBlinkLeft"),
            (9, "EyeBlinkRight"),
            (16, "JawForward"),
            (19, "JawOpen"),
            (20, "MouthClose"),
            (25, "MouthSmileLeft"),
            (43, "BrowDownLeft"),
            (48, "CheekPuff"),
            (53, "TongueOut"),
            (54, "HeadYaw"),
            (62, "RightEyeRoll"),
        ] {
            assert_eq!(names[at], name);
        }
    }
}
