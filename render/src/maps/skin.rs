//! The four maps of the skin, as HEADSHOP 4.4 has them: colour, bump of the fine structure, bump of the expressive
//! wrinkles, and the mask. Broad tones are laid on a coarse grid by place on the face; what is finer is added
//! texel by texel.

use glam::{Vec2, vec2};
use mouthpiece_rig::{ColourMap, Head};

use super::complexion::Complexion;
use super::image::{Image, root_of_linear};
use super::landmarks::{Ground, Landmarks};
use super::tone::{PLAIN, Tone, tone_at};
use super::wrinkles::Wrinkles;
use super::{grain, mask, parallel_rows};
use crate::tier::Detail;

/// The maps of the skin.
#[derive(Clone, Debug)]
pub(crate) struct SkinMaps {
    /// Square root of linear colour; a: how much its pores show. Over the head's whole `uv`.
    pub(crate) colour: Image,
    /// The fine structure: a tile; see [`grain`].
    pub(crate) grain: Image,
    /// Slopes across and up of the two layers of wrinkles (128 is flat, 255 is 45 degrees). Over the window.
    pub(crate) wrinkles: Image,
    /// See [`mask`]. Over the head's whole `uv`.
    pub(crate) mask: Image,
}

/// Tone cells across and down the whole map.
const GRID: (usize, usize) = (512, 256);
/// The tones of a head, cell by cell.
pub(super) type Tones = [Tone];
/// Skin of a head that brings no colour, sRGB: as its texels would be.
const UNCOLOURED: [u8; 3] = [204, 154, 132];

/// The maps of `head`.
pub(crate) fn paint(head: &Head, detail: &Detail) -> SkinMaps {
    let ground = Ground::of(head, GRID.0, GRID.1);
    let marks = Landmarks::of(head);
    let mut tones: Vec<Tone> = vec![PLAIN; GRID.0 * GRID.1];
    parallel_rows(&mut tones, GRID.0, |y, row| {
        for (x, tone) in row.iter_mut().enumerate() {
            if let Some((place, red)) = ground.cells[y * GRID.0 + x] {
                *tone = tone_at(place, red, &marks);
            }
        }
    });
    let red = |uv: Vec2| sample(&tones, uv)[4];
    let wrinkles = Wrinkles::of(head, detail.wrinkle_map as usize, &red);
    SkinMaps {
        colour: coloured(head.colour.as_ref(), &tones),
        grain: grain::paint(detail.grain_map as usize),
        mask: mask::paint(&tones, &wrinkles, detail.mask_map as usize),
        wrinkles: slopes(&wrinkles),
    }
}

/// The head's colour as the shader wants it, with the fine variation that it lacks.
fn coloured(map: Option<&ColourMap>, tones: &Tones) -> Image {
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
            let [r, g, b] = std::array::from_fn(|c| table[usize::from(rgb[c])]);
            *texel = vivid([r, g, b]);
        }
    });
    let complexion = Complexion::of(&image);
    parallel_rows(&mut image.texels, width, |y, row| {
        let v = (y as f32 + 0.5) / height as f32;
        for (x, texel) in row.iter_mut().enumerate() {
            let [r, g, b, _] = *texel;
            let tone = sample(tones, vec2((x as f32 + 0.5) / width as f32, v));
            // Lips have their own; painted hair hides it.
            let share = 1.0 - 0.6 * tone[4].clamp(0.0, 1.0);
            let [r, g, b] = complexion.over([r, g, b], x, y, share);
            *texel = [r, g, b, (tone[2].clamp(0.0, 1.0) * 255.0) as u8];
        }
    });
    image
}

/// The film's shoulder takes colour from what is bright and makes it paler, and skin is bright: it is given its
/// colour beforehand.
fn vivid([r, g, b]: [u8; 3]) -> [u8; 4] {
    /// Percent.
    const MORE: i32 = 13;
    const DARKER: i32 = 4;
    let [r, g, b] = [r, g, b].map(i32::from);
    let grey = (3 * r + 5 * g + 2 * b) / 10;
    // Painted hair is dark and keeps its own.
    let bright = (grey - 70).clamp(0, 60);
    let [r, g, b] = [r, g, b].map(|c| {
        let change = (c - grey) * MORE - c * DARKER;
        (c + change * bright / 6000).clamp(0, 255) as u8
    });
    [r, g, b, 0]
}

/// The two layers of wrinkles as slopes.
fn slopes(wrinkles: &Wrinkles) -> Image {
    let (width, height) = (wrinkles.raised.width, wrinkles.raised.height);
    let mut image = Image::new(width, height);
    parallel_rows(&mut image.texels, width, |y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            let (a, b) = (wrinkles.raised.slope(x, y), wrinkles.drawn.slope(x, y));
            *texel = [a.x, a.y, b.x, b.y].map(grain::slope);
        }
    });
    image
}

/// The tone grid at a place of the map, bilinear.
pub(super) fn sample(tones: &Tones, uv: Vec2) -> Tone {
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
