//! What a mouth should do, in physical terms and for any head; a head's
//! [`Calibration`](crate::Calibration) turns it into [`Controls`](crate::Controls).

use serde::{Deserialize, Serialize};

/// The posture of a mouth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Articulation {
    /// Vertical gap between the lips, mm; 0 touches, below 0 is pressed (a target past contact).
    pub aperture_mm: f32,
    /// Distance between the mouth's corners as a share of that at rest.
    pub width: f32,
    /// How far the lips stand forward of their place at rest, mm.
    pub protrusion_mm: f32,
    /// Distance of the lower lip's edge to that of the upper teeth, mm; none where it does not matter.
    #[serde(default)]
    pub lip_teeth_mm: Option<f32>,
    /// Jaw rotation, radians.
    pub jaw_rad: f32,
    /// Where the tongue is.
    pub tongue: Tongue,
}

/// The posture of a tongue; each value as the control of the same name in [`Control`](crate::Control).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tongue {
    /// Tip: 0 at rest to 1 at the alveolar ridge.
    pub tip: f32,
    /// Forward: 0 at rest to 1 between the teeth; -1 drawn back.
    pub out: f32,
    /// Body: 0 at rest to 1 at the palate.
    pub body: f32,
}

impl Articulation {
    /// Lips just closed, jaw up, tongue down.
    pub const REST: Self = Self {
        aperture_mm: 0.0,
        width: 1.0,
        protrusion_mm: 0.0,
        lip_teeth_mm: None,
        jaw_rad: 0.0,
        tongue: Tongue {
            tip: 0.0,
            out: 0.0,
            body: 0.0,
        },
    };
}
