//! Short hair: a cap that grows out of the hairline. Simple on purpose; strands are the renderer's
//! work.

use glam::{Vec3, vec2, vec3};

use super::shapes::{self, ramp};
use super::surface::{BACK, Surface, chart_of};
use super::{crown, polyline};
use crate::{Body, Material, Part};

const COLUMNS: usize = 128;
const ROWS: usize = 20;
/// Thickness over the ears and over the crown, mm, and the way from the hairline in which it grows.
const SIDE_MM: f32 = 6.0;
const TOP_MM: f32 = 14.0;
const GROWTH_MM: f32 = 20.0;
/// How much higher it stands over the forehead, mm.
const QUIFF_MM: f32 = 7.0;

/// The cap. `uv`: u round the head, v from the hairline (0) to the crown (1).
pub(super) fn cap(surface: &Surface) -> Part {
    let edge: Vec<(f32, f32)> = surface
        .curves
        .hairline
        .iter()
        .map(|p| {
            let chart = chart_of(*p);
            (chart.x.clamp(0.0, BACK), chart.y)
        })
        .collect();
    let meridians: Vec<Vec<Vec3>> = (0..=COLUMNS / 2)
        .map(|i| meridian(surface, BACK * i as f32 / (COLUMNS / 2) as f32, &edge))
        .collect();
    let mesh = shapes::outward(shapes::grid(COLUMNS, ROWS, true, |u, v| {
        let column = ((2.0 * u - 1.0) * (COLUMNS / 2) as f32).round();
        let line = &meridians[column.abs() as usize];
        // Rows close together at the hairline, where the cap curves.
        let share = v * (0.45 + 0.55 * v);
        let length: f32 = line.windows(2).map(|w| w[0].distance(w[1])).sum();
        let skin =
            polyline::at_share(line, share) * vec3(if column < 0.0 { -1.0 } else { 1.0 }, 1.0, 1.0);
        let out = vec3(skin.x, (skin.y - 50.0).max(0.0), skin.z - 5.0).normalize_or(Vec3::Y);
        let full = SIDE_MM + (TOP_MM - SIDE_MM) * ramp(50.0, 125.0, skin.y);
        // Locks: uneven in two sizes, gone at the crown, where all columns meet.
        let fine = (u * 151.0 + 5.0 * v).sin() + (u * 67.0 - 11.0 * v).sin();
        let broad = (u * 39.0 + 2.5 * (v * 7.0).sin()).sin() * (v * 12.0 + u * 9.0).sin();
        let locks = (1.0 - v * v) * (0.4 * fine + 1.5 * broad * ramp(80.0, 115.0, skin.y));
        // Brushed up and to the subject's left at the front: no head of hair is a dome.
        let front = (-((u - 0.47) / 0.10).powi(2)).exp() * ramp(0.03, 0.22, v) * ramp(0.85, 0.3, v);
        let grown = 1.0 - (-share * length / GROWTH_MM).exp();
        skin + out * (0.25 + grown * (full + locks))
            + vec3(1.5, QUIFF_MM, 0.35 * QUIFF_MM) * (front * grown)
    }));
    let weight = vec![0.0; mesh.positions.len()];
    Part {
        name: "hair".into(),
        material: Material::Hair,
        mesh,
        bodies: vec![Body::Skull],
        weight,
    }
}

/// The skin from the hairline up to the vertex at one longitude (a length in the chart).
fn meridian(surface: &Surface, x: f32, edge: &[(f32, f32)]) -> Vec<Vec3> {
    const STEPS: usize = 40;
    let start = edge
        .windows(2)
        .find(|w| (w[0].0..=w[1].0).contains(&x))
        .map_or(110.0, |w| {
            let share = (x - w[0].0) / (w[1].0 - w[0].0).max(1e-4);
            w[0].1 + (w[1].1 - w[0].1) * share
        });
    let mut line: Vec<Vec3> = (0..=STEPS)
        .map(|i| {
            // Steps shorten towards the top, where the surface runs level.
            let left = 1.0 - i as f32 / (STEPS + 1) as f32;
            let y = crown::VERTEX.y - (crown::VERTEX.y - start) * left * left;
            surface.point(vec2(x, y))
        })
        .collect();
    line.push(crown::VERTEX);
    line
}
