//! The muscle table under the first reference head's surface.

use glam::{Vec3, vec3};
use serde::Deserialize;

use super::grid::inwards;
use super::{Contraction, Fibre};
use crate::Muscle;

const TABLE: &str = include_str!("../../shop/data/muscles.json");
/// Shrinking of the orbicularis oris towards its axis at full contraction.
const SPHINCTER_SHRINKING: f32 = 0.5;
/// Protrusion of the innermost fibre at 1, mm, and the share that the outermost takes of it.
const PROTRUSION_MM: f32 = 12.0;
const OUTER_PROTRUSION: f32 = 0.12;

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
    /// Sphincters: share lost at full contraction.
    shrinking: Option<f32>,
    /// Whether a sphincter is one of two: it is then given whole, for the left side.
    #[serde(default)]
    paired: bool,
    /// `axis`: the first number is the longitude about the head's axis, degrees, instead of x.
    #[serde(default)]
    from: View,
    /// Muscles between bones: how far the middle moves outwards at full contraction.
    bulge_mm: Option<f32>,
}

#[derive(Clone, Copy, Default, Deserialize, PartialEq)]
#[serde(rename_all = "snake_case")]
enum View {
    #[default]
    Front,
    Axis,
}

/// The fibres of the muscle table under a skin given by its places seen from the front (x, y) and
/// about the head's axis (longitude, y), both sides.
pub(crate) fn fibres(
    front: impl Fn(f32, f32) -> Vec3,
    round: impl Fn(f32, f32) -> Vec3,
) -> Result<Vec<Fibre>, serde_json::Error> {
    let rows: Vec<Row> = serde_json::from_str(TABLE)?;
    let mut fibres = Vec::new();
    for row in rows {
        let place = |side: f32, p: &[f32; 4]| {
            let skin = match row.from {
                View::Front => front(p[0], p[1]),
                View::Axis => round(p[0].to_radians(), p[1]),
            };
            (skin + inwards(skin) * p[2]) * vec3(side, 1.0, 1.0)
        };
        let gradient = row.protrusion.unwrap_or(0.0);
        let sphincter = |side: f32, axis: [f32; 4]| Contraction::Sphincter {
            centre: vec3(axis[0] * side, axis[1], axis[2]),
            mandible: axis[3],
            protrusion_mm: PROTRUSION_MM * (OUTER_PROTRUSION + (1.0 - OUTER_PROTRUSION) * gradient),
            shrinking: row.shrinking.unwrap_or(SPHINCTER_SHRINKING),
        };
        if let (Some(axis), false) = (row.axis, row.paired) {
            // Given from the mid line to the left corner; the right half is its mirror image.
            let right = row
                .points
                .iter()
                .skip(1)
                .rev()
                .map(|p| (place(-1.0, p), p[3]));
            let left = row.points.iter().map(|p| (place(1.0, p), p[3]));
            let (points, mandible) = right.chain(left).unzip();
            fibres.push(Fibre {
                muscle: row.muscle,
                contraction: sphincter(1.0, axis),
                points,
                mandible,
            });
            continue;
        }
        for side in [1.0, -1.0] {
            let points: Vec<Vec3> = row.points.iter().map(|p| place(side, p)).collect();
            let contraction = match (row.axis, row.bulge_mm) {
                (Some(axis), _) => sphincter(side, axis),
                (None, Some(bulge)) => Contraction::Belly {
                    out: -inwards(points[points.len() / 2]) * bulge,
                },
                (None, None) => Contraction::Linear,
            };
            let mandible = row.points.iter().map(|p| p[3]).collect();
            fibres.push(Fibre {
                muscle: row.muscle,
                contraction,
                points,
                mandible,
            });
        }
    }
    Ok(fibres)
}
