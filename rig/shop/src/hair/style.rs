//! The cut: which way hair runs, how long it is and how high it stands, by place on the reference head (mm).
//! Short, parted on the subject's left, brushed across the top and up from the forehead; sides and nape tapered.

use glam::{Vec3, vec3};

use super::scalp::Scalp;
use crate::noise::ramp;
use crate::noise::value;

/// What grows at one place of the scalp.
#[derive(Clone, Copy, Debug)]
pub(super) struct Growth {
    /// Direction along the skin, unit length.
    pub(super) along: Vec3,
    pub(super) length_mm: f32,
}

/// How far the parting lies to the subject's left of the middle.
const PARTING_MM: f32 = 31.0;

/// 1 where the hair is long (the top of the head), 0 on sides and nape.
pub(super) fn top(p: Vec3) -> f32 {
    // The long hair reaches lower in front than at the back.
    ramp(72.0, 108.0, p.y + 0.10 * p.z)
}

/// Which side of the parting: -1 the long side, 1 the short one, blending over the parting's width.
fn side_of_parting(p: Vec3) -> f32 {
    // It bends towards the crown's whorl as it runs back.
    let line = PARTING_MM - 14.0 * ramp(10.0, -40.0, p.z);
    ((p.x - line) / 5.0).clamp(-1.0, 1.0)
}

/// How near the parting's groove a place is, 0..1.
fn parting(p: Vec3) -> f32 {
    let line = PARTING_MM - 14.0 * ramp(10.0, -40.0, p.z);
    ramp(9.0, 0.0, (p.x - line).abs()) * ramp(-30.0, 5.0, p.z) * top(p)
}

/// The growth at a place of the skin.
pub(super) fn growth(p: Vec3, scalp: &Scalp) -> Growth {
    let normal = scalp.normal(p);
    let top = top(p);
    let front = ramp(25.0, 80.0, p.z);
    let back = ramp(0.0, -55.0, p.z);
    // Across the top, away from the parting; up from the forehead in front, backwards behind.
    // Over the forehead it rises from the parting, then falls towards the temple.
    let arc = (0.10 + 0.014 * p.x).clamp(-0.75, 0.5);
    let swept = vec3(-1.0, arc, (-0.30 - 0.012 * p.x).clamp(-0.5, 0.25));
    let brushed = vec3(-1.0, 0.0, -0.15)
        .lerp(swept, front)
        .lerp(vec3(-0.45, 0.0, -1.0), back);
    let short = vec3(0.75, -0.55, -0.50);
    let side = side_of_parting(p);
    let over = brushed.lerp(short.lerp(vec3(0.2, 0.0, -1.0), back), 0.5 + 0.5 * side);
    // Sides: down and backwards above the ears, straight down in front of them and at the nape.
    let low = ramp(48.0, 22.0, p.y);
    let down = vec3(0.0, -0.80, -0.62).lerp(vec3(0.0, -1.0, -0.05), low.max(back));
    // Towards the middle of the nape.
    let down = down
        - vec3(
            0.30 * p.x.signum() * back * ramp(10.0, -40.0, p.y),
            0.0,
            0.0,
        );
    let wanted = down.normalize_or_zero().lerp(over.normalize_or_zero(), top);
    // Locks lean together.
    let lean = value(p.x * 0.055 + 40.0, (p.y - p.z) * 0.045 + 40.0, 5) - 0.5;
    let fine = value(p.x * 0.14 + 60.0, (p.y + p.z) * 0.12 + 60.0, 6) - 0.5;
    let flat = (wanted - normal * wanted.dot(normal)).normalize_or(Vec3::NEG_Y);
    let across = normal.cross(flat);
    let along = (flat + across * ((0.62 * lean + 0.40 * fine) * (0.25 + 0.75 * top * top)))
        .normalize_or(flat);

    let long = if side < 0.0 { 52.0 - 10.0 * back } else { 36.0 };
    let tapered = 9.0 + 17.0 * ramp(-30.0, 75.0, p.y);
    Growth {
        along,
        length_mm: tapered + (long - tapered) * top,
    }
}

/// How high the hair stands over the skin at a place, mm.
pub(super) fn height_mm(p: Vec3, scalp: &Scalp) -> f32 {
    // The nape is clipped short above the line where hair ends.
    let depth = scalp.depth_mm(p).min((p.y + 52.0).max(0.0)).max(0.0);
    let top = top(p);
    let side = 2.0 + 5.5 * ramp(-20.0, 80.0, p.y);
    let over = 12.5 - 2.5 * side_of_parting(p);
    // It stands highest above the forehead, on the long side.
    let quiff = 8.0 * (-((p.x + 6.0) / 27.0).powi(2)).exp() * ramp(30.0, 66.0, p.z) * top;
    let full = side + (over - side) * top + quiff;
    let grown = 1.0 - (-depth / (8.0 + 6.0 * top)).exp();
    let uneven = 1.0 + 0.20 * (value(p.x * 0.06 + 9.0, (p.z + p.y) * 0.05 + 9.0, 12) - 0.5) * top;
    full * grown * uneven * (1.0 - 0.35 * parting(p))
}
