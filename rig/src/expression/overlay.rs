//! An expression over speech: who wins where.
//!
//! A mouth that smiles while it talks still closes for /p b m/ and still rounds for /w/: people keep
//! the expression in the brows, lids and corners of the mouth, and let the lips go. So an
//! expression acts in full on what speech does not use; what parts the lips or shapes them gives way
//! while something is said, and altogether where the lips are about to meet. How near they are to
//! that is read off the head's own calibration ([`Mouth::of`]), so that no phone is known here. Where both
//! contract a muscle, the contractions add as 1 - (1 - a)(1 - b), which stays within 1.
//!
//! The shares are judgements; `rig/tests/expression.rs` holds them to closed lips under every
//! expression of the library.

use super::settings::{Bellies, pairs};
use crate::{Calibration, Control, Controls};

/// What speech needs of the mouth at an instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mouth {
    /// 0 silent to 1 in mid sentence.
    pub speaking: f32,
    /// 0 lips wide apart to 1 lips that must meet.
    pub closing: f32,
}

/// From this expected gap on, mm, lips are parted enough to bear an expression; at the other they meet.
const PARTED_MM: f32 = 4.5;
const MEETING_MM: f32 = 1.0;

impl Mouth {
    /// Read off what speech tells a head; `speaking` as above.
    #[must_use]
    pub fn of(calibration: &Calibration, speech: &Controls, speaking: f32) -> Self {
        let aperture_mm = calibration.expected(speech)[0];
        let parted = (aperture_mm - MEETING_MM) / (PARTED_MM - MEETING_MM);
        Self {
            speaking,
            closing: 1.0 - ease(parted),
        }
    }
}

/// 0 to 1 with no corner at either end; what is no number is 0.
pub(super) fn ease(x: f32) -> f32 {
    let x = if x.is_finite() {
        x.clamp(0.0, 1.0)
    } else {
        0.0
    };
    x * x * (3.0 - 2.0 * x)
}

/// What a control does for an expression, and so how it gives way to speech.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// Brows, nose, neck: speech has no use for them.
    Face,
    /// Lids: the more closed of the two wins, and eyes that are wide open close from there.
    Lid,
    /// Gaze and head: turned from where they were.
    Pose,
    /// Draws the corners of the mouth, which may stay drawn while the lips meet.
    Corner,
    /// Parts the lips.
    Parting,
    /// Shapes what speech shapes: lips, jaw, tongue.
    Shaping,
}

impl Role {
    const fn of(control: Control) -> Self {
        match control {
            Control::LidL | Control::LidR | Control::OrbicularisOculiPalpebral => Self::Lid,
            Control::GazeYaw
            | Control::GazePitch
            | Control::HeadYaw
            | Control::HeadPitch
            | Control::HeadRoll => Self::Pose,
            Control::ZygomaticusMajor
            | Control::LevatorAnguliOris
            | Control::Risorius
            | Control::Buccinator
            | Control::DepressorAnguliOris
            | Control::Mentalis
            | Control::Platysma => Self::Corner,
            Control::ZygomaticusMinor
            | Control::LevatorLabiiSuperioris
            | Control::LevatorLabiiSuperiorisAlaequeNasi
            | Control::DepressorLabiiInferioris => Self::Parting,
            Control::OrbicularisOrisSuperior
            | Control::OrbicularisOrisInferior
            | Control::ProtrusionSuperior
            | Control::ProtrusionInferior
            | Control::Jaw
            | Control::TongueTip
            | Control::TongueOut
            | Control::TongueBody
            | Control::Masseter
            | Control::Temporalis => Self::Shaping,
            _ => Self::Face,
        }
    }

    /// Share of an expression that is left in mid sentence, with the lips apart and with them meeting.
    const fn left_by_speech(self) -> (f32, f32) {
        match self {
            Self::Face | Self::Lid | Self::Pose => (1.0, 1.0),
            Self::Corner => (0.7, 0.4),
            Self::Parting => (0.5, 0.0),
            Self::Shaping => (0.2, 0.0),
        }
    }

    fn share(self, mouth: Mouth) -> f32 {
        let (parted, meeting) = self.left_by_speech();
        let spoken = parted + (meeting - parted) * mouth.closing.clamp(0.0, 1.0);
        1.0 + (spoken - 1.0) * mouth.speaking.clamp(0.0, 1.0)
    }
}

impl Controls {
    /// Lays `expression` over these controls of speech, by `weight` (0 not at all to 1), as far as
    /// `mouth` leaves room for it. Ranges hold if they did before.
    pub fn express(&mut self, expression: &Self, weight: f32, mouth: Mouth) {
        let weight = if weight.is_finite() {
            weight.clamp(0.0, 1.0)
        } else {
            0.0
        };
        let mut speech = Bellies::from(&*self);
        let expression = Bellies::from(expression);
        let mut lay = |slot: usize, control: Control| {
            let role = Role::of(control);
            let (a, b) = (
                speech.0[slot],
                expression.0[slot] * weight * role.share(mouth),
            );
            let (least, most) = control.range();
            speech.0[slot] = match role {
                Role::Lid => {
                    let wide = a.min(b).min(0.0);
                    wide + (1.0 - wide) * a.max(b).max(0.0)
                }
                _ if b > 0.0 && least == 0.0 && most == 1.0 => 1.0 - (1.0 - a) * (1.0 - b),
                _ => (a + b).clamp(least, most),
            };
        };
        for &control in &Control::ALL[..Control::LevatorLabiiSuperiorisSide as usize] {
            lay(control as usize, control);
        }
        for (_, both, side) in pairs() {
            lay(side as usize, both);
        }
        *self = Self::from(&speech);
    }
}
