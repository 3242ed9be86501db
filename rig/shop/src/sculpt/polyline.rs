//! Points along polylines: the feature curves come with spacings of their own.

use glam::{Vec2, Vec3, vec2};

/// The point at a share (0..1) of the length of an open polyline.
pub(super) fn at_share(line: &[Vec3], share: f32) -> Vec3 {
    let total: f32 = line.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut left = share.clamp(0.0, 1.0) * total;
    for w in line.windows(2) {
        let length = w[0].distance(w[1]);
        if left <= length {
            return w[0].lerp(w[1], left / length.max(1e-6));
        }
        left -= length;
    }
    line.last().copied().unwrap_or_default()
}

/// `count` points at equal lengths along an open polyline, ends included.
pub(super) fn evenly(line: &[Vec3], count: usize) -> Vec<Vec3> {
    (0..count)
        .map(|i| at_share(line, i as f32 / (count - 1).max(1) as f32))
        .collect()
}

/// The point of a polyline at `x`, for a line whose x grows; its ends are held.
pub(super) fn at_x(line: &[Vec3], x: f32) -> Vec3 {
    for w in line.windows(2) {
        if x <= w[1].x {
            return w[0].lerp(
                w[1],
                ((x - w[0].x) / (w[1].x - w[0].x).max(1e-6)).clamp(0.0, 1.0),
            );
        }
    }
    line.last().copied().unwrap_or_default()
}

/// The point of a superellipse with half axes `half` in the direction `turn` (0 along +x, counter-clockwise).
pub(super) fn superellipse(turn: f32, half: Vec2, exponent: f32) -> Vec2 {
    let part = |v: f32| v.abs().powf(2.0 / exponent).copysign(v);
    vec2(part(turn.cos()), part(turn.sin())) * half
}
