//! Decides which edges are split, makes the triangles that are drawn, and the weights of the points
//! that these need.
//!
//! An edge is split or not whatever triangle it is seen from, and a triangle is cut to match its split
//! edges, so that no crack opens between fine and coarse. Texture coordinates belong to triangles'
//! corners; a point between two corners is one vertex for all triangles that agree about both.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use super::level::Level;
use super::stencils::{Mixer, Stencils};
use super::{Detail, Subdivision, Topology};

/// A row of weights while it is worked out.
type Row = Vec<(u32, f64)>;

/// The mesh that is drawn, while it is split.
#[derive(Default)]
struct Drawn {
    /// Point and texture coordinates of each corner that differs from all others.
    corners: Vec<(u32, Vec2)>,
    /// The ends of each split edge, by its middle.
    ends: HashMap<u32, [u32; 2]>,
    triangles: Vec<[u32; 3]>,
}

/// Builds the drawn mesh of a control mesh that has been checked.
pub(super) fn build(mesh: &Topology<'_>, detail: &Detail<'_>) -> Subdivision {
    let mut levels = vec![Level::control(mesh)];
    for coarse in 0..detail.levels {
        let finer = levels[coarse].refined();
        levels.push(finer);
    }
    let limits = (detail.bow_mm > 0.0 && !detail.rest.is_empty())
        .then(|| limits_at_rest(&levels, detail.rest));
    let bows = |ends: [u32; 2], middle: u32| {
        limits.as_ref().is_none_or(|at| {
            let [a, b, m] = [ends[0], ends[1], middle].map(|p| at[p as usize]);
            (a + b - m * 2.0).length() > 2.0 * detail.bow_mm
        })
    };
    let mut drawn = Drawn::of(mesh, detail);
    for level in &levels[..detail.levels] {
        let points = level.point_count() as u32;
        let middles = (points..)
            .zip(&level.edges)
            .filter(|(middle, edge)| bows(edge.ends, *middle))
            .map(|(middle, edge)| (ordered(edge.ends), middle))
            .collect();
        drawn.split(&middles, limits.as_deref());
    }
    let kept = drawn.points(mesh.vertex_count, &levels);
    let stencils = rows(&levels, &kept, mesh.vertex_count);
    drawn.numbered(&kept, stencils)
}

fn ordered([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Where the points of all levels go in the limit, for positions of the control mesh.
fn limits_at_rest(levels: &[Level], rest: &[Vec3]) -> Vec<Vec3> {
    let mut terms = Vec::new();
    let sum = |terms: &[(u32, f64)], from: &[Vec3]| -> Vec3 {
        let part = |&(i, w): &(u32, f64)| from[i as usize] * w as f32;
        terms.iter().map(part).sum()
    };
    let mut positions = rest.to_vec();
    let mut limits: Vec<Vec3> = Vec::new();
    for (number, level) in levels.iter().enumerate() {
        for point in limits.len()..level.point_count() {
            terms.clear();
            level.limit_terms(point as u32, &mut terms);
            limits.push(sum(&terms, &positions));
        }
        if let Some(next) = levels.get(number + 1) {
            positions = (0..next.point_count() as u32)
                .map(|point| {
                    terms.clear();
                    level.next_terms(point, &mut terms);
                    sum(&terms, &positions)
                })
                .collect();
        }
    }
    limits
}

impl Drawn {
    /// The control mesh's triangles that can be seen.
    fn of(mesh: &Topology<'_>, detail: &Detail<'_>) -> Self {
        let mut drawn = Self::default();
        let mut numbers: HashMap<(u32, [u32; 2]), u32> = HashMap::new();
        let hidden = |v: &u32| detail.hidden.get(*v as usize).is_some_and(|h| *h);
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            if triangle.iter().all(hidden) {
                continue;
            }
            let uvs = mesh.wedges.get(t).copied().unwrap_or_default();
            drawn.triangles.push([0, 1, 2].map(|i| {
                let (vertex, uv) = (triangle[i], uvs[i]);
                *numbers
                    .entry((vertex, uv.to_array().map(f32::to_bits)))
                    .or_insert_with(|| {
                        drawn.corners.push((vertex, uv));
                        drawn.corners.len() as u32 - 1
                    })
            }));
        }
        drawn
    }

    /// Splits the edges that have a middle; `limits` choose the shorter way across what is left.
    fn split(&mut self, middles: &HashMap<[u32; 2], u32>, limits: Option<&[Vec3]>) {
        let mut made: HashMap<[u32; 2], u32> = HashMap::new();
        let (corners, all_ends) = (&mut self.corners, &mut self.ends);
        let mut finer = Vec::with_capacity(4 * self.triangles.len());
        for &t in &self.triangles {
            let middle = [0, 1, 2].map(|i| {
                let ends = [t[i], t[(i + 1) % 3]];
                let [a, b] = ends.map(|c| corners[c as usize]);
                let point = *middles.get(&ordered([a.0, b.0]))?;
                all_ends.entry(point).or_insert([a.0, b.0]);
                Some(*made.entry(ordered(ends)).or_insert_with(|| {
                    corners.push((point, (a.1 + b.1) * 0.5));
                    corners.len() as u32 - 1
                }))
            });
            let length = |a: u32, b: u32| {
                let [a, b] = [a, b].map(|c| corners[c as usize].0 as usize);
                limits.map_or(0.0, |at| at[a].distance_squared(at[b]))
            };
            match middle {
                [None, None, None] => finer.push(t),
                [Some(p), Some(q), Some(r)] => {
                    finer.extend([[t[0], p, r], [p, t[1], q], [r, q, t[2]], [p, q, r]]);
                }
                _ => {
                    // Turn it so that the first side is the odd one out.
                    let count = middle.iter().flatten().count();
                    let first = middle
                        .iter()
                        .position(|m| m.is_some() == (count == 1))
                        .unwrap_or(0);
                    let turned = |i: usize| (first + i) % 3;
                    let [a, b, c] = [0, 1, 2].map(|i| t[turned(i)]);
                    match [0, 1, 2].map(|i| middle[turned(i)]) {
                        [Some(m), _, _] => finer.extend([[a, m, c], [m, b, c]]),
                        [None, Some(m), Some(n)] => {
                            finer.push([n, m, c]);
                            if length(a, m) <= length(b, n) {
                                finer.extend([[a, b, m], [a, m, n]]);
                            } else {
                                finer.extend([[a, b, n], [b, m, n]]);
                            }
                        }
                        _ => finer.push(t),
                    }
                }
            }
        }
        self.triangles = finer;
    }

    /// The points that are needed: the control mesh's, and what is drawn.
    fn points(&self, control_count: usize, levels: &[Level]) -> Vec<bool> {
        let all = levels.last().map_or(control_count, Level::point_count);
        let mut kept: Vec<bool> = (0..all).map(|p| p < control_count).collect();
        for &corner in self.triangles.iter().flatten() {
            kept[self.corners[corner as usize].0 as usize] = true;
        }
        kept
    }

    /// Numbers points and copies.
    fn numbered(&self, kept: &[bool], stencils: Stencils) -> Subdivision {
        let mut count = 0;
        let number: Vec<u32> = kept
            .iter()
            .map(|&kept| {
                count += u32::from(kept);
                count.saturating_sub(1)
            })
            .collect();
        let mut uvs = vec![Vec2::ZERO; count as usize];
        let mut taken = vec![false; count as usize];
        let mut vertex = vec![u32::MAX; self.corners.len()];
        let mut copies = Vec::new();
        for &corner in self.triangles.iter().flatten() {
            let (point, uv) = self.corners[corner as usize];
            let point = number[point as usize];
            let vertex = &mut vertex[corner as usize];
            if *vertex != u32::MAX {
                continue;
            }
            if std::mem::replace(&mut taken[point as usize], true) {
                *vertex = count + copies.len() as u32;
                copies.push(point);
                uvs.push(uv);
            } else {
                *vertex = point;
                uvs[point as usize] = uv;
            }
        }
        let further = (0_u32..).zip(kept).filter(|(_, kept)| **kept);
        let parents = further
            .filter_map(|(point, _)| self.ends.get(&point))
            .map(|ends| ends.map(|end| number[end as usize]))
            .collect();
        let point = |c: u32| number[self.corners[c as usize].0 as usize];
        Subdivision {
            stencils,
            welded: self.triangles.iter().map(|t| t.map(point)).collect(),
            triangles: self
                .triangles
                .iter()
                .map(|t| t.map(|c| vertex[c as usize]))
                .collect(),
            copies,
            parents,
            uvs,
        }
    }
}

/// The limit of the points in `kept` as weights of control points.
fn rows(levels: &[Level], kept: &[bool], control_count: usize) -> Stencils {
    let mut terms = Vec::new();
    // From fine to coarse: which points of each level the limit and the next level are made of.
    let mut needed: Vec<Vec<bool>> = Vec::new();
    for (number, level) in levels.iter().enumerate().rev() {
        let born = match number {
            0 => 0,
            n => levels[n - 1].point_count(),
        };
        terms.clear();
        for point in (born..level.point_count()).filter(|&p| kept[p]) {
            level.limit_terms(point as u32, &mut terms);
        }
        for (point, _) in needed
            .last()
            .iter()
            .flat_map(|next| next.iter().enumerate())
            .filter(|(_, n)| **n)
        {
            level.next_terms(point as u32, &mut terms);
        }
        let mut flags = vec![false; level.point_count()];
        for &(point, _) in &terms {
            flags[point as usize] = true;
        }
        needed.push(flags);
    }
    needed.reverse();

    let mut mixer = Mixer::new(control_count);
    let mut mix = |rows: &[Row], terms: &[(u32, f64)]| -> Row {
        let row = |&(point, share): &(u32, f64)| (rows[point as usize].as_slice(), share);
        mixer.mix(terms.iter().map(row)).to_vec()
    };
    let mut stencils = Stencils::default();
    let mut coarse: Vec<Row> = (0..control_count as u32).map(|v| vec![(v, 1.0)]).collect();
    let mut born = 0;
    for (number, level) in levels.iter().enumerate() {
        for point in (born..level.point_count()).filter(|&p| kept[p]) {
            terms.clear();
            level.limit_terms(point as u32, &mut terms);
            let row = mix(&coarse, &terms);
            stencils.push(row.into_iter().map(|(i, w)| (i, w as f32)));
        }
        born = level.point_count();
        if let Some(next) = needed.get(number + 1) {
            coarse = (0..)
                .zip(next)
                .map(|(point, &needed)| {
                    terms.clear();
                    if needed {
                        level.next_terms(point, &mut terms);
                    }
                    mix(&coarse, &terms)
                })
                .collect();
        }
    }
    stencils
}
