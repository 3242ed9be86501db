//! The left ear: its front as it is seen from the side, its back as rows between the helix and the head.

use glam::{Vec2, Vec3, vec2, vec3};

use super::SculptError;
use super::fill::{Region, fill};
use super::half::{Half, closed};
use super::polyline::evenly;
use super::target::{Target, chart_of};

/// Edge length on the ear, mm.
const EDGE_MM: f32 = 2.7;
/// Where the helix joins the head above (otobasion superius), and about where its upper side there faces.
const OBS: Vec3 = vec3(76.69, 29.67, 14.04);
const HELIX_UP: Vec3 = vec3(0.4, 0.85, 0.35);
/// Rows between the helix and the line where the ear leaves the head.
const BACK_ROWS: usize = 4;

/// Places the ear; gives the line where it leaves the head, closed, counter-clockwise as seen from the side.
pub(super) fn build(half: &mut Half, target: &Target) -> Result<Vec<usize>, SculptError> {
    let curves = &target.curves;
    let (front, rear) = split(&curves.ear_attachment, curves.helix_outer_edge[0]);
    let count = |line: &[Vec3]| (length(line) / EDGE_MM).round().max(3.0) as usize + 1;

    // From the lobe's end up behind the ear to its top, along the silhouette and along the head: equally many.
    let mut silhouette = vec![rear[0]];
    silhouette.extend(&curves.helix_outer_edge);
    // Where the helix runs down to the temple its upper side is the silhouette.
    let (top, end) = (silhouette[silhouette.len() - 1], rear[rear.len() - 1]);
    let over = |share: f32| target.nearest(top.lerp(end, share), HELIX_UP.normalize(), 6.0);
    silhouette.extend([0.25, 0.5, 0.75].into_iter().filter_map(over));
    silhouette.push(end);
    let stations = count(&silhouette);
    let rim: Vec<usize> = push_line(half, &evenly(&silhouette, stations));
    let (low, high) = (rim[0], rim[stations - 1]);
    let mut root = vec![low];
    let along = evenly(&rear, stations);
    root.extend(push_line(half, &along[1..stations - 1]));
    root.push(high);
    let ahead = evenly(&front, count(&front));
    let mut fore = vec![high];
    fore.extend(push_line(half, &ahead[1..ahead.len() - 1]));
    fore.push(low);

    for &i in rim.iter().chain(&fore) {
        half.vertices[i].island = Some(from_side(half.vertices[i].position));
    }
    back(half, target, &rim, &root);

    let mut outline = rim.clone();
    outline.extend(&fore[1..fore.len() - 1]);
    let ridges = [
        &curves.helix_rim[4..],
        &curves.helix_inner_edge[..],
        &curves.antihelix_ridge,
        &curves.concha_boundary,
        &curves.tragus_ridge,
        &curves.antitragus_ridge,
    ];
    let mut lines: Vec<Vec<usize>> = Vec::new();
    for ridge in ridges {
        let points = evenly(ridge, count(ridge));
        let taken: Vec<Vec2> = half.vertices.iter().filter_map(|v| v.island).collect();
        let clear = |p: &Vec3| {
            taken
                .iter()
                .all(|q| q.distance(from_side(*p)) > 0.42 * EDGE_MM)
        };
        // A ridge that comes too near to another one is interrupted there.
        for run in points.split(|p| !clear(p)).filter(|run| !run.is_empty()) {
            let line = push_line(half, run);
            for &i in &line {
                half.vertices[i].island = Some(from_side(half.vertices[i].position));
            }
            half.keep(&line);
            lines.push(line);
        }
    }
    let first = half.vertices.len();
    let flat: Vec<Vec2> = half
        .vertices
        .iter()
        .map(|v| v.island.unwrap_or_default())
        .collect();
    let region = Region {
        outline,
        holes: Vec::new(),
        lines,
        spacing: &|_| EDGE_MM,
    };
    let (points, triangles) = fill(&flat, &region)?;
    for p in points {
        let place = target.seen_from_side(p.y, -p.x).unwrap_or_default();
        let i = half.push(place, chart_of(place));
        half.vertices[i].island = Some(p);
        half.vertices[i].free = true;
    }
    debug_assert!(
        triangles
            .iter()
            .flatten()
            .all(|&i| i >= first || half.vertices[i].island.is_some())
    );
    for t in triangles {
        half.triangle(t, true);
    }

    let mut attachment = root;
    attachment.extend(&fore[1..fore.len() - 1]);
    Ok(attachment)
}

/// The ear's own chart: what a look from the subject's left sees, face to the left.
fn from_side(p: Vec3) -> Vec2 {
    vec2(-p.z, p.y)
}

/// The back: rows from the silhouette to the head. On the island they lie outside the silhouette.
fn back(half: &mut Half, target: &Target, rim: &[usize], root: &[usize]) {
    let last = rim.len() - 1;
    let flat: Vec<Vec2> = rim
        .iter()
        .map(|&i| half.vertices[i].island.unwrap_or_default())
        .collect();
    let out = |i: usize| {
        let along = flat[(i + 1).min(last)] - flat[i.saturating_sub(1)];
        // The silhouette runs from the lobe up behind the ear: outside is to its right.
        vec2(along.y, -along.x).normalize_or_zero()
    };
    let mut outer = rim.to_vec();
    for row in 1..=BACK_ROWS {
        let share = row as f32 / BACK_ROWS as f32;
        let ring: Vec<usize> = (0..=last)
            .map(|i| {
                if i == 0 || i == last {
                    return rim[i];
                }
                let (a, b) = (
                    half.vertices[rim[i]].position,
                    half.vertices[root[i]].position,
                );
                let island = flat[i] + out(i) * (share * a.distance(b)).min(16.0);
                if row == BACK_ROWS {
                    half.vertices[root[i]].island = Some(island);
                    return root[i];
                }
                let p = a.lerp(b, share);
                let behind = Vec3::new(-0.5, 0.0, -1.0).normalize();
                let p = target.nearest(p, behind, 8.0).unwrap_or(p);
                let k = half.push(p, chart_of(p));
                half.vertices[k].island = Some(island);
                half.vertices[k].free = true;
                k
            })
            .collect();
        half.strip(&ring, &outer, true);
        outer = ring;
    }
}

/// The line where the ear leaves the head, cut at the lobe and where the helix joins the head above: the part before
/// the ear (from the top down) and the part behind it (from the lobe up).
fn split(attachment: &[Vec3], lobe: Vec3) -> (Vec<Vec3>, Vec<Vec3>) {
    let nearest = |q: Vec3| {
        let far = |i: &usize| attachment[*i].distance(q);
        (0..attachment.len())
            .min_by(|a, b| far(a).total_cmp(&far(b)))
            .unwrap_or(0)
    };
    let (low, high) = (nearest(lobe), nearest(OBS));
    let loop_ = closed(&(0..attachment.len()).collect::<Vec<_>>());
    let walk = |from: usize, to: usize| {
        let mut line = vec![attachment[from]];
        let mut at = from;
        while at != to {
            at = loop_[at + 1];
            line.push(attachment[at]);
        }
        line
    };
    let (down, up) = (walk(high, low), walk(low, high));
    let ahead = |line: &[Vec3]| line.iter().map(|p| p.z).sum::<f32>() / line.len() as f32;
    if ahead(&down) > ahead(&up) {
        (down, up)
    } else {
        let back = |mut line: Vec<Vec3>| {
            line.reverse();
            line
        };
        (back(up), back(down))
    }
}

fn push_line(half: &mut Half, points: &[Vec3]) -> Vec<usize> {
    points.iter().map(|&p| half.on_skin(p)).collect()
}

fn length(line: &[Vec3]) -> f32 {
    line.windows(2).map(|w| w[0].distance(w[1])).sum()
}
