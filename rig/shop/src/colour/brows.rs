//! Brows as hundreds of small hairs between the features `brow_lower_*` and `brow_upper_*`: at the nose they stand
//! up, sparse; in the body the lower ones rise and the upper ones are combed down until they meet; the tail lies along
//! the arch and thins out. A head without these lines has no brows.

use glam::{Vec2, vec2};
use mouthpiece_rig::Head;

use super::strokes::{Cover, Field, Stroke};
use crate::lines::{CHART_MM, Line};
use crate::noise::{Dice, ramp};

/// Hairs in one brow.
const HAIRS: usize = 820;
/// Thickness of a hair at its root, mm: life has 0.08; finer than a texel it would vanish.
const THICK_MM: f32 = 0.18;

/// How much hair covers each texel.
pub(super) fn paint(head: &Head, width: usize, height: usize) -> Cover {
    let mut field = Field::new(width, height);
    for (side, seed) in [("l", 1), ("r", 2)] {
        let line = |which| Some(Line::of(head, &format!("brow_{which}_{side}"))?.outward());
        if let (Some(lower), Some(upper)) = (line("lower"), line("upper")) {
            brow(&mut field, &lower, &upper, seed);
        }
    }
    field.cover()
}

fn brow(field: &mut Field, lower: &Line, upper: &Line, seed: u64) {
    // Place at `along` 0 nose .. 1 temple, `across` 0 lower .. 1 upper border; mm, y down.
    let at = |along: f32, across: f32| lower.at_share(along).lerp(upper.at_share(along), across);
    let mut dice = Dice::new(seed);
    for _ in 0..HAIRS {
        let along = dice.roll() * 0.97;
        // Ragged borders: dense in the middle, some strays.
        let stray = if dice.roll() < 0.07 { 1.0 } else { 0.72 };
        let across = 0.47 + 0.66 * stray * dice.spread();
        // The head fades in, the tail out.
        let dense = ramp(-0.02, 0.22, along) * ramp(1.04, 0.66, along);
        if dice.roll() > 0.22 + 0.78 * dense {
            continue;
        }
        let root = at(along, across);
        let ahead = (at((along + 0.05).min(1.0), across) - at(along, across)).normalize_or_zero();
        if ahead == Vec2::ZERO {
            continue;
        }
        // Up is -y. At the nose hairs stand; from there they lie down along the arch.
        let standing = 2.6 * ramp(0.24, 0.0, along);
        let meeting = 0.85 * (0.55 - across) * ramp(0.0, 0.2, along) * ramp(1.0, 0.55, along);
        let rise = standing + meeting + 0.28 * dice.spread();
        let direction = (ahead + vec2(0.0, -rise)).normalize_or_zero();
        let bent = (ahead + vec2(0.0, 0.18 - 0.3 * standing)).normalize_or_zero();
        let length = (3.6 + 4.2 * dice.roll()) * (0.60 + 0.40 * dense);
        let middle = root + direction * (length * 0.5);
        let tip = middle + (direction * 0.55 + bent * 0.45) * (length * 0.5);
        field.draw(&Stroke {
            points: [root, middle, tip].map(|p| p / CHART_MM),
            width: THICK_MM * (0.8 + 0.5 * dice.roll()) / CHART_MM.x,
            strength: (0.64 + 0.36 * dice.roll()) * (0.62 + 0.38 * dense),
        });
    }
    // The shade of skin under dense hair: without it single strokes look drawn on.
    for _ in 0..240 {
        let along = 0.02 + 0.90 * dice.roll();
        let dense = ramp(-0.02, 0.26, along) * ramp(1.0, 0.55, along);
        let middle = at(along, 0.45 + 0.24 * dice.spread());
        let ahead = (at((along + 0.05).min(1.0), 0.46) - at(along, 0.46)).normalize_or_zero();
        field.draw(&Stroke {
            points: [middle - ahead * 2.0, middle, middle + ahead * 2.5].map(|p| p / CHART_MM),
            width: 1.5 / CHART_MM.x,
            strength: 0.42 * dense,
        });
    }
}
