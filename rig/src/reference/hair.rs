//! Short hair: a cap over the scalp that rises from the hairline. Simple on purpose; strands are the
//! renderer's (and a later issue's) work.

use glam::{Vec3, vec2, vec3};

use super::shapes;
use super::surface::{BACK, Surface, chart_of};
use crate::{Body, Material, Part};

const COLUMNS: usize = 144;
const ROWS: usize = 30;
/// Thickness over the crown, mm.
const THICKNESS: f32 = 13.0;

/// The cap. `uv`: u round the head, v from the hairline (0) to the crown (1).
pub(super) fn cap(surface: &Surface) -> Part {
    let line = lower_edge(surface);
    let top = vec3(0.0, 145.0 + THICKNESS * 0.9, 2.0);
    let mesh = shapes::outward(shapes::grid(COLUMNS, ROWS, true, |u, v| {
        let around = 2.0 * u - 1.0;
        let start = edge_at(&line, around.abs());
        let chart_x = around * BACK;
        let side = (around.abs() * std::f32::consts::PI).sin().powi(2);
        let rim = 112.0_f32;
        // Up the side of the head along the surface, then over the top along a dome.
        let thick = (0.4
            + THICKNESS * shapes::ramp(0.0, 0.30, v) * (0.62 + 0.38 * shapes::ramp(0.3, 0.8, v)))
            * (1.0 - 0.38 * side * (1.0 - shapes::ramp(0.4, 0.7, v)));
        let share = v / 0.62;
        let wave = 0.7
            * ((u * 61.0 + 9.0 * v).sin() * (v * 23.0 + 4.0 * (u * 17.0).sin()).sin())
            * shapes::ramp(0.03, 0.2, v);
        if share <= 1.0 {
            let y = start + (rim - start).max(2.0) * share;
            surface.raised(vec2(chart_x, y), thick + wave)
        } else {
            let base = surface.raised(vec2(chart_x, start + (rim - start).max(2.0)), thick + wave);
            let s = (share - 1.0) / (1.0 / 0.62 - 1.0);
            let turn = s * std::f32::consts::FRAC_PI_2;
            vec3(
                top.x + (base.x - top.x) * turn.cos(),
                base.y + (top.y - base.y) * turn.sin(),
                top.z + (base.z - top.z) * turn.cos(),
            )
        }
    }));
    let weight = vec![0.0; mesh.positions.len()];
    Part {
        name: "hair",
        material: Material::Hair,
        mesh,
        bodies: [Body::Skull, Body::Skull],
        weight,
    }
}

/// Height of the hairline by share of the way round (0 the front, 1 the back): the upper branch in
/// front of and over the ear, the lower one behind it.
fn lower_edge(surface: &Surface) -> Vec<f32> {
    let line: Vec<Vec3> = surface.curves.hairline.clone();
    (0..=90)
        .map(|i| {
            let share = i as f32 / 90.0;
            let x = share * BACK;
            let mut heights: Vec<f32> = line
                .windows(2)
                .filter_map(|w| {
                    let (a, b) = (chart_of(w[0]), chart_of(w[1]));
                    ((a.x <= x) != (b.x <= x)).then(|| a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x))
                })
                .collect();
            heights.sort_by(f32::total_cmp);
            let highest =
                heights
                    .last()
                    .copied()
                    .unwrap_or(if share < 0.5 { 110.0 } else { -61.5 });
            // Over the ear the cap ends above it; the sideburn is painted, not modelled.
            highest.max(if share < 0.60 { 44.0 } else { -58.0 })
        })
        .collect()
}

fn edge_at(line: &[f32], share: f32) -> f32 {
    let at = share * (line.len() - 1) as f32;
    let i = (at as usize).min(line.len() - 2);
    line[i] + (line[i + 1] - line[i]) * (at - i as f32)
}
