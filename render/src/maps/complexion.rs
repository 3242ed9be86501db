//! The fine variation of the skin's colour: blood, which takes green and blue, and pigment, which takes most of
//! the blue, each in patches of several sizes. One tile, laid over the head's own colour as far as that is even:
//! a photographed face brings its own.

use super::image::Image;
use super::noise::{Tiled, hash, unit};
use super::{parallel_rows, ramp};

/// Side of the tile, texels; at the chart's 3.5 texels a mm it repeats after 146 mm, which no face shows.
const SIDE: usize = 512;

/// What each texel of the tile takes from the square roots of red, green and blue: 128 is nothing.
#[derive(Clone, Debug)]
pub(super) struct Complexion {
    taken: Vec<[f32; 3]>,
    strength: f32,
    mean: [f32; 3],
}

/// By how much more a painted face's zones (ruddy, pale, bluish) differ from its mean: at the size of a window paint
/// as soft as the head's is looks like one colour.
const ZONES: f32 = 0.30;
/// What differs from the mean by more than this, in bytes, is no zone of skin but a brow or the lips' red.
const ZONE_MOST: f32 = 26.0;

impl Complexion {
    /// What `image`, the square roots of a head's colours, lacks.
    pub(super) fn of(image: &Image) -> Self {
        let (unevenness, mean) = survey(image);
        let strength = ramp(3.6, 1.6, unevenness);
        let mut taken = vec![[0.0; 3]; SIDE * SIDE];
        if strength > 0.0 {
            let tint = Tint::new();
            parallel_rows(&mut taken, SIDE, |y, row| {
                for (x, texel) in row.iter_mut().enumerate() {
                    *texel = tint.at(x, y);
                }
            });
        }
        Self {
            taken,
            strength,
            mean,
        }
    }

    /// A texel's colour with the variation laid over it; `share` is how much of it the place takes.
    pub(super) fn over(&self, root: [u8; 3], x: usize, y: usize, share: f32) -> [u8; 3] {
        let taken = &self.taken[(y % SIDE) * SIDE + x % SIDE];
        let share = share * self.strength;
        std::array::from_fn(|c| {
            let root = f32::from(root[c]);
            let zone = (root - self.mean[c]).clamp(-ZONE_MOST, ZONE_MOST) * ZONES * share;
            ((root + zone) * (1.0 - taken[c] * share) + 0.5).clamp(0.0, 255.0) as u8
        })
    }
}

/// Blood and pigment over the tile.
#[derive(Clone, Debug)]
struct Tint {
    /// In cells of 18, 7, 3 and 1.2 mm.
    blood: [Tiled; 4],
    /// In cells of 13, 4 and 1.5 mm.
    pigment: [Tiled; 3],
    /// Fine red threads where blood lies near the surface: their course, and where there are some.
    threads: [Tiled; 3],
}

impl Tint {
    fn new() -> Self {
        let tiled = |(cells, seed)| Tiled::new(cells, seed);
        Self {
            blood: [(8, 1), (21, 2), (47, 3), (120, 4)].map(tiled),
            pigment: [(11, 5), (39, 6), (97, 7)].map(tiled),
            threads: [(33, 9), (80, 10), (9, 11)].map(tiled),
        }
    }

    /// What a texel's blood and pigment take.
    fn at(&self, x: usize, y: usize) -> [f32; 3] {
        let (u, v) = (x as f32 / SIDE as f32, y as f32 / SIDE as f32);
        let sum = |tiles: &[Tiled], shares: &[f32]| -> f32 {
            tiles.iter().zip(shares).map(|(t, s)| t.at(u, v) * s).sum()
        };
        let [course, waver, some] = self.threads.each_ref().map(|tile| tile.at(u, v));
        let thread = (1.0 - 9.0 * (course + 0.35 * waver).abs()).max(0.0) * some.max(0.0);
        let speckle = unit(hash(x as i32 / 2, y as i32 / 2, 8)) - 0.5;
        let blood = sum(&self.blood, &[0.45, 0.65, 0.75, 0.65]) + 0.9 * thread;
        let pigment = sum(&self.pigment, &[0.35, 0.45, 0.50]) + 0.22 * speckle;
        [
            0.010 * blood + 0.040 * pigment,
            0.070 * blood + 0.058 * pigment,
            0.060 * blood + 0.070 * pigment,
        ]
    }
}

/// How much a colour map varies within a few texels, in bytes (the mean of what its green differs from the mean
/// around it); and its mean colour. Over forehead to chin, between the eyes' outer corners; brows, eyes and mouth are
/// few among so many.
fn survey(image: &Image) -> (f32, [f32; 3]) {
    let (width, height) = (image.width, image.height);
    let reach = (width / 400).max(1);
    let (mut sum, mut count, mut colour) = (0.0_f32, 0.0_f32, [0.0_f32; 3]);
    for y in (height * 3 / 10..height * 8 / 10).step_by(7) {
        for x in (width * 4 / 10..width * 6 / 10).step_by(7) {
            let texel = |x: usize, y: usize| image.texels[y * width + x];
            let green = |x: usize, y: usize| f32::from(texel(x, y)[1]);
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
                for (mean, value) in colour.iter_mut().zip(texel(x, y)) {
                    *mean += f32::from(value);
                }
            }
        }
    }
    let count = count.max(1.0);
    (sum / count, colour.map(|sum| sum / count))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn face(texel: impl Fn(usize) -> [u8; 4]) -> Image {
        let mut image = Image::new(256, 128);
        (0..256 * 128).for_each(|i| image.texels[i] = texel(i));
        image
    }

    #[test]
    fn an_even_face_is_varied_and_a_photographed_one_left_alone() {
        let even = Complexion::of(&face(|_| [190, 150, 130, 0]));
        let texels: Vec<_> = (0..400)
            .map(|x| even.over([190, 150, 130], x, 40, 1.0))
            .collect();
        assert!(texels.iter().any(|t| t != &texels[0]));
        let photographed = face(|i| {
            let grain = (hash(i as i32, 0, 1) % 17) as u8;
            [180 + grain, 140 + grain, 120 + grain, 0]
        });
        let photographed = Complexion::of(&photographed);
        for x in 0..400 {
            assert_eq!(
                photographed.over([190, 150, 130], x, 40, 1.0),
                [190, 150, 130]
            );
        }
    }
}
