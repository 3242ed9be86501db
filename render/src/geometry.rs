//! A head's meshes as vertex and index buffers, and the skin's normals of each frame.

use glam::{Vec2, Vec3};
use mouthpiece_rig::{Head, Material, Mesh, Part};

use crate::gpu_data::{PartVertex, SkinMoving, SkinStill, octahedral, unorm};
use crate::maps;
use crate::maps::hairline::Hairline;

/// The skin as it is drawn: the head's vertices, then copies of those on the chart's seam, so that
/// no triangle runs the wrong way round the chart.
#[derive(Debug)]
pub(crate) struct SkinGeometry {
    triangles: Vec<[u32; 3]>,
    /// Which vertex each copy repeats.
    copies: Vec<u32>,
    /// Filled anew each frame.
    pub(crate) moving: Vec<SkinMoving>,
    pub(crate) still: Vec<SkinStill>,
    pub(crate) indices: Vec<u32>,
    /// The triangles round the mouth, whose backs show through it.
    pub(crate) inside: Vec<u32>,
    normals: Vec<Vec3>,
}

impl SkinGeometry {
    pub(crate) fn of(head: &Head) -> Self {
        let skin = &head.skin;
        let mesh = &skin.mesh;
        let vertex = |i: usize, uv: Vec2| SkinStill {
            uv: uv.to_array(),
            shares: [
                unorm(skin.weight[i]),
                unorm(skin.vermilion[i]),
                unorm(skin.wet[i]),
                unorm(mesh.occlusion[i]),
            ],
        };
        let mut still: Vec<SkinStill> = (0..mesh.positions.len())
            .map(|i| vertex(i, mesh.uvs[i]))
            .collect();
        let mut copies = Vec::new();
        let mut copy_of = std::collections::HashMap::new();
        let mut indices = Vec::with_capacity(mesh.triangles.len() * 3);
        let covered = under_hair(head);
        for t in &mesh.triangles {
            if t.iter().all(|&i| covered[i as usize]) {
                continue;
            }
            let u = t.map(|i| mesh.uvs[i as usize].x);
            let high = u[0].max(u[1]).max(u[2]);
            for (i, u) in t.iter().zip(u) {
                if high - u > 0.5 {
                    indices.push(*copy_of.entry(*i).or_insert_with(|| {
                        let at = *i as usize;
                        still.push(vertex(at, mesh.uvs[at] + Vec2::X));
                        copies.push(*i);
                        still.len() as u32 - 1
                    }));
                } else {
                    indices.push(*i);
                }
            }
        }
        let mut geometry = Self {
            triangles: mesh.triangles.clone(),
            moving: vec![SkinMoving::default(); still.len()],
            copies,
            still,
            indices,
            inside: inside_indices(head),
            normals: vec![Vec3::ZERO; mesh.positions.len()],
        };
        geometry.set(&mesh.positions);
        geometry
    }

    /// How many vertices the head's skin has.
    pub(crate) fn vertex_count(&self) -> usize {
        self.normals.len()
    }

    /// Takes over positions and computes normals, weighted by triangle area. Allocates nothing.
    pub(crate) fn set(&mut self, positions: &[Vec3]) {
        debug_assert_eq!(positions.len(), self.normals.len());
        self.normals.fill(Vec3::ZERO);
        for t in &self.triangles {
            let [a, b, c] = t.map(|i| positions[i as usize]);
            let area = (b - a).cross(c - a);
            for &i in t {
                self.normals[i as usize] += area;
            }
        }
        for ((out, p), n) in self.moving.iter_mut().zip(positions).zip(&self.normals) {
            *out = SkinMoving {
                position: p.to_array(),
                normal: n.normalize_or(Vec3::Z).to_array(),
            };
        }
        let own = self.normals.len();
        for (k, &source) in self.copies.iter().enumerate() {
            self.moving[own + k] = self.moving[source as usize];
        }
    }
}

/// Millimetres within the hairline at which skin is never seen.
const COVERED_MM: f32 = 15.0;

/// Where the skin's back can show through the mouth: the cheeks on both sides of it. Distance from the
/// middle of the mouth, mm: least across, most up and down, most behind.
const CHEEK_ACROSS_MM: f32 = 24.0;
const CHEEK_HEIGHT_MM: f32 = 34.0;
const CHEEK_DEPTH_MM: f32 = 75.0;

fn inside_indices(head: &Head) -> Vec<u32> {
    let mouth = maps::landmarks::Landmarks::of(head).mouth;
    let mesh = &head.skin.mesh;
    let near = |i: &u32| {
        let to = mesh.positions[*i as usize] - mouth;
        to.x.abs() > CHEEK_ACROSS_MM && to.y.abs() < CHEEK_HEIGHT_MM && -to.z < CHEEK_DEPTH_MM
    };
    mesh.triangles
        .iter()
        .filter(|t| t.iter().all(near))
        .flatten()
        .copied()
        .collect()
}

/// Which skin vertices lie deep under hair: triangles of them need not be drawn.
fn under_hair(head: &Head) -> Vec<bool> {
    let has_hair = head.parts.iter().any(|p| p.material == Material::Hair);
    let hairline = if has_hair { Hairline::of(head) } else { None };
    let depth = |uv: &Vec2| hairline.as_ref().map_or(0.0, |h| h.depth_mm(*uv));
    head.skin
        .mesh
        .uvs
        .iter()
        .map(|uv| depth(uv) > COVERED_MM)
        .collect()
}

/// All parts of one material in one pair of buffers.
#[derive(Debug, Default)]
pub(crate) struct PartGeometry {
    pub(crate) vertices: Vec<PartVertex>,
    pub(crate) indices: Vec<u32>,
}

impl PartGeometry {
    pub(crate) fn of(head: &Head, material: Material) -> Self {
        let mut geometry = Self::default();
        for part in head.parts.iter().filter(|p| p.material == material) {
            geometry.add(part);
        }
        geometry
    }

    fn add(&mut self, part: &Part) {
        let mesh = &part.mesh;
        let base = self.vertices.len() as u32;
        let strands = (part.material == Material::Hair).then(|| strand_directions(mesh));
        for (i, p) in mesh.positions.iter().enumerate() {
            let (bodies, share) = part.between(part.weight[i]);
            let [tx, ty] = strands.as_ref().map_or([0, 0], |d| octahedral(d[i]));
            self.vertices.push(PartVertex {
                rest: p.to_array(),
                normal: mesh.normals[i].to_array(),
                uv: mesh.uvs[i].to_array(),
                shares: [unorm(mesh.occlusion[i]), unorm(share), tx, ty],
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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{vec2, vec3};

    /// A strip round the bald back of the head, from u 0.9 over the seam to 0.1.
    fn strip() -> Head {
        let mut head = Head::reference().unwrap();
        head.parts.clear();
        let us = [0.9_f32, 0.97, 0.04, 0.1];
        let place = |u: f32, y: f32| {
            let turn = (u - 0.5) * std::f32::consts::TAU;
            vec3(turn.sin(), y, turn.cos()) * 90.0
        };
        let skin = &mut head.skin;
        skin.mesh.positions = us
            .iter()
            .flat_map(|&u| [place(u, 0.0), place(u, 0.2)])
            .collect();
        skin.mesh.uvs = us
            .iter()
            .flat_map(|&u| [vec2(u, 0.5), vec2(u, 0.4)])
            .collect();
        let n = skin.mesh.positions.len();
        skin.mesh.normals = vec![Vec3::Z; n];
        skin.mesh.occlusion = vec![1.0; n];
        (skin.weight, skin.vermilion, skin.wet) = (vec![1.0; n], vec![0.0; n], vec![0.0; n]);
        skin.mesh.triangles = (0..3)
            .flat_map(|k| [[2 * k, 2 * k + 2, 2 * k + 3], [2 * k, 2 * k + 3, 2 * k + 1]])
            .collect();
        head
    }

    #[test]
    fn no_drawn_triangle_runs_the_wrong_way_round_the_chart() {
        let geometry = SkinGeometry::of(&strip());
        for t in geometry.indices.chunks_exact(3) {
            let u: Vec<f32> = t
                .iter()
                .map(|&i| geometry.still[i as usize].uv[0])
                .collect();
            let span = u.iter().cloned().fold(f32::MIN, f32::max)
                - u.iter().cloned().fold(f32::MAX, f32::min);
            assert!(span < 0.5, "a triangle spans {span} of the chart");
        }
        assert_eq!(
            geometry.still.len(),
            8 + 2,
            "both low vertices behind the seam are copied"
        );
        let (last, source) = (geometry.moving[9], geometry.copies[1]);
        assert_eq!(last, geometry.moving[source as usize]);
    }
}
