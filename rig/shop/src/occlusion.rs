//! Ambient occlusion at rest: what share of the sky each vertex sees past the head's own parts.
//!
//! Rays by obvhs against the whole head. The renderer darkens mouth corners, nostrils, lids and
//! ears with it; what moves open later is the renderer's business.

use glam::{Vec3, Vec3A};
use obvhs::bvh2::Bvh2;
use obvhs::ray::Ray;
use obvhs::triangle::Triangle;
use obvhs::{BvhBuildParams, bvh2::builder::build_bvh2_from_tris};

use mouthpiece_rig::{Head, Material, Mesh, Part};

/// Rays a vertex; directions are a fixed spiral, so that every build gives the same head.
const RAYS: usize = 32;
/// What lies farther than this does not darken, mm.
const REACH_MM: f32 = 45.0;

/// Fills in the occlusion of the skin and of every part.
///
/// What lies inside the mouth is shaded by its own kind only: the lips are shut at rest and would
/// leave it black for good. How much light an open mouth lets in is the renderer's business.
pub(crate) fn bake(head: &mut Head) {
    let inside = |part: &Part| {
        matches!(
            part.material,
            Material::Teeth | Material::Gums | Material::Tongue | Material::Cavity
        )
    };
    let blocks = |part: &&Part| inside(part) && part.material != Material::Cavity;
    // Strands let light through; the colour map has the dark of their roots.
    let solid = |m: Material| !matches!(m, Material::Bone | Material::Hair | Material::Lash);
    let seen = |part: &&Part| !inside(part) && solid(part.material);
    let whole = Scene::new(
        std::iter::once(&head.skin.mesh).chain(head.parts.iter().filter(seen).map(|p| &p.mesh)),
    );
    let mouth = Scene::new(head.parts.iter().filter(blocks).map(|p| &p.mesh));
    let directions = spiral();
    whole.bake(&mut head.skin.mesh, &directions);
    // Hair and cloth keep their light: their own shading darkens them.
    let shaded = |part: &&mut Part| {
        !matches!(
            part.material,
            Material::Hair | Material::Cloth | Material::Bone
        )
    };
    for part in head.parts.iter_mut().filter(shaded) {
        let scene = if inside(part) { &mouth } else { &whole };
        scene.bake(&mut part.mesh, &directions);
    }
}

/// What can stand in the way of a ray.
struct Scene {
    triangles: Vec<Triangle>,
    bvh: Bvh2,
}

impl Scene {
    fn new<'a>(meshes: impl Iterator<Item = &'a Mesh>) -> Self {
        let mut triangles = Vec::new();
        for mesh in meshes {
            triangles.extend(mesh.triangles.iter().map(|t| {
                let [v0, v1, v2] = t.map(|i| Vec3A::from(mesh.positions[i as usize]));
                Triangle { v0, v1, v2 }
            }));
        }
        let mut spent = std::time::Duration::default();
        let bvh = build_bvh2_from_tris(&triangles, BvhBuildParams::fast_build(), &mut spent);
        Self { triangles, bvh }
    }

    /// Share of `directions` about `normal` in which nothing stands near.
    fn open(&self, origin: Vec3, normal: Vec3, directions: &[Vec3; RAYS]) -> f32 {
        let (side, up) = normal.any_orthonormal_pair();
        let start = Vec3A::from(origin + normal * 0.35);
        let free = directions.iter().filter(|d| {
            let direction = Vec3A::from(side * d.x + up * d.y + normal * d.z);
            let ray = Ray::new(start, direction, 0.0, REACH_MM);
            self.bvh.ray_traverse_miss(ray, |ray, id| {
                self.triangles[self.bvh.primitive_indices[id] as usize].intersect(ray)
            })
        });
        free.count() as f32 / RAYS as f32
    }

    /// Dims the occlusion of every vertex of `mesh` by what stands round it, on two threads: the result does not depend on
    /// how the work is split.
    fn bake(&self, mesh: &mut Mesh, directions: &[Vec3; RAYS]) {
        let (positions, normals) = (&mesh.positions, &mesh.normals);
        let count = positions.len();
        let mut values = vec![1.0_f32; count];
        let half = count.div_ceil(2).max(1);
        std::thread::scope(|scope| {
            for (chunk, start) in values.chunks_mut(half).zip((0..count).step_by(half)) {
                scope.spawn(move || {
                    for (k, value) in chunk.iter_mut().enumerate() {
                        *value = self.open(positions[start + k], normals[start + k], directions);
                    }
                });
            }
        });
        let lit = between_neighbours(&mesh.triangles, &values);
        for (kept, open) in mesh.occlusion.iter_mut().zip(lit) {
            *kept *= open;
        }
    }
}

/// A vertex that lies in a fold too narrow for the mesh sees nothing by itself and would be a black dot: it is lit by
/// at least this share of what its neighbours are.
const LEAST_OF_NEIGHBOURS: f32 = 0.75;

fn between_neighbours(triangles: &[[u32; 3]], values: &[f32]) -> Vec<f32> {
    let mut sums = vec![(0.0_f32, 0.0_f32); values.len()];
    for t in triangles {
        for k in 0..3 {
            let (sum, count) = &mut sums[t[k] as usize];
            *sum += values[t[(k + 1) % 3] as usize] + values[t[(k + 2) % 3] as usize];
            *count += 2.0;
        }
    }
    let least = |(sum, count): &(f32, f32)| LEAST_OF_NEIGHBOURS * sum / count.max(1.0);
    let pairs = values.iter().zip(&sums);
    pairs.map(|(value, sums)| value.max(least(sums))).collect()
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
