//! The top of the head, where the cylindrical chart runs out: rings from the chart's upper border to the vertex.

use glam::{Vec3, vec3};

use super::layout::TOP;
use super::skin::Vertex;
use super::surface::Surface;

/// Height of the highest point of the head (Farkas's v), mm, and where it lies.
pub(super) const VERTEX: Vec3 = vec3(0.0, 145.05, 0.2);
const RINGS: usize = 5;

/// Closes the mesh above the chart's upper border.
pub(super) fn close(
    vertices: &mut Vec<Vertex>,
    triangles: &mut Vec<[usize; 3]>,
    surface: &Surface,
) {
    let mut border: Vec<usize> = (0..vertices.len())
        .filter(|&i| (vertices[i].chart.y - TOP).abs() < 1e-3)
        .collect();
    border.sort_by(|&a, &b| vertices[a].chart.x.total_cmp(&vertices[b].chart.x));
    let mut outer = border.clone();
    for ring in 1..=RINGS {
        let share = ring as f32 / (RINGS + 1) as f32;
        let inner: Vec<usize> = border
            .iter()
            .map(|&i| {
                let mut v = vertices[i];
                // Steps shorten towards the top, where the surface runs level.
                v.chart.y = VERTEX.y - (VERTEX.y - TOP) * (1.0 - share).powi(2);
                v.position = surface.point(v.chart);
                vertices.push(v);
                vertices.len() - 1
            })
            .collect();
        join(triangles, &outer, &inner);
        outer = inner;
    }
    let mut top = vertices[border[0]];
    top.position = VERTEX;
    top.chart.y = VERTEX.y;
    vertices.push(top);
    let apex = vec![vertices.len() - 1; outer.len()];
    join(triangles, &outer, &apex);
}

fn join(triangles: &mut Vec<[usize; 3]>, outer: &[usize], inner: &[usize]) {
    for i in 0..outer.len() {
        let next = (i + 1) % outer.len();
        let [a, b, c, d] = [outer[i], outer[next], inner[next], inner[i]];
        triangles.push([a, b, c]);
        if c != d {
            triangles.push([a, c, d]);
        }
    }
}
