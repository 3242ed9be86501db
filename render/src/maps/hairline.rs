//! How deep under hair a place of the skin lies, by the features `hairline_*`: what lies deep is not drawn.

use glam::{Vec2, vec2};
use mouthpiece_rig::{Head, Material};

use super::CHART_MM;

/// Both sides of the hairline, from the forehead backwards.
#[derive(Clone, Debug)]
pub(crate) struct Hairline {
    /// The line, and the hand at which the hair lies as one walks it: the left one (with rows running
    /// down) on the subject's left side. Left, right.
    sides: [(Vec<Vec2>, f32); 2],
}

impl Hairline {
    /// None where the head has no hair or no such lines.
    pub(crate) fn shown(head: &Head) -> Option<Self> {
        let mut parts = head.parts.iter();
        parts
            .any(|part| part.material == Material::Hair)
            .then(|| Self::of(head))?
    }

    /// None where the head has no such lines.
    pub(crate) fn of(head: &Head) -> Option<Self> {
        let side = |name, hand| Some((line(head, name)?, hand));
        Some(Self {
            sides: [side("hairline_l", 1.0)?, side("hairline_r", -1.0)?],
        })
    }

    /// How far within the hair a place of the chart is, mm; below 0 outside.
    pub(crate) fn depth_mm(&self, uv: Vec2) -> f32 {
        let (line, hand) = &self.sides[usize::from(uv.x < 0.5)];
        let p = uv * CHART_MM;
        let (mut nearest, mut facing) = (f32::INFINITY, 0.0_f32);
        for step in line.windows(2) {
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

/// The named feature in mm, from the middle of the face outwards; none where the head has it not.
pub(crate) fn line(head: &Head, name: &str) -> Option<Vec<Vec2>> {
    let mut points: Vec<Vec2> = head
        .feature(name)?
        .points
        .iter()
        .map(|p| *p * CHART_MM)
        .collect();
    let from_middle = |p: &Vec2| (p.x - 0.5 * CHART_MM.x).abs();
    if from_middle(points.first()?) > from_middle(points.last()?) {
        points.reverse();
    }
    Some(points)
}

/// From the nearest point of a step of a line to `p`.
fn off_step(p: Vec2, from: Vec2, to: Vec2) -> Vec2 {
    let along = to - from;
    let share = ((p - from).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
    p - from - along * share
}
