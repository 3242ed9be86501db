//! Hairs on the skin along the feature lines `hairline_*`, so that the cap of hair does not end like a
//! cap: roots just inside the line, tips over it. A head without these lines has none.

use glam::{Vec2, vec2};
use mouthpiece_rig::Head;

use super::lines::{CHART_MM, Line, off_step};
use super::noise::Dice;
use super::strokes::{Blend, Field, Stroke};
use super::{CHART_HEIGHT, WINDOW_MAX, WINDOW_MIN};

/// Hairs a mm of the line.
const HAIRS_PER_MM: f32 = 9.0;

/// Both sides of the hairline, from the forehead backwards.
#[derive(Clone, Debug)]
pub(crate) struct Hairline {
    /// The line, and the hand at which the hair lies as one walks it: the left one (with rows running
    /// down) on the subject's left side. Left, right.
    sides: [(Line, f32); 2],
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

/// Lays the hairs into `field`, which covers the window.
pub(crate) fn paint(field: &mut Field<1>, hairline: &Hairline) {
    for ((line, hand), seed) in hairline.sides.iter().zip([31, 32]) {
        let mut dice = Dice::new(seed);
        for side in line.points.windows(2) {
            let along = side[1] - side[0];
            let count = along.length() * HAIRS_PER_MM;
            let inward = vec2(along.y, -along.x).normalize_or_zero() * *hand;
            // Part of a hair is a hair by chance: short steps must not lose theirs.
            for _ in 0..(count + dice.roll()) as usize {
                let on_line = side[0] + along * dice.roll();
                let root = on_line
                    + inward * (10.0 * dice.roll() * dice.roll() - 1.5 + 2.0 * dice.spread());
                let lean = along.normalize_or_zero() * (0.9 * dice.spread());
                let direction = (lean - inward).normalize_or_zero();
                let length_mm = 2.2 + 2.6 * dice.roll();
                let tip = root + direction * length_mm;
                let texel = |p: Vec2| {
                    let share = (p / CHART_MM - WINDOW_MIN) / (WINDOW_MAX - WINDOW_MIN);
                    share * vec2(field.width as f32, field.height as f32)
                };
                let points = [
                    texel(root),
                    texel(root.lerp(tip, 0.5) + lean * 0.3),
                    texel(tip),
                ];
                let per_mm = field.height as f32 / CHART_HEIGHT / (WINDOW_MAX.y - WINDOW_MIN.y);
                let strength = [0.55 + 0.45 * dice.roll()];
                field.draw(
                    &Stroke {
                        points,
                        half_width: 0.17 * per_mm,
                        strength,
                    },
                    Blend::Cover,
                );
            }
        }
    }
}
