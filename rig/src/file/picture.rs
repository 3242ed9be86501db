//! The colour map as a PNG.

use super::{HeadError, KEEP};
use crate::ColourMap;

/// Longest side of a colour map, texels.
const SIDE_MAX: u32 = 8192;

/// A PNG file of the map; nothing where it has no texels.
pub(super) fn encode(map: &ColourMap) -> Option<Vec<u8>> {
    let (width, height) = (
        u32::try_from(map.width).ok()?,
        u32::try_from(map.height).ok()?,
    );
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header().ok()?;
    writer.write_image_data(&map.rgb).ok()?;
    writer.finish().ok()?;
    Some(out)
}

/// The map in a PNG file, whatever its kind of pixels.
pub(super) fn decode(bytes: &[u8]) -> Result<ColourMap, HeadError> {
    let mut decoder = png::Decoder::new(std::io::Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info()?;
    let (width, height) = reader.info().size();
    if width > SIDE_MAX || height > SIDE_MAX {
        let fault = format!("{width}x{height} texels are more than {SIDE_MAX}x{SIDE_MAX}");
        return Err(HeadError::element("colour map", fault, "scale it down"));
    }
    let size = reader
        .output_buffer_size()
        .ok_or_else(|| HeadError::element("colour map", "it is too large", "scale it down"))?;
    let mut pixels = vec![0; size];
    let frame = reader.next_frame(&mut pixels)?;
    pixels.truncate(frame.buffer_size());
    let rgb: Vec<u8> = match frame.color_type {
        png::ColorType::Rgb => pixels,
        png::ColorType::Rgba => pixels
            .chunks_exact(4)
            .flat_map(|p| [p[0], p[1], p[2]])
            .collect(),
        png::ColorType::Grayscale => pixels.iter().flat_map(|&p| [p; 3]).collect(),
        png::ColorType::GrayscaleAlpha => pixels.chunks_exact(2).flat_map(|p| [p[0]; 3]).collect(),
        png::ColorType::Indexed => {
            return Err(HeadError::element("colour map", "it has no palette", KEEP));
        }
    };
    Ok(ColourMap {
        width: width as usize,
        height: height as usize,
        rgb,
    })
}
