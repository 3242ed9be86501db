//! The mouth's and the eyes' openings, measured on the drawn skin each frame: what lets light into
//! the mouth (HABER 4.1: teeth and tongue darken as it closes) and how far the lids shade the eyes.

use glam::{Vec3, Vec4, vec4};
use mouthpiece_rig::Head;
use mouthpiece_rig::lip_level::CONTACT;

/// Which vertices to look at.
#[derive(Clone, Debug)]
pub(crate) struct Openings {
    /// Contact vertices of the upper and lower lip, column by column.
    lips: Vec<(u32, u32)>,
    /// Margin vertices: left upper, left lower, right upper, right lower.
    lids: [Vec<u32>; 4],
    eyes: [Vec3; 2],
    radius: f32,
    /// Height of the open eye at rest over the ball's radius, left and right.
    open_at_rest: [f32; 2],
    lids_at_rest: [Vec4; 4],
    mouth_at_rest: Vec3,
}

/// The openings of one frame, in the head's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Open {
    /// Middle of the gap between the lips; w: half its width, mm.
    pub(crate) mouth: Vec4,
    /// Half the gap's height, mm.
    pub(crate) mouth_half_height: f32,
    /// Lid margins as parabolas over the ball; see shaders/frame.wgsl.
    pub(crate) lids: [Vec4; 4],
    /// The same at rest.
    pub(crate) lids_at_rest: [Vec4; 4],
}

impl Openings {
    /// Those of `head`, whose skin is drawn at `points` at rest.
    pub(crate) fn of(head: &Head, points: &[Vec3]) -> Self {
        let lips = head
            .lips
            .upper
            .iter()
            .zip(&head.lips.lower)
            .map(|(upper, lower)| (upper[CONTACT], lower[CONTACT]))
            .collect();
        let eyes = head.eyes.map(|eye| eye.centre);
        let radius = head.eyes[0].radius.max(1.0);
        // The inner edge of the margin, which the lids hold wholly. Upper lids turn down, lower ones up.
        let mut lids: [Vec<u32>; 4] = Default::default();
        let wet = |vertex: u32| head.skin.wet.get(vertex as usize).is_some_and(|w| *w > 0.5);
        for lid in head.lids.iter().filter(|l| l.hold > 0.99 && wet(l.vertex)) {
            let side = if lid.left { 0 } else { 2 };
            lids[side + usize::from(lid.turn > 0.0)].push(lid.vertex);
        }
        let mut openings = Self {
            lips,
            lids,
            eyes,
            radius,
            open_at_rest: [1.0; 2],
            lids_at_rest: [Vec4::ZERO; 4],
            mouth_at_rest: super::maps::landmarks::Landmarks::of(head).mouth,
        };
        let rest = openings.measure(points);
        openings.lids_at_rest = rest.lids;
        for (open, pair) in openings
            .open_at_rest
            .iter_mut()
            .zip(rest.lids.chunks_exact(2))
        {
            *open = (pair[0].x - pair[1].x).max(0.05);
        }
        openings
    }

    pub(crate) fn measure(&self, skin: &[Vec3]) -> Open {
        let (mouth, mouth_half_height) = self.mouth(skin);
        let mut lids: [Vec4; 4] = std::array::from_fn(|i| self.margin(i, skin));
        for side in 0..2 {
            let height = lids[2 * side].x - lids[2 * side + 1].x;
            lids[2 * side].w = (height / self.open_at_rest[side]).clamp(0.0, 1.0);
        }
        Open {
            mouth,
            mouth_half_height,
            lids,
            lids_at_rest: self.lids_at_rest,
        }
    }

    /// Middle of the gap and its halves: the mean gap of the middle columns counts, so that a mouth
    /// that is open only in the middle lets in little.
    fn mouth(&self, skin: &[Vec3]) -> (Vec4, f32) {
        let (mut middle, mut gap_sum, mut gap_max, mut columns) =
            (Vec3::ZERO, 0.0_f32, 0.0_f32, 0.0_f32);
        let (mut left, mut right) = (f32::NEG_INFINITY, f32::INFINITY);
        for &(upper, lower) in &self.lips {
            let (Some(u), Some(l)) = (skin.get(upper as usize), skin.get(lower as usize)) else {
                continue;
            };
            let gap = (u.y - l.y).max(0.0);
            let weight = gap + 0.01;
            middle += (*u + *l) * (0.5 * weight);
            columns += weight;
            gap_sum += gap * weight;
            gap_max = gap_max.max(gap);
            if gap > 0.5 {
                left = left.max(u.x);
                right = right.min(u.x);
            }
        }
        if columns <= 0.0 {
            return (self.mouth_at_rest.extend(1.0), 0.0);
        }
        let half_width = ((left - right) * 0.5).max(1.0);
        let half_width = if half_width.is_finite() {
            half_width
        } else {
            1.0
        };
        let half_height = 0.5 * (0.6 * gap_max + 0.4 * gap_sum / columns);
        ((middle / columns).extend(half_width), half_height)
    }

    /// A margin as a parabola y(x) over the ball, by least squares.
    fn margin(&self, which: usize, skin: &[Vec3]) -> Vec4 {
        let eye = self.eyes[which / 2];
        let mut s = [0.0_f64; 5];
        let mut t = [0.0_f64; 3];
        for &vertex in &self.lids[which] {
            let Some(p) = skin.get(vertex as usize) else {
                continue;
            };
            let q = (*p - eye) / self.radius;
            let (x, y) = (f64::from(q.x), f64::from(q.y));
            let powers = [1.0, x, x * x, x * x * x, x * x * x * x];
            for (sum, power) in s.iter_mut().zip(powers) {
                *sum += power;
            }
            for (sum, power) in t.iter_mut().zip(powers) {
                *sum += power * y;
            }
        }
        parabola(&s, &t).unwrap_or(if which.is_multiple_of(2) {
            vec4(0.45, 0.0, -0.5, 0.0)
        } else {
            vec4(-0.45, 0.0, 0.5, 0.0)
        })
    }
}

/// Solves the normal equations of a parabola by Cramer's rule; none where points are too few.
fn parabola(s: &[f64; 5], t: &[f64; 3]) -> Option<Vec4> {
    let det = |a: [f64; 3], b: [f64; 3], c: [f64; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1])
            + c[0] * (a[1] * b[2] - a[2] * b[1])
    };
    let (a, b, c) = ([s[0], s[1], s[2]], [s[1], s[2], s[3]], [s[2], s[3], s[4]]);
    let whole = det(a, b, c);
    if s[0] < 3.0 || whole.abs() < 1e-9 {
        return None;
    }
    let solution = [det(*t, b, c), det(a, *t, c), det(a, b, *t)].map(|d| (d / whole) as f32);
    Some(vec4(solution[0], solution[1], solution[2], 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_through_its_own_points_is_found() {
        let f = |x: f64| 0.4 + 0.1 * x - 0.6 * x * x;
        let (mut s, mut t) = ([0.0_f64; 5], [0.0_f64; 3]);
        for i in -5..=5 {
            let x = f64::from(i) * 0.15;
            for (k, sum) in (0..).zip(&mut s) {
                *sum += x.powi(k);
            }
            for (k, sum) in (0..).zip(&mut t) {
                *sum += x.powi(k) * f(x);
            }
        }
        let found = parabola(&s, &t).unwrap();
        assert!(
            (found - vec4(0.4, 0.1, -0.6, 0.0)).length() < 1e-4,
            "{found}"
        );
        assert!(parabola(&[2.0; 5], &[0.0; 3]).is_none());
    }
}
