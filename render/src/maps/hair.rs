//! The strands' map that hair cards show: columns of painted strands, roots at the top. The first are dense, then
//! come loose locks, one thick and the rest thin, then single hairs: `hair` in the head shop says which card shows which.
//! R tone of the strand, G how much light reaches it between its neighbours, B its shift, A how much it covers.
//!
//! Its smaller copies keep the share of samples that strands cover (see [`mips`]): hair neither thins out with distance
//! nor flickers when a turn of the head changes the copy that is read.

use super::image::Image;
use super::noise::{Dice, value};
use super::{parallel_rows, ramp};

/// Columns of equal width; how many are dense, and how many are loose locks. Keep in step with the head
/// shop's `hair`.
pub(crate) const COLUMNS: usize = 8;
/// See [`COLUMNS`].
pub(crate) const DENSE: usize = 4;
/// See [`COLUMNS`]: of the dense ones that whose strands gather in no locks.
pub(crate) const EVEN: usize = DENSE - 1;
/// See [`COLUMNS`].
pub(crate) const LOOSE: usize = 2;

/// Tone, light, shift, cover; all 0..1.
type Texel = [f32; 4];

/// A hair: a bent line that runs down the map. Across in columns, along in heights of the map.
#[derive(Clone, Copy, Debug)]
struct Strand {
    across: [f32; 3],
    along: [f32; 2],
    /// Half the width, in columns.
    half_width: f32,
    tone: f32,
    light: f32,
    shift: f32,
    /// Light that its root lacks.
    root_shade: f32,
}

/// What grows in a column.
#[derive(Clone, Copy, Debug)]
struct Growth {
    count: usize,
    /// Half a strand's width in columns.
    half_width: f32,
    /// How far strands stay from the column's sides.
    margin: f32,
    /// Locks whose tips draw together, and how much.
    locks: f32,
    gather: f32,
    /// Where strands begin (at latest) and end (at earliest).
    start: f32,
    end: f32,
}

const fn growth(column: usize) -> Growth {
    if column == EVEN {
        // Neither begin nor end together: such cards are to be seen nowhere.
        Growth {
            count: 300,
            half_width: 0.0085,
            margin: 0.02,
            locks: 9.0,
            gather: 0.0,
            start: 0.36,
            end: 0.56,
        }
    } else if column < DENSE {
        Growth {
            count: 300,
            half_width: 0.0085,
            margin: 0.02,
            locks: 9.0,
            gather: 0.40,
            start: 0.32,
            end: 0.56,
        }
    } else if column == DENSE {
        Growth {
            count: 90,
            half_width: 0.0100,
            margin: 0.08,
            locks: 3.0,
            gather: 0.60,
            start: 0.24,
            end: 0.55,
        }
    } else if column < DENSE + LOOSE {
        Growth {
            count: 22,
            half_width: 0.020,
            margin: 0.08,
            locks: 2.0,
            gather: 0.45,
            start: 0.20,
            end: 0.50,
        }
    } else {
        Growth {
            count: 4,
            half_width: 0.055,
            margin: 0.18,
            locks: 1.0,
            gather: 0.25,
            start: 0.05,
            end: 0.60,
        }
    }
}

/// The map, `side` texels wide and half as high.
pub(crate) fn paint(side: usize) -> Image {
    let (width, height) = (side, (side / 2).max(1));
    // What no strand covers has their mean tone, for the smaller copies.
    let mut texels: Vec<Texel> = vec![[0.45, 0.8, 0.5, 0.0]; width * height];
    for column in 0..COLUMNS {
        for strand in strands(column) {
            lay(&mut texels, (width, height), column, &strand);
        }
    }
    let mut image = Image::new(width, height);
    parallel_rows(&mut image.texels, width, |y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            *texel = texels[y * width + x].map(|v| (v.clamp(0.0, 1.0) * 255.0) as u8);
        }
    });
    image
}

/// Strands of one column, back to front.
fn strands(column: usize) -> Vec<Strand> {
    let g = growth(column);
    let mut dice = Dice::new(1201 + column as u64);
    let seed = column as f32 * 7.3;
    (0..g.count)
        .map(|i| {
            let front = i as f32 / g.count as f32;
            let share = dice.roll();
            let x = g.margin + (1.0 - 2.0 * g.margin) * share;
            // Locks: strands of one lock end together, in a point, and share a tone.
            let wavering = share * g.locks + 0.7 * (value(share * 5.0, seed, 30) - 0.5);
            let number = wavering.floor();
            let middle = (number + 0.5) / g.locks;
            let off = (share - middle) * g.locks;
            let lock = value(number * 1.7 + 0.5, seed, 31);
            // Of even strands each is a lock of its own.
            let even = column == EVEN;
            let lock = if even { 0.5 * lock + 0.25 } else { lock };
            let fine = value(share * g.locks * 4.0, seed, 32);
            let lean = if even { 0.0 } else { 0.12 * (lock - 0.5) } + 0.05 * dice.spread();
            let bend = 0.05 * dice.spread();
            // Some leave their lock.
            let stray = if dice.roll() < 0.12 { 0.10 } else { 0.0 };
            let tip = x + (middle - share) * g.gather + lean + stray * dice.spread();
            let start = dice.roll();
            let start = 0.02 + g.start * if even { start.sqrt() } else { start };
            let longest = 0.80 + 0.19 * lock;
            let end = longest
                - (longest - g.end) * (0.75 * off.abs() * 2.0 * dice.roll() + 0.25 * dice.roll());
            let end = if even {
                0.99 + (g.end - 0.99) * dice.roll().sqrt()
            } else {
                end
            };
            Strand {
                across: [x, 0.5 * (x + tip) + bend, tip],
                along: [start, end.max(start + 0.15)],
                half_width: g.half_width * (0.6 + 0.8 * dice.roll()),
                tone: 0.30 + 0.16 * lock + 0.22 * fine + 0.34 * dice.roll(),
                // What lies behind lies in shade.
                light: 0.42 + 0.58 * front.sqrt(),
                shift: dice.roll(),
                root_shade: if even { 0.08 } else { 0.22 },
            }
        })
        .collect()
}

fn lay(texels: &mut [Texel], (width, height): (usize, usize), column: usize, strand: &Strand) {
    /// Shade that a strand throws on what lies right behind it, and how far.
    const SHADE: f32 = 0.22;
    const SHADE_WIDTHS: f32 = 2.2;
    let scale = width as f32 / COLUMNS as f32;
    let left = column as f32 * scale;
    let [a, b, c] = strand.across;
    let [start, end] = strand.along.map(|v| v * height as f32);
    let last = (end.ceil() as usize).min(height);
    for y in start as usize..last {
        let t = ((y as f32 + 0.5 - start) / (end - start)).clamp(0.0, 1.0);
        let at = a * (1.0 - t) * (1.0 - t) + 2.0 * b * t * (1.0 - t) + c * t * t;
        let centre = left + at.clamp(0.015, 0.985) * scale;
        // Thin at the tip, and it comes out of the skin by degrees.
        let half = (strand.half_width * scale * (1.0 - 0.75 * t * t * t)).max(0.35);
        let present = ramp(0.0, 0.10, t) * (1.0 - 0.7 * ramp(0.8, 1.0, t)) * (2.0 * half).min(1.0);
        let light = strand.light * (1.0 - strand.root_shade * ramp(0.45, 0.0, t));
        let reach = half * SHADE_WIDTHS + 0.5;
        let from = (centre - reach).max(left) as usize;
        let to = ((centre + reach).ceil() as usize).min((left + scale) as usize);
        for x in from..to {
            let off = (x as f32 + 0.5 - centre).abs();
            let texel = &mut texels[y * width + x];
            texel[1] *= 1.0 - SHADE * present * ramp(reach, half, off);
            let cover = (half + 0.5 - off).clamp(0.0, 1.0) * present;
            if cover <= 0.0 {
                continue;
            }
            // Round: its sides turn away.
            let round = 1.0 - 0.25 * (off / half).min(1.0).powi(2);
            let over = [strand.tone, light * round, strand.shift, 1.0];
            for (value, over) in texel.iter_mut().zip(over) {
                *value += (over - *value) * cover;
            }
        }
    }
}

/// How many of a pixel's samples a cover turns into: keep in step with shaders/hair.wgsl.
fn covered(cover: u8, samples: u32) -> u32 {
    (f32::from(cover) / 255.0 * samples as f32 + 0.5) as u32
}

/// Mean share of covered samples within columns `x` (texels) of an image, its covers multiplied by `scale`.
fn coverage(image: &Image, x: std::ops::Range<usize>, scale: f32, samples: u32) -> f32 {
    let mut sum = 0;
    for row in image.texels.chunks(image.width) {
        for texel in &row[x.clone()] {
            sum += covered(scaled(texel[3], scale), samples);
        }
    }
    sum as f32 / (x.len() * image.height) as f32 / samples as f32
}

fn scaled(cover: u8, scale: f32) -> u8 {
    (f32::from(cover) * scale + 0.5).min(255.0) as u8
}

/// The map and its halvings down to one texel, for pictures of that many samples a pixel. An average of covers is
/// not the average of what becomes of them once samples are counted: in each copy every column's cover is
/// scaled until as many samples are covered as in the map itself.
pub(crate) fn mips(map: Image, samples: u32) -> Vec<Image> {
    let mut levels = map.into_mips();
    let Some((map, smaller)) = levels.split_first_mut() else {
        return levels;
    };
    let columns = |image: &Image, column: usize| {
        let side = image.width / COLUMNS;
        column * side..(column + 1) * side
    };
    for column in 0..COLUMNS {
        let wanted = coverage(map, columns(map, column), 1.0, samples);
        // Copies that have less than two texels a column are of pictures in which a head is a dot.
        for level in smaller.iter_mut().take_while(|l| l.width >= 2 * COLUMNS) {
            let x = columns(level, column);
            let (mut low, mut high) = (0.25_f32, 4.0_f32);
            for _ in 0..10 {
                let middle = (low * high).sqrt();
                if coverage(level, x.clone(), middle, samples) < wanted {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let scale = (low * high).sqrt();
            let width = level.width;
            for row in level.texels.chunks_mut(width) {
                for texel in &mut row[x.clone()] {
                    texel[3] = scaled(texel[3], scale);
                }
            }
        }
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worst difference of any column's coverage to the map's, over the copies of at least 8 texels a column.
    fn worst(levels: &[Image], samples: u32) -> f32 {
        let mut worst = 0.0_f32;
        for column in 0..COLUMNS {
            let share = |image: &Image| {
                let side = image.width / COLUMNS;
                coverage(image, column * side..(column + 1) * side, 1.0, samples)
            };
            let wanted = share(&levels[0]);
            for level in levels.iter().take_while(|l| l.width >= 8 * COLUMNS) {
                worst = worst.max((share(level) - wanted).abs());
            }
        }
        worst
    }

    #[test]
    fn strands_cover_as_much_in_every_smaller_copy() {
        for (side, samples) in [(1024, 4), (512, 1)] {
            let kept = worst(&mips(paint(side), samples), samples);
            let plain = worst(&paint(side).into_mips(), samples);
            assert!(kept < 0.012, "{samples} samples: off by {kept}");
            assert!(
                kept <= plain,
                "{samples} samples: {plain} by averages alone"
            );
        }
        // One sample is there or not: averages alone lose or add strands.
        let plain = worst(&paint(512).into_mips(), 1);
        assert!(plain > 0.03, "{plain} by averages alone");
    }

    #[test]
    fn dense_columns_cover_and_single_hairs_hardly_do() {
        let map = paint(512);
        let share = |column: usize| coverage(&map, column * 64..(column + 1) * 64, 1.0, 4);
        assert!(share(0) > 0.55, "{}", share(0));
        assert!(share(COLUMNS - 1) < 0.35, "{}", share(COLUMNS - 1));
    }
}
