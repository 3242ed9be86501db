//! Paints the muscle table on the skin of the reference head (HEADSHOP 5.2): grids of places on its
//! triangles, each with the share of the way from there to the bone.
//!
//! The table (`rig/shop/data/muscles.json`) holds, per fibre, points `[x, y, depth, mandible]`: a place as
//! seen from the front, or with `"from": "axis"` a longitude (degrees) about the head's axis and a
//! height; mm under the skin, at most down to the bone; share of the mandible in its motion. Linear
//! fibres begin at their origin. It is given for the left side. Which muscles there are and what
//! they do is anatomy (Terminologia Anatomica); depths and courses are judgements.

use glam::{Vec3, vec3};
use mouthpiece_rig::{Axis, GridPoint, Mesh, Muscle, MuscleGrid, Space, SurfacePoint};
use serde::Deserialize;
use thiserror::Error;

use crate::closest::{Facing, Hit, Surface, SurfaceError};

const TABLE: &str = include_str!("../data/muscles.json");
/// Axis of the longitudes, mm.
const AXIS_Z: f32 = 10.45;
/// No part of a face is farther from where rays start, mm.
const FAR_MM: f32 = 300.0;
/// Where a ray slips through the slit of the mouth it lands so much deeper than its neighbours, mm.
const SLIT_MM: f32 = 2.5;
/// Neighbours of a ray, mm across it: the slit is no wider.
const ASIDE_MM: [[f32; 2]; 7] = [
    [0.0, 0.0],
    [0.0, 0.7],
    [0.0, -0.7],
    [0.0, 1.4],
    [0.0, -1.4],
    [-1.4, 0.0],
    [-2.8, 0.0],
];
/// Places on the mid line are looked up so far beside it, mm or degrees.
const ASIDE: f32 = 0.03;
/// Shrinking of the orbicularis oris towards its axis at full contraction.
const SPHINCTER_SHRINKING: f32 = 0.5;
/// Protrusion of the innermost fibre at 1, mm, and the share that the outermost takes of it.
const PROTRUSION_MM: f32 = 12.0;
const OUTER_PROTRUSION: f32 = 0.12;

/// Why the muscles cannot be painted; none of it is a user's doing.
#[derive(Debug, Error)]
pub enum MuscleError {
    /// The table is no JSON of the expected form.
    #[error("rig/shop/data/muscles.json: {0}; restore it from the repository")]
    Table(#[from] serde_json::Error),
    /// The skin is no surface.
    #[error("muscles have no skin to be painted on: {0}")]
    Skin(#[from] SurfaceError),
    /// A point is not over skin.
    #[error(
        "rig/shop/data/muscles.json: a point of {0:?} lies beside the skin; move it onto the face"
    )]
    Beside(Muscle),
}

/// A fibre of the table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    muscle: Muscle,
    points: Vec<[f32; 4]>,
    /// Sphincters: centre `[x, y, z, mandible]` and share of the protrusion.
    axis: Option<[f32; 4]>,
    protrusion: Option<f32>,
    /// Sphincters: share of the distance to the axis that is lost at full contraction.
    shrinking: Option<f32>,
    /// Whether a sphincter is one of two: it is then given whole; else from the mid line to the left.
    #[serde(default)]
    paired: bool,
    #[serde(default)]
    from: View,
    /// Muscles between bones: how far the middle comes outwards at full contraction.
    #[serde(default)]
    bulge_mm: f32,
}

#[derive(Clone, Copy, Default, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum View {
    #[default]
    Front,
    Axis,
}

/// The muscles under the reference head's `skin` over its `bones`.
///
/// # Errors
/// Only where the crate's own data is damaged, or the skin is not the reference head's.
pub fn paint<'a>(
    skin: &Mesh,
    bones: impl IntoIterator<Item = &'a Mesh>,
) -> Result<Vec<MuscleGrid>, MuscleError> {
    let rows: Vec<Row> = serde_json::from_str(TABLE)?;
    let canvas = Canvas {
        surface: Surface::new(&skin.positions, &skin.triangles)?,
        space: Space::new(bones),
    };
    let mut grids: Vec<(f32, MuscleGrid)> = Vec::new();
    for row in &rows {
        for side in [1.0, -1.0] {
            let whole = row.axis.is_some() && !row.paired;
            if whole && side < 0.0 {
                continue;
            }
            let left = |p: &[f32; 4]| canvas.point(row, p, side);
            let mut fibre: Vec<(GridPoint, Vec3)> = if whole {
                let right = row.points.iter().skip(1).rev();
                right
                    .map(|p| canvas.point(row, p, -1.0))
                    .collect::<Result<_, _>>()?
            } else {
                Vec::new()
            };
            for p in &row.points {
                fibre.push(left(p)?);
            }
            let (fibre, places): (Vec<GridPoint>, Vec<Vec3>) = fibre.into_iter().unzip();
            let axis = row.axis.map(|[x, y, z, mandible]| {
                let gradient = row.protrusion.unwrap_or(0.0);
                Axis::new(
                    vec3(x * side, y, z),
                    &places,
                    mandible,
                    PROTRUSION_MM * (OUTER_PROTRUSION + (1.0 - OUTER_PROTRUSION) * gradient),
                    row.shrinking.unwrap_or(SPHINCTER_SHRINKING),
                )
            });
            let known = grids
                .iter_mut()
                .find(|(s, g)| *s == side && g.muscle == row.muscle);
            if let Some((_, grid)) = known {
                grid.fibres.push(fibre);
                grid.axes.extend(axis);
            } else {
                let grid = MuscleGrid {
                    muscle: row.muscle,
                    fibres: vec![fibre],
                    axes: axis.into_iter().collect(),
                    bulge_mm: row.bulge_mm,
                };
                grids.push((side, grid));
            }
        }
    }
    Ok(grids.into_iter().map(|(_, grid)| grid).collect())
}

/// What is painted on.
struct Canvas {
    surface: Surface,
    space: Space,
}

impl Canvas {
    /// A point of the table on the skin of one side, and its place under it.
    fn point(&self, row: &Row, p: &[f32; 4], side: f32) -> Result<(GridPoint, Vec3), MuscleError> {
        let [first, y, depth_mm, mandible] = *p;
        // A ray along the mid plane would run between triangles.
        let first = if first == 0.0 { ASIDE } else { first };
        let (start, ray) = match row.from {
            View::Front => (vec3(first * side, y, FAR_MM), -Vec3::Z),
            View::Axis => {
                let (s, c) = first.to_radians().sin_cos();
                let out = vec3(s * side, 0.0, c);
                (vec3(0.0, y, AXIS_Z) + out * FAR_MM, -out)
            }
        };
        let hit = self
            .skin(start, ray, side)
            .ok_or(MuscleError::Beside(row.muscle))?;
        let at = SurfacePoint {
            vertices: self.surface.triangles()[hit.triangle as usize],
            shares: hit.barycentric,
        };
        let skin = at.on(self.surface.positions());
        let (inwards, space) = self.space.under(skin);
        let depth = (depth_mm / space).min(1.0);
        Ok((
            GridPoint {
                at,
                depth,
                mandible,
            },
            skin + inwards * (space * depth),
        ))
    }

    /// The skin that a ray meets from outside; beside the slit of the mouth where it would slip in.
    fn skin(&self, start: Vec3, ray: Vec3, side: f32) -> Option<Hit> {
        let facing = Facing {
            direction: -ray,
            cosine: 0.05,
        };
        let across = ray.cross(Vec3::Y).normalize_or(Vec3::X);
        let across = across * (across.x * side).signum();
        let by_the_slit = start.x.abs() < 30.0 && (-50.0..-20.0).contains(&start.y);
        let tries = if by_the_slit { ASIDE_MM.len() } else { 1 };
        let hits: Vec<(Hit, f32)> = ASIDE_MM[..tries]
            .iter()
            .filter_map(|[a, b]| {
                let from = start + across * *a + Vec3::Y * *b;
                let hit = self.surface.ray(from, ray, 2.0 * FAR_MM, facing)?;
                let way = (hit.point - from).dot(ray);
                Some((hit, way))
            })
            .collect();
        let nearest = hits
            .iter()
            .map(|(_, way)| *way)
            .fold(f32::INFINITY, f32::min);
        hits.into_iter()
            .find(|(_, way)| *way < nearest + SLIT_MM)
            .map(|(hit, _)| hit)
    }
}
