//! The skin between the openings: the left half of the head in its cylindrical chart.

use glam::{Vec2, vec2};

use super::SculptError;
use super::fill::{Region, fill};
use super::half::Half;
use super::polyline::evenly;
use super::target::{BACK, Target};

/// The chart's span of heights, mm; above lies the crown, below the collar.
pub(super) const TOP: f32 = 118.0;
pub(super) const BOTTOM: f32 = -105.0;
/// Points along the feature lines that run free of the openings.
const ALAR_POINTS: usize = 12;
const JAW_POINTS: usize = 17;

/// Wanted edge length at a place of the chart, mm: fine where the face moves or turns sharply.
fn spacing(p: Vec2) -> f32 {
    let near = |centre: Vec2, half: Vec2| ((p - centre).abs() - half).max(Vec2::ZERO).length();
    let mouth = near(vec2(0.0, -38.0), vec2(40.0, 20.0));
    let eye = near(vec2(39.0, 36.0), vec2(22.0, 15.0));
    let nose = near(vec2(0.0, 0.0), vec2(15.0, 9.0));
    let ear = near(vec2(142.0, 8.0), vec2(22.0, 30.0));
    let face = (3.7 + 0.085 * mouth.min(eye))
        .min(2.3 + 0.1 * nose)
        .min(6.8);
    face.min(3.0 + 0.17 * ear) + 0.03 * (p.x - 100.0).clamp(0.0, 140.0)
}

/// Fills the chart round the openings; gives the line along its upper edge, front to back.
///
/// `mouth` is the ring round the mouth from the mid line below to the one above, `holes` are the closed ones.
pub(super) fn build(
    half: &mut Half,
    target: &Target,
    mouth: &[usize],
    holes: Vec<Vec<usize>>,
) -> Result<Vec<usize>, SculptError> {
    let corner = |half: &Half, i: usize| half.vertices[i].chart;
    let (below, above) = (corner(half, mouth[0]), corner(half, mouth[mouth.len() - 1]));
    let mut outline = edge(half, target, vec2(0.0, BOTTOM), below);
    outline.extend(mouth);
    outline.extend(
        edge(half, target, above, vec2(0.0, TOP))
            .into_iter()
            .skip(1),
    );
    let upper = edge(half, target, vec2(0.0, TOP), vec2(BACK, TOP));
    let lower = edge(half, target, vec2(BACK, BOTTOM), vec2(0.0, BOTTOM));
    outline.extend(&upper);
    let last = half.on_chart(target, vec2(BACK, TOP));
    outline.push(last);
    outline.extend(
        edge(half, target, vec2(BACK, TOP), vec2(BACK, BOTTOM))
            .into_iter()
            .skip(1),
    );
    outline.extend(lower);
    let mut lines = Vec::new();
    for points in [
        evenly(&target.curves.alar_crease[..33], ALAR_POINTS),
        evenly(&target.curves.jaw_line, JAW_POINTS)[1..].to_vec(),
    ] {
        let line: Vec<usize> = points.into_iter().map(|p| half.on_skin(p)).collect();
        half.keep(&line);
        lines.push(line);
    }
    for hole in &holes {
        half.keep(&super::half::closed(hole));
    }
    let region = Region {
        outline,
        holes,
        lines,
        spacing: &spacing,
    };
    let (points, triangles) = fill(&half.charts(), &region)?;
    for chart in points {
        let i = half.on_chart(target, chart);
        half.vertices[i].free = true;
    }
    for t in triangles {
        half.triangle(t, false);
    }
    for &i in &upper[1..] {
        half.vertices[i].free = true;
    }
    let mut border = upper;
    border.push(last);
    Ok(border)
}

/// Vertices from one place of the chart to another at the wanted spacing, the last place left out.
fn edge(half: &mut Half, target: &Target, from: Vec2, to: Vec2) -> Vec<usize> {
    // Walk by the wanted lengths, then stretch the walk so that it ends where it should.
    let (total, mut shares, mut at) = (from.distance(to), vec![0.0], 0.0);
    while at < total {
        at += spacing(from.lerp(to, at / total));
        shares.push(at);
    }
    let stretch = if at - total > 0.5 * spacing(to) && shares.len() > 2 {
        shares.pop();
        shares[shares.len() - 1]
    } else {
        at
    };
    shares.pop();
    shares
        .into_iter()
        .map(|s| half.on_chart(target, from.lerp(to, s / stretch)))
        .collect()
}
