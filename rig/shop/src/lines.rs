//! A head's feature lines on the skin's chart in mm, and distances to them: for hair and colour alike.

use glam::{Vec2, vec2};
use mouthpiece_rig::Head;

use crate::noise::value;

/// A mean radius of the face, mm: turns longitude into length.
pub(crate) const RADIUS_MM: f32 = 92.0;
/// Millimetres a unit of the chart's `uv`.
pub(crate) const CHART_MM: Vec2 = vec2(std::f32::consts::TAU * RADIUS_MM, 256.0);

/// A polyline with its bounds.
#[derive(Clone, Debug)]
pub(crate) struct Line {
    pub(crate) points: Vec<Vec2>,
    min: Vec2,
    max: Vec2,
}

impl Line {
    /// The named feature, where the head has it.
    pub(crate) fn of(head: &Head, name: &str) -> Option<Self> {
        let points: Vec<Vec2> = head
            .feature(name)?
            .points
            .iter()
            .map(|p| *p * CHART_MM)
            .collect();
        let min = points.iter().copied().reduce(Vec2::min)?;
        let max = points.iter().copied().reduce(Vec2::max)?;
        Some(Self { points, min, max })
    }

    /// The feature's left and right line.
    pub(crate) fn pair(head: &Head, name: &str) -> Vec<Self> {
        ["l", "r"]
            .iter()
            .filter_map(|side| Self::of(head, &format!("{name}_{side}")))
            .collect()
    }

    /// Turns the line so that it starts nearer the middle of the face.
    pub(crate) fn outward(mut self) -> Self {
        let from_middle = |p: Option<&Vec2>| p.map_or(0.0, |p| (p.x - 0.5 * CHART_MM.x).abs());
        if from_middle(self.points.first()) > from_middle(self.points.last()) {
            self.points.reverse();
        }
        self
    }

    /// The point at a share of the line's length.
    pub(crate) fn at_share(&self, share: f32) -> Vec2 {
        let total: f32 = self.points.windows(2).map(|w| w[0].distance(w[1])).sum();
        let mut left = total * share.clamp(0.0, 1.0);
        for w in self.points.windows(2) {
            let step = w[0].distance(w[1]);
            if left <= step {
                return w[0].lerp(w[1], left / step.max(1e-9));
            }
            left -= step;
        }
        self.points.last().copied().unwrap_or(Vec2::ZERO)
    }

    /// Distance of a place from the line, mm; infinite where it is surely more than `reach`.
    pub(crate) fn distance(&self, p: Vec2, reach: f32) -> f32 {
        let outside = (self.min - p).max(p - self.max).max(Vec2::ZERO);
        if outside.length_squared() > reach * reach {
            return f32::INFINITY;
        }
        let squared = self
            .points
            .windows(2)
            .map(|w| off_step(p, w[0], w[1]).length_squared())
            .fold(f32::INFINITY, f32::min);
        squared.sqrt()
    }
}

/// From the nearest point of a step of a line to `p`.
fn off_step(p: Vec2, from: Vec2, to: Vec2) -> Vec2 {
    let along = to - from;
    let share = ((p - from).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
    p - from - along * share
}

/// Both sides of the hairline, from the forehead backwards.
#[derive(Clone, Debug)]
pub(crate) struct Hairline {
    /// The line, and the hand at which the hair lies as one walks it: the left one (with rows running
    /// down) on the subject's left side. Left, right.
    pub(crate) sides: [(Line, f32); 2],
}

impl Hairline {
    /// None where the head has no such lines.
    pub(crate) fn of(head: &Head) -> Option<Self> {
        let side = |name, hand| Some((Line::of(head, name)?.outward(), hand));
        Some(Self {
            sides: [side("hairline_l", 1.0)?, side("hairline_r", -1.0)?],
        })
    }

    /// How far within the hair a place of the chart is, mm; below 0 outside.
    pub(crate) fn depth_mm(&self, uv: Vec2) -> f32 {
        let (line, hand) = &self.sides[usize::from(uv.x < 0.5)];
        let p = uv * CHART_MM;
        let (mut nearest, mut facing) = (f32::INFINITY, 0.0_f32);
        for step in line.points.windows(2) {
            let off = off_step(p, step[0], step[1]);
            let squared = off.length_squared();
            if squared > nearest * 1.001 {
                continue;
            }
            let along = step[1] - step[0];
            let side = off.dot(vec2(along.y, -along.x).normalize_or_zero()) * hand;
            // At a corner two steps are equally near: the one that is more square to it decides.
            if squared < nearest * 0.999 || side.abs() > facing.abs() {
                (nearest, facing) = (squared, side);
            }
        }
        nearest.sqrt() * facing.signum()
    }
}

/// How far the edge of hair strays from its line at a place of the chart (mm): what grows there and what is painted
/// there stray together.
pub(crate) fn waver_mm(chart: Vec2) -> f32 {
    4.0 * (value(chart.x * 0.10, chart.y * 0.10, 5) - 0.5)
        + 3.0 * (value(chart.x * 0.33, chart.y * 0.33, 6) - 0.5)
}
