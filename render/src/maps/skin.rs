//! Colour, bump and gloss of the skin: the head's colour, and painted detail. The fine structure follows the idea of Ishii et al. as
//! HEADSHOP 4.4 takes it: polygonal cells parted by furrows, with pores where the skin is oily.
//!
//! Broad tones are laid on a coarse grid by place on the face; grain is added texel by texel.

use glam::{Vec2, vec2};
use mouthpiece_rig::{ColourMap, Head};

use super::image::{Image, root_of_linear};
use super::landmarks::{Ground, Landmarks};
use super::noise::{cells, value};
use super::tone::{PLAIN, Tone, tone_at};
use super::{CHART_HEIGHT, RADIUS, WINDOW_MAX, WINDOW_MIN, parallel_rows, ramp};

/// The two maps of the skin.
#[derive(Clone, Debug)]
pub(crate) struct SkinMaps {
    /// Square root of linear colour; a: how much light shines through. Over the head's whole `uv`.
    pub(crate) colour: Image,
    /// Slopes across and up (128 is flat, 255 is 45 degrees), gloss, what is left of the colour in the
    /// grain (255 is twice). Over the window.
    pub(crate) detail: Image,
}

/// Tone cells across and down the whole map.
const GRID: (usize, usize) = (512, 256);
/// Skin of a head that brings no colour, sRGB: as its texels would be.
const UNCOLOURED: [u8; 3] = [204, 154, 132];

/// The maps of `head`, that of detail `width` texels wide and half as high.
pub(crate) fn paint(head: &Head, width: usize) -> SkinMaps {
    let ground = Ground::of(head, GRID.0, GRID.1);
    let marks = Landmarks::of(head);
    let mut tones: Vec<Tone> = vec![PLAIN; GRID.0 * GRID.1];
    parallel_rows(&mut tones, GRID.0, |y, row| {
        for (x, tone) in row.iter_mut().enumerate() {
            if let Some((place, red)) = ground.cells[y * GRID.0 + x] {
                let uv = vec2(
                    (x as f32 + 0.5) / ground.width as f32,
                    (y as f32 + 0.5) / ground.height as f32,
                );
                *tone = tone_at(place, red, uv, &marks);
            }
        }
    });
    SkinMaps {
        colour: coloured(head.colour.as_ref(), &tones),
        detail: detail(&tones, width, (width / 2).max(1)),
    }
}

/// The head's colour as the shader wants it, with the tones' translucence.
fn coloured(map: Option<&ColourMap>, tones: &[Tone]) -> Image {
    let known = map.filter(|m| m.width > 0 && m.rgb.len() >= m.width * m.height * 3);
    let (width, height) = known.map_or(GRID, |m| (m.width, m.height));
    let table: Vec<u8> = (0..256)
        .map(|byte| root_of_linear(byte as f32 / 255.0))
        .collect();
    let mut image = Image::new(width, height);
    parallel_rows(&mut image.texels, width, |y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            let at = 3 * (y * width + x);
            let rgb = known.map_or(&UNCOLOURED[..], |m| &m.rgb[at..at + 3]);
            let uv = vec2(
                (x as f32 + 0.5) / width as f32,
                (y as f32 + 0.5) / height as f32,
            );
            let thin = sample(tones, uv)[3];
            let [r, g, b] = std::array::from_fn(|c| table[usize::from(rgb[c])]);
            *texel = [r, g, b, (thin * 255.0) as u8];
        }
    });
    image
}

/// Slopes, gloss and grain.
fn detail(tones: &[Tone], width: usize, height: usize) -> Image {
    let mut bump = vec![0.0_f32; width * height];
    let mm = texel_mm(width, height);
    let uv = |x: usize, y: usize| {
        let share = vec2(
            (x as f32 + 0.5) / width as f32,
            (y as f32 + 0.5) / height as f32,
        );
        WINDOW_MIN + share * (WINDOW_MAX - WINDOW_MIN)
    };
    parallel_rows(&mut bump, width, |y, row| {
        for (x, depth) in row.iter_mut().enumerate() {
            let tone = sample(tones, uv(x, y));
            *depth = relief(vec2(x as f32, y as f32) * mm, &tone);
        }
    });
    let mut image = Image::new(width, height);
    parallel_rows(&mut image.texels, width, |y, row| {
        let above = y.saturating_sub(1) * width;
        let below = (y + 1).min(height - 1) * width;
        for (x, texel) in row.iter_mut().enumerate() {
            let (left, right) = (x.saturating_sub(1), (x + 1).min(width - 1));
            let dx = (bump[y * width + right] - bump[y * width + left]) / (2.0 * mm.x);
            // Rows run down, slopes up.
            let dy = (bump[above + x] - bump[below + x]) / (2.0 * mm.y);
            let tone = sample(tones, uv(x, y));
            let at = vec2(x as f32, y as f32) * mm;
            let patch = 0.8 + 0.4 * value(at.x * 0.4, at.y * 0.4, 31);
            // Darker in its furrows, and never quite even.
            let grain = tone[5] * (value(at.x * 1.3, at.y * 1.3, 9) - 0.5);
            let left_over = 1.0 + 0.020 * grain + 1.1 * bump[y * width + x].min(0.0);
            let slope = |slope: f32| (slope.clamp(-1.0, 1.0) * 127.0 + 127.5) as u8;
            let share = |share: f32| (share.clamp(0.0, 1.0) * 255.0) as u8;
            *texel = [
                slope(dx),
                slope(dy),
                share(tone[0] * patch),
                share(0.5 * left_over),
            ];
        }
    });
    image
}

/// Size of a texel on the face, mm.
pub(crate) fn texel_mm(width: usize, height: usize) -> Vec2 {
    let span = WINDOW_MAX - WINDOW_MIN;
    vec2(
        span.x * std::f32::consts::TAU * RADIUS / width as f32,
        span.y * CHART_HEIGHT / height as f32,
    )
}

/// The tone grid at a place of the map, bilinear.
fn sample(tones: &[Tone], uv: Vec2) -> Tone {
    let gx = (uv.x * GRID.0 as f32 - 0.5).clamp(0.0, GRID.0 as f32 - 1.001);
    let gy = (uv.y * GRID.1 as f32 - 0.5).clamp(0.0, GRID.1 as f32 - 1.001);
    let (ix, iy) = (gx as usize, gy as usize);
    let (fx, fy) = (gx - ix as f32, gy - iy as f32);
    let at = iy * GRID.0 + ix;
    let (a, b) = (&tones[at], &tones[at + 1]);
    let (c, d) = (&tones[at + GRID.0], &tones[at + GRID.0 + 1]);
    std::array::from_fn(|i| {
        let upper = a[i] + (b[i] - a[i]) * fx;
        let lower = c[i] + (d[i] - c[i]) * fx;
        upper + (lower - upper) * fy
    })
}

/// Height of the skin's fine structure at a place of the window (mm), in mm.
fn relief(at: Vec2, tone: &Tone) -> f32 {
    let lip = ramp(0.2, 0.6, tone[4]);
    let mut height = 0.0;
    if lip < 1.0 && tone[5] > 0.01 {
        // Cells stretched this way and that, as the furrows of skin run.
        let lean = 0.5 * (value(at.x * 0.07, at.y * 0.07, 3) - 0.5);
        let size = 0.78;
        let (near, second) = cells((at.x + lean * at.y) * size, at.y * size * 0.9, 11);
        height -= 0.045 * tone[1] * (1.0 - ((second - near) * 3.2).min(1.0));
        // Pores: pits in the larger cells.
        if tone[2] > 0.1 {
            let (pit, _) = cells(at.x * 0.72 + 31.0, at.y * 0.72, 23);
            height -= 0.10 * (tone[2] - 0.1) * (1.0 - (pit * 3.6).min(1.0));
        }
        height += 0.09 * tone[1] * (value(at.x * 0.45, at.y * 0.45, 41) - 0.5);
        height *= 1.0 - lip;
    }
    if lip > 0.0 {
        // Creases of the lips run across the red, here up and down, and waver.
        let bend = 2.6 * value(at.x * 0.16, at.y * 0.30, 53);
        let crease = value(at.x * 0.80 + bend, at.y * 0.21, 61);
        let fine = value(at.x * 2.3 + bend, at.y * 0.45, 67);
        height += lip * (0.20 * (crease - 0.5) + 0.10 * (fine - 0.5));
    }
    height
}
