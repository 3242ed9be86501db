//! The template's left half in the chart: feature lines as constraints, graded points between them,
//! constrained Delaunay triangles (HEADSHOP 3: edges aligned to features, tessellation by deformability).

use std::collections::HashMap;

use glam::{Vec2, vec2};
use spade::{ConstrainedDelaunayTriangulation, HasPosition, Point2, Triangulation};

use super::ReferenceError;
use super::surface::{BACK, ChartPoint};

/// The chart's span of heights, mm; above lies the crown, below the collar.
pub(super) const TOP: f32 = 118.0;
pub(super) const BOTTOM: f32 = -105.0;
const SMOOTHING_ROUNDS: usize = 6;

/// A chart point with the number of its vertex.
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

/// The half template: fixed points first (feature lines), then free ones.
pub(super) struct Layout {
    pub points: Vec<ChartPoint>,
    pub triangles: Vec<[usize; 3]>,
}

/// A feature line through fixed points, by their numbers.
pub(super) struct Line {
    pub points: Vec<usize>,
    /// A closed line around an opening: no triangles inside.
    pub opening: bool,
}

/// Wanted edge length at a place of the chart, mm: fine where the face moves or turns sharply.
fn spacing(p: Vec2) -> f32 {
    let near = |centre: Vec2, half: Vec2| ((p - centre).abs() - half).max(Vec2::ZERO).length();
    let mouth = near(vec2(0.0, -34.0), vec2(20.0, 8.0));
    let eye = near(vec2(34.0, 36.0), vec2(14.0, 5.0));
    let nose = near(vec2(0.0, 0.0), vec2(15.0, 9.0));
    let ear = near(vec2(142.0, 8.0), vec2(22.0, 30.0));
    let face = (2.3 + 0.085 * mouth.min(eye).min(nose)).min(6.0);
    face.min(2.4 + 0.15 * ear).min(9.0)
}

/// Builds the half template around `fixed` points and `lines` through them.
pub(super) fn build(fixed: Vec<Vec2>, lines: &[Line]) -> Result<Layout, ReferenceError> {
    let mut points = fixed;
    add_border(&mut points);
    let kept = points.len();
    scatter(&mut points, lines);
    let mut triangles = triangulate(&points, lines)?;
    for _ in 0..SMOOTHING_ROUNDS {
        smooth(&mut points, &triangles, kept);
        triangles = triangulate(&points, lines)?;
    }
    Ok(Layout { points, triangles })
}

/// Points along the four edges of the half chart; the mid line is left open between lips.
fn add_border(points: &mut Vec<Vec2>) {
    let taken: Vec<Vec2> = points.clone();
    let far = |p: Vec2, gap: f32| taken.iter().all(|q| q.distance(p) > gap);
    for x in [0.0, BACK] {
        let mut y = BOTTOM;
        while y < TOP - 1.0 {
            let p = vec2(x, y);
            let in_mouth = x == 0.0 && (-44.0..-24.5).contains(&y);
            if !in_mouth && far(p, 1.4) {
                points.push(p);
            }
            y += spacing(p);
        }
    }
    let columns = (BACK / 8.0).round() as usize;
    for y in [BOTTOM, TOP] {
        for i in 0..=columns {
            let p = vec2(BACK * i as f32 / columns as f32, y);
            if points.iter().all(|q| q.distance(p) > 1.0) {
                points.push(p);
            }
        }
    }
}

/// Fills the chart with free points at the wanted spacing, by darts from a fine lattice: the same
/// points every time.
fn scatter(points: &mut Vec<Vec2>, lines: &[Line]) {
    const CELL: f32 = 2.0;
    let key = |p: Vec2| ((p.x / CELL).floor() as i32, (p.y / CELL).floor() as i32);
    let mut grid: HashMap<(i32, i32), Vec<Vec2>> = HashMap::new();
    for &p in points.iter() {
        grid.entry(key(p)).or_default().push(p);
    }
    let openings: Vec<Vec<Vec2>> = lines
        .iter()
        .filter(|l| l.opening)
        .map(|l| l.points.iter().map(|&i| points[i]).collect())
        .collect();
    let step = 0.8;
    let rows = ((TOP - BOTTOM) / step) as i32;
    let columns = (BACK / step) as i32;
    // Finest regions first, so that the coarse ones fit themselves to them.
    let mut candidates: Vec<(f32, Vec2)> = (1..rows)
        .flat_map(|r| (1..columns).map(move |c| (r, c)))
        .map(|(r, c)| {
            let shift = 0.5 * (r & 1) as f32;
            let p = vec2((c as f32 + shift) * step, BOTTOM + r as f32 * step);
            (spacing(p), p)
        })
        .collect();
    candidates.sort_by(|a, b| {
        (a.0, a.1.y, a.1.x)
            .partial_cmp(&(b.0, b.1.y, b.1.x))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    for (wanted, p) in candidates {
        let border = (BACK - p.x).min(p.x).min(TOP - p.y).min(p.y - BOTTOM);
        if border < 0.45 * wanted || openings.iter().any(|o| contains(o, p)) {
            continue;
        }
        let reach = (wanted / CELL).ceil() as i32;
        let (kx, ky) = key(p);
        let crowded = (-reach..=reach).any(|dx| {
            (-reach..=reach).any(|dy| {
                grid.get(&(kx + dx, ky + dy))
                    .is_some_and(|cell| cell.iter().any(|q| q.distance(p) < 0.86 * wanted))
            })
        });
        if !crowded {
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

fn triangulate(points: &[Vec2], lines: &[Line]) -> Result<Vec<[usize; 3]>, ReferenceError> {
    let mut mesh = ConstrainedDelaunayTriangulation::<Site>::new();
    let handles = points
        .iter()
        .enumerate()
        .map(|(index, &at)| mesh.insert(Site { at, index }))
        .collect::<Result<Vec<_>, _>>()?;
    for line in lines {
        let closing = line
            .opening
            .then(|| (line.points[line.points.len() - 1], line.points[0]));
        for (a, b) in line.points.windows(2).map(|w| (w[0], w[1])).chain(closing) {
            if mesh.can_add_constraint(handles[a], handles[b]) {
                mesh.add_constraint(handles[a], handles[b]);
            }
        }
    }
    let openings: Vec<Vec<Vec2>> = lines
        .iter()
        .filter(|l| l.opening)
        .map(|l| l.points.iter().map(|&i| points[i]).collect())
        .collect();
    Ok(mesh
        .inner_faces()
        .map(|face| face.vertices().map(|v| *v.data()))
        .filter(|t| {
            let centre = (t[0].at + t[1].at + t[2].at) / 3.0;
            !openings.iter().any(|o| contains(o, centre))
        })
        .map(|t| t.map(|site| site.index))
        .collect())
}

/// Moves each free point towards the middle of its neighbours.
fn smooth(points: &mut [Vec2], triangles: &[[usize; 3]], kept: usize) {
    let mut sum = vec![Vec2::ZERO; points.len()];
    let mut count = vec![0.0_f32; points.len()];
    for t in triangles {
        for i in 0..3 {
            let (a, b) = (t[i], t[(i + 1) % 3]);
            sum[a] += points[b];
            sum[b] += points[a];
            count[a] += 1.0;
            count[b] += 1.0;
        }
    }
    for i in kept..points.len() {
        if count[i] > 0.0 {
            points[i] = points[i].lerp(sum[i] / count[i], 0.6);
        }
    }
}
