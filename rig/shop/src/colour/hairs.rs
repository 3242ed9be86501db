//! Roots of the hair and the down before them, along the features `hairline_*`: sparse and fine outside the line,
//! dense within, so that the cards of hair do not begin like a wig. A head without these lines has none.

use glam::{Vec2, vec2};

use super::strokes::{Cover, Field, Stroke};
use crate::lines::{CHART_MM, Hairline, waver_mm};
use crate::noise::{Dice, ramp};

/// Hairs a mm of the line.
const HAIRS_PER_MM: f32 = 24.0;

pub(super) fn paint(hairline: Option<&Hairline>, width: usize, height: usize) -> Cover {
    let mut field = Field::new(width, height);
    for ((line, hand), seed) in hairline.iter().flat_map(|h| &h.sides).zip([31, 32]) {
        let mut dice = Dice::new(seed);
        for side in line.points.windows(2) {
            let along = side[1] - side[0];
            let count = along.length() * HAIRS_PER_MM;
            let inward = vec2(along.y, -along.x).normalize_or_zero() * *hand;
            // Part of a hair is a hair by chance: short steps must not lose theirs.
            for _ in 0..(count + dice.roll()) as usize {
                let on_line = side[0] + along * dice.roll();
                // No line: it wavers.
                let waver = waver_mm(on_line);
                let share = dice.roll();
                let depth = waver - 5.0 + 13.0 * share.sqrt();
                let root = on_line + inward * depth;
                let grown = ramp(-5.0, 2.5, depth - waver);
                // Up from the forehead to the side it is brushed to; down and back on the sides.
                let lateral = ramp(
                    60.0,
                    110.0,
                    root.y - 0.1 * (root.x - 0.5 * CHART_MM.x).abs(),
                );
                let brushed = inward * 0.8 + vec2(-0.55, 0.0);
                let down = inward * 0.75 + vec2(0.0, 0.75);
                let direction =
                    brushed.lerp(down, lateral) + along.normalize_or_zero() * (0.5 * dice.spread());
                let direction = direction.normalize_or(inward);
                let length = (2.0 + 4.0 * dice.roll()) * (0.5 + 0.5 * grown);
                let middle = root + direction * (0.5 * length);
                let bend = Vec2::new(-direction.y, direction.x) * (0.2 * length * dice.spread());
                field.draw(&Stroke {
                    points: [root, middle + bend, root + direction * length].map(|p| p / CHART_MM),
                    width: 0.18 * (0.7 + 0.3 * grown) / CHART_MM.x,
                    strength: (0.22 + 0.55 * grown) * (0.6 + 0.4 * dice.roll()),
                });
            }
        }
    }
    field.cover()
}
