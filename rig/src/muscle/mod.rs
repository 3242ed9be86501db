//! Muscles as fibres: control polygons that shorten (linear) or close on an axis (sphincter).
//!
//! HABER 4.2 and 5.1. Contraction, straightening under tension, the two-part orbicularis oris with a
//! central axis, protrusion along it and a gradient from inner to outer fibre are here; bulging and
//! the springs between merged muscles are not yet. Where the paper gives no number (how much a
//! fibre shortens, how far lips protrude), the constants below are judgements. Where muscles merge
//! into the orbicularis oris, their insertions take its fibres along ([`merges`]).

use glam::{Affine3A, Vec3, vec3};
use serde::{Deserialize, Serialize};

use crate::{Control, Controls, Muscle, SurfacePoint};

const TABLE: &str = include_str!("../data/muscles.json");
/// Shortening of a linear fibre at full contraction: skeletal muscle manages about a third.
const LINEAR_SHORTENING: f32 = 0.36;
/// Shrinking of a sphincter towards its axis at full contraction.
const SPHINCTER_SHRINKING: f32 = 0.5;
/// Protrusion of the innermost fibre at 1, mm, and the share that the outermost takes of it.
const PROTRUSION_MM: f32 = 12.0;
const OUTER_PROTRUSION: f32 = 0.12;

/// How a fibre contracts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
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
        let contraction = controls[Control::contraction(self.muscle)];
        match self.contraction {
            Contraction::Linear => {
                self.straighten(out);
                shorten(out, 1.0 - LINEAR_SHORTENING * contraction);
            }
            Contraction::Sphincter {
                centre,
                mandible: share,
                protrusion_mm,
            } => {
                let control = if self.muscle == Muscle::OrbicularisOrisSuperior {
                    Control::ProtrusionSuperior
                } else {
                    Control::ProtrusionInferior
                };
                let axis = carried(centre, share, mandible);
                let scale = 1.0 - SPHINCTER_SHRINKING * contraction;
                let forward = protrusion_mm * controls[control];
                for q in out {
                    let across = (*q - axis) * vec3(1.0, 1.0, 0.0);
                    *q += across * (scale - 1.0) + vec3(0.0, 0.0, forward);
                }
            }
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

/// A point of a muscle as it is painted on the skin (HEADSHOP 5.2).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GridPoint {
    /// The place on the skin that it lies under.
    pub at: SurfacePoint,
    /// How far from the skin (0) to the bone under it (1).
    pub depth: f32,
    /// Share of the mandible against the skull in its motion.
    pub mandible: f32,
}

/// A muscle, or its belly of one side, painted on the skin as a grid: one row of points per fibre.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MuscleGrid {
    /// Which.
    pub muscle: Muscle,
    /// Its fibres; linear ones begin at their origin.
    pub fibres: Vec<Vec<GridPoint>>,
    /// Per fibre of a sphincter: its axis; empty for linear muscles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axes: Vec<Contraction>,
}

/// A control point of a sphincter that a linear muscle's insertion takes along.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Merge {
    /// The sphincter's fibre and point.
    pub fibre: usize,
    pub point: usize,
    /// The linear fibre that inserts there, and the share of its pull that arrives.
    pub puller: usize,
    pub share: f32,
}

/// A linear muscle takes the sphincter's points within this distance of its insertion along, mm.
const MERGE_REACH_MM: f32 = 17.0;

/// Where linear muscles merge into the orbicularis oris. Raisers of the upper lip do not reach the
/// lower half, depressors of the lower lip not the upper one.
pub(crate) fn merges(fibres: &[Fibre]) -> Vec<Merge> {
    use Muscle::{
        DepressorLabiiInferioris, LevatorLabiiSuperioris, LevatorLabiiSuperiorisAlaequeNasi,
        Mentalis, OrbicularisOrisInferior, OrbicularisOrisSuperior, ZygomaticusMinor,
    };
    let mut merges = Vec::new();
    for (f, sphincter) in fibres.iter().enumerate() {
        if sphincter.contraction == Contraction::Linear {
            continue;
        }
        for (p, place) in sphincter.points.iter().enumerate() {
            let start = merges.len();
            for (l, linear) in fibres.iter().enumerate() {
                let apart = match linear.muscle {
                    LevatorLabiiSuperioris
                    | LevatorLabiiSuperiorisAlaequeNasi
                    | ZygomaticusMinor => sphincter.muscle == OrbicularisOrisInferior,
                    DepressorLabiiInferioris => sphincter.muscle == OrbicularisOrisSuperior,
                    Mentalis => true,
                    _ => false,
                };
                let Some(&insertion) = linear.points.last() else {
                    continue;
                };
                let near = 1.0 - insertion.distance(*place) / MERGE_REACH_MM;
                if linear.contraction == Contraction::Linear && !apart && near > 0.0 {
                    merges.push(Merge {
                        fibre: f,
                        point: p,
                        puller: l,
                        share: near.sqrt(),
                    });
                }
            }
            // Fibres of one muscle share the point: together they pull no harder than one.
            for i in start..merges.len() {
                let muscle = fibres[merges[i].puller].muscle;
                let alike: f32 = merges[start..]
                    .iter()
                    .filter(|m| fibres[m.puller].muscle == muscle)
                    .map(|m| m.share)
                    .sum();
                merges[i].share *= merges[i].share / alike.max(1.0);
            }
        }
    }
    merges
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

/// A row of the muscle table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    muscle: Muscle,
    /// `[x, y, depth, mandible]` per point: place as seen from the front, mm under the skin, share of the mandible.
    points: Vec<[f32; 4]>,
    /// Sphincters: centre `[x, y, z, mandible]` and share of the protrusion.
    axis: Option<[f32; 4]>,
    protrusion: Option<f32>,
}

/// The fibres of `rig/data/muscles.json` under a skin given by `surface(x, y)`, both sides.
pub(crate) fn fibres(surface: impl Fn(f32, f32) -> Vec3) -> Result<Vec<Fibre>, serde_json::Error> {
    let rows: Vec<Row> = serde_json::from_str(TABLE)?;
    let mut fibres = Vec::new();
    for row in rows {
        let place = |side: f32, p: &[f32; 4]| {
            let skin = surface(p[0], p[1]);
            // Under the skin means towards the middle of the head at that height.
            let inwards = (vec3(0.0, p[1], 30.0) - skin).normalize_or(-Vec3::Z);
            (skin + inwards * p[2]) * vec3(side, 1.0, 1.0)
        };
        match row.axis {
            None => {
                for side in [1.0, -1.0] {
                    fibres.push(Fibre {
                        muscle: row.muscle,
                        contraction: Contraction::Linear,
                        points: row.points.iter().map(|p| place(side, p)).collect(),
                        mandible: row.points.iter().map(|p| p[3]).collect(),
                    });
                }
            }
            Some(axis) => {
                // Given from the mid line to the left corner; the right half is its mirror image.
                let right = row
                    .points
                    .iter()
                    .skip(1)
                    .rev()
                    .map(|p| (place(-1.0, p), p[3]));
                let left = row.points.iter().map(|p| (place(1.0, p), p[3]));
                let (points, mandible) = right.chain(left).unzip();
                let gradient = row.protrusion.unwrap_or(1.0);
                fibres.push(Fibre {
                    muscle: row.muscle,
                    contraction: Contraction::Sphincter {
                        centre: vec3(axis[0], axis[1], axis[2]),
                        mandible: axis[3],
                        protrusion_mm: PROTRUSION_MM
                            * (OUTER_PROTRUSION + (1.0 - OUTER_PROTRUSION) * gradient),
                    },
                    points,
                    mandible,
                });
            }
        }
    }
    Ok(fibres)
}
