//! Muscles as fibres: control polygons that shorten (linear), close on an axis (sphincter) or bulge.
//!
//! HABER 4.2 and 5.1. Contraction, straightening under tension, the two-part orbicularis oris with a
//! central axis, protrusion along it and a gradient from inner to outer fibre are here; bulging only
//! of the two muscles of the jaw that lie between bones, and the springs between merged muscles not
//! yet. Where the paper gives no number (how much a fibre shortens), the constants below are
//! judgements. Where muscles come from: `grid`; where they merge into a sphincter: `merge`.

mod grid;
mod merge;
mod surface;
mod system;

use glam::{Affine3A, Vec3, vec3};

pub use grid::{Axis, GridPoint, MuscleGrid, Space, rebuild};
use merge::{Merge, merges};
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
        // From bone to the corner of the mouth or beside it: longer than what it can be drawn by.
        Muscle::ZygomaticusMajor
        | Muscle::ZygomaticusMinor
        | Muscle::LevatorAnguliOris
        | Muscle::DepressorAnguliOris => 0.27,
        _ => LINEAR_SHORTENING,
    }
}

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

impl Fibre {
    /// Writes the control polygon for `controls` into `out` (as long as `points`).
    pub fn contracted(&self, controls: &Controls, mandible: &Affine3A, out: &mut [Vec3]) {
        for ((q, p), share) in out.iter_mut().zip(&self.points).zip(&self.mandible) {
            *q = carried(*p, *share, mandible);
        }
        let contraction = self.told(controls);
        match self.contraction {
            Contraction::Linear => {
                self.straighten(out);
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
                let forward = match self.muscle {
                    Muscle::OrbicularisOrisSuperior => controls[Control::ProtrusionSuperior],
                    Muscle::OrbicularisOrisInferior => controls[Control::ProtrusionInferior],
                    _ => 0.0,
                } * protrusion_mm;
                let axis = carried(centre, share, mandible);
                let scale = 1.0 - shrinking * contraction;
                for q in out {
                    let across = (*q - axis) * vec3(1.0, 1.0, 0.0);
                    *q += across * (scale - 1.0) + vec3(0.0, 0.0, forward);
                }
            }
        }
    }

    /// Whether nothing moves it: no contraction or protrusion of its muscle beyond `still`, and, where it
    /// hangs on the mandible, no motion of the jaw.
    pub(crate) fn rests(&self, controls: &Controls, jaw_still: bool, still: f32) -> bool {
        let protrudes = |control| controls[control].abs() >= still;
        let active = self.told(controls).abs() >= still
            || match self.muscle {
                Muscle::OrbicularisOrisSuperior => protrudes(Control::ProtrusionSuperior),
                Muscle::OrbicularisOrisInferior => protrudes(Control::ProtrusionInferior),
                _ => false,
            };
        !active && (jaw_still || self.mandible.iter().all(|share| *share == 0.0))
    }

    /// How much `controls` contract it: as their belly of the muscle on its side of the face.
    fn told(&self, controls: &Controls) -> f32 {
        let uneven = Control::side(self.muscle).is_some_and(|side| controls[side] != 0.0);
        let middle = self.points.iter().map(|p| p.x).sum::<f32>() / self.points.len().max(1) as f32;
        if uneven && middle.abs() >= MIDDLE_MM {
            controls.contraction(self.muscle, middle > 0.0)
        } else {
            controls[Control::contraction(self.muscle)]
        }
    }

    /// A curved fibre under tension approaches the straight line between its ends (HABER 5.1).
    fn straighten(&self, out: &mut [Vec3]) {
        let (Some(&first), Some(&last)) = (out.first(), out.last()) else {
            return;
        };
        let chord = |p: &[Vec3]| p[0].distance(p[p.len() - 1]);
        let length: f32 = self.points.windows(2).map(|w| w[0].distance(w[1])).sum();
        let (rest, now) = (chord(&self.points), chord(out));
        let tension = ((now - rest) / (length - rest).max(0.5)).clamp(0.0, 1.0);
        let count = out.len();
        for (i, q) in out.iter_mut().enumerate() {
            let straight = first.lerp(last, i as f32 / (count - 1) as f32);
            *q = q.lerp(straight, tension);
        }
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

/// Slides every point towards the first one along the polygon, to `scale` times its distance.
fn shorten(points: &mut [Vec3], scale: f32) {
    // From the far end, so that the part of the polygon still to be walked is unchanged.
    for i in (1..points.len()).rev() {
        let arc: f32 = points[..=i].windows(2).map(|w| w[0].distance(w[1])).sum();
        let mut left = arc * scale;
        let mut place = points[i];
        for j in 0..i {
            let length = points[j].distance(points[j + 1]);
            if left <= length {
                place = points[j].lerp(points[j + 1], left / length.max(1e-6));
                break;
            }
            left -= length;
        }
        points[i] = place;
    }
}
