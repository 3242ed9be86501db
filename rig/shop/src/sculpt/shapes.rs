//! Small helpers to build meshes of parts: grids over two parameters, normals, ramps.

use glam::{Vec2, Vec3, vec2};

use mouthpiece_rig::Mesh;
use mouthpiece_rig::normals;

pub(super) use crate::noise::ramp;

/// A grid of `columns` x `rows` cells over (u, v) in 0..1, joined at u = 0 and 1 where `closed`.
/// Seen from the side where u grows to the right and v downwards, triangles are counter-clockwise.
pub(super) fn grid(
    columns: usize,
    rows: usize,
    closed: bool,
    at: impl Fn(f32, f32) -> Vec3,
) -> Mesh {
    let stride = if closed { columns } else { columns + 1 };
    let mut mesh = Mesh::default();
    for row in 0..=rows {
        for column in 0..stride {
            let uv = vec2(column as f32 / columns as f32, row as f32 / rows as f32);
            mesh.positions.push(at(uv.x, uv.y));
            mesh.uvs.push(uv);
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let index = |r: usize, c: usize| (r * stride + c % stride) as u32;
            let (a, b) = (index(row, column), index(row, column + 1));
            let (c, d) = (index(row + 1, column), index(row + 1, column + 1));
            mesh.triangles.push([a, c, d]);
            mesh.triangles.push([a, d, b]);
        }
    }
    finish(mesh)
}

/// Fills in normals and occlusion of a mesh that has positions, uvs and triangles.
pub(super) fn finish(mut mesh: Mesh) -> Mesh {
    mesh.triangles.retain(|t| {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        (b - a).cross(c - a).length() > 1e-5
    });
    mesh.normals = normals(&mesh.positions, &mesh.triangles);
    mesh.occlusion = vec![1.0; mesh.positions.len()];
    mesh
}

/// Turns a roughly convex mesh so that its triangles face away from its middle.
pub(super) fn outward(mut mesh: Mesh) -> Mesh {
    let middle = mesh.positions.iter().sum::<Vec3>() / mesh.positions.len().max(1) as f32;
    let facing: f32 = mesh
        .positions
        .iter()
        .zip(&mesh.normals)
        .map(|(p, n)| (*p - middle).dot(*n))
        .sum();
    if facing < 0.0 {
        for t in &mut mesh.triangles {
            t.swap(1, 2);
        }
        for n in &mut mesh.normals {
            *n = -*n;
        }
    }
    mesh
}

/// Adds `other` to `mesh`.
pub(super) fn append(mesh: &mut Mesh, other: &Mesh) {
    let offset = mesh.positions.len() as u32;
    mesh.positions.extend(&other.positions);
    mesh.normals.extend(&other.normals);
    mesh.uvs.extend(&other.uvs);
    mesh.occlusion.extend(&other.occlusion);
    mesh.triangles
        .extend(other.triangles.iter().map(|t| t.map(|i| i + offset)));
}

/// The mirror image of a mesh, left for right.
pub(super) fn mirrored(mesh: &Mesh) -> Mesh {
    let flip = |p: &Vec3| Vec3::new(-p.x, p.y, p.z);
    Mesh {
        positions: mesh.positions.iter().map(flip).collect(),
        normals: mesh.normals.iter().map(flip).collect(),
        uvs: mesh.uvs.iter().map(|uv| Vec2::new(-uv.x, uv.y)).collect(),
        occlusion: mesh.occlusion.clone(),
        triangles: mesh.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
    }
}
