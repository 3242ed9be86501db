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

/// A surface that the chart sees edge on is stretched no more than this.
const STRETCH_MAX: f32 = 2.2;
/// How far round the face reaches in the chart, mm: behind it come the ears, where the chart jumps.
const FACE_HALF: f32 = 95.0;

/// Distance of points in the chart, mm: the wanted edge length, less where the surface runs away from the chart, as
/// under nose and chin.
fn spacing(target: &Target, p: Vec2) -> f32 {
    if p.x > FACE_HALF {
        return edge_length(p);
    }
    let up = vec2(0.0, 0.6);
    let run = target.point(p + up).distance(target.point(p - up)) / (2.0 * up.y);
    edge_length(p) / run.clamp(1.0, STRETCH_MAX).powf(0.75)
}

/// Wanted edge length at a place of the chart, mm: fine where the face moves or turns sharply.
fn edge_length(p: Vec2) -> f32 {
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
    let (first, last) = (mouth[0], mouth[mouth.len() - 1]);
    let [below, above] = [first, last].map(|i| half.vertices[i].chart);
    let corners = [
        vec2(0.0, BOTTOM),
        vec2(0.0, TOP),
        vec2(BACK, TOP),
        vec2(BACK, BOTTOM),
    ];
    let [low, high, high_back, low_back] = corners.map(|chart| half.on_chart(target, chart));
    let mut between = |from: Vec2, to: Vec2| between(half, target, from, to);
    let upper = between(corners[1], corners[2]);
    let mut outline = vec![low];
    outline.extend(between(corners[0], below));
    outline.extend(mouth);
    outline.extend(between(above, corners[1]));
    outline.push(high);
    outline.extend(&upper);
    outline.push(high_back);
    outline.extend(between(corners[2], corners[3]));
    outline.push(low_back);
    outline.extend(between(corners[3], corners[0]));
    let mut lines = Vec::new();
    for points in [
        evenly(&target.curves.alar_crease[..31], ALAR_POINTS),
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
        spacing: &|p| spacing(target, p),
    };
    let (points, triangles) = fill(&half.charts(), &region)?;
    for chart in points {
        let i = half.on_chart(target, chart);
        half.vertices[i].free = true;
    }
    for t in triangles {
        half.triangle(t, false);
    }
    for &i in &upper {
        half.vertices[i].free = true;
    }
    let mut border = vec![high];
    border.extend(upper);
    border.push(high_back);
    Ok(border)
}

/// Vertices between two places of the chart at the wanted spacing, those places left out.
fn between(half: &mut Half, target: &Target, from: Vec2, to: Vec2) -> Vec<usize> {
    // Walk by the wanted lengths, then stretch the walk so that it ends where it should.
    let total = from.distance(to);
    let (mut shares, mut at) = (Vec::new(), 0.0);
    while at < total {
        at += spacing(target, from.lerp(to, at / total));
        shares.push(at);
    }
    let beyond = at - total > 0.5 * spacing(target, to);
    if beyond && shares.len() > 1 {
        shares.pop();
    }
    let stretch = shares.pop().unwrap_or(total);
    shares
        .into_iter()
        .map(|s| half.on_chart(target, from.lerp(to, s / stretch)))
        .collect()
}
