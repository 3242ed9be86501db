//! A head's parts as vertex and index buffers; the skin is in `surface`.

use glam::Vec3;
use mouthpiece_rig::{Head, Material, Mesh, Part};

use crate::gpu_data::{PartVertex, octahedral, unorm};
use crate::hairs;

/// All parts of one material in one pair of buffers.
#[derive(Debug, Default)]
pub(crate) struct PartGeometry {
    pub(crate) vertices: Vec<PartVertex>,
    pub(crate) indices: Vec<u32>,
}

impl PartGeometry {
    /// For pictures of that many samples a pixel.
    pub(crate) fn of(head: &Head, material: Material, samples: u32) -> Self {
        let mut geometry = Self::default();
        for part in head.parts.iter().filter(|p| p.material == material) {
            if material == Material::Hair {
                geometry.add(part, &hairs::dressed(head, part, samples > 1));
            } else {
                geometry.add(part, &part.mesh);
            }
        }
        geometry
    }

    /// Adds a part with the mesh that it is drawn as.
    fn add(&mut self, part: &Part, mesh: &Mesh) {
        let base = self.vertices.len() as u32;
        let strands = match part.material {
            Material::Hair => Some(strand_directions(mesh)),
            Material::Lash => Some(lash_sides(mesh)),
            _ => None,
        };
        for (i, p) in mesh.positions.iter().enumerate() {
            let (bodies, share) = part.between(part.weight.get(i).copied().unwrap_or_default());
            let [tx, ty] = strands.as_ref().map_or([0, 0], |d| octahedral(d[i]));
            let light = match (&strands, part.material) {
                (Some(sides), Material::Lash) => sides[i].length() / LASH_HALF_MM,
                _ => mesh.occlusion[i],
            };
            self.vertices.push(PartVertex {
                rest: p.to_array(),
                normal: mesh.normals[i].to_array(),
                uv: mesh.uvs[i].to_array(),
                shares: [unorm(light), unorm(share), tx, ty],
                bodies: [bodies[0] as u8, bodies[1] as u8, 0, 0],
            });
        }
        // Of an eyeball only the front is ever seen.
        let seen = |t: &&[u32; 3]| {
            part.material != Material::Eye
                || t.iter()
                    .any(|i| mesh.uvs[*i as usize].length() < EYE_SEEN_RADII)
        };
        self.indices.extend(
            mesh.triangles
                .iter()
                .filter(seen)
                .flatten()
                .map(|i| base + i),
        );
    }
}

/// Iris radii from the pupil at which the ball is behind the lids whatever the gaze.
const EYE_SEEN_RADII: f32 = 3.4;

/// Half a lash's width that is written as 1, mm. Keep in step with shaders/lash.wgsl.
const LASH_HALF_MM: f32 = 0.5;

/// From the middle of its blade to each vertex of a lash: they come in pairs across it (see the head shop's `lashes`).
fn lash_sides(mesh: &Mesh) -> Vec<Vec3> {
    let p = &mesh.positions;
    (0..p.len())
        .map(|i| {
            let other = p.get(i ^ 1).copied().unwrap_or(p[i]);
            0.5 * (p[i] - other)
        })
        .collect()
}

/// Which way the strands run at each vertex: where the texture's v grows; down where it does not say.
fn strand_directions(mesh: &Mesh) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    for t in &mesh.triangles {
        let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
        let [s, u, w] = t.map(|i| mesh.uvs[i as usize]);
        let (e, f) = (u - s, w - s);
        let area = e.perp_dot(f);
        if area.abs() < 1e-12 {
            continue;
        }
        let along = ((c - a) * e.x - (b - a) * f.x) * area.signum();
        for &i in t {
            sums[i as usize] += along.normalize_or_zero();
        }
    }
    sums.iter()
        .zip(&mesh.normals)
        .map(|(sum, n)| {
            let down = Vec3::NEG_Y - *n * n.dot(Vec3::NEG_Y);
            sum.normalize_or(down.normalize_or(Vec3::NEG_Z))
        })
        .collect()
}
