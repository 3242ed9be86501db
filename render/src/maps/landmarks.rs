//! Where things are on a face, read off the head: enough to place colour and gloss.

use glam::{Vec2, Vec3, vec2, vec3};
use mouthpiece_rig::Head;

use super::{WINDOW_MAX, WINDOW_MIN};

/// Places on the face at rest, mm; sided ones are the subject's left.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Landmarks {
    /// Centre of the left eyeball.
    pub(crate) eye: Vec3,
    /// Middle of the mouth.
    pub(crate) mouth: Vec3,
    /// Tip of the nose.
    pub(crate) nose: Vec3,
    /// Half the distance between the outermost skin vertices: the ears.
    pub(crate) ear_x: f32,
    /// Size of the face against the mean one (eyes to mouth 70 mm).
    pub(crate) scale: f32,
}

impl Landmarks {
    pub(crate) fn of(head: &Head) -> Self {
        let skin = &head.skin;
        let positions = &skin.mesh.positions;
        let eye = head.eyes[0].centre;
        let (mut sum, mut share) = (Vec3::ZERO, 0.0_f32);
        for ((p, red), wet) in positions.iter().zip(&skin.vermilion).zip(&skin.wet) {
            let weight = red * (1.0 - wet);
            sum += *p * weight;
            share += weight;
        }
        let mouth = if share > 0.5 {
            let mean = sum / share;
            vec3(0.0, mean.y, mean.z)
        } else {
            vec3(0.0, eye.y - 70.0, eye.z + 28.0)
        };
        let nose = positions
            .iter()
            .filter(|p| p.x.abs() < 8.0 && p.y > mouth.y + 12.0 && p.y < eye.y)
            .copied()
            .reduce(|a, b| if b.z > a.z { b } else { a })
            .unwrap_or(vec3(0.0, mouth.y + 35.0, mouth.z + 16.0));
        let ear_x = positions
            .iter()
            .filter(|p| p.y > mouth.y)
            .map(|p| p.x.abs())
            .fold(0.0, f32::max);
        let scale = ((eye.y - mouth.y) / 70.0).clamp(0.3, 3.0);
        Self {
            eye,
            mouth,
            nose,
            ear_x,
            scale,
        }
    }
}

/// What lies under each place of the window, on a coarse grid: position, and how red the lips are.
#[derive(Clone, Debug)]
pub(crate) struct Ground {
    pub(crate) width: usize,
    pub(crate) height: usize,
    /// Position, mm, and vermilion.
    pub(crate) cells: Vec<(Vec3, f32)>,
}

impl Ground {
    /// Draws the skin's triangles into the window. Folds (inside of lips, nostrils, behind the ears)
    /// lie over each other: the outermost wins.
    pub(crate) fn of(head: &Head, width: usize, height: usize) -> Self {
        let mesh = &head.skin.mesh;
        let mut cells = vec![(Vec3::ZERO, 0.0); width * height];
        let mut depth = vec![-1.0_f32; width * height];
        let size = vec2(width as f32, height as f32);
        for t in &mesh.triangles {
            let corner = t.map(|i| {
                let i = i as usize;
                let at = (mesh.uvs[i] - WINDOW_MIN) / (WINDOW_MAX - WINDOW_MIN) * size;
                (at, mesh.positions[i], head.skin.vermilion[i])
            });
            let [a, b, c] = corner;
            let low = a.0.min(b.0).min(c.0);
            let high = a.0.max(b.0).max(c.0);
            // A triangle across the chart's seam would cover everything.
            if high.x - low.x > size.x * 0.4 {
                continue;
            }
            let area = (b.0 - a.0).perp_dot(c.0 - a.0);
            if area.abs() < 1e-6 {
                continue;
            }
            let x0 = (low.x - 0.5).ceil().max(0.0) as usize;
            let y0 = (low.y - 0.5).ceil().max(0.0) as usize;
            let x1 = (high.x + 0.5).floor().min(size.x) as usize;
            let y1 = (high.y + 0.5).floor().min(size.y) as usize;
            for y in y0..y1 {
                for x in x0..x1 {
                    let p = vec2(x as f32 + 0.5, y as f32 + 0.5);
                    let wb = (p - a.0).perp_dot(c.0 - a.0) / area;
                    let wc = (b.0 - a.0).perp_dot(p - a.0) / area;
                    let wa = 1.0 - wb - wc;
                    // Grown a little: no cracks between triangles.
                    if wa < -0.3 || wb < -0.3 || wc < -0.3 {
                        continue;
                    }
                    let place = a.1 * wa + b.1 * wb + c.1 * wc;
                    let outward = vec2(place.x, place.z).length();
                    let at = y * width + x;
                    if outward > depth[at] {
                        depth[at] = outward;
                        cells[at] = (place, a.2 * wa + b.2 * wb + c.2 * wc);
                    }
                }
            }
        }
        let mut ground = Self {
            width,
            height,
            cells,
        };
        ground.fill_holes(&depth);
        ground
    }

    /// Where nothing was drawn (above the crown, in the eyes) a cylinder stands in.
    fn fill_holes(&mut self, depth: &[f32]) {
        for (at, deep) in depth.iter().enumerate() {
            if *deep < 0.0 {
                let uv = self.uv(at % self.width, at / self.width);
                let turn = (uv.x - 0.5) * std::f32::consts::TAU;
                let place = vec3(
                    super::RADIUS * turn.sin(),
                    150.0 - 256.0 * uv.y,
                    10.0 + super::RADIUS * turn.cos(),
                );
                self.cells[at] = (place, 0.0);
            }
        }
    }

    /// Chart coordinates of the middle of a cell.
    pub(crate) fn uv(&self, x: usize, y: usize) -> Vec2 {
        let share = vec2(
            (x as f32 + 0.5) / self.width as f32,
            (y as f32 + 0.5) / self.height as f32,
        );
        WINDOW_MIN + share * (WINDOW_MAX - WINDOW_MIN)
    }
}
