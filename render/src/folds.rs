//! What the skin's own bending does to light, frame by frame: a fold that deepens (corner of the mouth, lid, cheek
//! beside the nose) keeps out light from around it, and where the skin is sharply convex light that has crept
//! under it shows farther round the terminator.
//!
//! The bend of the surface is read off the drawn triangles: along each edge how fast the normal turns. Occlusion
//! of whole parts by others (lips, nostrils, ears) is not seen by it; that was cast for the head at rest.

use glam::Vec3;

/// Measures the bend of a surface. Allocates nothing once made.
#[derive(Clone, Debug)]
pub(crate) struct Folds {
    edges: Vec<[u32; 2]>,
    /// One over the number of each point's edges.
    share: Vec<f32>,
    /// The bend at rest, 1/mm: above 0 hollow.
    rest: Vec<f32>,
    now: Vec<f32>,
}

/// How much of the light a fold leaves goes by its bend over this many mm.
const REACH_MM: f32 = 4.0;
/// Bend (convex, 1/mm) that counts as wholly convex: the tip of a small nose, an ear's rim.
const SHARP: f32 = 0.12;
/// A bend beyond this, 1/mm, is no skin's but a seam's where lips or lids touch.
const MOST: f32 = 0.5;

impl Folds {
    /// Of a surface of `points` points; `drawn` are its triangles, with copies of points where the chart is cut.
    pub(crate) fn of(points: usize, triangles: &[[u32; 3]], copies: &[u32]) -> Self {
        let whole = |i: u32| {
            copies
                .get((i as usize).wrapping_sub(points))
                .copied()
                .unwrap_or(i)
        };
        let mut edges: Vec<[u32; 2]> = triangles
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| {
                let (a, b) = (whole(a), whole(b));
                [a.min(b), a.max(b)]
            })
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let mut share = vec![0.0_f32; points];
        for i in edges.as_flattened() {
            share[*i as usize] += 1.0;
        }
        share.iter_mut().for_each(|n| *n = 1.0 / n.max(1.0));
        Self {
            edges,
            share,
            rest: vec![0.0; points],
            now: vec![0.0; points],
        }
    }

    /// Takes the bend of `points` as that of the head at rest.
    pub(crate) fn rest(&mut self, points: &[Vec3], normals: &[Vec3]) {
        self.measure(points, normals);
        self.rest.clone_from(&self.now);
    }

    /// Takes over the surface as it is now; normals have unit length.
    pub(crate) fn measure(&mut self, points: &[Vec3], normals: &[Vec3]) {
        self.now.fill(0.0);
        for &[i, j] in &self.edges {
            let (i, j) = (i as usize, j as usize);
            let edge = points[j] - points[i];
            // The normal turns towards the other end: hollow.
            let bend = (normals[i] - normals[j]).dot(edge) / edge.length_squared().max(0.04);
            let bend = bend.clamp(-MOST, MOST);
            self.now[i] += bend * self.share[i];
            self.now[j] += bend * self.share[j];
        }
    }

    /// What the fold at a point leaves of the light against the head at rest, 0..1 where 0.5 is as at rest; and
    /// how convex it is, 0..1.
    pub(crate) fn at(&self, point: usize) -> (f32, f32) {
        let (now, rest) = (self.now[point], self.rest[point]);
        let left = |bend: f32| 1.0 - (bend * REACH_MM).clamp(0.0, 0.5);
        let ratio = left(now) / left(rest);
        (0.5 * ratio, (-now / SHARP).clamp(0.0, 1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::vec3;

    /// A strip bent round the x axis; hollow seen from the normals' side when `radius` is below 0.
    fn strip(radius: f32) -> (Vec<Vec3>, Vec<Vec3>, Vec<[u32; 3]>) {
        let place = |k: u32, x: f32| {
            let turn = (k as f32 - 2.0) * 2.0 / radius;
            let out = vec3(0.0, turn.sin(), turn.cos());
            (out * radius + vec3(x, 0.0, 0.0), out)
        };
        let both: Vec<_> = (0..5)
            .flat_map(|k| [place(k, 0.0), place(k, 2.0)])
            .collect();
        let triangles = (0..4)
            .flat_map(|k| {
                [
                    [2 * k, 2 * k + 1, 2 * k + 2],
                    [2 * k + 1, 2 * k + 3, 2 * k + 2],
                ]
            })
            .collect();
        let (points, normals) = both.into_iter().unzip();
        (points, normals, triangles)
    }

    #[test]
    fn a_fold_that_deepens_keeps_light_out_and_one_that_opens_lets_it_in() {
        let (points, normals, triangles) = strip(-60.0);
        let mut folds = Folds::of(points.len(), &triangles, &[]);
        folds.rest(&points, &normals);
        assert!((folds.at(4).0 - 0.5).abs() < 1e-3);
        let (points, normals, _) = strip(-12.0);
        folds.measure(&points, &normals);
        assert!(folds.at(4).0 < 0.45, "{:?}", folds.at(4));
        let (points, normals, _) = strip(20.0);
        folds.measure(&points, &normals);
        let (light, convex) = folds.at(4);
        assert!(light > 0.5 && convex > 0.15, "{light} {convex}");
    }
}
