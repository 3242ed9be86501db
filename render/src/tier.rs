//! How much work a picture may cost. The same picture up to detail; what differs is listed here
//! and nowhere else.

use std::str::FromStr;

use thiserror::Error;

/// A quality tier. Exports name one; it never changes by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Tier {
    /// For software rendering beside a running simulation.
    Low,
    /// The default.
    #[default]
    Medium,
    /// For a real graphics card, or stills.
    High,
}

/// The name is none of low, medium, high.
#[derive(Debug, Error, PartialEq, Eq)]
#[error("there is no tier {0:?}: use low, medium or high")]
pub struct UnknownTier(pub String);

impl FromStr for Tier {
    type Err = UnknownTier;
    fn from_str(name: &str) -> Result<Self, UnknownTier> {
        match name {
            "low" => Ok(Self::Low),
            "medium" => Ok(Self::Medium),
            "high" => Ok(Self::High),
            _ => Err(UnknownTier(name.into())),
        }
    }
}

/// How closely triangles follow the skin's surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Smoothness {
    /// How often a side of the head's own triangles may be halved.
    pub(crate) levels: usize,
    /// A side is halved where the surface bows from it by more than this, mm; 0: always. A pixel of a picture of
    /// 640 x 480 is about 0.6 mm wide, and in software each triangle more is felt.
    pub(crate) bow_mm: f32,
    /// Whether what is left out would not be missed in a picture of that size.
    pub(crate) coarse: bool,
}

/// What a tier means in numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Detail {
    /// Triangles of the skin.
    pub(crate) smoothness: Smoothness,
    /// Samples a pixel, where offered.
    pub(crate) samples: u32,
    /// Width of the skin's mask in texels; it is half as high.
    pub(crate) mask_map: u32,
    /// Side of the skin's map of wrinkles in texels.
    pub(crate) wrinkle_map: u32,
    /// Side of the tile of the skin's fine structure in texels.
    pub(crate) grain_map: u32,
    /// Whether the skin's fine structure is drawn.
    pub(crate) grain: bool,
    /// Whether all lamps see the skin's bumps, or only the key lamp.
    pub(crate) all_lamps: bool,
    /// Side of the eye map in texels.
    pub(crate) eye_map: u32,
    /// Side of the key light's shadow map in texels.
    pub(crate) shadow_map: u32,
    /// Reads of the shadow map a pixel: 1, 2 or 9.
    pub(crate) shadow_taps: u32,
    /// Anisotropic samples; costly in software.
    pub(crate) anisotropy: u16,
    /// Width of the strands' map in texels; it is half as high.
    pub(crate) hair_map: u32,
}

impl Tier {
    /// All of them, cheapest first.
    pub const ALL: [Self; 3] = [Self::Low, Self::Medium, Self::High];

    /// The name used on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
        }
    }

    pub(crate) const fn detail(self) -> Detail {
        match self {
            Self::Low => Detail {
                smoothness: Smoothness {
                    levels: 0,
                    bow_mm: 0.0,
                    coarse: true,
                },
                samples: 1,
                mask_map: 512,
                wrinkle_map: 512,
                grain_map: 256,
                grain: false,
                all_lamps: false,
                eye_map: 256,
                hair_map: 512,
                shadow_map: 256,
                shadow_taps: 1,
                anisotropy: 1,
            },
            Self::Medium => Detail {
                smoothness: Smoothness {
                    levels: 1,
                    bow_mm: 0.25,
                    coarse: false,
                },
                samples: 4,
                mask_map: 1024,
                wrinkle_map: 1024,
                grain_map: 512,
                grain: true,
                all_lamps: false,
                eye_map: 512,
                hair_map: 768,
                shadow_map: 384,
                shadow_taps: 2,
                anisotropy: 1,
            },
            Self::High => Detail {
                smoothness: Smoothness {
                    levels: 2,
                    bow_mm: 0.15,
                    coarse: false,
                },
                samples: 4,
                mask_map: 2048,
                wrinkle_map: 1024,
                grain_map: 1024,
                grain: true,
                all_lamps: true,
                eye_map: 1024,
                hair_map: 1024,
                shadow_map: 448,
                shadow_taps: 9,
                anisotropy: 8,
            },
        }
    }
}
