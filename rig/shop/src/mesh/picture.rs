//! Textures of scans: PNG and JPEG in, and several of them stacked into one picture.

use std::io::Cursor;

use glam::{Vec2, vec2};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::error::Fault;
use super::limits::MAX_PIXELS;
use super::scan::Image;
use super::text::quote;

/// The picture in `bytes`, whatever its name ends in.
pub(crate) fn decode(name: &str, bytes: &[u8]) -> Result<Image, Fault> {
    let read = if bytes.starts_with(b"\x89PNG") {
        png(bytes)
    } else if bytes.starts_with(&[0xff, 0xd8]) {
        jpeg(bytes)
    } else {
        Err("it is neither PNG nor JPEG".to_owned())
    };
    read.map_err(|why| Fault::Picture {
        name: quote(name.as_bytes()),
        why,
    })
}

fn check(width: u64, height: u64) -> Result<(), String> {
    match width.checked_mul(height) {
        None | Some(0) => Err("it has no pixels".to_owned()),
        Some(pixels) if pixels > MAX_PIXELS => {
            Err(format!("{width} x {height} pixels, {MAX_PIXELS} at most"))
        }
        Some(_) => Ok(()),
    }
}

fn png(bytes: &[u8]) -> Result<Image, String> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(|e| e.to_string())?;
    let (width, height) = (reader.info().width, reader.info().height);
    check(u64::from(width), u64::from(height))?;
    let size = reader.output_buffer_size().ok_or("it is too large")?;
    let mut pixels = vec![0; size];
    let frame = reader.next_frame(&mut pixels).map_err(|e| e.to_string())?;
    pixels.truncate(frame.buffer_size());
    let rgb = match frame.color_type {
        png::ColorType::Rgb => pixels,
        png::ColorType::Rgba => pixels
            .chunks_exact(4)
            .flat_map(|p| [p[0], p[1], p[2]])
            .collect(),
        png::ColorType::Grayscale => pixels.iter().flat_map(|&p| [p; 3]).collect(),
        png::ColorType::GrayscaleAlpha => pixels.chunks_exact(2).flat_map(|p| [p[0]; 3]).collect(),
        png::ColorType::Indexed => return Err("its palette was not resolved".to_owned()),
    };
    Ok(Image { width, height, rgb })
}

fn jpeg(bytes: &[u8]) -> Result<Image, String> {
    let options = DecoderOptions::default()
        .jpeg_set_out_colorspace(ColorSpace::RGB)
        .set_max_width(1 << 16)
        .set_max_height(1 << 16);
    let mut decoder = JpegDecoder::new_with_options(Cursor::new(bytes), options);
    decoder.decode_headers().map_err(|e| e.to_string())?;
    let (width, height) = decoder.dimensions().ok_or("it has no size")?;
    check(width as u64, height as u64)?;
    let rgb = decoder.decode().map_err(|e| e.to_string())?;
    if rgb.len() != width * height * 3 {
        return Err("its colours are neither RGB nor grey".to_owned());
    }
    let side = |n: usize| u32::try_from(n).map_err(|e| e.to_string());
    Ok(Image {
        width: side(width)?,
        height: side(height)?,
        rgb,
    })
}

/// What a file says of one material's colour.
#[derive(Clone, Debug)]
pub(crate) struct Material {
    /// Which of the pictures it shows.
    pub(crate) picture: Option<usize>,
    /// Its colour without a picture, sRGB.
    pub(crate) solid: [u8; 3],
}

impl Default for Material {
    fn default() -> Self {
        Self {
            picture: None,
            solid: [200; 3],
        }
    }
}

/// Side of the patch that stands for a material without a picture, pixels.
const PATCH: u32 = 4;

/// Pictures and patches under one another, and the triangles' `uvs` moved to where they now are.
/// `material` says per triangle which of `materials` it has. A corner without coordinates is NaN.
pub(crate) fn stack(
    mut pictures: Vec<Image>,
    materials: &[Material],
    material: &[u32],
    uvs: &mut [[Vec2; 3]],
) -> Result<Image, Fault> {
    // Per material: its picture where there is one, and after all pictures its patch.
    let mut patch = vec![usize::MAX; materials.len()];
    for (uv, &m) in uvs.iter().zip(material) {
        let m = m as usize;
        let plain = materials[m].picture.is_none() || uv.iter().any(|c| !c.is_finite());
        if plain && patch[m] == usize::MAX {
            patch[m] = pictures.len();
            let rgb = materials[m].solid.repeat((PATCH * PATCH) as usize);
            pictures.push(Image {
                width: PATCH,
                height: PATCH,
                rgb,
            });
        }
    }
    let width = pictures.iter().map(|p| p.width).max().unwrap_or(0);
    let height: u64 = pictures.iter().map(|p| u64::from(p.height)).sum();
    check(u64::from(width), height).map_err(|why| Fault::Picture {
        name: "made of all textures".to_owned(),
        why,
    })?;
    let mut top = Vec::with_capacity(pictures.len());
    let mut y = 0u32;
    for picture in &pictures {
        top.push(y);
        y += picture.height;
    }
    let whole = vec2(width as f32, y as f32);
    for (corners, &m) in uvs.iter_mut().zip(material) {
        let m = m as usize;
        let textured = corners.iter().all(|c| c.is_finite());
        let which = match materials[m].picture {
            Some(picture) if textured => picture,
            _ => {
                *corners = [Vec2::splat(0.5); 3];
                patch[m]
            }
        };
        let size = vec2(pictures[which].width as f32, pictures[which].height as f32);
        let origin = vec2(0.0, top[which] as f32);
        *corners = unwrap(*corners).map(|uv| {
            // Half a pixel inside, so that no filter reads the neighbour picture.
            let pixel = (uv * size).clamp(Vec2::splat(0.5), size - 0.5);
            (origin + pixel) / whole
        });
    }
    if pictures.len() == 1 {
        return Ok(pictures.swap_remove(0));
    }
    let mut rgb = Vec::with_capacity(width as usize * y as usize * 3);
    for picture in &pictures {
        let row = picture.width as usize * 3;
        for pixels in picture.rgb.chunks_exact(row) {
            rgb.extend_from_slice(pixels);
            rgb.resize(rgb.len() + width as usize * 3 - row, 0);
        }
    }
    Ok(Image {
        width,
        height: y,
        rgb,
    })
}

/// A triangle of a picture that repeats, moved into the picture as a whole.
fn unwrap(corners: [Vec2; 3]) -> [Vec2; 3] {
    const SLACK: f32 = 1e-3;
    let inside = |c: &Vec2| c.min_element() >= -SLACK && c.max_element() <= 1.0 + SLACK;
    if corners.iter().all(inside) {
        return corners;
    }
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    corners.map(|c| c - middle.floor())
}
