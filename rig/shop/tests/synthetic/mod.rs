//! A pair to fit: the reference head's skin, and a "scan" of it after a known smooth warp, with noise and holes, without
//! a back of the head and without the insides that no scanner sees. Shared by tests, bench and example.

#![allow(clippy::expect_used, reason = "a test without its head is over")]

use std::collections::HashMap;

use glam::{Vec3, vec3};
use mouthpiece_rig::Head;
use mouthpiece_shop::fit::{Fit, Template, visible};

/// Places of landmarks on the reference head, mm; those aside of the middle count for both sides.
const MARKS: [[f32; 3]; 37] = [
    [0.0, 145.0, 0.0],
    [0.0, 56.0, -87.0],
    [0.0, 57.0, 108.0],
    [0.0, 42.0, 106.0],
    [0.0, 117.0, 80.0],
    [0.0, 1.0, 131.0],
    [0.0, -12.0, 116.0],
    [0.0, -25.0, 118.0],
    [0.0, -44.0, 115.0],
    [0.0, -53.0, 109.0],
    [0.0, -61.0, 110.0],
    [0.0, -76.0, 104.0],
    [0.0, -86.0, 62.0],
    [18.0, 33.0, 92.0],
    [45.0, 34.0, 86.0],
    [32.0, 42.0, 93.0],
    [32.0, 29.0, 93.0],
    [18.0, -1.0, 108.0],
    [13.0, -10.0, 109.0],
    [7.0, -24.0, 117.0],
    [25.0, -35.0, 102.0],
    [9.0, 38.0, 100.0],
    [38.0, 63.0, 98.0],
    [33.0, 17.0, 95.0],
    [56.0, 65.0, 78.0],
    [79.0, 60.0, -1.0],
    [73.0, 22.0, 43.0],
    [75.0, 10.0, 12.0],
    [87.0, 36.0, -3.0],
    [66.0, -21.0, 16.0],
    [91.0, 20.0, -15.0],
    [77.0, 30.0, 14.0],
    [57.0, -50.0, 46.0],
    [50.0, 5.0, 85.0],
    [35.0, -62.0, 80.0],
    [50.0, -25.0, 75.0],
    [40.0, 95.0, 82.0],
];

/// Everything a fit needs, and what should come out.
pub(crate) struct Pair {
    pub(crate) positions: Vec<Vec3>,
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) freedom: Vec<f32>,
    pub(crate) face: Vec<bool>,
    pub(crate) scan: (Vec<Vec3>, Vec<[u32; 3]>),
    pub(crate) landmarks: Vec<(Vec3, Vec3)>,
    /// Where every vertex of the template should come to lie.
    pub(crate) truth: Vec<Vec3>,
}

/// What is wrong with the scan.
#[derive(Clone, Copy)]
pub(crate) struct Faults {
    pub(crate) noise_mm: f32,
    pub(crate) holes: bool,
    /// Landmarks off by about this much, mm.
    pub(crate) clumsy_mm: f32,
}

impl Pair {
    /// `parts`: into how many pieces each edge of the template is cut for the scan.
    pub(crate) fn new(warp: impl Fn(Vec3) -> Vec3, parts: u32, faults: Faults) -> Self {
        let head = Head::reference().expect("the reference head");
        let mesh = &head.skin.mesh;
        let (positions, triangles) = (mesh.positions.clone(), mesh.triangles.clone());
        let freedom = visible(&positions, &triangles);
        let freedom: Vec<f32> = freedom
            .iter()
            .zip(&head.skin.wet)
            .map(|(f, wet)| f * (1.0 - wet))
            .collect();
        let face: Vec<bool> = positions
            .iter()
            .zip(&freedom)
            .map(|(p, f)| *f >= 1.0 && on_face(*p))
            .collect();
        let marks: Vec<Vec3> = MARKS
            .iter()
            .flat_map(|&[x, y, z]| {
                if x == 0.0 {
                    vec![vec3(x, y, z)]
                } else {
                    vec![vec3(x, y, z), vec3(-x, y, z)]
                }
            })
            .map(|p| nearest(&positions, &freedom, p))
            .collect();
        let landmarks = marks
            .iter()
            .enumerate()
            .map(|(i, &p)| (p, warp(p) + random(i as u32, 7) * faults.clumsy_mm))
            .collect();
        let truth = positions.iter().map(|p| warp(*p)).collect();
        let seen: Vec<[u32; 3]> = triangles
            .iter()
            .copied()
            .filter(|t| t.iter().all(|&v| freedom[v as usize] > 0.0))
            .collect();
        let (points, faces) = finer(&positions, &mesh.normals, &seen, parts);
        let scanned = |p: Vec3| {
            let hole = faults.holes && HOLES.iter().any(|h| p.distance(Vec3::from(*h)) < 7.0);
            p.z > -25.0 && !hole
        };
        let faces = faces
            .into_iter()
            .filter(|t| t.iter().all(|&v| scanned(points[v as usize])))
            .collect();
        let points = points
            .iter()
            .enumerate()
            .map(|(i, p)| warp(*p) + random(i as u32, 3) * faults.noise_mm)
            .collect();
        Self {
            positions,
            triangles,
            freedom,
            face,
            scan: (points, faces),
            landmarks,
            truth,
        }
    }

    pub(crate) fn template(&self) -> Template<'_> {
        Template {
            positions: &self.positions,
            triangles: &self.triangles,
            freedom: &self.freedom,
        }
    }

    /// How far landmarks on the fitted skin are from where they should be, mm.
    pub(crate) fn landmark_errors(&self, fit: &Fit, warp: impl Fn(Vec3) -> Vec3) -> Vec<f32> {
        self.landmarks
            .iter()
            .zip(&fit.landmarks)
            .map(|((from, _), at)| at.distance(warp(*from)))
            .collect()
    }
}

/// Holes in the scan: cheek, forehead, side of the nose, under the lip, jaw.
const HOLES: [[f32; 3]; 5] = [
    [45.0, 0.0, 88.0],
    [-30.0, 90.0, 92.0],
    [-12.0, 15.0, 112.0],
    [12.0, -60.0, 106.0],
    [-62.0, -30.0, 50.0],
];

/// The part of a head that has a face's accuracy to keep.
pub(crate) fn on_face(p: Vec3) -> bool {
    p.z > 35.0 && p.y > -78.0 && p.y < 105.0 && p.x.abs() < 68.0
}

/// Smooth warps a fit must undo: a smaller head, a wide one, a narrow one, one with a long nose.
pub(crate) fn warp(kind: usize) -> impl Fn(Vec3) -> Vec3 + Copy {
    let scale = [
        vec3(0.82, 0.78, 0.8),
        vec3(1.12, 0.97, 1.0),
        vec3(0.88, 1.05, 1.03),
        vec3(1.0, 1.0, 1.0),
    ][kind];
    move |p: Vec3| {
        let wave = vec3(
            2.5 * (p.y / 41.0).sin() * (p.x / 60.0).sin(),
            2.0 * (p.x.abs() / 37.0 + p.z / 50.0).cos(),
            3.0 * (p.y / 33.0 + 1.0).sin() * (-(p.x / 55.0).powi(2)).exp(),
        );
        let nose = (-(p - vec3(0.0, 2.0, 128.0)).length_squared() / 700.0).exp();
        let long = if kind == 3 {
            vec3(0.0, -4.0, 12.0) * nose
        } else {
            Vec3::ZERO
        };
        p * scale + wave + long
    }
}

fn nearest(positions: &[Vec3], freedom: &[f32], p: Vec3) -> Vec3 {
    let free = positions
        .iter()
        .zip(freedom)
        .filter(|(_, f)| **f >= 1.0)
        .map(|(q, _)| *q);
    free.min_by(|a, b| a.distance(p).total_cmp(&b.distance(p)))
        .unwrap_or(p)
}

/// The same every run: about normal in each axis, unit deviation.
fn random(i: u32, salt: u32) -> Vec3 {
    let one = |k: u32| {
        let mut sum = 0.0;
        for j in 0..4 {
            let mut h =
                i.wrapping_mul(0x9E37_79B9) ^ (k * 31 + j + salt * 977).wrapping_mul(0x85EB_CA6B);
            h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
            h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
            sum += (h >> 8) as f32 / (1 << 24) as f32 - 0.5;
        }
        sum * 3.0_f32.sqrt()
    };
    vec3(one(0), one(1), one(2))
}

/// Cuts every triangle into `parts` squared, bulged by the vertex normals (Phong tessellation), so that the scan is no
/// polyhedron with the template's own corners alone.
fn finer(
    positions: &[Vec3],
    normals: &[Vec3],
    triangles: &[[u32; 3]],
    parts: u32,
) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let (mut points, mut faces) = (Vec::new(), Vec::new());
    // By the corners' numbers and shares, so that neighbours agree on what lies on their edge.
    let mut known: HashMap<[(u32, u32); 3], u32> = HashMap::new();
    for t in triangles {
        let p = t.map(|v| positions[v as usize]);
        let n = t.map(|v| normals[v as usize]);
        let mut at = |i: u32, j: u32| {
            let shares = [parts - i - j, i, j];
            let share = shares.map(|k| k as f32 / parts as f32);
            let flat: Vec3 = (0..3).map(|k| p[k] * share[k]).sum();
            let round: Vec3 = (0..3)
                .map(|k| (flat - n[k] * (flat - p[k]).dot(n[k])) * share[k])
                .sum();
            let point = flat.lerp(round, 0.6);
            let mut key = [0, 1, 2].map(|k| {
                if shares[k] == 0 {
                    (u32::MAX, 0)
                } else {
                    (t[k], shares[k])
                }
            });
            key.sort_unstable();
            *known.entry(key).or_insert_with(|| {
                points.push(point);
                points.len() as u32 - 1
            })
        };
        for i in 0..parts {
            for j in 0..parts - i {
                faces.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                if i + j + 2 <= parts {
                    faces.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
                }
            }
        }
    }
    faces.retain(|[a, b, c]| a != b && b != c && c != a);
    (points, faces)
}
