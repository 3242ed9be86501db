//! The dark under the strands: a closed cap that rises out of the skin inside the hairline.

use glam::{Vec3, vec2, vec3};
use mouthpiece_rig::Mesh;

use super::scalp::Scalp;
use super::style;
use crate::noise::value;

const COLUMNS: usize = 56;
const ROWS: usize = 12;
/// Share of the hair's height that it reaches, and how far it starts under the skin, mm.
const SHARE: f32 = 0.60;
const SUNK_MM: f32 = 1.3;
/// How much light reaches it.
const LIGHT: f32 = 0.62;

pub(super) fn grow(mesh: &mut Mesh, scalp: &Scalp) {
    let base = mesh.positions.len() as u32;
    for column in 0..COLUMNS {
        let turn = std::f32::consts::TAU * column as f32 / COLUMNS as f32;
        let out = vec3(turn.sin(), 0.0, turn.cos());
        // From the crown down this meridian: the last place within the hair.
        let at = |polar: f32| scalp.towards(out * polar.sin() + Vec3::Y * polar.cos());
        let mut end = 0.3;
        while end < 2.9 && scalp.depth_mm(at(end)) > 0.0 {
            end += 0.01;
        }
        for row in 0..ROWS {
            let share = (row as f32 + 0.5) / (ROWS as f32 - 0.5);
            let skin = at(end * share.powf(0.9));
            let normal = scalp.normal(skin);
            mesh.positions
                .push(skin + normal * (style::height_mm(skin, scalp) * SHARE - SUNK_MM));
            mesh.normals.push(normal);
            mesh.uvs.push(vec2(0.0, -1.0));
            let uneven = 0.7 + 0.6 * value(turn * 9.0 + 5.0, share * 9.0, 15);
            mesh.occlusion.push(LIGHT * uneven);
        }
    }
    let crown = mesh.positions.len() as u32;
    let top = scalp.towards(Vec3::Y);
    mesh.positions
        .push(top + Vec3::Y * (style::height_mm(top, scalp) * SHARE - SUNK_MM));
    mesh.normals.push(Vec3::Y);
    mesh.uvs.push(vec2(0.0, -1.0));
    mesh.occlusion.push(LIGHT);
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
