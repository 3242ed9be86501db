//! Muscles as they are painted on the skin, and their fibres in the space over the bones (HEADSHOP 5.2).
//!
//! A grid point lies on a triangle of the skin and a share of the way from there to the bone, so that a
//! muscle follows any warp of skin and skull. Inwards is towards the vertical axis of the head. The
//! space is what a small bundle of rays finds free, and where bone is far, bounded: a muscle of the
//! cheek does not sink into the mouth.

use glam::{Vec3, Vec3A, vec3};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;
use serde::{Deserialize, Serialize};

use super::{Contraction, Fibre};
use crate::{Mesh, Muscle, SurfacePoint};

/// The head's vertical axis lies this far in front of its frame's, mm.
const AXIS_Z: f32 = 30.0;
/// The space counts as no deeper than this, mm: what the deepest muscle of the cheek (buccinator) needs.
const DEEPEST_MM: f32 = 16.0;
/// And as no shallower: skin on bone is some 2 mm thick at least.
const SHALLOWEST_MM: f32 = 1.0;
/// Rays round the straight one, and the tangent of their angle to it.
const RAYS: usize = 6;
const SPREAD: f32 = 0.4;

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

/// The axis that a fibre of a sphincter closes on; it runs along z.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    /// From the middle of the fibre's points, mm, on a head where they are `spread_mm` from it in the mean.
    pub from_middle: Vec3,
    /// See `from_middle`: the axis keeps its place in proportion.
    pub spread_mm: f32,
    /// Share of the mandible in its motion.
    pub mandible: f32,
    /// Protrusion of the fibre per unit of control, mm.
    pub protrusion_mm: f32,
    /// Share of its distance from the axis that the fibre loses at full contraction.
    pub shrinking: f32,
}

impl Axis {
    /// The axis through `centre` of a fibre with these points; protrusion and shrinking as given.
    #[must_use]
    pub fn new(
        centre: Vec3,
        points: &[Vec3],
        mandible: f32,
        protrusion_mm: f32,
        shrinking: f32,
    ) -> Self {
        let (middle, spread_mm) = middle(points);
        Self {
            from_middle: centre - middle,
            spread_mm,
            mandible,
            protrusion_mm,
            shrinking,
        }
    }

    fn contraction(&self, points: &[Vec3]) -> Contraction {
        let (middle, spread) = middle(points);
        Contraction::Sphincter {
            centre: middle + self.from_middle * (spread / self.spread_mm.max(1e-3)),
            mandible: self.mandible,
            protrusion_mm: self.protrusion_mm,
            shrinking: self.shrinking,
        }
    }
}

fn middle(points: &[Vec3]) -> (Vec3, f32) {
    let count = points.len().max(1) as f32;
    let middle = points.iter().sum::<Vec3>() / count;
    (
        middle,
        points.iter().map(|p| p.distance(middle)).sum::<f32>() / count,
    )
}

/// A muscle, or its belly of one side, painted on the skin as a grid: one row of points per fibre.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MuscleGrid {
    /// Which.
    pub muscle: Muscle,
    /// Its fibres; linear ones begin at their origin.
    pub fibres: Vec<Vec<GridPoint>>,
    /// Per fibre of a sphincter: its axis; empty for other muscles.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axes: Vec<Axis>,
    /// Of a muscle between bones: how far its middle comes outwards at full contraction, mm; else 0.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub bulge_mm: f32,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "serde asks for it")]
fn is_zero(value: &f32) -> bool {
    *value == 0.0
}

/// Towards the axis of the head at the height of `p`, where a muscle under the skin there lies.
pub(super) fn inwards(p: Vec3) -> Vec3 {
    (vec3(0.0, p.y, AXIS_Z) - p).normalize_or(-Vec3::Z)
}

/// The space between skin and bones.
pub struct Space {
    triangles: Vec<Triangle>,
    bvh: Bvh2,
}

impl Space {
    /// Over these bones.
    #[must_use]
    pub fn new<'a>(bones: impl IntoIterator<Item = &'a Mesh>) -> Self {
        let mut triangles = Vec::new();
        for mesh in bones {
            triangles.extend(mesh.triangles.iter().map(|t| {
                let [v0, v1, v2] = t.map(|i| Vec3A::from(mesh.positions[i as usize]));
                Triangle { v0, v1, v2 }
            }));
        }
        let mut spent = std::time::Duration::default();
        let bvh = build_bvh2_from_tris(&triangles, BvhBuildParams::fast_build(), &mut spent);
        Self { triangles, bvh }
    }

    /// How deep the space under a place of the skin is, mm, and which way.
    #[must_use]
    pub fn under(&self, skin: Vec3) -> (Vec3, f32) {
        let straight = inwards(skin);
        let (a, b) = straight.any_orthonormal_pair();
        let mut depth = self.free(skin, straight);
        for i in 0..RAYS {
            let (s, c) = (std::f32::consts::TAU * i as f32 / RAYS as f32).sin_cos();
            let aside = (straight + (a * c + b * s) * SPREAD).normalize();
            depth = depth.min(self.free(skin, aside));
        }
        (straight, depth.max(SHALLOWEST_MM))
    }

    fn free(&self, from: Vec3, direction: Vec3) -> f32 {
        if self.triangles.is_empty() {
            return DEEPEST_MM;
        }
        let ray = Ray::new(from.into(), direction.into(), 0.0, DEEPEST_MM);
        let mut hit = RayHit::none();
        self.bvh.ray_traverse(ray, &mut hit, |ray, id| {
            self.triangles[self.bvh.primitive_indices[id] as usize].intersect(ray)
        });
        hit.t.min(DEEPEST_MM)
    }
}

/// The fibres of painted muscles under a skin, in the space over its bones.
#[must_use]
pub fn rebuild<'a>(
    grids: &[MuscleGrid],
    skin: &[Vec3],
    bones: impl IntoIterator<Item = &'a Mesh>,
) -> Vec<Fibre> {
    let space = Space::new(bones);
    let mut fibres = Vec::new();
    for grid in grids {
        for (k, row) in grid.fibres.iter().enumerate() {
            let points: Vec<Vec3> = row
                .iter()
                .map(|point| {
                    let place = point.at.on(skin);
                    let (straight, depth) = space.under(place);
                    place + straight * (depth * point.depth)
                })
                .collect();
            let contraction = match grid.axes.get(k) {
                Some(axis) => axis.contraction(&points),
                None if grid.bulge_mm > 0.0 => Contraction::Belly {
                    out: -inwards(points.get(points.len() / 2).copied().unwrap_or_default())
                        * grid.bulge_mm,
                },
                None => Contraction::Linear,
            };
            fibres.push(Fibre {
                muscle: grid.muscle,
                contraction,
                mandible: row.iter().map(|p| p.mandible).collect(),
                points,
            });
        }
    }
    fibres
}
