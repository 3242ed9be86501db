//! The eye's map: iris with pupil, fibres and limbal ring; the white, pinker towards the corners, with
//! a few veins. A square of six iris radii, laid round the direction of gaze.

use glam::{Vec2, Vec3, vec2, vec3};

use super::image::{Image, root_of_linear};
use super::noise::{Dice, fractal, value};
use super::strokes::{Field, Stroke};
use super::{parallel_rows, ramp};

/// Iris radii from the middle of the map to its side. Keep in step with shaders/eye.wgsl.
const REACH: f32 = 3.0;
/// Radius of the pupil in iris radii: that of a lit room.
const PUPIL: f32 = 0.39;

/// Square root of linear colour; a: 1 in the iris, 0 in the white.
pub(crate) fn paint(side: usize) -> Image {
    let veins = veins(side);
    let mut image = Image::new(side, side);
    parallel_rows(&mut image.texels, side, |y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            // Rows run down; the eye's uv grows upwards as v does in the shader's map lookup.
            let at = (vec2(x as f32, y as f32) + 0.5) / side as f32 * (2.0 * REACH) - REACH;
            let r = at.length();
            let white = sclera(at, veins.values[y * side + x][0]);
            let share = ramp(1.07, 0.94, r);
            let colour = if share > 0.0 {
                white.lerp(iris(at, r), share)
            } else {
                white
            };
            *texel = [
                root_of_linear(colour.x),
                root_of_linear(colour.y),
                root_of_linear(colour.z),
                (share * 255.0) as u8,
            ];
        }
    });
    image
}

fn sclera(at: Vec2, vein: f32) -> Vec3 {
    let corner = ramp(1.25, 2.9, at.x.abs());
    let cloud = fractal(at.x * 2.2 + 9.0, at.y * 2.2, 3) - 0.5;
    let white = vec3(0.775, 0.742, 0.722).lerp(vec3(0.725, 0.560, 0.520), corner * 0.75);
    let white = white * (1.0 + 0.05 * cloud);
    white.lerp(vec3(0.72, 0.36, 0.33), vein * (0.10 + 0.45 * corner))
}

fn iris(at: Vec2, r: f32) -> Vec3 {
    let angle = at.y.atan2(at.x) / std::f32::consts::TAU + 0.5;
    // Fibres: noise round the clock, wavering along the radius; whole turns join.
    let fibre = |count: f32, seed: u32| {
        let turn = angle * count + 0.8 * value(r * 5.0, angle * 12.0, seed + 9);
        let wrapped = turn.rem_euclid(count);
        let first = value(wrapped, r * 2.0, seed);
        let joined = value(wrapped - count, r * 2.0, seed);
        first + (joined - first) * ramp(count - 1.0, count, wrapped)
    };
    let strand = 0.55 * fibre(90.0, 5) + 0.45 * fibre(41.0, 6);
    let outer = vec3(0.265, 0.265, 0.205).lerp(vec3(0.455, 0.435, 0.325), strand);
    let inner = vec3(0.36, 0.225, 0.105).lerp(vec3(0.56, 0.39, 0.20), strand);
    let collar = 0.52 + 0.07 * (fibre(17.0, 8) - 0.5);
    let mut c = outer.lerp(inner, ramp(collar + 0.14, collar - 0.10, r) * 0.85);
    c *= 0.86 + 0.28 * ramp(0.38, 0.75, r);
    // Limbal ring, then the pupil with its dark rim.
    c *= 1.0 - 0.72 * ramp(0.76, 0.99, r);
    c *= 1.0 - 0.35 * ramp(PUPIL + 0.07, PUPIL, r);
    c.lerp(
        vec3(0.022, 0.018, 0.018),
        ramp(PUPIL + 0.03, PUPIL - 0.02, r),
    )
}

/// Veins that wander from the corners towards the iris and thin out.
fn veins(side: usize) -> Field<1> {
    let mut field = Field::new(side, side, [0.0]);
    let scale = side as f32 / (2.0 * REACH);
    let mut dice = Dice::new(404);
    for i in 0..34 {
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        let mut p = vec2(sign * (2.9 + 0.3 * dice.roll()), 1.5 * dice.spread());
        let mut heading = vec2(-sign, 0.25 * dice.spread());
        let mut strength = 0.5 + 0.5 * dice.roll();
        for _ in 0..9 {
            let next = p + heading * 0.19;
            heading = (heading + vec2(0.0, 0.55 * dice.spread())).normalize_or_zero();
            let far = next + heading * 0.06;
            if next.length() < 1.18 {
                break;
            }
            let texel = |q: Vec2| (q + REACH) * scale;
            field.draw(&Stroke {
                points: [texel(p), texel(next), texel(far)],
                half_width: 0.016 * scale,
                strength: [strength],
            });
            p = next;
            strength *= 0.84;
        }
    }
    field
}
