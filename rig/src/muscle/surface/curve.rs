//! Smooth curves through control polygons, and places at equal distances along them.

use glam::Vec3;

/// Pieces of a fibre's segment before its length is measured.
const PIECES: usize = 10;

/// A control polygon that goes on straight beyond its ends, mm.
pub(super) fn longer(polygon: &[Vec3], [before, after]: [f32; 2]) -> Vec<Vec3> {
    let mut out = polygon.to_vec();
    let last = out.len() - 1;
    out[0] += (polygon[0] - polygon[1]).normalize_or_zero() * before;
    out[last] += (polygon[last] - polygon[last - 1]).normalize_or_zero() * after;
    out
}

/// A smooth curve through a control polygon, as places at equal distances along it.
pub(super) fn curve(polygon: &[Vec3], closed: bool, count: usize) -> Vec<Vec3> {
    let n = if closed {
        polygon.len() - 1
    } else {
        polygon.len()
    };
    let at = |i: isize| {
        if closed {
            polygon[i.rem_euclid(n as isize) as usize]
        } else if i < 0 {
            // Beyond an end the polygon goes on straight.
            polygon[0] * 2.0 - polygon[1]
        } else if i as usize >= n {
            polygon[n - 1] * 2.0 - polygon[n - 2]
        } else {
            polygon[i as usize]
        }
    };
    let segments = if closed { n } else { n - 1 };
    let mut fine = Vec::with_capacity(segments * PIECES + 1);
    for i in 0..segments as isize {
        for k in 0..PIECES {
            let t = k as f32 / PIECES as f32;
            fine.push(catmull_rom([at(i - 1), at(i), at(i + 1), at(i + 2)], t));
        }
    }
    fine.push(at(segments as isize));
    let length: f32 = fine.windows(2).map(|w| w[0].distance(w[1])).sum();
    let last = if closed { count } else { count - 1 };
    (0..count)
        .map(|i| walk(&fine, length * i as f32 / last as f32))
        .collect()
}

/// The place so far along a polygon.
fn walk(polygon: &[Vec3], mut way: f32) -> Vec3 {
    for w in polygon.windows(2) {
        let length = w[0].distance(w[1]);
        if way <= length {
            return w[0].lerp(w[1], way / length.max(1e-9));
        }
        way -= length;
    }
    polygon[polygon.len() - 1]
}

/// The place so far along a smooth line through knots.
pub(super) fn on_line(knots: &[Vec3], mut way: f32) -> Vec3 {
    for (i, w) in knots.windows(2).enumerate() {
        let length = w[0].distance(w[1]);
        if way <= length || i + 2 == knots.len() {
            let before = i.checked_sub(1).map_or(w[0] * 2.0 - w[1], |k| knots[k]);
            let after = knots.get(i + 2).copied().unwrap_or(w[1] * 2.0 - w[0]);
            let t = (way / length.max(1e-9)).clamp(0.0, 1.0);
            return catmull_rom([before, w[0], w[1], after], t);
        }
        way -= length;
    }
    knots[0]
}

/// Between the second and third of four places, passing through both.
fn catmull_rom([a, b, c, d]: [Vec3; 4], t: f32) -> Vec3 {
    let (t2, t3) = (t * t, t * t * t);
    0.5 * (b * 2.0
        + (c - a) * t
        + (a * 2.0 - b * 5.0 + c * 4.0 - d) * t2
        + (b * 3.0 - a - c * 3.0 + d) * t3)
}
