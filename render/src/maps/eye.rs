//! The eye's map: iris with pupil, fibres and limbal ring; the white, pinker towards the corners, with
//! a few veins. A square of six iris radii, laid round the direction of gaze.

use glam::{Vec2, Vec3, vec2, vec3};

use super::image::{Image, root_of_linear};
use super::noise::{Dice, fractal, value};
use super::strokes::{Field, Stroke};
use super::{parallel_rows, ramp};

/// Iris radii from the middle of the map to its side. Keep in step with shaders/eye.wgsl.
const REACH: f32 = 3.0;
/// Radius of the painted pupil in iris radii; the shader widens and narrows it. Keep in step with shaders/eye.wgsl.
const PUPIL: f32 = 0.36;

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
            let share = ramp(1.12, 0.92, r);
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
    let white = vec3(0.660, 0.628, 0.606).lerp(vec3(0.625, 0.455, 0.405), corner * 0.75);
    // Where the white is thin, next to the iris, the dark behind it shows through bluish.
    let thin = ramp(1.45, 1.02, at.length());
    let white = white * (1.0 + 0.07 * cloud) * (Vec3::ONE - vec3(0.15, 0.12, 0.07) * thin);
    white.lerp(vec3(0.60, 0.25, 0.22), vein * (0.18 + 0.42 * corner))
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
    let strand = ramp(0.15, 0.85, 0.55 * fibre(90.0, 5) + 0.45 * fibre(41.0, 6));
    let outer = vec3(0.175, 0.180, 0.150).lerp(vec3(0.365, 0.360, 0.295), strand);
    let inner = vec3(0.200, 0.135, 0.070).lerp(vec3(0.365, 0.260, 0.145), strand);
    // The collarette: a ragged ring where the pupil's own zone ends, its rim a little raised.
    let collar = 0.54 + 0.10 * (fibre(17.0, 8) - 0.5);
    let mut c = outer.lerp(inner, ramp(collar + 0.16, collar - 0.10, r) * 0.85);
    c *= 1.0 + 0.12 * ramp(0.07, 0.0, (r - collar).abs());
    // Crypts: gaps between the strands there, down to the dark layer.
    let crypt = ramp(0.70, 0.95, fibre(23.0, 31)) * ramp(0.24, 0.06, (r - collar - 0.06).abs());
    c *= 1.0 - 0.30 * crypt;
    // Furrows of contraction run round it.
    let furrow = ramp(0.035, 0.0, (r - 0.80).abs()) + 0.7 * ramp(0.03, 0.0, (r - 0.70).abs());
    c *= 1.0 - 0.13 * furrow * value(angle * 9.0, 3.0, 12);
    // The limbal ring is broad and soft on its inner side; so is the ruff round the pupil.
    c *= 1.0 - 0.80 * ramp(0.70, 1.0, r);
    c *= 1.0 - 0.55 * ramp(PUPIL + 0.13, PUPIL, r);
    c.lerp(
        vec3(0.012, 0.010, 0.010),
        ramp(PUPIL + 0.035, PUPIL - 0.035, r),
    )
}

/// Veins that wander from the corners towards the iris and thin out.
fn veins(side: usize) -> Field<1> {
    let mut field = Field::new(side, side, [0.0]);
    let scale = side as f32 / (2.0 * REACH);
    let mut dice = Dice::new(404);
    for i in 0..44 {
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
                half_width: 0.019 * scale,
                strength: [strength],
            });
            p = next;
            strength *= 0.84;
        }
    }
    field
}
