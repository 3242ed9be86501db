//! A row of teeth with its gums from the front, as a height field: how far forward it stands at each place, and where
//! its biting edge is.

use glam::{Vec3, Vec3A, vec3a};

use crate::Mesh;

/// Distance of the field's samples, mm.
const CELL_MM: f32 = 0.5;
/// The middle of the arch that lips can touch: so far to each side, mm.
const HALF_WIDTH_MM: f32 = 26.0;
/// How far the row reaches from its biting edge, mm.
const TALL_MM: f32 = 22.0;
/// Gaps between teeth up to twice this wide are closed, mm.
const GAP_MM: f32 = 1.5;
/// Farther behind the front than this, mm, a point is behind the teeth and none of a lip's.
const BEHIND_MM: f32 = 7.0;
/// Where nothing is.
const NOTHING: f32 = -1e3;

/// See the module.
#[derive(Clone, Debug)]
pub(super) struct Field {
    /// 1 of the upper row, which reaches upwards from its edge; -1 of the lower one.
    up: f32,
    /// Samples across, and the first one's x.
    across: usize,
    left: f32,
    /// Samples along the height from `bottom`, and that height times `up`.
    tall: usize,
    bottom: f32,
    /// By height, then across.
    front: Vec<f32>,
    /// Per sample across: the biting edge's height times `up`, and the most forward sample.
    edge: Vec<f32>,
    most: Vec<f32>,
}

impl Field {
    /// None where nothing of the meshes lies in the middle of the arch.
    pub(super) fn new<'a>(meshes: impl Iterator<Item = &'a Mesh>, up: f32) -> Option<Self> {
        let triangles: Vec<[Vec3; 3]> = meshes
            .flat_map(|m| {
                let at = |v: u32| m.positions.get(v as usize).copied().unwrap_or_default();
                m.triangles.iter().map(move |t| t.map(at))
            })
            .filter(|t| t.iter().any(|p| p.x.abs() < HALF_WIDTH_MM))
            .collect();
        let heights = triangles.iter().flatten().map(|p| p.y * up);
        let bottom = heights.reduce(f32::min)? - CELL_MM;
        let across = (2.0 * HALF_WIDTH_MM / CELL_MM) as usize + 1;
        let tall = (TALL_MM / CELL_MM) as usize + 1;
        let mut field = Self {
            up,
            across,
            left: -HALF_WIDTH_MM,
            tall,
            bottom,
            front: vec![NOTHING; across * tall],
            edge: vec![f32::MAX; across],
            most: vec![NOTHING; across],
        };
        for t in &triangles {
            field.raise(t);
        }
        field.close();
        Some(field)
    }

    /// Raises the samples that a triangle covers.
    fn raise(&mut self, t: &[Vec3; 3]) {
        let [a, b, c] = t.map(|p| {
            Vec3::new(
                (p.x - self.left) / CELL_MM,
                (p.y * self.up - self.bottom) / CELL_MM,
                p.z,
            )
        });
        let area = (b - a).truncate().perp_dot((c - a).truncate());
        if area.abs() < 1e-9 {
            return;
        }
        let (low, high) = (a.min(b).min(c).ceil(), a.max(b).max(c).floor());
        let cells = |low: f32, high: f32, count: usize| {
            low.max(0.0) as usize..(high.max(-1.0) + 1.0).min(count as f32) as usize
        };
        for y in cells(low.y, high.y, self.tall) {
            for x in cells(low.x, high.x, self.across) {
                let p = glam::vec2(x as f32, y as f32);
                let share = |q: Vec3, r: Vec3| (q.truncate() - p).perp_dot(r.truncate() - p) / area;
                let (u, v, w) = (share(b, c), share(c, a), share(a, b));
                if u.min(v).min(w) >= -1e-4 {
                    let z = a.z * u + b.z * v + c.z * w;
                    let sample = &mut self.front[y * self.across + x];
                    *sample = sample.max(z);
                }
            }
        }
    }

    /// Closes gaps, finds the edge, and carries the front past edge and gums, so that it can be read between samples.
    fn close(&mut self) {
        for row in self.front.chunks_mut(self.across) {
            let wide = windows(row, f32::max);
            row.copy_from_slice(&windows(&wide, f32::min));
        }
        for x in 0..self.across {
            let at = |y: usize| y * self.across + x;
            let found = |y: &usize| self.front[at(*y)] > NOTHING;
            let (Some(first), Some(last)) =
                ((0..self.tall).find(found), (0..self.tall).rev().find(found))
            else {
                continue;
            };
            self.edge[x] = self.bottom + (first as f32 - 0.5) * CELL_MM;
            for y in 0..self.tall {
                if self.front[at(y)] <= NOTHING {
                    self.front[at(y)] = self.front[at(y.clamp(first, last))];
                }
                self.most[x] = self.most[x].max(self.front[at(y)]);
            }
        }
        // Lips slide: steps between tooth and gum are rounded off.
        for _ in 0..2 {
            self.smooth();
        }
        let wide = windows(&self.edge, f32::min);
        self.edge = windows(&wide, f32::max);
        // What lies between two samples is bounded by both.
        self.most = (0..self.across)
            .map(|x| self.most[x].max(self.most[(x + 1).min(self.across - 1)]))
            .collect();
    }

    /// Takes the mean of each sample and its eight neighbours where all of them stand.
    fn smooth(&mut self) {
        let (before, across) = (self.front.clone(), self.across);
        for y in 1..self.tall - 1 {
            for x in 1..across - 1 {
                let rows =
                    [y - 1, y, y + 1].map(|y| &before[y * across + x - 1..y * across + x + 2]);
                if rows.iter().all(|row| row.iter().all(|z| *z > NOTHING)) {
                    self.front[y * across + x] =
                        rows.iter().flat_map(|row| *row).sum::<f32>() / 9.0;
                }
            }
        }
    }

    /// The sample to the left of a place and the share of the next one.
    #[inline]
    fn column(&self, x: f32) -> Option<(usize, f32)> {
        let across = (x - self.left) * (1.0 / CELL_MM);
        let inside = across >= 0.0 && across < (self.across - 1) as f32;
        inside.then(|| (across as usize, across - (across as usize) as f32))
    }

    /// Whether a point may be held by the row, or may be when it is `near_mm` nearer.
    #[inline]
    pub(super) fn may_hold(&self, p: Vec3A, near_mm: f32) -> bool {
        let height = p.y * self.up - self.bottom;
        if height < -near_mm || height > TALL_MM {
            return false;
        }
        self.column(p.x)
            .is_some_and(|(x, _)| p.z < self.most[x] + near_mm)
    }

    /// The way out for a point in the row or nearer than `clearance_mm`: past the edge where that is the shorter one by
    /// `rather_ahead_mm`, else ahead.
    pub(super) fn push(&self, p: Vec3A, clearance_mm: f32, rather_ahead_mm: f32) -> Option<Vec3A> {
        let (x, share) = self.column(p.x)?;
        let edge = self.edge[x] + (self.edge[x + 1] - self.edge[x]) * share;
        let inside = p.y * self.up - edge + clearance_mm;
        let tall = (p.y * self.up - self.bottom) * (1.0 / CELL_MM);
        if inside <= 0.0 || tall >= (self.tall - 1) as f32 {
            return None;
        }
        let tall = tall.max(0.0);
        let (y, rise) = (tall as usize, tall - (tall as usize) as f32);
        let at = |y: usize, x: usize| self.front[y * self.across + x];
        let (a, b, c, d) = (at(y, x), at(y, x + 1), at(y + 1, x), at(y + 1, x + 1));
        let (low, high) = (a + (b - a) * share, c + (d - c) * share);
        let front = low + (high - low) * rise;
        let slope_x = ((b - a) + (d - c - b + a) * rise) * (1.0 / CELL_MM);
        let slope_y = (high - low) * (self.up / CELL_MM);
        let per = 1.0 / (1.0 + slope_x * slope_x + slope_y * slope_y);
        // Both along the front's normal.
        let behind = (front - p.z) * per.sqrt() + clearance_mm;
        if behind <= 0.0 || front - p.z > BEHIND_MM {
            return None;
        }
        Some(if inside + rather_ahead_mm < behind {
            vec3a(0.0, -inside * self.up, 0.0)
        } else {
            vec3a(-slope_x, -slope_y, 1.0) * (per.sqrt() * behind)
        })
    }
}

/// The least or greatest value round each sample.
fn windows(row: &[f32], of: fn(f32, f32) -> f32) -> Vec<f32> {
    let reach = (GAP_MM / CELL_MM) as usize;
    (0..row.len())
        .map(|i| {
            let around = &row[i.saturating_sub(reach)..(i + reach + 1).min(row.len())];
            around.iter().copied().fold(row[i], of)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A wall 20 mm tall whose front is at z = 100 and whose biting edge is at y = -30.
    fn wall() -> Field {
        let p = |x, y| Vec3::new(x, y, 100.0);
        let mesh = Mesh {
            positions: vec![
                p(-30.0, -30.0),
                p(30.0, -30.0),
                p(30.0, -10.0),
                p(-30.0, -10.0),
            ],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        };
        Field::new([&mesh].into_iter(), 1.0).unwrap()
    }

    #[test]
    fn a_point_in_a_wall_leaves_by_the_nearer_way() {
        let wall = wall();
        let ahead = wall.push(vec3a(3.0, -22.0, 98.5), 0.0, 0.0).unwrap();
        assert!(ahead.abs_diff_eq(vec3a(0.0, 0.0, 1.5), 1e-4), "{ahead}");
        let below = wall.push(vec3a(3.0, -29.5, 97.0), 0.0, 0.0).unwrap();
        assert!(below.abs_diff_eq(vec3a(0.0, -0.75, 0.0), 0.3), "{below}");
        assert!(wall.push(vec3a(3.0, -32.0, 97.0), 0.0, 0.0).is_none());
        assert!(wall.push(vec3a(3.0, -22.0, 100.5), 0.1, 0.0).is_none());
    }
}
