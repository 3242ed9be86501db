//! The maps of skin, eyes and hair (HEADSHOP 4.4). The skin's colour is the head's own; the others
//! are painted by program, those of the skin by place on the face.
//!
//! The skin's wrinkles cover the window of the chart that shows a face: 151 degrees of longitude, from 135 mm to
//! -90 mm, so that 1024 x 1024 texels give over 4 texels a mm; at its edges it is flat, which the sampler extends.
//!
//! Colours are kept as the square root of linear light: the shader squares them, which costs less in
//! software rendering than decoding sRGB. Nothing here knows of wgpu.

mod complexion;
mod creases;
mod expression_lines;
pub(crate) mod eye;
pub(crate) mod grain;
pub(crate) mod hair;
pub(crate) mod hairline;
pub(crate) mod image;
pub(crate) mod landmarks;
mod mask;
pub(crate) mod noise;
pub(crate) mod skin;
pub(crate) mod strokes;
pub(crate) mod tone;
mod wrinkles;
pub(crate) mod zones;

use glam::{Vec2, vec2};
use mouthpiece_rig::Head;

use crate::tier::Detail;

/// Part of the chart that the skin's wrinkles cover. Keep in step with shaders/skin_surface.wgsl.
pub(crate) const WINDOW_MIN: Vec2 = vec2(0.29, 0.06);
/// See [`WINDOW_MIN`].
pub(crate) const WINDOW_MAX: Vec2 = vec2(0.71, 0.94);
/// A mean radius of the face, mm: turns longitude into length for textures' grain.
pub(crate) const RADIUS: f32 = 92.0;
/// Height of the whole chart, mm.
pub(crate) const CHART_HEIGHT: f32 = 256.0;
/// Millimetres a unit of the chart's `uv`.
pub(crate) const CHART_MM: Vec2 = vec2(std::f32::consts::TAU * RADIUS, CHART_HEIGHT);

/// Every map of a head.
#[derive(Clone, Debug)]
pub(crate) struct Maps {
    pub(crate) skin: skin::SkinMaps,
    pub(crate) eye: image::Image,
    pub(crate) hair: image::Image,
}

impl Maps {
    /// Paints them: the hair's, which is laid strand by strand, beside the others.
    pub(crate) fn paint(head: &Head, detail: &Detail) -> Self {
        let hair = || hair::paint(detail.hair_map as usize);
        std::thread::scope(|scope| {
            let beside = std::thread::Builder::new()
                .name("paint hair".into())
                .spawn_scoped(scope, hair);
            let skin = skin::paint(head, detail);
            let eye = eye::paint(detail.eye_map as usize);
            // Where no thread is to be had, or it failed, the work is done here.
            let hair = beside
                .ok()
                .and_then(|thread| thread.join().ok())
                .unwrap_or_else(hair);
            Self { skin, eye, hair }
        })
    }
}

/// Runs `paint(row number, row)` over all rows, on as many threads as there are cores, up to 4.
pub(crate) fn parallel_rows<T: Send>(
    values: &mut [T],
    width: usize,
    paint: impl Fn(usize, &mut [T]) + Sync,
) {
    let height = values.len() / width.max(1);
    let cores = std::thread::available_parallelism()
        .map_or(1, usize::from)
        .min(4);
    if height < 64 || cores == 1 {
        values
            .chunks_mut(width.max(1))
            .enumerate()
            .for_each(|(y, row)| paint(y, row));
        return;
    }
    // Interleaved bands, since the rows of a face are unequal work.
    let band = height.div_ceil(cores * 4).max(1);
    let bands = std::sync::Mutex::new(values.chunks_mut(band * width).enumerate());
    let work = || {
        loop {
            let next = match bands.lock() {
                Ok(mut bands) => bands.next(),
                Err(_) => None,
            };
            let Some((number, rows)) = next else { return };
            for (y, row) in rows.chunks_mut(width).enumerate() {
                paint(number * band + y, row);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..cores {
            // Where no thread is to be had the work is done here.
            let _ = std::thread::Builder::new()
                .name("paint maps".into())
                .spawn_scoped(scope, work);
        }
        work();
    });
}

/// Smooth step from 0 at `from` to 1 at `to`, either way round.
pub(crate) fn ramp(from: f32, to: f32, value: f32) -> f32 {
    let t = ((value - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
