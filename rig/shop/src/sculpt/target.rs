//! Where the skin of the reference head lies: the surface of a mean human head, and the feature curves on it.
//! Data and sources: `rig/shop/data/README.md`. Only the left half is carried; the right one mirrors it.

use std::f32::consts::PI;

use glam::{Vec2, Vec3, vec2, vec3};
use serde::Deserialize;

use super::SculptError;
use crate::closest::{Facing, Surface};
use crate::mesh;

const HEAD: &[u8] = include_bytes!("../../data/mean_head.ply");
const CURVES: &str = include_str!("../../data/curves.json");
/// The chart's axis runs through x = 0 and this z, mm.
pub(super) const AXIS_Z: f32 = 10.45;
/// Height at the upper edge of the texture, and the height that it spans, mm.
const TOP: f32 = 150.0;
const SPAN: f32 = 256.0;
/// Turns longitude into a length, so that the chart is about as wide as the face is; mm.
const CHART_RADIUS: f32 = 95.0;
/// The chart point of the farthest longitude at a height: the back of the head.
pub(super) const BACK: f32 = CHART_RADIUS * PI;
/// No part of the head is farther from the axis, mm.
const FAR: f32 = 200.0;
/// Rays keep so far from the mid plane, mm.
const ASIDE_MM: f32 = 0.05;

/// A place of the chart in mm: x along the longitude (0 straight ahead), y the height.
pub(super) type ChartPoint = Vec2;

/// Feature curves of the left half; the names are those of `rig/shop/data/curves.json`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the names are the data's")]
pub(super) struct Curves {
    pub lip_contact_upper: Vec<Vec3>,
    pub lip_contact_lower: Vec<Vec3>,
    pub vermilion_upper: Vec<Vec3>,
    pub vermilion_lower: Vec<Vec3>,
    pub lid_margin_outer: Vec<Vec3>,
    pub lid_margin_inner: Vec<Vec3>,
    pub upper_lid_crease: Vec<Vec3>,
    pub nostril_rim: Vec<Vec3>,
    pub nostril_inner: Vec<Vec3>,
    pub brow_upper: Vec<Vec3>,
    pub brow_lower: Vec<Vec3>,
    pub hairline: Vec<Vec3>,
    pub alar_crease: Vec<Vec3>,
    pub jaw_line: Vec<Vec3>,
    pub helix_rim: Vec<Vec3>,
    pub helix_inner_edge: Vec<Vec3>,
    pub helix_outer_edge: Vec<Vec3>,
    pub antihelix_ridge: Vec<Vec3>,
    pub antitragus_ridge: Vec<Vec3>,
    pub tragus_ridge: Vec<Vec3>,
    pub concha_boundary: Vec<Vec3>,
    pub ear_attachment: Vec<Vec3>,
}

/// The mean head, to be sculpted onto.
pub(super) struct Target {
    pub surface: Surface,
    pub curves: Curves,
}

impl Target {
    pub(super) fn load() -> Result<Self, SculptError> {
        let half =
            mesh::read_bytes(mesh::Format::Ply, "rig/shop/data/mean_head.ply", HEAD, &())?.scan;
        let (mut positions, mut triangles) = (half.positions, half.triangles);
        let offset = positions.len() as u32;
        let mirrored: Vec<Vec3> = positions
            .iter()
            .map(|p| *p * vec3(-1.0, 1.0, 1.0))
            .collect();
        let on_seam: Vec<bool> = positions.iter().map(|p| p.x.abs() < 1e-4).collect();
        positions.extend(mirrored);
        let mirror = |i: u32| if on_seam[i as usize] { i } else { i + offset };
        let right: Vec<[u32; 3]> = triangles
            .iter()
            .map(|&[a, b, c]| [mirror(a), mirror(c), mirror(b)])
            .collect();
        triangles.extend(right);
        Ok(Self {
            surface: Surface::new(&positions, &triangles)?,
            curves: serde_json::from_str(CURVES)?,
        })
    }

    /// The skin at a place of the chart: the outermost of its layers, but behind and under the auricle the innermost.
    pub(super) fn point(&self, chart: ChartPoint) -> Vec3 {
        // The mirrored halves meet in the mid plane, where a ray could slip between them.
        let angle = longitude(chart.clamp(vec2(ASIDE_MM, -FAR), vec2(BACK - ASIDE_MM, FAR)));
        let out = vec3(angle.sin(), 0.0, angle.cos());
        let axis = vec3(0.0, chart.y, AXIS_Z);
        let faces_out = Facing {
            direction: out,
            cosine: 0.0,
        };
        let hit = if behind_auricle(chart) {
            self.surface.ray(axis, out, FAR, faces_out)
        } else {
            self.surface.ray(axis + out * FAR, -out, FAR, faces_out)
        };
        let near = |p: Vec3| self.surface.closest_facing(p, FAR, faces_out);
        let mut point = hit
            .or_else(|| near(axis + out * 90.0))
            .map_or(axis, |hit| hit.point);
        if chart.x < ASIDE_MM || chart.x > BACK - ASIDE_MM {
            point.x = 0.0;
        }
        point
    }

    /// The skin straight behind a place of the face seen from the front: x and y are kept.
    pub(super) fn seen_from_front(&self, x: f32, y: f32) -> Vec3 {
        self.ray_to(vec3(x, y, FAR), Vec3::NEG_Z)
            .unwrap_or(vec3(x, y, AXIS_Z))
    }

    /// The skin straight inwards of a place of the left ear seen from the side.
    pub(super) fn seen_from_side(&self, y: f32, z: f32) -> Option<Vec3> {
        self.ray_to(vec3(FAR, y, z), Vec3::NEG_X)
    }

    /// The skin straight below a place above the head.
    pub(super) fn seen_from_above(&self, x: f32, z: f32) -> Vec3 {
        let from = vec3(x.max(ASIDE_MM), FAR, z);
        let point = self.ray_to(from, Vec3::NEG_Y).unwrap_or(vec3(x, TOP, z));
        vec3(if x < ASIDE_MM { 0.0 } else { point.x }, point.y, point.z)
    }

    fn ray_to(&self, from: Vec3, direction: Vec3) -> Option<Vec3> {
        let facing = Facing {
            direction: -direction,
            cosine: 0.0,
        };
        self.surface
            .ray(from, direction, 2.0 * FAR, facing)
            .map(|hit| hit.point)
    }

    /// The nearest place of the skin.
    pub(super) fn beside(&self, p: Vec3) -> Vec3 {
        self.surface.closest(p, FAR).map_or(p, |hit| hit.point)
    }

    /// The nearest place of the skin whose outside looks about as `normal` does.
    pub(super) fn nearest(&self, p: Vec3, normal: Vec3, reach: f32) -> Option<Vec3> {
        let facing = Facing {
            direction: normal,
            cosine: 0.3,
        };
        self.surface
            .closest_facing(p, reach, facing)
            .map(|hit| hit.point)
    }
}

/// Where a look along the chart's radius meets the auricle before the head.
fn behind_auricle(chart: ChartPoint) -> bool {
    (105.0..200.0).contains(&chart.x) && (-32.0..48.0).contains(&chart.y)
}

/// The longitude of a chart point, radians.
pub(super) fn longitude(chart: ChartPoint) -> f32 {
    chart.x / CHART_RADIUS
}

/// The chart point that a point in space lies over.
pub(super) fn chart_of(point: Vec3) -> ChartPoint {
    vec2(point.x.atan2(point.z - AXIS_Z) * CHART_RADIUS, point.y)
}

/// Texture coordinates of a chart point, as [`Skin`](mouthpiece_rig::Skin) documents them.
pub(super) fn uv_of(chart: ChartPoint) -> Vec2 {
    vec2(0.5 + longitude(chart) / (2.0 * PI), (TOP - chart.y) / SPAN)
}
