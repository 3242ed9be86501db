//! A picture that a user hangs behind the head: read from a PNG or JPEG file, kept as sRGB bytes with
//! straight alpha. How it is fitted to the frame is shaders/picture.wgsl's business.

use std::fmt;
use std::path::{Path, PathBuf};

use image::{ImageError, ImageReader};
use thiserror::Error;

/// The longest side taken, pixels: nobody sees more behind a head, and a file that claims more is
/// refused before memory is spent on it.
pub const PICTURE_SIDE_MAX: u32 = 16_384;
/// The most memory that reading may take, bytes: a picture of 64 million pixels and as much again.
const PICTURE_BYTES_MAX: u64 = 512 << 20;

/// Why a picture or panorama cannot be had from a file.
#[derive(Debug, Error)]
pub enum PictureError {
    /// The file cannot be opened.
    #[error("{path} cannot be read: {source}; check the name and who may read it")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// It is of another kind, whatever its name.
    #[error("{path} is none of the pictures that are understood: give {wanted}")]
    Kind {
        /// The file.
        path: PathBuf,
        /// What would do.
        wanted: &'static str,
    },
    /// The file is damaged.
    #[error("{path} is damaged: {why}; save it again with the program it came from")]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        why: String,
    },
    /// It is too large.
    #[error("{path} is too large: make it at most {max} pixels a side")]
    Large {
        /// The file.
        path: PathBuf,
        /// Longest side.
        max: u32,
    },
    /// A panorama that holds no light, or what is not a number.
    #[error(
        "{path} holds no light to shine with (black, or not numbers): give another .hdr or .exr"
    )]
    Dark {
        /// The file.
        path: PathBuf,
    },
}

/// A picture in memory.
#[derive(Clone, PartialEq, Eq)]
pub struct Picture {
    width: u32,
    height: u32,
    /// Rows from the top, sRGB, straight alpha.
    rgba: Vec<[u8; 4]>,
}

impl Picture {
    /// From rows of straight-alpha sRGB, top first; none when there are not `width` x `height` of them.
    #[must_use]
    pub fn from_rgba(width: u32, height: u32, rgba: Vec<[u8; 4]>) -> Option<Self> {
        let fits =
            width > 0 && height > 0 && rgba.len() as u64 == u64::from(width) * u64::from(height);
        fits.then_some(Self {
            width,
            height,
            rgba,
        })
    }

    /// Reads a PNG or JPEG file.
    ///
    /// # Errors
    /// When it cannot be opened, is of another kind, damaged or too large.
    pub fn load(path: &Path) -> Result<Self, PictureError> {
        let decoded = decode(
            path,
            &[image::ImageFormat::Png, image::ImageFormat::Jpeg],
            "a .png or .jpg",
        )?;
        let rgba = decoded.into_rgba8();
        let (width, height) = rgba.dimensions();
        let texels = rgba
            .into_raw()
            .chunks_exact(4)
            .map(|t| [t[0], t[1], t[2], t[3]])
            .collect();
        Self::from_rgba(width, height, texels).ok_or_else(|| PictureError::Damaged {
            path: path.to_path_buf(),
            why: "it has no pixels".into(),
        })
    }

    /// Width and height, pixels.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Whether nothing shows through it.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        self.rgba.iter().all(|t| t[3] == 255)
    }

    /// As the card wants it: colours multiplied with their alpha, so that averages of texels are right.
    pub(crate) fn premultiplied(&self) -> crate::maps::image::Image {
        let texels = self.rgba.iter().map(|&[r, g, b, a]| {
            let times = |c: u8| ((u16::from(c) * u16::from(a) + 127) / 255) as u8;
            [times(r), times(g), times(b), a]
        });
        crate::maps::image::Image {
            width: self.width as usize,
            height: self.height as usize,
            texels: texels.collect(),
        }
    }
}

impl fmt::Debug for Picture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Picture({} x {})", self.width, self.height)
    }
}

/// Decodes a file whose content is of one of `formats`, within limits.
pub(crate) fn decode(
    path: &Path,
    formats: &[image::ImageFormat],
    wanted: &'static str,
) -> Result<image::DynamicImage, PictureError> {
    let named = || path.to_path_buf();
    let unreadable = |source| PictureError::Unreadable {
        path: named(),
        source,
    };
    let mut reader = ImageReader::open(path)
        .and_then(ImageReader::with_guessed_format)
        .map_err(unreadable)?;
    if !reader.format().is_some_and(|f| formats.contains(&f)) {
        return Err(PictureError::Kind {
            path: named(),
            wanted,
        });
    }
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(PICTURE_SIDE_MAX);
    limits.max_image_height = Some(PICTURE_SIDE_MAX);
    limits.max_alloc = Some(PICTURE_BYTES_MAX);
    reader.limits(limits);
    reader.decode().map_err(|error| match error {
        ImageError::IoError(source) if source.kind() != std::io::ErrorKind::UnexpectedEof => {
            unreadable(source)
        }
        ImageError::Limits(_) => PictureError::Large {
            path: named(),
            max: PICTURE_SIDE_MAX,
        },
        error => PictureError::Damaged {
            path: named(),
            why: error.to_string(),
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alpha_multiplies_colour_and_clear_texels_leave_no_trace() {
        let picture = Picture::from_rgba(
            3,
            1,
            vec![[200, 100, 0, 255], [200, 100, 0, 128], [200, 100, 0, 0]],
        );
        let image = picture.unwrap().premultiplied();
        assert_eq!(
            image.texels,
            [[200, 100, 0, 255], [100, 50, 0, 128], [0, 0, 0, 0]]
        );
        assert!(Picture::from_rgba(2, 2, vec![[0; 4]; 3]).is_none());
    }

    #[test]
    fn what_is_no_picture_is_said_to_be_none() {
        let missing = Picture::load(Path::new("no/such/picture.png")).unwrap_err();
        assert!(
            matches!(missing, PictureError::Unreadable { .. }),
            "{missing}"
        );
        let text = Picture::load(Path::new("Cargo.toml")).unwrap_err();
        assert!(matches!(text, PictureError::Kind { .. }), "{text}");
        let folder = Picture::load(Path::new("src")).unwrap_err();
        assert!(
            matches!(folder, PictureError::Unreadable { .. }),
            "{folder}"
        );
    }
}
