//! The mask of HEADSHOP 4.4: gloss, how deep the fine structure is, how much light shines through, and where
//! wrinkles lie. Over the head's whole chart.

use glam::vec2;

use super::image::Image;
use super::noise::value;
use super::skin::{Tones, sample};
use super::wrinkles::Wrinkles;
use super::{CHART_MM, parallel_rows};

/// Depth at which a wrinkle's floor is as dark as it gets, mm.
const DEEP_MM: f32 = 0.68;

/// Gloss, bump intensity, translucence; the wrinkles' floors: above one half those of the first layer, below of the second.
pub(super) fn paint(tones: &Tones, wrinkles: &Wrinkles, width: usize) -> Image {
    let height = (width / 2).max(1);
    let mut image = Image::new(width, height);
    parallel_rows(&mut image.texels, width, |y, row| {
        for (x, texel) in row.iter_mut().enumerate() {
            let uv = vec2(
                (x as f32 + 0.5) / width as f32,
                (y as f32 + 0.5) / height as f32,
            );
            let tone = sample(tones, uv);
            let at = uv * CHART_MM;
            // Oil lies in patches.
            let patch = 0.78
                + 0.28 * value(at.x * 0.14, at.y * 0.14, 31)
                + 0.18 * value(at.x * 0.5, at.y * 0.5, 32);
            let floor =
                |relief: &super::creases::Relief| (-relief.at(at) / DEEP_MM).clamp(0.0, 1.0);
            // The lips' own creases are in their colour.
            let floors = (floor(&wrinkles.raised) - floor(&wrinkles.drawn))
                * (1.0 - tone[4].clamp(0.0, 1.0));
            let share = |share: f32| (share.clamp(0.0, 1.0) * 255.0) as u8;
            *texel = [
                share(tone[0] * patch),
                share(tone[1]),
                share(tone[3]),
                (128.0 + 127.0 * floors) as u8,
            ];
        }
    });
    image
}
