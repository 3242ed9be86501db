//! The scalp as hair needs it: how far the skin lies from a point inside the skull in every direction, and how
//! deep within the hairline a place is.

use glam::{Vec2, Vec3, vec2, vec3};
use mouthpiece_rig::Head;

use crate::lines::{CHART_MM, Hairline, waver_mm};

/// Middle of the cranium on the reference head, mm: all of the scalp is seen from it.
const CENTRE: Vec3 = vec3(0.0, 55.0, 5.0);
/// Cells of the map round the head and from the crown down.
const CELLS: (usize, usize) = (120, 60);
/// Axis of the skin's chart (see `Skin::mesh`), mm.
const AXIS_Z: f32 = 10.45;

/// Scalp, forehead and what else hair may lie on.
pub(super) struct Scalp {
    /// Distances from [`CENTRE`], mm, row by row from straight up.
    radius: Vec<f32>,
    hairline: Hairline,
}

impl Scalp {
    pub(super) fn of(head: &Head) -> Option<Self> {
        let hairline = Hairline::of(head)?;
        let mesh = &head.skin.mesh;
        let triangles: Vec<[Vec3; 3]> = mesh
            .triangles
            .iter()
            .map(|t| t.map(|i| mesh.positions[i as usize] - CENTRE))
            // The neck is never asked for; leaving it out halves the work.
            .filter(|t| t.iter().any(|p| p.y > -125.0))
            .collect();
        let mut radius = vec![f32::INFINITY; CELLS.0 * (CELLS.1 + 1)];
        for (cell, radius) in radius.iter_mut().enumerate() {
            let direction = direction(cell % CELLS.0, cell / CELLS.0);
            // The nearest skin: behind the ear, not the ear.
            *radius = triangles
                .iter()
                .filter_map(|t| hit(direction, t))
                .fold(f32::INFINITY, f32::min);
        }
        fill(&mut radius);
        Some(Self { radius, hairline })
    }

    /// Distance of the skin from the middle of the cranium in a direction, mm.
    fn radius(&self, direction: Vec3) -> f32 {
        use std::f32::consts::{PI, TAU};
        let d = direction.normalize_or(Vec3::Y);
        let turn = (d.x.atan2(d.z) / TAU + 0.5) * CELLS.0 as f32;
        let down = d.y.clamp(-1.0, 1.0).acos() / PI * CELLS.1 as f32;
        let (x, y) = (turn.floor(), down.floor().min(CELLS.1 as f32 - 1.0));
        let (fx, fy) = (turn - x, down - y);
        let at = |dx: usize, dy: usize| {
            self.radius[(y as usize + dy) * CELLS.0 + (x as usize + dx) % CELLS.0]
        };
        let upper = at(0, 0) + (at(1, 0) - at(0, 0)) * fx;
        let lower = at(0, 1) + (at(1, 1) - at(0, 1)) * fx;
        upper + (lower - upper) * fy
    }

    /// The skin under (or over) a place.
    pub(super) fn under(&self, place: Vec3) -> Vec3 {
        let d = (place - CENTRE).normalize_or(Vec3::Y);
        CENTRE + d * self.radius(d)
    }

    /// The skin in a direction from the middle of the cranium.
    pub(super) fn towards(&self, direction: Vec3) -> Vec3 {
        self.under(CENTRE + direction)
    }

    /// Outward normal at a place, over a finger's width.
    pub(super) fn normal(&self, place: Vec3) -> Vec3 {
        const STEP_MM: f32 = 6.0;
        let out = (place - CENTRE).normalize_or(Vec3::Y);
        let a = out.any_orthonormal_vector();
        let b = out.cross(a);
        let ends = |s: Vec3| self.under(place + s * STEP_MM) - self.under(place - s * STEP_MM);
        ends(a).cross(ends(b)).normalize_or(out)
    }

    /// How deep within the wavering edge of hair a place is, mm; below 0 outside.
    pub(super) fn depth_mm(&self, place: Vec3) -> f32 {
        let uv = chart_uv(place);
        self.hairline.depth_mm(uv) - waver_mm(uv * CHART_MM)
    }
}

/// Where on the skin's chart a place lies.
fn chart_uv(place: Vec3) -> Vec2 {
    let longitude = place.x.atan2(place.z - AXIS_Z);
    vec2(
        0.5 + longitude / std::f32::consts::TAU,
        (150.0 - place.y) / CHART_MM.y,
    )
}

fn direction(column: usize, row: usize) -> Vec3 {
    use std::f32::consts::{PI, TAU};
    let turn = (column as f32 / CELLS.0 as f32 - 0.5) * TAU;
    // Off the exact pole and off edges in the middle plane, where rays slip between triangles.
    let down = (row as f32 / CELLS.1 as f32 * PI).clamp(1e-3, PI - 1e-3);
    let turn = turn + 1.7e-4;
    vec3(down.sin() * turn.sin(), down.cos(), down.sin() * turn.cos())
}

/// Distance at which a ray from the origin meets a triangle.
fn hit(d: Vec3, [a, b, c]: &[Vec3; 3]) -> Option<f32> {
    // A quick refusal: most triangles lie elsewhere.
    if a.dot(d) <= 0.0 {
        return None;
    }
    let (e, f) = (*b - *a, *c - *a);
    let p = d.cross(f);
    let det = e.dot(p);
    if det.abs() < 1e-9 {
        return None;
    }
    let u = -a.dot(p) / det;
    let q = (-*a).cross(e);
    let v = d.dot(q) / det;
    let t = f.dot(q) / det;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 20.0).then_some(t)
}

/// Gives cells that no skin was found for (the neck's opening) what their neighbours above have.
fn fill(radius: &mut [f32]) {
    for cell in 0..radius.len() {
        if !radius[cell].is_finite() {
            radius[cell] = if cell >= CELLS.0 {
                radius[cell - CELLS.0]
            } else {
                90.0
            };
        }
    }
}
