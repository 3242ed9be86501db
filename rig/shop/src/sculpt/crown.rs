//! The top of the head, where the cylindrical chart runs out: filled in plan, as it is seen from above.

use glam::{Vec2, Vec3, vec2, vec3};

use super::SculptError;
use super::fill::{Region, fill};
use super::half::Half;
use super::target::{AXIS_Z, Target, chart_of};

/// Edge length on the crown, mm.
const EDGE_MM: f32 = 10.5;

/// Closes the half template above `border`, which runs along the chart's upper edge from the front to the back.
pub(super) fn build(half: &mut Half, target: &Target, border: &[usize]) -> Result<(), SculptError> {
    let plan = |p: Vec3| vec2(p.x, -p.z);
    let from_above = |p: Vec2| target.seen_from_above(p.x, -p.y);
    let [first, last] = [0, border.len() - 1].map(|i| half.vertices[border[i]].position.z);
    let steps = ((first - last) / EDGE_MM).round() as usize;
    let mut outline = border.to_vec();
    for i in 1..steps {
        let z = last + (first - last) * i as f32 / steps as f32;
        let p = from_above(vec2(0.0, -z));
        outline.push(half.push(p, chart_of(vec3(0.0, p.y, p.z))));
    }
    let flat: Vec<Vec2> = half.vertices.iter().map(|v| plan(v.position)).collect();
    // The surface falls away towards the border: as seen from above its points lie closer there.
    let spacing = |p: Vec2| {
        let from_top = vec2(p.x, p.y + AXIS_Z).length();
        EDGE_MM * (1.0 - 0.35 * (from_top / 85.0).powi(3)).max(0.5)
    };
    let region = Region {
        outline,
        holes: Vec::new(),
        lines: Vec::new(),
        spacing: &spacing,
    };
    let (points, triangles) = fill(&flat, &region)?;
    for p in points {
        let p = from_above(p);
        let i = half.push(p, chart_of(p));
        half.vertices[i].free = true;
    }
    for t in triangles {
        half.triangle(t, false);
    }
    Ok(())
}
