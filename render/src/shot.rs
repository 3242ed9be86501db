//! Pictures taken back from the screen for somebody else to look at: what is shown itself, not drawn again.
//!
//! The thread that draws only has the card copy the finished picture. Whoever gets the [`Shot`] reads it, on a thread of
//! its own; nothing waits in between.

use crate::error::RenderError;

/// What becomes of a shot; called on the thread that draws, so it only passes it on.
pub(crate) type Take = Box<dyn FnOnce(Shot) + Send>;

/// A picture that was shown, in a buffer that can be read.
#[derive(Debug)]
pub struct Shot {
    rows: wgpu::Buffer,
    size: (u32, u32),
    format: wgpu::TextureFormat,
}

/// Rows from the top, RGB, sRGB, no padding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SmallPicture {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Three bytes a pixel.
    pub rgb: Vec<u8>,
}

impl Shot {
    /// Has `texture`, which has just been drawn to, copied, and passed on when that is done.
    pub(crate) fn request(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        texture: &wgpu::Texture,
        take: Take,
    ) {
        let size = (texture.width(), texture.height());
        let rows = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("shot"),
            size: u64::from(padded_row(size.0)) * u64::from(size.1),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor {
            label: Some("shot"),
        });
        encoder.copy_texture_to_buffer(
            texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &rows,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(padded_row(size.0)),
                    rows_per_image: None,
                },
            },
            texture.size(),
        );
        let shot = Self {
            rows: rows.clone(),
            size,
            format: texture.format(),
        };
        encoder.map_buffer_on_submit(&rows, wgpu::MapMode::Read, .., move |mapped| {
            // A device that is lost in between: whoever asked gets nothing, and asks again.
            if mapped.is_ok() {
                take(shot);
            }
        });
        queue.submit([encoder.finish()]);
    }

    /// The picture, made smaller by a whole number so that no side is longer than `side_max`.
    ///
    /// # Errors
    /// When the device was lost.
    pub fn read(self, side_max: u32) -> Result<SmallPicture, RenderError> {
        let picture = {
            let bytes = self
                .rows
                .get_mapped_range(..)
                .map_err(|e| RenderError::Readback(e.to_string()))?;
            let blue_first = matches!(
                self.format,
                wgpu::TextureFormat::Bgra8Unorm | wgpu::TextureFormat::Bgra8UnormSrgb
            );
            shrink(&bytes, self.size, side_max, blue_first)
        };
        self.rows.unmap();
        Ok(picture)
    }
}

/// The mean of each square of `n` by `n` pixels, `n` being the least that will do.
fn shrink(
    bytes: &[u8],
    (width, height): (u32, u32),
    side_max: u32,
    blue_first: bool,
) -> SmallPicture {
    let n = width.max(height).div_ceil(side_max.max(1)).max(1);
    let (small_width, small_height) = ((width / n).max(1), (height / n).max(1));
    let (n, row) = (n as usize, padded_row(width) as usize);
    let mut rgb = Vec::with_capacity(small_width as usize * small_height as usize * 3);
    for y in 0..small_height as usize {
        for x in 0..small_width as usize {
            let (mut sum, mut count) = ([0_u32; 3], 0);
            let rows = bytes.chunks_exact(row).skip(y * n).take(n);
            for pixel in
                rows.flat_map(|row| row.chunks_exact(4).take(width as usize).skip(x * n).take(n))
            {
                for (sum, value) in sum.iter_mut().zip(pixel) {
                    *sum += u32::from(*value);
                }
                count += 1;
            }
            let mut mean = sum.map(|s| (s / count.max(1)).min(255) as u8);
            if blue_first {
                mean.swap(0, 2);
            }
            rgb.extend_from_slice(&mean);
        }
    }
    SmallPicture {
        width: small_width,
        height: small_height,
        rgb,
    }
}

/// Bytes of a row in a readback buffer.
pub(crate) fn padded_row(width: u32) -> u32 {
    (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_are_averaged_and_rows_lose_their_padding() {
        // 5 x 4 of which the last column is left out.
        let row = padded_row(5) as usize;
        let mut bytes = vec![0; row * 4];
        for (y, line) in bytes.chunks_exact_mut(row).enumerate() {
            for (x, pixel) in line.chunks_exact_mut(4).take(5).enumerate() {
                pixel.copy_from_slice(&[10 * x as u8, 20 * y as u8, 7, 255]);
            }
        }
        let small = shrink(&bytes, (5, 4), 3, true);
        assert_eq!((small.width, small.height), (2, 2));
        assert_eq!(small.rgb, [7, 10, 5, 7, 10, 25, 7, 50, 5, 7, 50, 25]);
        let whole = shrink(&bytes, (5, 4), 500, false);
        assert_eq!((whole.width, whole.height), (5, 4));
        assert_eq!(whole.rgb[..6], [0, 0, 7, 10, 0, 7]);
    }
}
