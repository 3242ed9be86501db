//! What lies under the strands: a closed cap that rises out of the skin inside the hairline. On sides and nape, where
//! hair is short and even, the cap is what is seen most: its columns run as the hair grows, so that the renderer
//! can lay strands along them.

use glam::{Vec3, vec2, vec3};
use mouthpiece_rig::Mesh;

use super::scalp::Scalp;
use super::style;
use crate::noise::{ramp, value};

/// An even number: strands are laid to and fro from column to column.
const COLUMNS: usize = 72;
const ROWS: usize = 14;
/// How far from the edge the last rows lie, rad (a hundredth is about a mm), and which share of `uv.y` is left to them.
const LAST: [f32; 3] = [0.11, 0.05, 0.0];
const LAST_SHARE: f32 = 0.2;
/// Share of the hair's height that it reaches, and less of it over the forehead, where locks stand up.
const SHARE: f32 = 0.83;
const LESS_IN_FRONT: f32 = 0.20;
/// How far it starts under the skin, and how deep within the hairline it is out of it, mm.
const SUNK_MM: f32 = 1.3;
const OUT_MM: f32 = 5.0;
/// How much light reaches it where hair is long, and where it is short; and less of it over the forehead.
const LIGHT: [f32; 2] = [0.82, 0.92];
const DARKER_IN_FRONT: f32 = 0.32;
/// How far columns turn back from the temples to the nape, rad, and between which angles from straight up.
const SWEEP: f32 = 0.62;
const SWEPT: [f32; 2] = [0.95, 1.85];

/// How far over the forehead a place of the long hair is, 0..1.
fn front(skin: Vec3) -> f32 {
    ramp(15.0, 55.0, skin.z) * style::top(skin)
}

/// Height of the cap over the skin, mm; below 0 it is hidden.
pub(super) fn height_mm(skin: Vec3, scalp: &Scalp) -> f32 {
    let share = SHARE - LESS_IN_FRONT * front(skin);
    let sunk = SUNK_MM * ramp(OUT_MM, 0.0, scalp.depth_mm(skin));
    style::height_mm(skin, scalp) * share - sunk
}

pub(super) fn grow(mesh: &mut Mesh, scalp: &Scalp) {
    let base = mesh.positions.len() as u32;
    for column in 0..COLUMNS {
        let turn = std::f32::consts::TAU * column as f32 / COLUMNS as f32;
        // From the crown down and, on the sides, backwards: the last place within the hair.
        let at = |polar: f32| {
            let swept = SWEEP * turn.sin() * turn.sin().abs() * ramp(SWEPT[0], SWEPT[1], polar);
            let out = vec3((turn + swept).sin(), 0.0, (turn + swept).cos());
            scalp.towards(out * polar.sin() + Vec3::Y * polar.cos())
        };
        let mut end = 0.3;
        while end < 2.9 && scalp.depth_mm(at(end)) > 0.0 {
            end += 0.01;
        }
        for row in 0..ROWS {
            // Those before the last few are even; the last ones know how near the edge is.
            let even = ROWS - LAST.len();
            let (polar, share) = if row < even {
                let share = (row as f32 + 0.5) / (even as f32 + 0.5);
                let upper = (end - LAST[0]).max(0.15);
                (upper * share.powf(0.9), share * (1.0 - LAST_SHARE))
            } else {
                let last = row - even;
                let share = 1.0 - LAST_SHARE + LAST_SHARE * last as f32 / (LAST.len() - 1) as f32;
                (end - LAST[last], share)
            };
            let skin = at(polar);
            let uneven = 0.88 + 0.24 * value(turn * 9.0 + 5.0, share * 9.0, 15);
            let shift = 0.24 * (value(turn * 7.0 + 50.0, share * 6.0, 16) - 0.5);
            let u = (column % 2) as f32 * 0.72 + 0.14 + shift;
            vertex(mesh, scalp, skin, vec2(u, share), uneven);
        }
    }
    let crown = mesh.positions.len() as u32;
    vertex(mesh, scalp, scalp.towards(Vec3::Y), vec2(0.5, 0.0), 1.0);
    let index = |column: usize, row: usize| base + ((column % COLUMNS) * ROWS + row) as u32;
    for column in 0..COLUMNS {
        mesh.triangles
            .push([crown, index(column, 0), index(column + 1, 0)]);
        for row in 0..ROWS - 1 {
            let (a, b) = (index(column, row), index(column + 1, row));
            let (c, d) = (index(column, row + 1), index(column + 1, row + 1));
            mesh.triangles.push([a, c, d]);
            mesh.triangles.push([a, d, b]);
        }
    }
}

/// One of its vertices over a place of the skin; `place` across a column and from the crown (0) to the edge (1).
fn vertex(mesh: &mut Mesh, scalp: &Scalp, skin: Vec3, place: glam::Vec2, uneven: f32) {
    let normal = scalp.normal(skin);
    let light = LIGHT[1] + (LIGHT[0] - LIGHT[1]) * style::top(skin) - DARKER_IN_FRONT * front(skin);
    mesh.positions.push(skin + normal * height_mm(skin, scalp));
    mesh.normals.push(normal);
    mesh.uvs.push(vec2(
        (super::EVEN as f32 + place.x) / super::COLUMNS as f32,
        -1.0 - place.y,
    ));
    mesh.occlusion.push((light * uneven).min(1.0));
}
