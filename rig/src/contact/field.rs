//! A row of teeth with its gums from the front, as a height field: how far forward it stands at each place, and where
//! its biting edge is.

use glam::{Vec3, Vec3A, Vec4, vec3a};

use super::four::Places;
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
/// Added to a number that is not negative, this rounds it, into the bits.
const WHOLE: f32 = 8_388_608.0;
const WHOLE_BITS: u32 = 0x007f_ffff;
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
    /// Per sample across: the biting edge's height times `up`.
    edge: Vec<f32>,
    /// By height, then across, as far as a point may be off: how far forward something stands in the neighbourhood,
    /// and that much more. The greatest of them.
    reach: Vec<f32>,
    most: f32,
    /// How far below `bottom` samples of `reach` begin, and how many there are along the height.
    below: f32,
    high: usize,
}

impl Field {
    /// None where nothing of the meshes lies in the middle of the arch. Points will be looked for that may be
    /// `near_mm` off.
    pub(super) fn new<'a>(
        meshes: impl Iterator<Item = &'a Mesh>,
        up: f32,
        near_mm: f32,
    ) -> Option<Self> {
        let triangles: Vec<[Vec3; 3]> = meshes
            .flat_map(|m| {
                let at = |v: u32| m.positions.get(v as usize).copied().unwrap_or_default();
                m.triangles.iter().map(move |t| t.map(at))
            })
            .filter(|t| {
                t.iter().any(|p| p.x < HALF_WIDTH_MM) && t.iter().any(|p| p.x > -HALF_WIDTH_MM)
            })
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
            reach: Vec::new(),
            most: NOTHING,
            below: 0.0,
            high: 0,
        };
        for t in &triangles {
            field.raise(t);
        }
        field.close();
        field.look(near_mm);
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
            }
        }
        // Lips slide: steps between tooth and gum are rounded off.
        for _ in 0..2 {
            self.smooth();
        }
        let wide = windows(&self.edge, f32::min);
        self.edge = windows(&wide, f32::max);
    }

    /// Bounds the front round each sample, edges included: a point that is so far off may be held there.
    fn look(&mut self, near_mm: f32) {
        // A sample stands for what it is the nearest of, and what lies between samples is bounded by both.
        let cells = (near_mm / CELL_MM).ceil() as usize + 1;
        self.below = cells as f32 * CELL_MM;
        self.high = self.tall + cells;
        self.reach = (0..self.high * self.across)
            .map(|i| {
                let (x, y) = (i % self.across, (i / self.across) as i32 - cells as i32);
                let columns = x.saturating_sub(cells)..(x + cells + 1).min(self.across);
                let first = (y - cells as i32).clamp(0, self.tall as i32 - 1) as usize;
                let last = (y + cells as i32).clamp(0, self.tall as i32 - 1) as usize;
                let front = (first..=last)
                    .flat_map(|y| &self.front[y * self.across..][columns.clone()])
                    .fold(NOTHING, |most: f32, z| most.max(*z));
                front + near_mm
            })
            .collect();
        self.most = self.reach.iter().fold(NOTHING, |most, z| most.max(*z));
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
        let x = across as i32;
        inside.then_some((x as usize, across - x as f32))
    }

    /// Bits of the points that may be held by the row, were they as much off as was said.
    #[inline]
    pub(super) fn near(&self, at: &Places) -> u32 {
        let tall = at.y * self.up - Vec4::splat(self.bottom - self.below);
        let tall = tall * (1.0 / CELL_MM);
        let across = (at.x - Vec4::splat(self.left)) * (1.0 / CELL_MM);
        let inside = tall.cmpge(Vec4::ZERO)
            & tall.cmplt(Vec4::splat(self.high as f32))
            & across.cmpge(Vec4::ZERO)
            & across.cmplt(Vec4::splat(self.across as f32))
            & at.z.cmplt(Vec4::splat(self.most));
        let mask = inside.bitmask();
        if mask == 0 {
            return 0;
        }
        // Whole samples, in the lowest bits of numbers that are so great.
        let whole = |p: Vec4, count: usize| {
            let p = p.clamp(Vec4::ZERO, Vec4::splat((count - 1) as f32));
            (p + Vec4::splat(WHOLE))
                .to_array()
                .map(|p| (p.to_bits() & WHOLE_BITS) as usize)
        };
        let (tall, across) = (whole(tall, self.high), whole(across, self.across));
        let reach = std::array::from_fn(|i| self.reach[tall[i] * self.across + across[i]]);
        mask & at.z.cmplt(Vec4::from_array(reach)).bitmask()
    }

    /// The way out for a point in the row or nearer than `clearance_mm`: past the edge where that is the shorter one by
    /// `rather_ahead_mm`, else ahead.
    #[inline]
    pub(super) fn push(&self, p: Vec3A, clearance_mm: f32, rather_ahead_mm: f32) -> Option<Vec3A> {
        let (x, share) = self.column(p.x)?;
        let edge = self.edge[x] + (self.edge[x + 1] - self.edge[x]) * share;
        let inside = p.y * self.up - edge + clearance_mm;
        let tall = (p.y * self.up - self.bottom) * (1.0 / CELL_MM);
        if inside <= 0.0 || tall >= (self.tall - 1) as f32 {
            return None;
        }
        let tall = tall.max(0.0);
        let y = tall as i32;
        let (y, rise) = (y as usize, tall - y as f32);
        let at = |y: usize, x: usize| self.front[y * self.across + x];
        let (a, b, c, d) = (at(y, x), at(y, x + 1), at(y + 1, x), at(y + 1, x + 1));
        let (low, high) = (a + (b - a) * share, c + (d - c) * share);
        let front = low + (high - low) * rise;
        let slope_x = ((b - a) + (d - c - b + a) * rise) * (1.0 / CELL_MM);
        let slope_y = (high - low) * (self.up / CELL_MM);
        let per = 1.0 / (1.0 + slope_x * slope_x + slope_y * slope_y);
        // Both along the front's normal.
        let per = per.sqrt();
        let behind = (front - p.z) * per + clearance_mm;
        if behind <= 0.0 || front - p.z > BEHIND_MM {
            return None;
        }
        Some(if inside + rather_ahead_mm < behind {
            vec3a(0.0, -inside * self.up, 0.0)
        } else {
            vec3a(-slope_x, -slope_y, 1.0) * (per * behind)
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
        Field::new([&mesh].into_iter(), 1.0, 0.6).unwrap()
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
