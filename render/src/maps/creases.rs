//! A relief of lines in the skin: each a valley between two low shoulders, as skin that is pushed together
//! folds. Painted over a window of the chart, in mm.

use glam::{Vec2, vec2};

use super::noise::value;
use super::ramp;

/// A line in the skin, in mm of the chart.
#[derive(Clone, Debug)]
pub(super) struct Crease {
    /// Its course.
    pub(super) points: Vec<Vec2>,
    /// Depth of the valley and half its width, mm.
    pub(super) depth_mm: f32,
    pub(super) half_width_mm: f32,
    /// Height of the shoulders as a share of the depth: on the left hand as one walks the course (rows running
    /// down), on the right.
    pub(super) shoulders: [f32; 2],
    /// Share of its length over which it begins and ends.
    pub(super) fade: [f32; 2],
}

/// Heights over a window, mm.
#[derive(Clone, Debug)]
pub(super) struct Relief {
    pub(super) width: usize,
    pub(super) height: usize,
    /// The window's upper left corner and a texel's size, mm of the chart.
    corner: Vec2,
    texel: Vec2,
    pub(super) heights: Vec<f32>,
}

/// Half widths from its course at which a crease has ended.
const REACH: f32 = 5.0;

impl Relief {
    pub(super) fn new((width, height): (usize, usize), corner: Vec2, texel: Vec2) -> Self {
        Self {
            width,
            height,
            corner,
            texel,
            heights: vec![0.0; width * height],
        }
    }

    /// Place of a texel's middle, mm of the chart.
    pub(super) fn place(&self, x: usize, y: usize) -> Vec2 {
        self.corner + vec2(x as f32 + 0.5, y as f32 + 0.5) * self.texel
    }

    /// The texels within a box of the chart, cut to the window: first and one past the last.
    pub(super) fn texels(&self, low: Vec2, high: Vec2) -> ([usize; 2], [usize; 2]) {
        let size = vec2(self.width as f32, self.height as f32);
        let first = ((low - self.corner) / self.texel)
            .floor()
            .clamp(Vec2::ZERO, size);
        let last = ((high - self.corner) / self.texel)
            .ceil()
            .clamp(first, size);
        (
            [first.x as usize, first.y as usize],
            [last.x as usize, last.y as usize],
        )
    }

    /// Height at a place of the chart, mm; 0 outside.
    pub(super) fn at(&self, place: Vec2) -> f32 {
        let t = (place - self.corner) / self.texel;
        if t.x < 0.0 || t.y < 0.0 || t.x >= self.width as f32 || t.y >= self.height as f32 {
            return 0.0;
        }
        self.heights[t.y as usize * self.width + t.x as usize]
    }

    /// Slopes across and up at a texel.
    pub(super) fn slope(&self, x: usize, y: usize) -> Vec2 {
        let height = |x: usize, y: usize| self.heights[y * self.width + x];
        let (left, right) = (x.saturating_sub(1), (x + 1).min(self.width - 1));
        let (above, below) = (y.saturating_sub(1), (y + 1).min(self.height - 1));
        // Rows run down, slopes up.
        vec2(
            height(right, y) - height(left, y),
            height(x, above) - height(x, below),
        ) / (2.0 * self.texel)
    }

    /// Folds a crease into the skin.
    pub(super) fn fold(&mut self, crease: &Crease, seed: u32) {
        let course = smooth(&crease.points);
        let total: f32 = course.windows(2).map(|s| s[0].distance(s[1])).sum();
        if total <= 0.0 {
            return;
        }
        let reach = Vec2::splat(crease.half_width_mm * REACH);
        let low = course.iter().copied().reduce(Vec2::min).unwrap_or_default() - reach;
        let high = course.iter().copied().reduce(Vec2::max).unwrap_or_default() + reach;
        let (first, last) = self.texels(low, high);
        let (width, height) = (last[0] - first[0], last[1] - first[1]);
        // Signed distance and share of the length of what is nearest so far.
        let mut nearest = vec![(f32::INFINITY, 0.0_f32); width * height];
        let mut walked = 0.0;
        for step in course.windows(2) {
            let (from, to) = (step[0], step[1]);
            let length = from.distance(to);
            let (a, b) = self.texels(from.min(to) - reach, from.max(to) + reach);
            for y in a[1].max(first[1])..b[1].min(last[1]) {
                for x in a[0].max(first[0])..b[0].min(last[0]) {
                    let along = to - from;
                    let off = self.place(x, y) - from;
                    let share = (off.dot(along) / along.length_squared().max(1e-9)).clamp(0.0, 1.0);
                    let aside = off - along * share;
                    let best = &mut nearest[(y - first[1]) * width + x - first[0]];
                    if aside.length() < best.0.abs() {
                        let hand = along.perp_dot(off).signum();
                        *best = (aside.length() * hand, (walked + length * share) / total);
                    }
                }
            }
            walked += length;
        }
        for (number, (off, share)) in nearest.into_iter().enumerate() {
            if off.is_finite() {
                let texel = (first[1] + number / width) * self.width + first[0] + number % width;
                self.heights[texel] += profile(crease, off, share, total, seed);
            }
        }
    }
}

/// Height of a crease at a signed distance from its course, at a share of its length.
fn profile(crease: &Crease, off: f32, share: f32, total_mm: f32, seed: u32) -> f32 {
    let ends = ramp(0.0, crease.fade[0], share) * ramp(1.0, 1.0 - crease.fade[1], share);
    // Not the same depth all along.
    let uneven = 0.55 + 0.9 * value(share * total_mm * 0.16, seed as f32 * 7.3, seed);
    let w = crease.half_width_mm * (0.75 + 0.25 * ends);
    let bell = |d: f32| (-d * d).exp();
    let valley = bell(off / w);
    let shoulder =
        crease.shoulders[usize::from(off > 0.0)] * bell((off.abs() - 2.1 * w) / (1.35 * w));
    crease.depth_mm * ends * uneven * (shoulder - valley)
}

/// A course with its corners rounded: two rounds of cutting them (Chaikin).
fn smooth(points: &[Vec2]) -> Vec<Vec2> {
    let mut course = points.to_vec();
    for _ in 0..2 {
        let (Some(&first), Some(&last)) = (course.first(), course.last()) else {
            return course;
        };
        let cut: Vec<Vec2> = course
            .windows(2)
            .flat_map(|s| [s[0].lerp(s[1], 0.25), s[0].lerp(s[1], 0.75)])
            .collect();
        course = std::iter::once(first).chain(cut).chain([last]).collect();
    }
    course
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crease_is_a_valley_with_shoulders_that_ends_where_it_ends() {
        let mut relief = Relief::new((200, 100), Vec2::ZERO, Vec2::splat(0.25));
        let crease = Crease {
            points: vec![vec2(10.0, 12.0), vec2(25.0, 12.0), vec2(40.0, 12.0)],
            depth_mm: 0.4,
            half_width_mm: 1.0,
            shoulders: [0.4, 0.4],
            fade: [0.2, 0.2],
        };
        relief.fold(&crease, 1);
        assert!(relief.at(vec2(25.0, 12.1)) < -0.15, "no valley");
        assert!(relief.at(vec2(25.0, 14.3)) > 0.03, "no shoulder");
        assert!(relief.at(vec2(25.0, 20.0)).abs() < 1e-3, "too wide");
        assert!(relief.at(vec2(44.0, 12.0)).abs() < 1e-3, "too long");
    }

    #[test]
    fn a_crease_outside_the_window_does_no_harm() {
        let mut relief = Relief::new((10, 10), Vec2::ZERO, Vec2::ONE);
        let crease = Crease {
            points: vec![vec2(-90.0, -50.0), vec2(300.0, 400.0)],
            depth_mm: 1.0,
            half_width_mm: 1.0,
            shoulders: [0.0; 2],
            fade: [0.1; 2],
        };
        relief.fold(&crease, 1);
        assert!(relief.heights.iter().all(|h| h.is_finite()));
    }
}
