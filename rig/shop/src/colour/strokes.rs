//! Hairs as tapered strokes, laid into a field finer than the map and then averaged into it: a hair is thinner than a
//! texel.

use glam::{Vec2, vec2};

/// Cells of the fine field a texel, each way.
const FINE: usize = 2;

/// How much hair covers each texel, 0..1.
#[derive(Clone, Debug)]
pub(super) struct Field {
    width: usize,
    height: usize,
    values: Vec<f32>,
}

/// What was averaged.
#[derive(Clone, Debug)]
pub(super) struct Cover {
    pub(super) values: Vec<f32>,
}

/// A bent hair: quadratic curve over the map, whose sides are 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stroke {
    pub(super) points: [Vec2; 3],
    /// Width at the root as a share of the map's width; the tip is thin.
    pub(super) width: f32,
    /// What it covers with, 0..1.
    pub(super) strength: f32,
}

impl Field {
    /// For a map of that many texels.
    pub(super) fn new(width: usize, height: usize) -> Self {
        let (width, height) = (width * FINE, height * FINE);
        Self {
            width,
            height,
            values: vec![0.0; width * height],
        }
    }

    /// Lays a stroke; what falls outside is cut off.
    pub(super) fn draw(&mut self, stroke: &Stroke) {
        let size = vec2(self.width as f32, self.height as f32);
        let [a, b, c] = stroke.points.map(|p| p * size);
        let half = 0.5 * stroke.width * size.x;
        let length = a.distance(b) + b.distance(c);
        let steps = (length * 1.5).ceil().clamp(1.0, 400.0) as usize;
        for i in 0..=steps {
            let t = i as f32 / steps as f32;
            let p = a.lerp(b, t).lerp(b.lerp(c, t), t);
            // Full at the root, thin at the tip.
            let taper = 1.0 - 0.85 * t * t;
            let root = (t * 6.0).min(1.0);
            self.dab(
                p,
                half * taper,
                stroke.strength * taper * (0.35 + 0.65 * root),
            );
        }
    }

    fn dab(&mut self, p: Vec2, half: f32, strength: f32) {
        let reach = half + 0.7;
        let low = (p - reach).floor().max(Vec2::ZERO);
        let high = (p + reach)
            .ceil()
            .min(vec2(self.width as f32, self.height as f32) - 1.0);
        let mut y = low.y;
        while y <= high.y {
            let mut x = low.x;
            while x <= high.x {
                let off = vec2(x + 0.5, y + 0.5).distance(p);
                let cover = (half + 0.5 - off).clamp(0.0, 1.0) * (2.0 * half).min(1.0);
                let value = &mut self.values[y as usize * self.width + x as usize];
                *value = value.max(cover * strength);
                x += 1.0;
            }
            y += 1.0;
        }
    }

    /// The mean over each texel.
    pub(super) fn cover(&self) -> Cover {
        let (width, height) = (self.width / FINE, self.height / FINE);
        let mut values = vec![0.0_f32; width * height];
        for (y, row) in self.values.chunks_exact(self.width.max(1)).enumerate() {
            for (x, value) in row.iter().enumerate() {
                if let Some(sum) = values.get_mut(y / FINE * width + x / FINE) {
                    *sum += value / (FINE * FINE) as f32;
                }
            }
        }
        Cover { values }
    }
}
