//! Openings beside the mouth: lids with their thickness and closed rings round the eye, the nostril with its depth.

use glam::{Vec2, Vec3, vec2, vec3};

use super::eyes::Eyes;
use super::half::{Half, closed, middle};
use super::polyline::{evenly, superellipse};
use super::target::{ChartPoint, Target, chart_of};

/// Vertices round a lid margin.
const LIDS: usize = 32;
/// Rings on the skin round the margin: how far along the way to the outermost; the crease of the upper lid lies on the
/// second one.
const RINGS: [f32; 6] = [0.13, 0.27, 0.38, 0.54, 0.75, 1.0];
const CREASE: usize = 1;
/// The outermost ring: from the middle of the margin towards the nose, the temple, up and down, mm in the chart.
const NASAL: f32 = 23.0;
const TEMPORAL: f32 = 30.0;
const UP: f32 = 17.5;
const DOWN: f32 = 19.0;

/// The eye's opening in the half template.
pub(super) struct Eye {
    /// Margins of the lids: outer and inner edge, counter-clockwise from the temporal end.
    pub margins: [Vec<usize>; 2],
    /// The outermost ring.
    pub outline: Vec<usize>,
}

/// Places lids and rings of the left eye.
pub(super) fn eye(half: &mut Half, target: &Target, eyes: &Eyes) -> Eye {
    let curves = &target.curves;
    let centre = middle(&curves.lid_margin_outer);
    let temple = centre + vec3(40.0, 0.0, -20.0);
    let outer: Vec<usize> = round(&curves.lid_margin_outer, temple, LIDS)
        .into_iter()
        .map(|p| half.on_skin(p))
        .collect();
    let ball = |p: Vec3, height: f32| {
        eyes.centre + (p - eyes.centre).normalize_or(Vec3::Z) * (eyes.radius + height)
    };
    let (mut inner, mut behind) = (Vec::new(), Vec::new());
    let inside = round(&curves.lid_margin_inner, temple, LIDS);
    for (p, &o) in inside.into_iter().zip(&outer) {
        let chart = half.vertices[o].chart;
        half.vertices[o].wet = 0.1;
        inner.push(half.push(ball(p, 0.25), chart));
        let out = (p - centre) * vec3(0.12, 0.8, 0.0);
        behind.push(half.push(ball(p + out - vec3(0.0, 0.0, 1.0), 0.1), chart));
    }
    for (ring, wet) in [(&inner, 0.8), (&behind, 1.0)] {
        for &i in ring {
            half.vertices[i].wet = wet;
        }
    }
    half.strip(&closed(&outer), &closed(&inner), false);
    half.strip(&closed(&inner), &closed(&behind), false);
    for ring in [&outer, &inner] {
        half.creases
            .extend(closed(ring).windows(2).map(|w| [w[0], w[1]]));
    }

    let middle = chart_of(centre);
    let crease: Vec<ChartPoint> = curves
        .upper_lid_crease
        .iter()
        .map(|p| chart_of(*p))
        .collect();
    let mut before = outer.clone();
    for (k, &share) in RINGS.iter().enumerate() {
        let ring: Vec<usize> = outer
            .iter()
            .map(|&o| {
                let from = half.vertices[o].chart;
                let out = middle + outermost(from - middle);
                let folded = crossing(from, out, &crease);
                // On the upper lid the second ring runs along the fold, the first half way to it.
                let share = match folded {
                    Some(fold) if k <= CREASE => fold * (k + 1) as f32 / (CREASE + 1) as f32,
                    Some(fold) => {
                        fold + (1.0 - fold) * (share - RINGS[CREASE]) / (1.0 - RINGS[CREASE])
                    }
                    None => share,
                };
                let chart = from.lerp(out, share);
                half.on_chart(target, chart)
            })
            .collect();
        half.strip(&closed(&ring), &closed(&before), false);
        before = ring;
    }
    Eye {
        margins: [outer, inner],
        outline: before,
    }
}

/// The outermost ring in the direction of a margin point; the margin is long and low, so its turn is evened out.
fn outermost(d: Vec2) -> Vec2 {
    let turn = (d.y * Eyes::SQUASH).atan2(d.x);
    let half = vec2(
        if d.x > 0.0 { TEMPORAL } else { NASAL },
        if d.y > 0.0 { UP } else { DOWN },
    );
    superellipse(turn, half, 2.2)
}

/// How far along the way from `a` to `b` a line is crossed.
fn crossing(a: Vec2, b: Vec2, line: &[Vec2]) -> Option<f32> {
    line.windows(2).find_map(|w| {
        let (d, e) = (b - a, w[1] - w[0]);
        let across = d.perp_dot(e);
        let (s, t) = (
            (w[0] - a).perp_dot(e) / across,
            (w[0] - a).perp_dot(d) / across,
        );
        ((0.1..0.6).contains(&s) && (0.0..=1.0).contains(&t)).then_some(s)
    })
}

/// Vertices round a nostril, and the way out of it to the ring round it, mm.
const NOSTRIL: usize = 14;
const NOSTRIL_RING_MM: f32 = 1.6;

/// Places the left nostril with its depth; gives the ring round it.
pub(super) fn nostril(half: &mut Half, target: &Target) -> Vec<usize> {
    let curves = &target.curves;
    let centre = middle(&curves.nostril_rim);
    let around = round(&curves.nostril_rim, centre + vec3(20.0, 0.0, 0.0), NOSTRIL);
    let rim: Vec<usize> = around.iter().map(|&p| half.on_skin(p)).collect();
    let inner = round(&curves.nostril_inner, around[0], NOSTRIL);
    let inside = middle(&inner);
    let up = vec3(0.8, 7.5, -2.5);
    let first = half.vertices.len();
    let mut outer = rim.clone();
    for (rise, shrink) in [(0.0, 1.0), (0.4, 0.9), (0.8, 0.66)] {
        let ring: Vec<usize> = inner
            .iter()
            .zip(&rim)
            .map(|(p, &i)| {
                let chart = half.vertices[i].chart;
                half.push(inside + (*p - inside) * shrink + up * rise, chart)
            })
            .collect();
        half.strip(&closed(&outer), &closed(&ring), false);
        outer = ring;
    }
    let chart = half.vertices[rim[0]].chart;
    let apex = half.push(inside + up, chart);
    half.strip(&closed(&outer), &vec![apex; outer.len() + 1], false);
    for v in &mut half.vertices[first..] {
        v.lit = 0.12;
    }
    let ring: Vec<usize> = around
        .iter()
        .map(|&p| {
            let out = p + (p - centre).normalize_or(Vec3::X) * NOSTRIL_RING_MM;
            half.on_skin(target.beside(out))
        })
        .collect();
    half.strip(&closed(&ring), &closed(&rim), false);
    ring
}

/// Points at equal lengths along a closed curve from its place nearest to `start`, counter-clockwise as seen in the
/// chart.
fn round(curve: &[Vec3], start: Vec3, count: usize) -> Vec<Vec3> {
    let far = |i: &usize| curve[*i].distance(start);
    let first = (0..curve.len())
        .min_by(|a, b| far(a).total_cmp(&far(b)))
        .unwrap_or(0);
    let mut line: Vec<Vec3> = curve[first..]
        .iter()
        .chain(&curve[..=first])
        .copied()
        .collect();
    let area: f32 = line
        .windows(2)
        .map(|w| chart_of(w[0]).perp_dot(chart_of(w[1])))
        .sum();
    if area < 0.0 {
        line.reverse();
    }
    let mut points = evenly(&line, count + 1);
    points.pop();
    points
}
