//! The feature mesh of HEADSHOP 6.2, Figure 4: triangles between landmarks, refined to find more of them.
//!
//! Landmarks are joined by the Delaunay triangulation of their directions from the middle of the head, made flat by
//! stereographic projection from where no landmark is, so that no seam runs through the face. One round puts a vertex
//! into each triangle and flips the old edges (`split`). The vertices live on the template, as places in its triangles;
//! source and target feature mesh have one connectivity, and after each warp one shape, so one object serves for both.

use std::collections::HashMap;

use glam::Vec3;
use spade::{DelaunayTriangulation, Point2, Triangulation as _};

/// Directions tried for the pole of the projection.
const POLES: usize = 256;

/// A place on the template.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Place {
    pub(crate) triangle: u32,
    pub(crate) shares: [f32; 3],
}

impl Place {
    /// Where it is on the template in some shape.
    pub(crate) fn on(&self, positions: &[Vec3], triangles: &[[u32; 3]]) -> Vec3 {
        let [a, b, c] = triangles[self.triangle as usize].map(|v| positions[v as usize]);
        a * self.shares[0] + b * self.shares[1] + c * self.shares[2]
    }
}

/// Triangles over points of the template, outward normals by the right hand.
pub(crate) struct FeatureMesh {
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl FeatureMesh {
    /// Joins points of the surface, whose outward normals are known, as seen from the middle of the head.
    pub(crate) fn new(points: &[Vec3], normals: &[Vec3]) -> Self {
        let n = points.len() as f32;
        let mean = points.iter().sum::<Vec3>() / n;
        let spread = points.iter().map(|p| p.distance(mean)).sum::<f32>() / n;
        // Landmarks all round a head have normals that cancel; those of a face alone point forward.
        let middle = mean - normals.iter().sum::<Vec3>() / n * spread;
        let directions: Vec<Vec3> = points
            .iter()
            .map(|p| (*p - middle).try_normalize().unwrap_or(Vec3::Y))
            .collect();
        let up = -loneliest(&directions);
        let (u, v) = up.any_orthonormal_pair();
        let (u, v) = if u.cross(v).dot(up) > 0.0 {
            (u, v)
        } else {
            (v, u)
        };
        let mut plane = DelaunayTriangulation::<Point2<f64>>::new();
        let mut names = Vec::with_capacity(points.len());
        for (i, d) in directions.iter().enumerate() {
            let away = f64::from(1.0 + d.dot(up)).max(1e-6);
            let at = Point2::new(f64::from(d.dot(u)) / away, f64::from(d.dot(v)) / away);
            if let Ok(handle) = plane.insert(at) {
                // Two landmarks in one direction: the first keeps the place.
                if handle.index() == names.len() {
                    names.push(i as u32);
                }
            }
        }
        let triangles = plane
            .inner_faces()
            .map(|face| face.vertices().map(|v| names[v.fix().index()]))
            .collect();
        Self { triangles }
    }

    /// Unit normals of the triangles, averaged once with those of the neighbours (6.2: it makes sampling local).
    pub(crate) fn normals(&self, points: &[Vec3]) -> Vec<Vec3> {
        let raw: Vec<Vec3> = self
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| points[v as usize]);
                (b - a).cross(c - a).normalize_or_zero()
            })
            .collect();
        let across = self.sides();
        let neighbour =
            |a: u32, b: u32| across.get(&[b, a]).map_or(Vec3::ZERO, |&t| raw[t as usize]);
        self.triangles
            .iter()
            .zip(&raw)
            .map(|(&[a, b, c], n)| {
                (*n + (neighbour(a, b) + neighbour(b, c) + neighbour(c, a)) / 3.0).normalize_or(*n)
            })
            .collect()
    }

    /// Splits each triangle that got a vertex into three and flips the edges between two such triangles, unless a
    /// flip would turn a triangle over. `inside[t]` is the new vertex; `points` hold the new vertices already.
    pub(crate) fn split(&mut self, inside: &[Option<u32>], points: &[Vec3]) {
        let across = self.sides();
        let normal = |t: [u32; 3]| {
            let [a, b, c] = t.map(|v| points[v as usize]);
            (b - a).cross(c - a)
        };
        let mut next = Vec::with_capacity(self.triangles.len() * 3);
        for (t, &[a, b, c]) in self.triangles.iter().enumerate() {
            let Some(x) = inside[t] else {
                next.push([a, b, c]);
                continue;
            };
            for (p, q) in [(a, b), (b, c), (c, a)] {
                let other = across.get(&[q, p]).and_then(|&t| inside[t as usize]);
                let Some(y) = other else {
                    next.push([p, q, x]);
                    continue;
                };
                let old = normal([p, q, x]) + normal([q, p, y]);
                let (one, two) = ([p, y, x], [y, q, x]);
                let flips = normal(one).dot(old) > 0.0 && normal(two).dot(old) > 0.0;
                match (flips, x < y) {
                    (true, true) => next.extend([one, two]),
                    (true, false) => {}
                    (false, _) => next.push([p, q, x]),
                }
            }
        }
        self.triangles = next;
    }

    /// Which triangle stands on the left of each directed edge.
    fn sides(&self) -> HashMap<[u32; 2], u32> {
        self.triangles
            .iter()
            .enumerate()
            .flat_map(|(t, &[a, b, c])| {
                [([a, b], t as u32), ([b, c], t as u32), ([c, a], t as u32)]
            })
            .collect()
    }
}

/// The direction farthest from all of `directions`, on a spiral of tries.
fn loneliest(directions: &[Vec3]) -> Vec3 {
    let nearest = |pole: Vec3| directions.iter().map(|d| d.dot(pole)).fold(-1.0, f32::max);
    (0..POLES)
        .map(|i| {
            let y = 1.0 - 2.0 * (i as f32 + 0.5) / POLES as f32;
            let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
            Vec3::new(sin, 0.0, cos) * (1.0 - y * y).sqrt() + Vec3::Y * y
        })
        .min_by(|a, b| nearest(*a).total_cmp(&nearest(*b)))
        .unwrap_or(Vec3::NEG_Z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn half_ball(n: usize) -> Vec<Vec3> {
        (0..n)
            .map(|i| {
                let z = 1.0 - 1.3 * (i as f32 + 0.5) / n as f32;
                let (sin, cos) = (i as f32 * 2.4).sin_cos();
                Vec3::new(sin * (1.0 - z * z).sqrt(), cos * (1.0 - z * z).sqrt(), z) * 90.0
            })
            .collect()
    }

    #[test]
    fn it_covers_the_face_outwards_without_a_seam_and_stays_so_when_split() {
        let mut points = half_ball(60);
        let normals: Vec<Vec3> = points.iter().map(|p| p.normalize()).collect();
        let mut mesh = FeatureMesh::new(&points, &normals);
        for _ in 0..3 {
            let inside: Vec<Option<u32>> = mesh
                .triangles
                .clone()
                .iter()
                .map(|t| {
                    let centre: Vec3 = t.iter().map(|&v| points[v as usize]).sum();
                    points.push(centre.normalize() * 90.0);
                    Some(points.len() as u32 - 1)
                })
                .collect();
            let before = mesh.triangles.len();
            mesh.split(&inside, &points);
            assert_eq!(mesh.triangles.len(), 3 * before);
            for t in &mesh.triangles {
                let [a, b, c] = t.map(|v| points[v as usize]);
                assert!((b - a).cross(c - a).dot(a + b + c) > 0.0);
            }
            // Every directed edge once: a surface.
            assert_eq!(mesh.sides().len(), 3 * mesh.triangles.len());
        }
    }
}
