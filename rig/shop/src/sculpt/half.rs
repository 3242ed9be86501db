//! The left half of the template while it grows: vertices, triangles, and which of them are what.

use glam::{Vec2, Vec3};

use super::target::{ChartPoint, Target, chart_of};

/// A vertex of the half template.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub position: Vec3,
    pub chart: ChartPoint,
    /// Place on the ear's own island of the texture, mm, where it is part of the ear.
    pub island: Option<Vec2>,
    pub vermilion: f32,
    pub wet: f32,
    /// Share of its light that reaches it through openings the mesh is too coarse to show.
    pub lit: f32,
    /// Whether relaxing may slide it along the surface.
    pub free: bool,
}

/// The half template.
#[derive(Default)]
pub(super) struct Half {
    pub vertices: Vec<Vertex>,
    pub triangles: Vec<[usize; 3]>,
    /// Per triangle: whether it takes its texture from the ear's island.
    pub of_ear: Vec<bool>,
    /// Edges that stay sharp.
    pub creases: Vec<[usize; 2]>,
    /// Edges along feature lines: flipping leaves them alone.
    pub kept: Vec<[usize; 2]>,
}

impl Half {
    pub(super) fn push(&mut self, position: Vec3, chart: ChartPoint) -> usize {
        self.vertices.push(Vertex {
            position,
            chart,
            island: None,
            vermilion: 0.0,
            wet: 0.0,
            lit: 1.0,
            free: false,
        });
        self.vertices.len() - 1
    }

    /// A vertex on a feature curve.
    pub(super) fn on_skin(&mut self, position: Vec3) -> usize {
        self.push(position, chart_of(position))
    }

    /// A vertex on the skin at a place of the chart.
    pub(super) fn on_chart(&mut self, target: &Target, chart: ChartPoint) -> usize {
        self.push(target.point(chart), chart)
    }

    /// A triangle, unless two of its corners are one.
    pub(super) fn triangle(&mut self, t: [usize; 3], of_ear: bool) {
        if t[0] != t[1] && t[1] != t[2] && t[2] != t[0] {
            self.triangles.push(t);
            self.of_ear.push(of_ear);
        }
    }

    /// Joins two rows of vertices by quads, each cut along its shorter diagonal. Seen from outside the second row lies
    /// to the left of the first one's direction.
    pub(super) fn strip(&mut self, first: &[usize], second: &[usize], of_ear: bool) {
        for i in 0..first.len() - 1 {
            let [a, b, c, d] = [first[i], first[i + 1], second[i + 1], second[i]];
            let length = |i: usize, j: usize| {
                self.vertices[i]
                    .position
                    .distance(self.vertices[j].position)
            };
            let quad = if length(a, c) <= length(b, d) {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, b, d], [b, c, d]]
            };
            for t in quad {
                self.triangle(t, of_ear);
            }
        }
        self.keep(first);
        self.keep(second);
    }

    /// Keeps the edges along a line.
    pub(super) fn keep(&mut self, line: &[usize]) {
        self.kept
            .extend(line.windows(2).map(|w| [w[0].min(w[1]), w[0].max(w[1])]));
    }

    /// Whether every vertex belongs to a triangle.
    pub(super) fn all_used(&self) -> bool {
        let mut used = vec![false; self.vertices.len()];
        for &i in self.triangles.iter().flatten() {
            used[i] = true;
        }
        used.into_iter().all(|used| used)
    }

    pub(super) fn charts(&self) -> Vec<ChartPoint> {
        self.vertices.iter().map(|v| v.chart).collect()
    }
}

/// A ring with its first vertex again at the end.
pub(super) fn closed(ring: &[usize]) -> Vec<usize> {
    ring.iter().chain(ring.first()).copied().collect()
}

/// The middle of some points.
pub(super) fn middle(points: &[Vec3]) -> Vec3 {
    points.iter().sum::<Vec3>() / points.len().max(1) as f32
}
