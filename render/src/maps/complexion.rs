//! The fine variation of the skin's colour: blood, which takes green and blue, and pigment, which takes most of
//! the blue, each in patches of several sizes. One tile, laid over the head's own colour as far as that is even:
//! a photographed face brings its own.

use super::image::Image;
use super::noise::{hash, unit, value_tiled};
use super::{parallel_rows, ramp};

/// Side of the tile, texels; at the chart's 3.5 texels a mm it repeats after 146 mm, which no face shows.
const SIDE: usize = 512;

/// What each texel of the tile takes from the square roots of red, green and blue: 128 is nothing.
#[derive(Clone, Debug)]
pub(super) struct Complexion {
    taken: Vec<[f32; 3]>,
    strength: f32,
}

impl Complexion {
    /// For a colour map whose texels vary from their neighbours by that much (see [`unevenness`]).
    pub(super) fn new(unevenness: f32) -> Self {
        let strength = ramp(3.6, 1.6, unevenness);
        let mut taken = vec![[0.0; 3]; SIDE * SIDE];
        if strength > 0.0 {
            parallel_rows(&mut taken, SIDE, |y, row| {
                for (x, texel) in row.iter_mut().enumerate() {
                    *texel = taken_at(x, y);
                }
            });
        }
        Self { taken, strength }
    }

    /// A texel's colour with the variation laid over it; `share` is how much of it the place takes.
    pub(super) fn over(&self, root: [u8; 3], x: usize, y: usize, share: f32) -> [u8; 3] {
        let taken = &self.taken[(y % SIDE) * SIDE + x % SIDE];
        let share = share * self.strength;
        std::array::from_fn(|c| {
            (f32::from(root[c]) * (1.0 - taken[c] * share) + 0.5).clamp(0.0, 255.0) as u8
        })
    }
}

/// Blood and pigment of a texel as what they take.
fn taken_at(x: usize, y: usize) -> [f32; 3] {
    let at = |cells: i32, seed: u32| {
        let scale = cells as f32 / SIDE as f32;
        value_tiled(x as f32 * scale, y as f32 * scale, cells, seed) - 0.5
    };
    // Cells of 18, 7, 3 and 1.2 mm.
    let blood = 0.45 * at(8, 1) + 0.65 * at(21, 2) + 0.75 * at(47, 3) + 0.65 * at(120, 4);
    let pigment = 0.35 * at(11, 5) + 0.45 * at(39, 6) + 0.50 * at(97, 7);
    let speckle = unit(hash(x as i32 / 2, y as i32 / 2, 8)) - 0.5;
    // Fine red threads where blood lies near the surface.
    let thread = (1.0 - 9.0 * (at(33, 9) + 0.35 * at(80, 10)).abs()).max(0.0) * at(9, 11).max(0.0);
    let blood = blood + 0.9 * thread;
    let pigment = pigment + 0.22 * speckle;
    [
        0.010 * blood + 0.040 * pigment,
        0.080 * blood + 0.062 * pigment,
        0.068 * blood + 0.080 * pigment,
    ]
}

/// How much a colour map varies within a few texels, in bytes: the mean of what the green of its
/// middle differs from the mean around it.
pub(super) fn unevenness(image: &Image) -> f32 {
    let (width, height) = (image.width, image.height);
    let reach = (width / 400).max(1);
    // Forehead to chin, between the eyes' outer corners; brows, eyes and mouth are few among so many.
    let (mut sum, mut count) = (0.0_f32, 0.0_f32);
    for y in (height * 3 / 10..height * 8 / 10).step_by(7) {
        for x in (width * 4 / 10..width * 6 / 10).step_by(7) {
            let green = |x: usize, y: usize| f32::from(image.texels[y * width + x][1]);
            let around = (green(x - reach, y)
                + green(x + reach, y)
                + green(x, y - reach)
                + green(x, y + reach))
                / 4.0;
            let off = (green(x, y) - around).abs();
            // Edges of features are not skin's grain.
            if off < 12.0 {
                sum += off;
                count += 1.0;
            }
        }
    }
    if count > 0.0 { sum / count } else { 0.0 }
}
