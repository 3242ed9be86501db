//! Muscles as fibres: control polygons that shorten (linear), close on an axis (sphincter) or bulge.
//!
//! HABER 4.2 and 5.1, point by point: contraction and straightening under tension are here, with the
//! sphincter's central axis, protrusion along it and its gradient from inner to outer fibre; `bulge` makes
//! contracted muscles thicker, `merge` joins merged muscles by nodes and springs, `system` does all of it
//! for a head at a moment; where muscles come from is in `grid`, and `surface` draws them. Where the paper
//! gives no number (how much a fibre shortens), the constants below are judgements.

mod bulge;
mod grid;
mod merge;
mod surface;
mod system;

use glam::{Affine3A, Vec3, vec3};

pub use grid::{Axis, GridPoint, MuscleGrid, Space, rebuild};
pub use surface::{Belly, MuscleSurfaces, enclosed_volume};
pub(crate) use system::Muscles;

use crate::{Control, Controls, Muscle};

/// Shortening of a linear fibre at full contraction: skeletal muscle manages about a third.
const LINEAR_SHORTENING: f32 = 0.36;

/// Of one muscle. The sheets are long and thin, and slide under the skin more than they draw it along.
const fn shortening(muscle: Muscle) -> f32 {
    match muscle {
        Muscle::FrontalisInner | Muscle::FrontalisOuter => 0.24,
        Muscle::Platysma => 0.2,
        // They end in the lip, which comes no farther than to the nose.
        Muscle::LevatorLabiiSuperioris | Muscle::LevatorLabiiSuperiorisAlaequeNasi => 0.22,
        Muscle::ZygomaticusMajor => 0.33,
        // From bone to the corner of the mouth or beside it: longer than what it can be drawn by.
        Muscle::ZygomaticusMinor | Muscle::LevatorAnguliOris | Muscle::DepressorAnguliOris => 0.27,
        Muscle::DepressorLabiiInferioris => 0.3,
        _ => LINEAR_SHORTENING,
    }
}

/// How much more the orbicularis oris presses the lips together than it narrows the mouth: the corners are
/// held by the muscles that end there, the lips only by each other.
const PRESS: f32 = 1.5;
/// And how far it presses its fibres up or down at most, mm: the outer ones do not overtake the inner.
const PRESS_MAX_MM: f32 = 6.0;
/// The least slack that a fibre counts as having, mm: so that a straight one does not jump.
const SLACK_MM: f32 = 0.5;
/// A fibre nearer to the middle of the face than this belongs to both sides.
const MIDDLE_MM: f32 = 2.0;

/// How a fibre contracts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Contraction {
    /// Towards its origin, the first point.
    Linear,
    /// Towards an axis along z through `centre`; `protrusion` is the fibre's share of the protrusion.
    Sphincter {
        /// A point of the axis.
        centre: Vec3,
        /// Share of the mandible in the axis's motion.
        mandible: f32,
        /// Protrusion of this fibre per unit of control, mm.
        protrusion_mm: f32,
        /// Share of its distance from the axis that it loses at full contraction.
        shrinking: f32,
    },
    /// Between bones: it keeps its length and thickens in the middle (HABER 5.1: bulging).
    Belly {
        /// How far its middle moves outwards at full contraction, mm.
        out: Vec3,
    },
}

/// One fibre of a muscle.
#[derive(Clone, Debug)]
pub struct Fibre {
    /// The muscle it belongs to.
    pub muscle: Muscle,
    /// How it contracts.
    pub contraction: Contraction,
    /// Control polygon at rest, mm; a linear fibre starts at its origin on the bone.
    pub points: Vec<Vec3>,
    /// Per point: share of the mandible against the skull in its motion.
    pub mandible: Vec<f32>,
}

/// What of a fibre at rest is asked for at every step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measure {
    /// Length of the polygon, and distance of its ends, mm.
    length: f32,
    chord: f32,
    /// The subject's left side, right side, or neither.
    left: Option<bool>,
}

impl Measure {
    pub(crate) fn new(fibre: &Fibre) -> Self {
        let points = &fibre.points;
        let middle = points.iter().map(|p| p.x).sum::<f32>() / points.len().max(1) as f32;
        Self {
            length: length(points),
            chord: chord(points),
            left: (middle.abs() >= MIDDLE_MM).then_some(middle > 0.0),
        }
    }
}

impl Fibre {
    /// Writes the control polygon for `controls` into `out` (as long as `points`): what this fibre does
    /// alone, before those that it is merged with have their say.
    pub fn contracted(&self, controls: &Controls, mandible: &Affine3A, out: &mut [Vec3]) {
        self.contract(&Measure::new(self), controls, mandible, out);
    }

    /// As [`Self::contracted`], with what was measured at rest.
    pub(crate) fn contract(
        &self,
        measure: &Measure,
        controls: &Controls,
        mandible: &Affine3A,
        out: &mut [Vec3],
    ) {
        for ((q, p), share) in out.iter_mut().zip(&self.points).zip(&self.mandible) {
            *q = carried(*p, *share, mandible);
        }
        let contraction = self.told(measure, controls);
        match self.contraction {
            Contraction::Linear => {
                straighten(out, measure.chord, measure.length);
                shorten(out, 1.0 - shortening(self.muscle) * contraction);
            }
            Contraction::Belly { out: bulge } => {
                let last = (out.len() - 1).max(1) as f32;
                for (i, q) in out.iter_mut().enumerate() {
                    let belly = (std::f32::consts::PI * i as f32 / last).sin();
                    *q += bulge * (belly * contraction);
                }
            }
            Contraction::Sphincter {
                centre,
                mandible: share,
                protrusion_mm,
                shrinking,
            } => {
                let forward = self.protrudes(controls) * protrusion_mm;
                let axis = carried(centre, share, mandible);
                let lips = self.rounds_lips();
                for q in out {
                    let mut shift = (axis - *q) * (shrinking * contraction);
                    if lips {
                        let over = (shift.y * PRESS / PRESS_MAX_MM).powi(2);
                        shift.y *= PRESS / (1.0 + over * over).sqrt().sqrt();
                    }
                    *q += vec3(shift.x, shift.y, forward);
                }
            }
        }
    }

    /// How hard it works, 0 to 1: by contraction or protrusion.
    pub(crate) fn works(&self, measure: &Measure, controls: &Controls) -> f32 {
        let protrudes = self.protrudes(controls).abs();
        self.told(measure, controls).abs().max(protrudes)
    }

    const fn rounds_lips(&self) -> bool {
        matches!(
            self.muscle,
            Muscle::OrbicularisOrisSuperior | Muscle::OrbicularisOrisInferior
        )
    }

    /// Whether the mandible takes any of it along.
    pub(crate) fn hangs_on_mandible(&self) -> bool {
        self.mandible.iter().any(|share| *share != 0.0)
    }

    /// The protrusion that `controls` ask of its muscle.
    fn protrudes(&self, controls: &Controls) -> f32 {
        match self.muscle {
            Muscle::OrbicularisOrisSuperior => controls[Control::ProtrusionSuperior],
            Muscle::OrbicularisOrisInferior => controls[Control::ProtrusionInferior],
            _ => 0.0,
        }
    }

    /// How much `controls` contract it: as their belly of the muscle on its side of the face.
    fn told(&self, measure: &Measure, controls: &Controls) -> f32 {
        let uneven = Control::side(self.muscle).is_some_and(|side| controls[side] != 0.0);
        match measure.left {
            Some(left) if uneven => controls.contraction(self.muscle, left),
            _ => controls[Control::contraction(self.muscle)],
        }
    }
}

fn length(points: &[Vec3]) -> f32 {
    points.windows(2).map(|w| w[0].distance(w[1])).sum()
}

fn chord(points: &[Vec3]) -> f32 {
    match (points.first(), points.last()) {
        (Some(first), Some(last)) => first.distance(*last),
        _ => 0.0,
    }
}

/// A curved fibre under tension approaches the straight line between its ends, and is on it when they
/// are as far apart as it is long (HABER 5.1); `chord` and `length` are those without the tension.
fn straighten(out: &mut [Vec3], rest_chord: f32, length: f32) {
    let (Some(&first), Some(&last)) = (out.first(), out.last()) else {
        return;
    };
    let tension = ((chord(out) - rest_chord) / (length - rest_chord).max(SLACK_MM)).clamp(0.0, 1.0);
    if tension == 0.0 {
        return;
    }
    let ends = (out.len() - 1).max(1) as f32;
    for (i, q) in out.iter_mut().enumerate() {
        *q = q.lerp(first.lerp(last, i as f32 / ends), tension);
    }
}

/// A point that follows the mandible by a share.
pub(crate) fn carried(p: Vec3, share: f32, mandible: &Affine3A) -> Vec3 {
    if share == 0.0 {
        p
    } else {
        p.lerp(mandible.transform_point3(p), share)
    }
}

/// Slides every point towards the first one along the polygon, to `scale` times its distance. `scale` is
/// at most 1.
fn shorten(points: &mut [Vec3], scale: f32) {
    if scale >= 1.0 || points.len() < 2 {
        return;
    }
    // From the far end, so that the part of the polygon still to be walked is unchanged: one walk back for
    // the points (to `i`, `arc` mm along), one for their places (in the segment from `j`, `from` mm along).
    let mut i = points.len() - 1;
    let mut arc = length(points);
    let mut j = i - 1;
    let mut from = arc - points[j].distance(points[i]);
    while i > 0 {
        let before = points[i - 1].distance(points[i]);
        let place = arc * scale;
        while from > place && j > 0 {
            j -= 1;
            from -= points[j].distance(points[j + 1]);
        }
        let along = points[j].distance(points[j + 1]).max(1e-6);
        // The segment's own end is unchanged still: it lies before `i`, or is `i`.
        points[i] = points[j].lerp(points[j + 1], ((place - from) / along).clamp(0.0, 1.0));
        arc -= before;
        i -= 1;
        if j >= i && i > 0 {
            j = i - 1;
            from = arc - points[j].distance(points[i]);
        }
    }
}
