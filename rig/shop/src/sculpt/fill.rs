//! A flat region filled with triangles: feature lines as constraints, graded points between them, constrained
//! Delaunay triangles (HEADSHOP 3: edges aligned to features, tessellation by deformability).

use std::collections::HashMap;

use glam::Vec2;
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

use super::SculptError;

const SMOOTHING_ROUNDS: usize = 8;
/// Free points keep this share of the wanted edge length from each other.
const CROWDED: f32 = 0.86;
/// Triangles of less than half of this area are none, mm².
const SLIVER_MM2: f32 = 0.02;

/// A region by the numbers of its fixed points.
pub(super) struct Region<'a> {
    /// Its outline, closed.
    pub outline: Vec<usize>,
    /// Closed lines with no triangles inside.
    pub holes: Vec<Vec<usize>>,
    /// Open lines that edges must run along.
    pub lines: Vec<Vec<usize>>,
    /// Wanted edge length at a place.
    pub spacing: &'a dyn Fn(Vec2) -> f32,
}

/// A point with its number.
#[derive(Clone, Copy)]
struct Site {
    at: Vec2,
    index: usize,
}

impl HasPosition for Site {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        Point2::new(f64::from(self.at.x), f64::from(self.at.y))
    }
}

/// Fills `region` over `fixed` points (only those it names are used). Gives the free points that were added, numbered
/// from `fixed.len()` on, and the triangles, counter-clockwise.
pub(super) fn fill(
    fixed: &[Vec2],
    region: &Region<'_>,
) -> Result<(Vec<Vec2>, Vec<[usize; 3]>), SculptError> {
    let mut points = fixed.to_vec();
    let mut used: Vec<usize> = region
        .outline
        .iter()
        .chain(region.holes.iter().flatten())
        .chain(region.lines.iter().flatten())
        .copied()
        .collect();
    used.sort_unstable();
    used.dedup();
    let polygon = |line: &[usize]| -> Vec<Vec2> { line.iter().map(|&i| fixed[i]).collect() };
    let outline = polygon(&region.outline);
    let holes: Vec<Vec<Vec2>> = region.holes.iter().map(|h| polygon(h)).collect();
    let within = |p: Vec2| contains(&outline, p) && !holes.iter().any(|h| contains(h, p));
    scatter(&mut points, &used, &outline, region.spacing, &within);
    used.extend(fixed.len()..points.len());
    let mut triangles = triangulate(&points, &used, region, &within)?;
    for _ in 0..SMOOTHING_ROUNDS {
        smooth(&mut points, &triangles, fixed.len());
        triangles = triangulate(&points, &used, region, &within)?;
    }
    Ok((points.split_off(fixed.len()), triangles))
}

/// Adds free points at the wanted spacing, by darts from a fine lattice: the same points every time.
fn scatter(
    points: &mut Vec<Vec2>,
    used: &[usize],
    outline: &[Vec2],
    spacing: &dyn Fn(Vec2) -> f32,
    within: &dyn Fn(Vec2) -> bool,
) {
    const CELL: f32 = 2.0;
    const STEP: f32 = 0.8;
    let key = |p: Vec2| ((p.x / CELL).floor() as i32, (p.y / CELL).floor() as i32);
    let mut grid: HashMap<(i32, i32), Vec<Vec2>> = HashMap::new();
    for &i in used {
        grid.entry(key(points[i])).or_default().push(points[i]);
    }
    let low = outline.iter().copied().fold(Vec2::INFINITY, Vec2::min);
    let high = outline.iter().copied().fold(Vec2::NEG_INFINITY, Vec2::max);
    let (rows, columns) = (
        ((high.y - low.y) / STEP) as i32,
        ((high.x - low.x) / STEP) as i32,
    );
    // Finest regions first, so that the coarse ones fit themselves to them.
    let mut candidates: Vec<(f32, Vec2)> = (1..rows)
        .flat_map(|r| (1..columns).map(move |c| (r, c)))
        .map(|(r, c)| low + Vec2::new(c as f32 + 0.5 * (r & 1) as f32, r as f32) * STEP)
        .map(|p| (spacing(p), p))
        .collect();
    candidates.sort_by(|a, b| {
        a.0.total_cmp(&b.0)
            .then(a.1.y.total_cmp(&b.1.y))
            .then(a.1.x.total_cmp(&b.1.x))
    });
    for (wanted, p) in candidates {
        let reach = (wanted / CELL).ceil() as i32;
        let (kx, ky) = key(p);
        let crowded = (-reach..=reach).any(|dx| {
            (-reach..=reach).any(|dy| {
                grid.get(&(kx + dx, ky + dy))
                    .is_some_and(|cell| cell.iter().any(|q| q.distance(p) < CROWDED * wanted))
            })
        });
        if !crowded && within(p) {
            points.push(p);
            grid.entry((kx, ky)).or_default().push(p);
        }
    }
}

/// Whether a closed polygon contains a point (even-odd rule).
fn contains(polygon: &[Vec2], p: Vec2) -> bool {
    let mut inside = false;
    for i in 0..polygon.len() {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}

fn triangulate(
    points: &[Vec2],
    used: &[usize],
    region: &Region<'_>,
    within: &dyn Fn(Vec2) -> bool,
) -> Result<Vec<[usize; 3]>, SculptError> {
    let mut mesh = ConstrainedDelaunayTriangulation::<Site>::new();
    let mut handles = HashMap::new();
    for &index in used {
        let at = points[index];
        handles.insert(index, mesh.insert(Site { at, index })?);
    }
    let closed = region.holes.iter().chain([&region.outline]);
    let rings = closed.flat_map(|l| (0..l.len()).map(|i| (l[i], l[(i + 1) % l.len()])));
    let open = region
        .lines
        .iter()
        .flat_map(|l| l.windows(2).map(|w| (w[0], w[1])));
    for (a, b) in rings.chain(open) {
        let (a, b) = (handles[&a], handles[&b]);
        if a != b && mesh.can_add_constraint(a, b) {
            mesh.add_constraint(a, b);
        }
    }
    Ok(mesh
        .inner_faces()
        .map(|face| face.vertices().map(|v| *v.data()))
        .filter(|t| within((t[0].at + t[1].at + t[2].at) / 3.0))
        // Rounding leaves slivers along straight outlines.
        .filter(|t| (t[1].at - t[0].at).perp_dot(t[2].at - t[0].at) > SLIVER_MM2)
        .map(|t| t.map(|site| site.index))
        .collect())
}

/// Moves each free point towards the middle of its neighbours.
fn smooth(points: &mut [Vec2], triangles: &[[usize; 3]], kept: usize) {
    let mut sum = vec![(Vec2::ZERO, 0.0_f32); points.len()];
    for t in triangles {
        for i in 0..3 {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            for (v, other) in [(a, b), (b, a)] {
                sum[v].0 += points[other];
                sum[v].1 += 1.0;
            }
        }
    }
    for (point, (total, count)) in points.iter_mut().zip(sum).skip(kept) {
        if count > 0.0 {
            *point = point.lerp(total / count, 0.6);
        }
    }
}
