//! Brows as hundreds of small hairs between the feature lines `brow_lower_*` and `brow_upper_*`: at
//! the nose they stand up, further out they lie along the arch, the upper ones combed down onto the
//! lower. A head without these lines has no brows.

use glam::{Vec2, vec2};
use mouthpiece_rig::{Feature, Head};

use super::landmarks::Ground;
use super::noise::Dice;
use super::strokes::{Blend, Field, Stroke};
use super::{CHART_HEIGHT, WINDOW_MAX, WINDOW_MIN, ramp};

/// Hairs in one brow.
const HAIRS: usize = 760;

/// How much hair covers each texel, 0..1.
pub(crate) fn paint(head: &Head, ground: &Ground, width: usize, height: usize) -> Field<1> {
    let mut field = Field::new(width, height, [0.0]);
    for (lower, upper, seed) in [
        ("brow_lower_l", "brow_upper_l", 1),
        ("brow_lower_r", "brow_upper_r", 2),
    ] {
        if let (Some(lower), Some(upper)) = (head.feature(lower), head.feature(upper)) {
            brow(&mut field, &Arch::new(lower, upper, ground), seed);
        }
    }
    field
}

/// A brow's two borders, from the nose outwards, in texels of the window; and texels a mm.
struct Arch {
    lower: Vec<Vec2>,
    upper: Vec<Vec2>,
    /// Texels a mm, across and down.
    per_mm: Vec2,
    size: Vec2,
}

impl Arch {
    fn new(lower: &Feature, upper: &Feature, ground: &Ground) -> Self {
        // Borders in parts of the window.
        let inward = |f: &Feature| {
            let mut points: Vec<Vec2> = f
                .points
                .iter()
                .map(|p| (*p - WINDOW_MIN) / (WINDOW_MAX - WINDOW_MIN))
                .collect();
            let from_middle = |p: Option<&Vec2>| p.map_or(0.0, |p| (p.x - 0.5).abs());
            if from_middle(points.first()) > from_middle(points.last()) {
                points.reverse();
            }
            points
        };
        let (lower, upper) = (inward(lower), inward(upper));
        // How far from the axis the skin is here decides what a mm of longitude is.
        let middle = at_share(&lower, 0.5);
        let cell = |v: f32, n: usize| ((v * n as f32) as usize).min(n - 1);
        let place = ground.cells
            [cell(middle.y, ground.height) * ground.width + cell(middle.x, ground.width)]
        .0;
        let radius = vec2(place.x, place.z - 10.0).length().clamp(50.0, 150.0);
        let span = WINDOW_MAX - WINDOW_MIN;
        let per_mm = vec2(
            1.0 / (span.x * std::f32::consts::TAU * radius),
            1.0 / (span.y * CHART_HEIGHT),
        );
        Self {
            lower,
            upper,
            per_mm,
            size: Vec2::ONE,
        }
    }

    /// Texel at `along` 0 nose .. 1 temple, `across` 0 lower .. 1 upper border.
    fn at(&self, along: f32, across: f32) -> Vec2 {
        at_share(&self.lower, along).lerp(at_share(&self.upper, along), across) * self.size
    }
}

fn brow(field: &mut Field<1>, arch: &Arch, seed: u64) {
    let size = vec2(field.width as f32, field.height as f32);
    let arch = Arch {
        lower: arch.lower.clone(),
        upper: arch.upper.clone(),
        per_mm: arch.per_mm * size,
        size,
    };
    let mut dice = Dice::new(seed);
    for _ in 0..HAIRS {
        let along = dice.roll().powf(0.92) * 0.93;
        // Denser in the body than at its borders; the ends thin out.
        let across = 0.5 + 0.56 * dice.spread();
        let end = ramp(0.0, 0.10, along) * ramp(1.0, 0.72, along);
        if dice.roll() > 0.30 + 0.70 * end {
            continue;
        }
        let root = arch.at(along, across);
        let ahead = arch.at((along + 0.06).min(1.0), across) - root;
        let ahead = (ahead / arch.per_mm).normalize_or_zero();
        if ahead == Vec2::ZERO {
            continue;
        }
        // Texture rows run down: up is -y. At the nose hairs rise, then they follow the arch.
        let rise = (1.1 - 2.4 * along).max(0.0) + 0.55 * (0.62 - across) + 0.16 * dice.spread();
        let direction = (ahead + vec2(0.0, -rise)).normalize_or_zero();
        let bend = (ahead + vec2(0.0, 0.25 * (across - 0.45))).normalize_or_zero();
        let length_mm =
            (4.6 + 3.2 * dice.roll()) * (0.62 + 0.38 * end) * if across < 0.0 { 0.7 } else { 1.0 };
        let middle = root + direction * arch.per_mm * (length_mm * 0.5);
        let tip = middle + (direction * 0.45 + bend * 0.55) * arch.per_mm * (length_mm * 0.5);
        field.draw(
            &Stroke {
                points: [root, middle, tip],
                half_width: (0.13 + 0.05 * dice.roll()) * arch.per_mm.x,
                strength: [(0.58 + 0.40 * dice.roll()) * (0.55 + 0.45 * end)],
            },
            Blend::Cover,
        );
    }
    under_shade(field, &arch);
}

/// The shade of skin under dense hair: without it single strokes look drawn on.
fn under_shade(field: &mut Field<1>, arch: &Arch) {
    let mut dice = Dice::new(7);
    for _ in 0..260 {
        let along = 0.03 + 0.85 * dice.roll();
        let end = ramp(0.0, 0.14, along) * ramp(1.0, 0.6, along);
        let middle = arch.at(along, 0.46 + 0.16 * dice.spread());
        let ahead = (arch.at((along + 0.05).min(1.0), 0.46) - middle) / arch.per_mm;
        let ahead = ahead.normalize_or_zero() * arch.per_mm;
        field.draw(
            &Stroke {
                points: [middle - ahead * 2.0, middle, middle + ahead * 3.0],
                half_width: 0.75 * arch.per_mm.x,
                strength: [0.36 * end],
            },
            Blend::Cover,
        );
    }
}

/// The point at a share of a polyline's length.
fn at_share(line: &[Vec2], share: f32) -> Vec2 {
    let total: f32 = line.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut left = total * share.clamp(0.0, 1.0);
    for w in line.windows(2) {
        let step = w[0].distance(w[1]);
        if left <= step {
            return w[0].lerp(w[1], left / step.max(1e-9));
        }
        left -= step;
    }
    line.last().copied().unwrap_or(Vec2::ZERO)
}
