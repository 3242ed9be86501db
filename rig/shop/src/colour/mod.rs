//! The colour map of a head's skin, painted by program: HEADSHOP 4.4's first texture. Zones of real skin (ruddy
//! cheeks, nose and ears, pale forehead, bluish rings under the eyes), lips, brows hair by hair, and the roots of
//! the hair. Its finest grain is left to the renderer's detail map.
//!
//! Zones are functions of the place on the *reference* head ([`Skin::reference`]), so that a fitted head is painted as
//! the same person's kin. A scan's own colours are baked elsewhere, over the same [`texels`].

mod brows;
mod hairs;
mod strokes;
mod texels;
mod tone;

use glam::Vec3;
use mouthpiece_rig::{ColourMap, Head, Skin};

use crate::lines::Hairline;
pub use texels::{Texel, texels};
use tone::{Face, Spot};

/// Texels across that keep a brow's hairs apart and the file small.
pub const WIDTH: usize = 2048;
/// Rings of texels painted round each island, so that filtering never reads past its edge.
const BLEED: usize = 6;
/// Skin where nothing is painted: sRGB, as bytes.
const PLAIN: [u8; 3] = [196, 148, 123];

/// Paints the colour map of a head, `width` texels across and half as many down, sRGB.
#[must_use]
pub fn paint(head: &Head, width: usize) -> ColourMap {
    let height = (width / 2).max(1);
    let places = texels(&head.skin, width);
    let hairline = Hairline::of(head);
    let face = Face::of(head);
    let brows = brows::paint(head, width, height);
    let roots = hairs::paint(hairline.as_ref(), width, height);
    let mut rgb = vec![PLAIN; width * height];
    let mut painted = vec![false; width * height];
    for (at, texel) in places.iter().enumerate() {
        let Some(texel) = texel else { continue };
        let spot = spot(&head.skin, texel);
        let hair = roots.values[at].max(brows.values[at]);
        rgb[at] = face.colour(&spot, hairline.as_ref(), hair);
        painted[at] = true;
    }
    bleed(&mut rgb, &mut painted, width);
    ColourMap {
        width,
        height,
        rgb: rgb.into_iter().flatten().collect(),
    }
}

/// What lies under a texel.
fn spot(skin: &Skin, texel: &Texel) -> Spot {
    let corners = skin.mesh.triangles[texel.triangle as usize];
    let shares = texel.shares;
    let mix = |value: &dyn Fn(usize) -> f32| -> f32 {
        corners
            .iter()
            .zip(shares)
            .map(|(i, share)| value(*i as usize) * share)
            .sum()
    };
    let reference = if skin.reference.len() == skin.mesh.positions.len() {
        &skin.reference
    } else {
        &skin.mesh.positions
    };
    let place: Vec3 = corners
        .iter()
        .zip(shares)
        .map(|(i, share)| reference[*i as usize] * share)
        .sum();
    // The chart runs over at the back: corners beyond the seam are taken from this side of it.
    let first = skin.mesh.uvs[corners[0] as usize].x;
    let unrolled = |i: usize| {
        let u = skin.mesh.uvs[i].x;
        u - (u - first).round()
    };
    Spot {
        place,
        chart: glam::vec2(mix(&unrolled).rem_euclid(1.0), mix(&|i| skin.mesh.uvs[i].y)),
        red: mix(&|i| skin.vermilion[i]),
        wet: mix(&|i| skin.wet[i]),
        open: mix(&|i| skin.mesh.occlusion.get(i).copied().unwrap_or(1.0)),
    }
}

/// Gives unpainted texels beside painted ones the mean of those.
fn bleed(rgb: &mut [[u8; 3]], painted: &mut [bool], width: usize) {
    let height = rgb.len() / width.max(1);
    for _ in 0..BLEED {
        let mut ring = Vec::new();
        for at in (0..rgb.len()).filter(|at| !painted[*at]) {
            let (x, y) = (at % width, at / width);
            let mut sum = [0_u32; 3];
            let mut count = 0;
            for (dx, dy) in [(-1, 0), (1, 0), (0, -1), (0, 1)] {
                let (nx, ny) = (x as isize + dx, y as isize + dy);
                if nx < 0 || ny < 0 || nx >= width as isize || ny >= height as isize {
                    continue;
                }
                let near = ny as usize * width + nx as usize;
                if painted[near] {
                    for (sum, byte) in sum.iter_mut().zip(rgb[near]) {
                        *sum += u32::from(byte);
                    }
                    count += 1;
                }
            }
            if count > 0 {
                ring.push((at, sum.map(|s| (s / count) as u8)));
            }
        }
        for (at, colour) in ring {
            rgb[at] = colour;
            painted[at] = true;
        }
    }
}
