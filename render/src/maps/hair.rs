//! The hair's map: strands that run away from the crown, laid flat round it (azimuthal, equidistant).
//! R tone of the strand, G how high it stands (decides in which layers it shows), B its shift.

use glam::{Vec2, Vec3, vec2, vec3};

use super::image::Image;
use super::noise::{Dice, value};
use super::parallel_rows;
use super::strokes::{Blend, Field, Stroke};

/// Where the strands part from. Keep in step with shaders/hair.wgsl.
const CROWN: Vec3 = vec3(0.0, 145.0, -35.0);
/// Middle of the skull, which directions are taken from.
const CENTRE: Vec3 = vec3(0.0, 55.0, 5.0);
/// Radians from the crown to the side of the map.
const REACH: f32 = 2.4;

/// The map's coordinates of a place on the head.
pub(crate) fn uv(place: Vec3) -> Vec2 {
    let pole = (CROWN - CENTRE).normalize_or(Vec3::Y);
    let to = (place - CENTRE).normalize_or(Vec3::Y);
    let right = Vec3::X;
    let front = right.cross(pole);
    let flat = vec2(to.dot(right), to.dot(front));
    let angle = flat.length().atan2(to.dot(pole));
    flat.normalize_or_zero() * (angle / REACH * 0.5) + 0.5
}

/// The map, `side` texels square.
pub(crate) fn paint(side: usize) -> Image {
    let s = side as f32;
    // Tone, height, shift.
    let mut field = Field::new(side, side, [0.35, 0.05, 0.5]);
    let mut dice = Dice::new(1201);
    // About one strand every 0.6 mm; texels of 0.4 mm at a side of 1024.
    let strands = side * side / 14;
    for _ in 0..strands {
        let root = vec2(dice.roll(), dice.roll());
        let from_crown = root - 0.5;
        let away = from_crown.normalize_or_zero();
        // A whorl at the crown, and locks that lean together.
        let lock = value(root.x * 34.0, root.y * 34.0, 3) - 0.5;
        let turn = 0.9 * (-from_crown.length() * 9.0).exp() + 0.75 * lock + 0.18 * dice.spread();
        let direction = Vec2::from_angle(turn).rotate(away);
        let bent = Vec2::from_angle(turn + 0.25 * dice.spread()).rotate(away);
        let length = 0.016 + 0.022 * dice.roll();
        let middle = root + direction * (length * 0.5);
        let points = [root * s, middle * s, (middle + bent * (length * 0.5)) * s];
        let half_width = (0.00055 + 0.0003 * dice.roll()) * s;
        let clump = value(root.x * 70.0, root.y * 70.0, 8);
        let strength = [
            0.25 + 0.30 * dice.roll() + 0.40 * clump,
            0.30 + 0.70 * dice.roll(),
            dice.roll(),
        ];
        let stroke = Stroke {
            points,
            half_width: half_width.max(0.45),
            strength,
        };
        field.draw(&stroke, Blend::Over);
    }
    let mut image = Image::new(side, side);
    parallel_rows(&mut image.texels, side, |y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            let [tone, height, shift] =
                field.values[y * side + x].map(|v| (v.clamp(0.0, 1.0) * 255.0) as u8);
            *texel = [tone, height, shift, 255];
        }
    });
    image
}
