//! How far some points lie from a scan, and how its surface lies about them. For a few dozen points a
//! plain walk over the triangles costs less than building a hierarchy, which the fit does later, in its
//! own frame: see `closest`.

use std::collections::HashMap;
use std::hash::BuildHasherDefault;

use glam::{DVec3, Vec3};

use super::scan::Scan;
use super::stl::Mix;

/// The triangles of a scan, with what lets most be passed over.
pub(crate) struct Nearest<'a> {
    scan: &'a Scan,
    /// Longest side at the first corner.
    reach: Vec<f32>,
}

impl<'a> Nearest<'a> {
    pub(crate) fn new(scan: &'a Scan) -> Self {
        let reach = scan.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|i| scan.positions[i as usize]);
            a.distance_squared(b).max(a.distance_squared(c)).sqrt()
        });
        Self {
            scan,
            reach: reach.collect(),
        }
    }

    /// Distance to the surface, and the triangle that is nearest.
    pub(crate) fn find(&self, point: DVec3) -> (f64, usize) {
        let point = point.as_vec3();
        let (mut best, mut which) = (f32::INFINITY, 0);
        for (i, (t, &reach)) in self.scan.triangles.iter().zip(&self.reach).enumerate() {
            let a = self.scan.positions[t[0] as usize];
            let bound = best + reach;
            if point.distance_squared(a) > bound * bound {
                continue;
            }
            let [b, c] = [t[1], t[2]].map(|i| self.scan.positions[i as usize]);
            let distance = point.distance(on_triangle(point, a, b, c));
            if distance < best {
                (best, which) = (distance, i);
            }
        }
        (f64::from(best), which)
    }

    /// Whether each of these triangles has a corner on the rim of a hole.
    pub(crate) fn on_rim(&self, triangles: &[usize]) -> Vec<bool> {
        let mut uses: HashMap<(u32, u32), u32, BuildHasherDefault<Mix>> = HashMap::default();
        let edges = |t: &[u32; 3]| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])];
        for (a, b) in self.scan.triangles.iter().flat_map(edges) {
            *uses.entry((a.min(b), a.max(b))).or_default() += 1;
        }
        let mut rim = vec![false; self.scan.positions.len()];
        for ((a, b), _) in uses.iter().filter(|(_, uses)| **uses == 1) {
            rim[*a as usize] = true;
            rim[*b as usize] = true;
        }
        let at = |&t: &usize| self.scan.triangles[t].iter().any(|&i| rim[i as usize]);
        triangles.iter().map(at).collect()
    }
}

/// The point of a triangle that is nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
fn on_triangle(p: Vec3, a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    a + ab * (vb / sum) + ac * (vc / sum)
}

/// A place on the scan with the direction that should be outwards there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    pub(crate) at: DVec3,
    pub(crate) outward: DVec3,
}

/// Triangles looked at in all: a sample tells as much as all of them.
const SAMPLE: usize = 20_000;

/// Mean cosine between the normals of the triangles within `radius` of `spots` and what should be
/// outwards there: -1..1, below zero where the scan is inside out.
pub(crate) fn facing(scan: &Scan, spots: &[Spot], radius: f64) -> f64 {
    let stride = scan.triangles.len().div_ceil(SAMPLE).max(1);
    let (mut cosine, mut area) = (0.0, 0.0);
    for t in scan.triangles.iter().step_by(stride) {
        let [a, b, c] = t.map(|i| scan.positions[i as usize].as_dvec3());
        let (middle, normal) = ((a + b + c) / 3.0, (b - a).cross(c - a));
        let size = normal.length();
        for spot in spots {
            if middle.distance_squared(spot.at) < radius * radius {
                cosine += normal.dot(spot.outward);
                area += size;
            }
        }
    }
    if area > 0.0 { cosine / area } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn finds_what_a_fine_sampling_finds(
            corners in prop::collection::vec(prop::array::uniform3(-1.0..1.0f32), 9),
            point in prop::array::uniform3(-2.0..2.0f32),
        ) {
            let positions: Vec<Vec3> = corners.into_iter().map(Vec3::from_array).collect();
            let triangles = vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]];
            let scan = Scan { positions, triangles, colour: None };
            let (found, _) = Nearest::new(&scan).find(Vec3::from_array(point).as_dvec3());
            const STEPS: u16 = 60;
            let mut least = f32::INFINITY;
            for t in &scan.triangles {
                let [a, b, c] = t.map(|i| scan.positions[i as usize]);
                for i in 0..=STEPS {
                    for j in 0..=STEPS - i {
                        let (u, v) = (f32::from(i) / f32::from(STEPS), f32::from(j) / f32::from(STEPS));
                        let on = a + (b - a) * u + (c - a) * v;
                        least = least.min(on.distance(Vec3::from_array(point)));
                    }
                }
            }
            prop_assert!(found <= f64::from(least) + 1e-4);
            prop_assert!(found >= f64::from(least) - 0.1);
        }
    }
}
