//! The drawn surface of lips and lids as the renderer's finest tier has it, and how deep points lie in it.

use std::collections::HashMap;

use glam::Vec3;
use mouthpiece_rig::lip_level::BORDER;
use mouthpiece_rig::{Detail, Head, Lips, Subdivision, normals};

/// Farther than this from a sheet a point is no longer asked about, mm.
const REACH_MM: f32 = 2.0;

/// The skin as it is drawn, with the triangles of some of its regions.
pub(crate) struct Drawn {
    subdivision: Subdivision,
    pub(crate) upper: Sheet,
    pub(crate) lower: Sheet,
    /// Points beside the corners of the mouth, where both lips are one.
    corner: Vec<bool>,
}

/// Triangles of one region, and the points that they use.
pub(crate) struct Sheet {
    pub(crate) triangles: Vec<[u32; 3]>,
    pub(crate) points: Vec<u32>,
    /// Whether a point is on the region's border, by its number.
    border: Vec<bool>,
}

impl Drawn {
    /// Edges halved `levels` times: the finest tier has 2.
    pub(crate) fn new(head: &Head, levels: usize) -> Self {
        let detail = Detail {
            levels,
            ..Detail::default()
        };
        let subdivision = head.subdivision(&detail).unwrap();
        let Lips { upper, lower } = &head.lips;
        let columns = |columns: &[[u32; 11]]| {
            let mut inside = vec![0.0_f32; head.skin.mesh.positions.len()];
            for v in columns.iter().flat_map(|column| &column[BORDER..]) {
                inside[*v as usize] = 1.0;
            }
            inside
        };
        let (upper, lower) = (
            Sheet::new(&subdivision, &columns(upper)),
            Sheet::new(&subdivision, &columns(lower)),
        );
        let mut corners = vec![0.0; head.skin.mesh.positions.len()];
        for column in head
            .lips
            .upper
            .first()
            .iter()
            .chain(&head.lips.upper.last())
        {
            for v in *column {
                corners[*v as usize] = 1.0;
            }
        }
        let spread = subdivision.spread(&corners);
        let corner = spread.iter().map(|s| *s > 0.0).collect();
        Self {
            subdivision,
            upper,
            lower,
            corner,
        }
    }

    /// Triangles whose control vertices all have the value 1.
    pub(crate) fn sheet(&self, inside: &[f32]) -> Sheet {
        Sheet::new(&self.subdivision, inside)
    }

    pub(crate) fn points(&self, control: &[Vec3]) -> Vec<Vec3> {
        let mut points = vec![Vec3::ZERO; self.subdivision.point_count()];
        self.subdivision.apply(control, &mut points);
        points
    }

    /// Triangles of points; those of the ears' islands have copies among theirs and are left out.
    pub(crate) fn triangles(&self) -> Vec<[u32; 3]> {
        let count = self.subdivision.point_count() as u32;
        let whole = |t: &&[u32; 3]| t.iter().all(|p| *p < count);
        self.subdivision
            .triangles()
            .iter()
            .filter(whole)
            .copied()
            .collect()
    }

    /// Places where a look from straight ahead goes between the lips: at each x, a look at the seam meets one of
    /// both lips in front of the teeth.
    pub(crate) fn see_through(&self, control: &[Vec3]) -> Vec<(f32, f32)> {
        let points = self.points(control);
        let edge = |sheet: &Sheet, x: f32, best: fn(f32, f32) -> f32| {
            let mut found: Option<f32> = None;
            for t in &sheet.triangles {
                for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                    let (a, b) = (points[a as usize], points[b as usize]);
                    if (a.x - x) * (b.x - x) <= 0.0 && (a.x - b.x).abs() > 1e-6 {
                        let y = a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
                        found = Some(found.map_or(y, |f| best(f, y)));
                    }
                }
            }
            found
        };
        let (mut low, mut high) = (f32::MAX, f32::MIN);
        for p in &self.upper.points {
            let x = points[*p as usize].x;
            (low, high) = (low.min(x), high.max(x));
        }
        (0..200)
            .map(|i| low + (high - low) * (i as f32 + 0.5) / 200.0)
            .filter_map(|x| {
                let gap = edge(&self.upper, x, f32::min)? - edge(&self.lower, x, f32::max)?;
                (gap > 0.05).then_some((x, gap))
            })
            .collect()
    }

    /// How far front to back the lips touch in the middle of the mouth, mm.
    pub(crate) fn band(&self, control: &[Vec3]) -> f32 {
        const TOUCH_MM: f32 = 0.12;
        let points = self.points(control);
        let near = |p: &Vec3| p.x.abs() < 1.0;
        let of = |sheet: &Sheet| -> Vec<Vec3> {
            sheet
                .points
                .iter()
                .map(|p| points[*p as usize])
                .filter(near)
                .collect()
        };
        let (upper, lower) = (of(&self.upper), of(&self.lower));
        let touching: Vec<f32> = lower
            .iter()
            .filter(|p| {
                // Compared over what lies just in front and behind, since points do not face each other.
                let height = |sign: f32| {
                    upper
                        .iter()
                        .filter(|q| {
                            (q.z - p.z) * sign >= 0.0 && (q.z - p.z).abs() < 1.2 && q.y < p.y + 3.0
                        })
                        .map(|q| (q.z, q.y))
                        .min_by(|a, b| (a.0 - p.z).abs().total_cmp(&(b.0 - p.z).abs()))
                };
                match (height(1.0), height(-1.0)) {
                    (Some(a), Some(b)) => {
                        let share = if (b.0 - a.0).abs() < 1e-6 {
                            0.0
                        } else {
                            (p.z - a.0) / (b.0 - a.0)
                        };
                        a.1 + (b.1 - a.1) * share - p.y < TOUCH_MM
                    }
                    _ => false,
                }
            })
            .map(|p| p.z)
            .collect();
        let most = touching.iter().copied().fold(f32::MIN, f32::max);
        let least = touching.iter().copied().fold(f32::MAX, f32::min);
        (most - least).max(0.0)
    }

    /// How deep either lip's surface lies in the other's, mm, and where.
    pub(crate) fn lips_overlap(&self, control: &[Vec3]) -> (f32, Vec3) {
        let points = self.points(control);
        let a = self.deepest(&points, &self.lower, &self.upper);
        let b = self.deepest(&points, &self.upper, &self.lower);
        if a.0 > b.0 { a } else { b }
    }

    /// The depth of the deepest of a sheet's points inside another sheet of a surface, whose triangles face outwards.
    fn deepest(&self, points: &[Vec3], of: &Sheet, inside: &Sheet) -> (f32, Vec3) {
        let all = normals(points, &self.triangles());
        let bin = |x: f32| (((x + 60.0) / REACH_MM) as usize).min(59);
        let mut bins = vec![Vec::new(); 60];
        for t in &inside.triangles {
            let xs = t.map(|p| points[p as usize].x);
            let low = xs.into_iter().fold(f32::MAX, f32::min) - REACH_MM;
            let high = xs.into_iter().fold(f32::MIN, f32::max) + REACH_MM;
            for bin in &mut bins[bin(low)..=bin(high)] {
                bin.push(*t);
            }
        }
        let mut worst = (0.0, Vec3::ZERO);
        for &point in of.points.iter().filter(|p| !self.corner[**p as usize]) {
            let p = points[point as usize];
            let mut best = (REACH_MM, Vec3::ZERO, Vec3::ZERO);
            let mut beside = false;
            for t in &bins[bin(p.x)] {
                let corners = t.map(|i| points[i as usize]);
                if corners
                    .iter()
                    .all(|c| (c.y - p.y).abs() > 4.0 || (c.z - p.z).abs() > 4.0)
                {
                    continue;
                }
                let shares = nearest(p, corners);
                let at: Vec3 = corners.iter().zip(shares).map(|(c, s)| *c * s).sum();
                let distance = at.distance(p);
                if distance < best.0 {
                    let normal: Vec3 = t
                        .iter()
                        .zip(shares)
                        .map(|(i, s)| all[*i as usize] * s)
                        .sum();
                    best = (distance, at, normal);
                    // Past its border a sheet has no inside.
                    let on_border =
                        |(i, share): (&u32, f32)| share < 1e-3 || inside.border[*i as usize];
                    beside = t.iter().zip(shares).all(on_border);
                }
            }
            // Both surfaces face each other where they overlap; at the corner they are one and do not.
            let facing = all[point as usize].dot(best.2.normalize_or_zero()) < -0.3;
            if !beside
                && facing
                && best.0 < REACH_MM
                && best.0 > worst.0
                && (p - best.1).dot(best.2) < 0.0
            {
                worst = (best.0, p);
            }
        }
        worst
    }
}

impl Sheet {
    fn new(subdivision: &Subdivision, inside: &[f32]) -> Self {
        let spread = subdivision.spread(inside);
        let triangles: Vec<[u32; 3]> = subdivision
            .triangles()
            .iter()
            .filter(|t| {
                t.iter()
                    .all(|p| spread.get(*p as usize).is_some_and(|s| *s > 0.999))
            })
            .copied()
            .collect();
        let mut points: Vec<u32> = triangles.iter().flatten().copied().collect();
        points.sort_unstable();
        points.dedup();
        let mut uses = HashMap::new();
        for t in &triangles {
            for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
                *uses.entry([a.min(b), a.max(b)]).or_insert(0) += 1;
            }
        }
        let mut border = vec![false; subdivision.point_count()];
        for (ends, _) in uses.iter().filter(|(_, uses)| **uses == 1) {
            for end in ends {
                border[*end as usize] = true;
            }
        }
        Self {
            triangles,
            points,
            border,
        }
    }
}

/// Shares of a triangle's corners in its point nearest to `p`.
pub(crate) fn nearest(p: Vec3, [a, b, c]: [Vec3; 3]) -> [f32; 3] {
    let (ab, ac, n) = (b - a, c - a, (b - a).cross(c - a));
    let area = n.length_squared().max(1e-20);
    let v = (p - a).cross(ac).dot(n) / area;
    let w = ab.cross(p - a).dot(n) / area;
    if v >= 0.0 && w >= 0.0 && v + w <= 1.0 {
        return [1.0 - v - w, v, w];
    }
    let on = |q: Vec3, r: Vec3| {
        let share = ((p - q).dot(r - q) / (r - q).length_squared().max(1e-20)).clamp(0.0, 1.0);
        (share, (q + (r - q) * share).distance_squared(p))
    };
    let (ab, bc, ca) = (on(a, b), on(b, c), on(c, a));
    if ab.1 <= bc.1 && ab.1 <= ca.1 {
        [1.0 - ab.0, ab.0, 0.0]
    } else if bc.1 <= ca.1 {
        [0.0, 1.0 - bc.0, bc.0]
    } else {
        [ca.0, 0.0, 1.0 - ca.0]
    }
}
