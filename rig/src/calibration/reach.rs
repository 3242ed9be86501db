//! What of a wanted articulation a head cannot do, and by how much.

use std::fmt;

use super::{Calibration, MEASURES};
use crate::Articulation;

/// What a mouth is judged by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Gap between the lips.
    Aperture,
    /// Distance between the corners.
    Width,
    /// How far the lips stand forward.
    Protrusion,
    /// Lower lip to upper teeth.
    LipTeeth,
}

impl Measure {
    /// All of them, in the order of [`Reach::wanted_mm`].
    pub const ALL: [Self; MEASURES] = [
        Self::Aperture,
        Self::Width,
        Self::Protrusion,
        Self::LipTeeth,
    ];

    /// In words.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Aperture => "aperture",
            Self::Width => "width",
            Self::Protrusion => "protrusion",
            Self::LipTeeth => "lip to teeth",
        }
    }

    /// From here on a difference counts as a miss, mm: somewhat more than viewers notice from a metre
    /// away; of the width, which carries least meaning, 5 % of a mouth.
    #[must_use]
    pub const fn tolerance_mm(self) -> f32 {
        match self {
            Self::Aperture | Self::LipTeeth => 0.8,
            Self::Width => 2.5,
            Self::Protrusion => 1.0,
        }
    }
}

/// A wanted mouth beside the nearest that a head can make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// What is wanted, mm, by [`Measure::ALL`]; none where it does not matter.
    pub wanted_mm: [Option<f32>; MEASURES],
    /// What the fit expects of the controls that come nearest, mm, lips not stopping each other.
    pub expected_mm: [f32; MEASURES],
}

impl Reach {
    /// What is missed by more than its tolerance.
    pub fn misses(&self) -> impl Iterator<Item = Miss> {
        let all = Measure::ALL.into_iter();
        all.zip(self.wanted_mm).zip(self.expected_mm).filter_map(
            |((measure, wanted), expected_mm)| {
                let miss = Miss {
                    measure,
                    wanted_mm: wanted?,
                    expected_mm,
                };
                (miss.by_mm().abs() > measure.tolerance_mm()).then_some(miss)
            },
        )
    }
}

/// A measure that a head cannot bring to where it is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Miss {
    /// Which.
    pub measure: Measure,
    /// Where it is wanted, mm.
    pub wanted_mm: f32,
    /// Where it comes to, mm.
    pub expected_mm: f32,
}

impl Miss {
    /// By how much, mm: above 0 it comes out too large. Of an aperture below 0, a target past contact, only what
    /// keeps the lips from meeting counts.
    #[must_use]
    pub fn by_mm(&self) -> f32 {
        if self.measure == Measure::Aperture && self.wanted_mm < 0.0 {
            self.expected_mm.max(0.0)
        } else {
            self.expected_mm - self.wanted_mm
        }
    }
}

impl fmt::Display for Miss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} {:.1} mm instead of {:.1} ({:+.1})",
            self.measure.name(),
            self.expected_mm,
            self.wanted_mm,
            self.by_mm()
        )
    }
}

impl Calibration {
    /// What the head can do of `articulation`: nothing is simulated.
    #[must_use]
    pub fn reach(&self, articulation: &Articulation) -> Reach {
        let wanted = self.wanted(articulation).map(Some);
        let [aperture, width, protrusion, lip_teeth] = wanted;
        Reach {
            wanted_mm: [
                aperture,
                width,
                protrusion,
                articulation.lip_teeth_mm.and(lip_teeth),
            ],
            expected_mm: self.expected(&self.controls(articulation)),
        }
    }
}
