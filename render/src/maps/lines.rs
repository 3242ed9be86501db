//! A head's feature lines on the chart in mm, and distances to them.

use glam::{Vec2, vec2};
use mouthpiece_rig::Head;

use super::{CHART_HEIGHT, RADIUS};

/// Millimetres a unit of the chart's `uv`.
pub(crate) const CHART_MM: Vec2 = vec2(std::f32::consts::TAU * RADIUS, CHART_HEIGHT);

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
pub(crate) fn off_step(p: Vec2, from: Vec2, to: Vec2) -> Vec2 {
    let along = to - from;
    let share = ((p - from).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
    p - from - along * share
}
