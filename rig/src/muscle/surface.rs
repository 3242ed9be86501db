//! Muscles' surfaces, rebuilt from the control polygons of their fibres for drawing (HABER 4.2 aligns an
//! ellipsoid to each segment of a fibre; here neighbouring fibres share one smooth closed surface).
//!
//! The fibres of one painted grid become curves, the curves a sheet, and the sheet gets a thickness: an
//! ellipse across a single fibre, a flat band with round edges across several. Round sphincters close on
//! themselves. A muscle that shortens grows thicker by as much as keeps its volume (HABER 5.1: bulging);
//! one whose fibres keep their length bulges by as far as they have come out. Widths, thicknesses and
//! lengths of tendon are in `shape`. Skin does not feel these surfaces: it hangs on the fibres.

mod curve;
mod seat;
mod shape;
mod sheet;

use std::sync::Arc;

use glam::Vec3;

use crate::anatomy::Rays;
use crate::{Head, Mesh, Muscle};

use sheet::Sheet;

/// The surface of a muscle, or of its belly of one side.
#[derive(Clone, Debug)]
pub struct Belly {
    /// Of which.
    pub muscle: Muscle,
    /// A closed surface; `uv` as [`Material::Muscle`](crate::Material::Muscle) has it.
    pub mesh: Mesh,
}

/// How the surfaces of all of a head's muscles are made.
#[derive(Clone, Debug)]
pub struct MuscleSurfaces {
    sheets: Vec<Sheet>,
    /// What muscles do not sink into as they move.
    skull: Arc<Rays>,
    point_count: usize,
}

impl MuscleSurfaces {
    /// Measures the muscles of `head` at rest.
    #[must_use]
    pub fn new(head: &Head) -> Self {
        let rays = |names: &[&str]| {
            let bones = names.iter().filter_map(|name| head.part(name));
            Rays::new(bones.map(|b| (&b.mesh.positions[..], &b.mesh.triangles[..])))
        };
        let bones = rays(&["skull", "mandible"]);
        let rest: Vec<Vec3> = head
            .fibres
            .iter()
            .flat_map(|f| f.points.iter().copied())
            .collect();
        let mut starts = vec![0];
        for fibre in &head.fibres {
            starts.push(starts[starts.len() - 1] + fibre.points.len());
        }
        let mut sheets = Vec::new();
        let mut first = 0;
        for grid in &head.muscles {
            let last = (first + grid.fibres.len()).min(head.fibres.len());
            let ranges: Vec<_> = (first..last).map(|k| starts[k]..starts[k + 1]).collect();
            first = last;
            let Some(contraction) = last.checked_sub(1).map(|k| head.fibres[k].contraction) else {
                continue;
            };
            // A muscle in slips is a sheet each.
            let together = if shape::of(grid.muscle).slips {
                1
            } else {
                ranges.len().max(1)
            };
            for fibres in ranges.chunks(together) {
                let number = sheets.len();
                sheets.extend(Sheet::new(
                    grid.muscle,
                    contraction,
                    fibres,
                    &rest,
                    &bones,
                    number,
                ));
            }
        }
        Self {
            sheets,
            skull: Arc::new(rays(&["skull"])),
            point_count: rest.len(),
        }
    }

    /// The surfaces for the displaced control points of all fibres, in the order of [`Head::fibres`];
    /// none for points of another head.
    #[must_use]
    pub fn shaped(&self, points: &[Vec3]) -> Vec<Belly> {
        if points.len() != self.point_count {
            return Vec::new();
        }
        let shaped = self.sheets.iter().map(|s| s.shaped(points, &self.skull));
        shaped.collect()
    }
}

/// Volume that a closed mesh encloses, mm3; above 0 where its triangles face outwards.
#[must_use]
pub fn enclosed_volume(positions: &[Vec3], triangles: &[[u32; 3]]) -> f32 {
    triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|i| positions[i as usize].as_dvec3());
            a.dot(b.cross(c)) / 6.0
        })
        .sum::<f64>() as f32
}
