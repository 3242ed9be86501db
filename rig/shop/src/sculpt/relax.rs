//! Evens the template out where it lies: free vertices slide along the surface, edges flip to the better diagonal.

use std::collections::{HashMap, HashSet};

use glam::Vec3;
use mouthpiece_rig::normals;

use super::half::Half;
use super::target::Target;

const ROUNDS: usize = 10;
const FLIP_ROUNDS: usize = 4;
/// A vertex looks for the surface within this distance, mm.
const REACH_MM: f32 = 6.0;
/// New triangles face as the old ones do, at least so far (cosine).
const SAME_SIDE: f32 = 0.8;

/// Slides free vertices to the middle of their neighbours and back onto the surface, and flips edges between.
pub(super) fn relax(half: &mut Half, target: &Target) {
    for round in 0..ROUNDS {
        if round % 3 == 0 {
            flip(half);
        }
        slide(half, target);
    }
    flip(half);
}

fn slide(half: &mut Half, target: &Target) {
    let positions: Vec<Vec3> = half.vertices.iter().map(|v| v.position).collect();
    let triangles: Vec<[u32; 3]> = half.triangles.iter().map(|t| t.map(|i| i as u32)).collect();
    let facing = normals(&positions, &triangles);
    // Triangles pull by their area, so that sizes even out gradually.
    let mut sum = vec![(Vec3::ZERO, 0.0_f32); positions.len()];
    for t in &half.triangles {
        let [a, b, c] = t.map(|i| positions[i]);
        let area = (b - a).cross(c - a).length().sqrt();
        for &i in t {
            sum[i].0 += (a + b + c) * (area / 3.0);
            sum[i].1 += area;
        }
    }
    for (i, v) in half.vertices.iter_mut().enumerate() {
        if v.free && sum[i].1 > 0.0 {
            let place = v.position.lerp(sum[i].0 / sum[i].1, 0.5);
            if let Some(on) = target.nearest(place, facing[i], REACH_MM) {
                v.position = on;
            }
        }
    }
}

/// Flips each edge, unless it is kept, whose other diagonal gives the larger least angle.
fn flip(half: &mut Half) {
    let kept: HashSet<[usize; 2]> = half.kept.iter().copied().collect();
    for _ in 0..FLIP_ROUNDS {
        let mut sides: HashMap<[usize; 2], Vec<usize>> = HashMap::new();
        for (k, t) in half.triangles.iter().enumerate() {
            for i in 0..3 {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                sides.entry([a.min(b), a.max(b)]).or_default().push(k);
            }
        }
        let mut edges: Vec<([usize; 2], Vec<usize>)> = sides.into_iter().collect();
        edges.sort_unstable();
        let existing: HashSet<[usize; 2]> = edges.iter().map(|e| e.0).collect();
        let mut touched = vec![false; half.triangles.len()];
        let mut flips = 0;
        for (edge, at) in edges {
            let &[s, t] = &at[..] else { continue };
            if kept.contains(&edge) || touched[s] || touched[t] || half.of_ear[s] != half.of_ear[t]
            {
                continue;
            }
            let Some([a, c, b, d]) = quad(half.triangles[s], half.triangles[t], edge) else {
                continue;
            };
            if existing.contains(&[c.min(d), c.max(d)]) {
                continue;
            }
            let p = |i: usize| half.vertices[i].position;
            let new = [[a, d, c], [d, b, c]];
            let old = [half.triangles[s], half.triangles[t]];
            let least =
                |ts: &[[usize; 3]; 2]| ts.iter().map(|t| least_angle(t.map(p))).fold(9.0, f32::min);
            let normal = |t: [usize; 3]| {
                let [a, b, c] = t.map(p);
                (b - a).cross(c - a).normalize_or_zero()
            };
            let outside = (normal(old[0]) + normal(old[1])).normalize_or_zero();
            let same = new.iter().all(|t| normal(*t).dot(outside) > SAME_SIDE);
            if same && least(&new) > least(&old) + 0.02 {
                half.triangles[s] = new[0];
                half.triangles[t] = new[1];
                touched[s] = true;
                touched[t] = true;
                flips += 1;
            }
        }
        if flips == 0 {
            return;
        }
    }
}

/// Corners of two triangles with a common edge, `[a, c, b, d]`: the first is a, b, c in its order, d the other's tip.
fn quad(s: [usize; 3], t: [usize; 3], edge: [usize; 2]) -> Option<[usize; 4]> {
    let i = (0..3).find(|&i| !edge.contains(&s[i]))?;
    let d = t.into_iter().find(|v| !edge.contains(v))?;
    let (c, a, b) = (s[i], s[(i + 1) % 3], s[(i + 2) % 3]);
    Some([a, c, b, d])
}

/// The least angle of a triangle, radians.
fn least_angle([a, b, c]: [Vec3; 3]) -> f32 {
    let at = |p: Vec3, q: Vec3, r: Vec3| (q - p).angle_between(r - p);
    at(a, b, c).min(at(b, c, a)).min(at(c, a, b))
}
