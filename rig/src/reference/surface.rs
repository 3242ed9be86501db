//! Where the skin of the reference head lies: a radius round a vertical axis for every longitude
//! and height, and the feature curves on it. Data and sources: `rig/data/README.md`.

use std::f32::consts::PI;

use glam::{Vec2, Vec3, vec2, vec3};
use serde::Deserialize;

use super::ReferenceError;

const MAP: &[u8] = include_bytes!("../../data/surface.png");
const CURVES: &str = include_str!("../../data/curves.json");
/// The map's axis runs through x = 0 and this z, mm.
const AXIS_Z: f32 = 10.45;
const TOP: f32 = 150.0;
const SIDE: usize = 256;
/// Turns longitude into a length, so that the chart is about as wide as the face is; mm.
const CHART_RADIUS: f32 = 95.0;

/// A point of the chart in mm: x along the longitude (0 straight ahead), y the height.
pub(super) type ChartPoint = Vec2;

/// Feature curves of the left half; the names are those of `rig/data/curves.json`.
#[derive(Deserialize)]
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
}

/// The surface of the left half; the right half is its mirror image.
pub(super) struct Surface {
    radius: Vec<f32>,
    pub curves: Curves,
}

impl Surface {
    pub(super) fn load() -> Result<Self, ReferenceError> {
        let mut reader = png::Decoder::new(std::io::Cursor::new(MAP)).read_info()?;
        let mut bytes = vec![0; reader.output_buffer_size().unwrap_or(0)];
        reader.next_frame(&mut bytes)?;
        let radius: Vec<f32> = bytes
            .chunks_exact(2)
            .map(|b| f32::from(u16::from_be_bytes([b[0], b[1]])) * 0.01)
            .collect();
        if radius.len() != SIDE * SIDE {
            return Err(ReferenceError::MapSize(radius.len()));
        }
        Ok(Self {
            radius,
            curves: serde_json::from_str(CURVES)?,
        })
    }

    /// Radius at a longitude (radians, mirrored where negative) and height; bilinear.
    fn radius(&self, longitude: f32, y: f32) -> f32 {
        let column = (longitude.abs() / PI * SIDE as f32 - 0.5).clamp(0.0, SIDE as f32 - 1.0);
        // The map's top rows are empty: above them the last full one holds.
        let row = (TOP - y).clamp(6.0, SIDE as f32 - 1.0);
        let (c, r) = (column.floor() as usize, row.floor() as usize);
        let (fc, fr) = (column.fract(), row.fract());
        let at = |r: usize, c: usize| self.radius[r.min(SIDE - 1) * SIDE + c.min(SIDE - 1)];
        let upper = at(r, c) * (1.0 - fc) + at(r, c + 1) * fc;
        let lower = at(r + 1, c) * (1.0 - fc) + at(r + 1, c + 1) * fc;
        upper * (1.0 - fr) + lower * fr
    }

    /// The point of the skin at a place of the chart.
    pub(super) fn point(&self, chart: ChartPoint) -> Vec3 {
        self.raised(chart, 0.0)
    }

    /// The point `height` mm above the skin (along the map's radius).
    pub(super) fn raised(&self, chart: ChartPoint, height: f32) -> Vec3 {
        let longitude = longitude(chart);
        let radius = self.radius(longitude, chart.y) + height;
        vec3(
            radius * longitude.sin(),
            chart.y,
            AXIS_Z + radius * longitude.cos(),
        )
    }

    /// The skin straight behind a point of the face seen from the front: x and y are kept.
    pub(super) fn seen_from_front(&self, x: f32, y: f32) -> Vec3 {
        let mut angle = (x / 100.0).clamp(-1.5, 1.5);
        for _ in 0..20 {
            let radius = self.radius(angle, y);
            angle += 0.7 * ((x / radius).clamp(-1.0, 1.0).asin() - angle);
        }
        self.point(vec2(angle * CHART_RADIUS, y))
    }
}

/// The longitude of a chart point, radians.
pub(super) fn longitude(chart: ChartPoint) -> f32 {
    chart.x / CHART_RADIUS
}

/// The chart point of the farthest longitude at a height: the back of the head.
pub(super) const BACK: f32 = CHART_RADIUS * PI;

/// The chart point that a point in space lies over.
pub(super) fn chart_of(point: Vec3) -> ChartPoint {
    vec2(point.x.atan2(point.z - AXIS_Z) * CHART_RADIUS, point.y)
}

/// Texture coordinates of a chart point, as [`Skin`](crate::Skin) documents them.
pub(super) fn uv_of(chart: ChartPoint) -> Vec2 {
    vec2(0.5 + longitude(chart) / (2.0 * PI), (TOP - chart.y) / 256.0)
}
