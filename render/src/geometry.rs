//! A head's meshes as vertex and index buffers, and the skin's normals of each frame.

use glam::{Vec2, Vec3};
use mouthpiece_rig::{Head, Material, Mesh, Part};

use crate::gpu_data::{PartVertex, SkinMoving, SkinStill, unorm};
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
        let (edge, normals) = match part.material {
            Material::Hair => (edge_distance(mesh), joined_normals(mesh)),
            _ => (vec![1.0; mesh.positions.len()], mesh.normals.clone()),
        };
        for (i, p) in mesh.positions.iter().enumerate() {
            let (bodies, share) = part.between(part.weight[i]);
            let uv = match part.material {
                Material::Hair => maps::hair::uv(*p),
                _ => mesh.uvs[i],
            };
            self.vertices.push(PartVertex {
                rest: p.to_array(),
                normal: normals[i].to_array(),
                uv: uv.to_array(),
                shares: [unorm(mesh.occlusion[i]), unorm(share), unorm(edge[i]), 0],
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

/// For each vertex the first one at its place.
fn welded(mesh: &Mesh) -> Vec<u32> {
    let mut first_at = std::collections::HashMap::new();
    let place = |(i, p): (usize, &Vec3)| {
        let key = (*p * 64.0).round().as_ivec3();
        *first_at.entry((key.x, key.y, key.z)).or_insert(i as u32)
    };
    mesh.positions.iter().enumerate().map(place).collect()
}

/// Normals with one at each place, so that layers raised along them do not tear at seams and poles.
fn joined_normals(mesh: &Mesh) -> Vec<Vec3> {
    let welded = welded(mesh);
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    for (first, normal) in welded.iter().zip(&mesh.normals) {
        sums[*first as usize] += *normal;
    }
    welded
        .iter()
        .map(|first| sums[*first as usize].normalize_or(Vec3::Y))
        .collect()
}

/// Millimetres from the edge at which hair stands to its full height.
const EDGE_REACH_MM: f32 = 16.0;

/// Distance of each vertex from the mesh's open edge along the mesh, 0 at it to 1 at [`EDGE_REACH_MM`].
fn edge_distance(mesh: &Mesh) -> Vec<f32> {
    let mut sides: std::collections::HashMap<(u32, u32), u32> = std::collections::HashMap::new();
    // Vertices at one place count as one: a seam is no edge.
    let welded = welded(mesh);
    let weld = |i: u32| welded[i as usize];
    for t in &mesh.triangles {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            let (a, b) = (weld(a), weld(b));
            *sides.entry((a.min(b), a.max(b))).or_default() += 1;
        }
    }
    let mut distance = vec![f32::INFINITY; mesh.positions.len()];
    for (&(a, b), &count) in &sides {
        if count == 1 {
            distance[a as usize] = 0.0;
            distance[b as usize] = 0.0;
        }
    }
    // Relaxation along sides; the order of a hash map does not change where it ends.
    let mut lengths: Vec<(u32, u32, f32)> = sides
        .keys()
        .map(|&(a, b)| {
            (
                a,
                b,
                mesh.positions[a as usize].distance(mesh.positions[b as usize]),
            )
        })
        .collect();
    lengths.sort_by_key(|&(a, b, _)| (a, b));
    for _ in 0..64 {
        let mut changed = false;
        for &(a, b, length) in &lengths {
            let (da, db) = (distance[a as usize], distance[b as usize]);
            if da + length < db {
                distance[b as usize] = da + length;
                changed = true;
            } else if db + length < da {
                distance[a as usize] = db + length;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    (0..mesh.positions.len() as u32)
        .map(|i| (distance[weld(i) as usize] / EDGE_REACH_MM).min(1.0))
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
