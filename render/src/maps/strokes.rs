//! Tapered strokes: veins of the eye.

use glam::Vec2;

/// A field of N values a texel, 0..1, that strokes are laid into.
#[derive(Clone, Debug)]
pub(crate) struct Field<const N: usize> {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) values: Vec<[f32; N]>,
}

/// A bent hair: quadratic curve, in texels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stroke<const N: usize> {
    pub(crate) points: [Vec2; 3],
    /// Half the width at the root, texels; the tip is thin.
    pub(crate) half_width: f32,
    /// What it covers with, 0..1.
    pub(crate) strength: [f32; N],
}

impl<const N: usize> Field<N> {
    pub(crate) fn new(width: usize, height: usize, value: [f32; N]) -> Self {
        Self {
            width,
            height,
            values: vec![value; width * height],
        }
    }

    /// Lays a stroke over what is left uncovered; what falls outside is cut off.
    pub(crate) fn draw(&mut self, stroke: &Stroke<N>) {
        let [a, b, c] = stroke.points;
        let length = a.distance(b) + b.distance(c);
        let steps = (length / (stroke.half_width * 1.2).clamp(0.5, 2.0))
            .ceil()
            .clamp(1.0, 400.0) as usize;
        for i in 0..=steps {
            let t = i as f32 / steps as f32;
            let p = a.lerp(b, t).lerp(b.lerp(c, t), t);
            // Full at the root, thin at the tip.
            let taper = 1.0 - t * t * 0.85;
            let root = (t * 8.0).min(1.0);
            let fade = taper * (0.4 + 0.6 * root);
            self.dab(
                p,
                stroke.half_width * taper,
                stroke.strength.map(|s| s * fade),
            );
        }
    }

    fn dab(&mut self, p: Vec2, half_width: f32, strength: [f32; N]) {
        let reach = half_width + 0.7;
        let x0 = (p.x - reach).floor().max(0.0) as usize;
        let y0 = (p.y - reach).floor().max(0.0) as usize;
        let x1 = (p.x + reach).ceil().min(self.width as f32 - 1.0);
        let y1 = (p.y + reach).ceil().min(self.height as f32 - 1.0);
        if x1 < 0.0 || y1 < 0.0 {
            return;
        }
        for y in y0..=y1 as usize {
            for x in x0..=x1 as usize {
                let d = Vec2::new(x as f32, y as f32).distance(p);
                let cover = (half_width + 0.5 - d).clamp(0.0, 1.0) * (2.0 * half_width).min(1.0);
                if cover <= 0.0 {
                    continue;
                }
                let value = &mut self.values[y * self.width + x];
                for (value, strength) in value.iter_mut().zip(strength) {
                    *value = value.max(cover * strength);
                }
            }
        }
    }
}
