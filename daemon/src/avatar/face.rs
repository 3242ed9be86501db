//! What a face does at an instant, in the words that shapes and expressions of other avatars are made
//! of: how far jaw and lips are open as measured on the simulated mesh, how round, how wide, and what
//! each muscle pulls. Left and right are the subject's.

use std::sync::Arc;

use glam::{Quat, Vec3};
use mouthpiece_rig::{
    Body, Control, Controls, Head, KeyFrame, Measures, Muscle, lip_level, measure,
};

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
pub const PRESS_MM: f32 = 1.0;

/// Reads faces off key frames of one head.
pub struct Reader {
    head: Arc<Head>,
    width_mm: f32,
    /// Where the lower lip touches the upper one, at rest.
    lip: Vec3,
}

impl Reader {
    pub fn new(head: &Arc<Head>) -> Self {
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

    /// What the face of `frame` does.
    pub fn face<'a>(&'a self, frame: &'a KeyFrame) -> Face<'a> {
        let mouth = measure(&self.head, frame);
        let jaw = self.head.mandible(mouth.jaw_rad);
        Face {
            head: &self.head,
            is: &frame.state,
            jaw_mm: self.lip.y - jaw.transform_point3(self.lip).y,
            width_mm: self.width_mm,
            mouth,
        }
    }
}

/// What a face does at an instant.
pub struct Face<'a> {
    head: &'a Head,
    pub is: &'a Controls,
    pub mouth: Measures,
    /// The mouth's width at rest, mm.
    width_mm: f32,
    /// The gap that the jaw alone would open, mm.
    jaw_mm: f32,
}

impl Face<'_> {
    /// How the skull is turned, in the head's frame: X to the subject's left, Y up, Z out of the face.
    pub fn turned(&self) -> Quat {
        Quat::from_affine3(&self.head.bodies(self.is)[Body::Skull as usize].into())
    }

    pub fn belly(&self, muscle: Muscle, left: bool) -> f32 {
        self.is.contraction(muscle, left)
    }

    pub fn both(&self, muscle: Muscle) -> f32 {
        0.5 * (self.belly(muscle, true) + self.belly(muscle, false))
    }

    /// How much more the left belly pulls than the right one.
    pub fn aside(&self, muscle: Muscle) -> f32 {
        self.belly(muscle, true) - self.belly(muscle, false)
    }

    pub fn gap_mm(&self) -> f32 {
        self.mouth.aperture_mm.max(0.0)
    }

    pub fn jaw_open(&self) -> f32 {
        self.mouth.jaw_rad / JAW_OPEN_RAD
    }

    /// ARKit's mouthClose undoes jawOpen at the lips: both at the same value is a closed mouth.
    pub fn close(&self) -> f32 {
        if self.jaw_mm <= 0.0 {
            return 0.0;
        }
        self.jaw_open() * (1.0 - self.gap_mm() / self.jaw_mm).clamp(0.0, 1.0)
    }

    pub fn round(&self) -> f32 {
        let narrow = (1.0 - self.mouth.width_mm / self.width_mm) / NARROW;
        let forward = self.mouth.protrusion_mm / FORWARD_MM;
        (0.5 * (narrow.clamp(0.0, 1.0) + forward.clamp(0.0, 1.0))).clamp(0.0, 1.0)
    }

    pub fn open(&self) -> f32 {
        (self.gap_mm() / FUNNEL_MM).min(1.0)
    }

    /// A pull outwards counts as far as the mouth did widen: others hold against it.
    pub fn stretch(&self, left: bool) -> f32 {
        let wide = (self.mouth.width_mm / self.width_mm - 1.0) / WIDE;
        let pull = self.belly(Muscle::Risorius, left) + 0.5 * self.belly(Muscle::Platysma, left);
        pull.min(wide).max(0.0)
    }

    pub fn press(&self) -> f32 {
        let [upper, lower] = [
            Muscle::OrbicularisOrisSuperior,
            Muscle::OrbicularisOrisInferior,
        ]
        .map(|m| self.both(m));
        upper.min(lower) * (1.0 - self.gap_mm() / PRESS_MM).max(0.0)
    }

    pub fn blink(&self, left: bool) -> f32 {
        let lid = if left { Control::LidL } else { Control::LidR };
        self.is[lid].max(0.0) + self.belly(Muscle::OrbicularisOculiPalpebral, left)
    }

    pub fn wide(&self, left: bool) -> f32 {
        let lid = if left { Control::LidL } else { Control::LidR };
        self.is[lid] / lid.range().0
    }

    /// Both eyes look the same way.
    pub fn look(&self, control: Control) -> f32 {
        self.is[control] / control.range().1
    }

    pub fn brow_down(&self, left: bool) -> f32 {
        self.belly(Muscle::CorrugatorSupercilii, left)
            + 0.5 * self.belly(Muscle::DepressorSupercilii, left)
            + 0.5 * self.belly(Muscle::Procerus, left)
    }

    pub fn cheek(&self, left: bool) -> f32 {
        let smile = 0.5 * self.belly(Muscle::ZygomaticusMajor, left);
        self.belly(Muscle::OrbicularisOculiOrbital, left).max(smile)
    }

    pub fn smile(&self, left: bool) -> f32 {
        self.belly(Muscle::ZygomaticusMajor, left)
            + 0.3 * self.belly(Muscle::ZygomaticusMinor, left)
    }

    pub fn upper_up(&self, left: bool) -> f32 {
        self.belly(Muscle::LevatorLabiiSuperioris, left)
            + 0.5 * self.belly(Muscle::LevatorLabiiSuperiorisAlaequeNasi, left)
    }

    pub fn sneer(&self, left: bool) -> f32 {
        self.belly(Muscle::LevatorLabiiSuperiorisAlaequeNasi, left)
            + 0.5 * self.belly(Muscle::Nasalis, left)
    }

    pub fn sideways(&self) -> f32 {
        0.5 * (self.aside(Muscle::Risorius) + self.aside(Muscle::Buccinator))
    }
}
