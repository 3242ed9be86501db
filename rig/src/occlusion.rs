//! Ambient occlusion at rest: what share of the sky each vertex sees past the head's own parts.
//!
//! Rays by obvhs against the whole head. The renderer darkens mouth corners, nostrils, lids and
//! ears with it; what moves open later is the renderer's business.

use glam::{Vec3, Vec3A};
use obvhs::ray::Ray;
use obvhs::triangle::Triangle;
use obvhs::{BvhBuildParams, bvh2::builder::build_bvh2_from_tris};

use crate::Head;

/// Rays a vertex; directions are a fixed spiral, so that every build gives the same head.
const RAYS: usize = 40;
/// What lies farther than this does not darken, mm.
const REACH_MM: f32 = 45.0;

/// Fills in the occlusion of the skin and of every part.
pub(crate) fn bake(head: &mut Head) {
    let mut triangles = Vec::new();
    let meshes = std::iter::once(&head.skin.mesh).chain(head.parts.iter().map(|p| &p.mesh));
    for mesh in meshes {
        triangles.extend(mesh.triangles.iter().map(|t| {
            let [v0, v1, v2] = t.map(|i| Vec3A::from(mesh.positions[i as usize]));
            Triangle { v0, v1, v2 }
        }));
    }
    let bvh = build_bvh2_from_tris(
        &triangles,
        BvhBuildParams::fast_build(),
        &mut std::time::Duration::default(),
    );
    let directions = spiral();
    let seen = |origin: Vec3, normal: Vec3| {
        let (side, up) = normal.any_orthonormal_pair();
        let start = Vec3A::from(origin + normal * 0.35);
        let mut open = 0;
        for d in &directions {
            let direction = Vec3A::from(side * d.x + up * d.y + normal * d.z);
            let ray = Ray::new(start, direction, 0.0, REACH_MM);
            let mut hit = obvhs::ray::RayHit::none();
            let blocked = bvh.ray_traverse(ray, &mut hit, |ray, id| {
                triangles[bvh.primitive_indices[id] as usize].intersect(ray)
            });
            open += usize::from(!blocked);
        }
        open as f32 / RAYS as f32
    };
    let bake_mesh = |mesh: &mut crate::Mesh| {
        let (positions, normals) = (&mesh.positions, &mesh.normals);
        let count = positions.len();
        let mut values = vec![1.0_f32; count];
        let half = count.div_ceil(2).max(1);
        // Both cores of a small machine; the result does not depend on how it is split.
        std::thread::scope(|scope| {
            for (chunk, start) in values.chunks_mut(half).zip((0..count).step_by(half)) {
                scope.spawn(move || {
                    for (k, value) in chunk.iter_mut().enumerate() {
                        *value = seen(positions[start + k], normals[start + k]);
                    }
                });
            }
        });
        mesh.occlusion = values;
    };
    bake_mesh(&mut head.skin.mesh);
    for part in &mut head.parts {
        bake_mesh(&mut part.mesh);
    }
}

/// Directions over the upper hemisphere, cosine-weighted, z up.
fn spiral() -> [Vec3; RAYS] {
    std::array::from_fn(|i| {
        let share = (i as f32 + 0.5) / RAYS as f32;
        let turn = i as f32 * 2.399_963; // the golden angle
        let radius = share.sqrt();
        Vec3::new(
            radius * turn.cos(),
            radius * turn.sin(),
            (1.0 - share).sqrt(),
        )
    })
}
