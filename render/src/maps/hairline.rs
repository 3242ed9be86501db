//! Hairs on the skin along the feature lines `hairline_*`, so that the cap of hair does not end like a
//! cap: roots just inside the line, tips over it. A head without these lines has none.

use glam::{Vec2, vec2};
use mouthpiece_rig::Head;

use super::noise::Dice;
use super::strokes::{Blend, Field, Stroke};
use super::{CHART_HEIGHT, RADIUS, WINDOW_MAX, WINDOW_MIN};

/// Hairs a mm of the line.
const HAIRS_PER_MM: f32 = 9.0;

/// The line of one side from the forehead backwards, in mm on the chart, and the hand at which the
/// hair lies: the left one on the subject's left side, as seen with rows running down.
fn line_mm(head: &Head, name: &str, hand: f32) -> Option<(Vec<Vec2>, f32)> {
    let mm = vec2(std::f32::consts::TAU * RADIUS, CHART_HEIGHT);
    let mut points: Vec<Vec2> = head.feature(name)?.points.iter().map(|p| *p * mm).collect();
    let from_middle = |p: Option<&Vec2>| p.map_or(0.0, |p| (p.x - 0.5 * mm.x).abs());
    if from_middle(points.first()) > from_middle(points.last()) {
        points.reverse();
    }
    Some((points, hand))
}

/// How far within the hair a place of the chart is, mm; below 0 outside. None without a hairline.
pub(crate) fn depth_mm(head: &Head, uv: Vec2) -> Option<f32> {
    let (name, hand) = if uv.x >= 0.5 {
        ("hairline_l", 1.0)
    } else {
        ("hairline_r", -1.0)
    };
    let (points, hand) = line_mm(head, name, hand)?;
    let p = uv * vec2(std::f32::consts::TAU * RADIUS, CHART_HEIGHT);
    let mut nearest = (f32::INFINITY, 0.0);
    for side in points.windows(2) {
        let along = side[1] - side[0];
        let share = ((p - side[0]).dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
        let off = p - side[0] - along * share;
        let inward = vec2(along.y, -along.x).normalize_or_zero() * hand;
        let distance = off.length();
        // At a corner two steps are equally near: the one that is more square to it decides.
        let facing = off.dot(inward);
        if distance < nearest.0 - 1e-3
            || (distance < nearest.0 + 1e-3 && facing.abs() > f32::abs(nearest.1))
        {
            nearest = (distance, facing);
        }
    }
    Some(nearest.0 * nearest.1.signum())
}

/// Lays the hairs into `field`, which covers the window.
pub(crate) fn paint(field: &mut Field, head: &Head) {
    let mm = vec2(std::f32::consts::TAU * RADIUS, CHART_HEIGHT);
    for (name, hand, seed) in [("hairline_l", 1.0, 31), ("hairline_r", -1.0, 32)] {
        let Some((points, hand)) = line_mm(head, name, hand) else {
            continue;
        };
        let mut dice = Dice::new(seed);
        for side in points.windows(2) {
            let along = side[1] - side[0];
            let count = along.length() * HAIRS_PER_MM;
            let inward = vec2(along.y, -along.x).normalize_or_zero() * hand;
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
                    let share = (p / mm - WINDOW_MIN) / (WINDOW_MAX - WINDOW_MIN);
                    share * vec2(field.width as f32, field.height as f32)
                };
                let points = [
                    texel(root),
                    texel(root.lerp(tip, 0.5) + lean * 0.3),
                    texel(tip),
                ];
                let per_mm = field.height as f32 / CHART_HEIGHT / (WINDOW_MAX.y - WINDOW_MIN.y);
                let strength = 0.55 + 0.45 * dice.roll();
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
