//! Reads and writes PNGs and tells how different two pictures look (FLIP, Andersson et al. 2020).

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use nv_flip::{DEFAULT_PIXELS_PER_DEGREE, FlipImageRgb8, FlipPool};

/// A picture, 8 bits each of red, green and blue, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Three bytes a pixel.
    pub rgb: Vec<u8>,
}

impl Picture {
    /// Reads an RGB or RGBA PNG; what is behind see-through pixels is not looked at.
    #[must_use]
    pub fn read(path: &Path) -> Self {
        let file = File::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let mut reader = png::Decoder::new(BufReader::new(file))
            .read_info()
            .unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let mut bytes = vec![0; reader.output_buffer_size().expect("a small picture")];
        let info = reader.next_frame(&mut bytes).expect("a whole PNG");
        assert_eq!(info.bit_depth, png::BitDepth::Eight);
        let rgb = match info.color_type {
            png::ColorType::Rgb => bytes,
            png::ColorType::Rgba => opaque(&bytes),
            other => panic!("{}: {other:?}", path.display()),
        };
        Self {
            width: info.width,
            height: info.height,
            rgb,
        }
    }

    /// From rows of RGBA.
    #[must_use]
    pub fn from_rgba(width: u32, height: u32, rgba: &[u8]) -> Self {
        let rgb = opaque(rgba);
        Self { width, height, rgb }
    }

    /// Writes it as PNG.
    pub fn write(&self, path: &Path) {
        let file = File::create(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let mut encoder = png::Encoder::new(file, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::High);
        encoder
            .write_header()
            .and_then(|mut writer| writer.write_image_data(&self.rgb))
            .expect("a picture can be written");
    }

    /// How different `self` looks from `other`.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Difference {
        assert_eq!((self.width, self.height), (other.width, other.height));
        let image = |p: &Self| FlipImageRgb8::with_data(p.width, p.height, &p.rgb);
        let map = nv_flip::flip(image(self), image(other), DEFAULT_PIXELS_PER_DEGREE);
        let shown = Self {
            rgb: map.apply_color_lut(&nv_flip::magma_lut()).to_vec(),
            ..*self
        };
        Difference {
            mean: FlipPool::from_image(&map).mean(),
            worst_tile: worst_tile(&map.to_vec(), self.width as usize),
            map: shown,
        }
    }
}

impl Difference {
    /// Mean over the picture up to which it looks the same. Measured on the first version: OpenGL instead of Vulkan
    /// below 0.0001, a head turned by 0.01 rad 0.02, another tier 0.023.
    pub const MEAN_MAX: f32 = 0.01;
    /// The same of any tile. Measured: OpenGL 0.0002, a jaw turned by 0.01 rad 0.13, by 0.02 rad 0.20, another tier 0.2.
    pub const TILE_MAX: f32 = 0.15;

    /// Whether a viewer would take both for the same picture.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.mean <= Self::MEAN_MAX && self.worst_tile <= Self::TILE_MAX
    }
}

/// FLIP's values: 0 looks the same, 1 is black against white.
#[derive(Clone, Debug)]
pub struct Difference {
    /// Of the whole picture.
    pub mean: f32,
    /// The mean of the square of [`TILE`] pixels that differs most: a mouth that is gone is little of
    /// a picture, but all of a tile.
    pub worst_tile: f32,
    /// Where they differ, brighter for more.
    pub map: Picture,
}

/// Side of a tile, pixels: half a mouth at the size of the golden pictures.
pub const TILE: usize = 20;

fn worst_tile(map: &[f32], width: usize) -> f32 {
    let rows: Vec<&[f32]> = map.chunks_exact(width).collect();
    let tile_mean = |band: &[&[f32]], x: usize| {
        let values = band.iter().flat_map(|row| &row[x..x + TILE]);
        values.sum::<f32>() / (TILE * TILE) as f32
    };
    rows.chunks_exact(TILE)
        .flat_map(|band| {
            let columns = (0..=width - TILE).step_by(TILE);
            columns.map(move |x| tile_mean(band, x))
        })
        .fold(0.0, f32::max)
}

fn opaque(rgba: &[u8]) -> Vec<u8> {
    let pixels = rgba.chunks_exact(4);
    pixels.flat_map(|p| [p[0], p[1], p[2]]).collect()
}
