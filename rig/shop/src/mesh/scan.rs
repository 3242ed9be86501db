//! A scan as it stands in its file: what every reader of this folder yields and every later step of
//! the shop takes. No claim is made about its unit, its orientation or its holes: see `prepare`.

use glam::{Vec2, Vec3};

/// A triangle mesh with or without colour.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scan {
    /// Corners, in the coordinates of the file; finite.
    pub positions: Vec<Vec3>,
    /// Indices into `positions`, in range; counter-clockwise seen from outside where the file says so.
    pub triangles: Vec<[u32; 3]>,
    /// What colour it has.
    pub colour: Option<ScanColour>,
}

/// Colour of a scan, sRGB.
#[derive(Clone, Debug, PartialEq)]
pub enum ScanColour {
    /// One colour per entry of `positions`.
    PerVertex(Vec<[u8; 3]>),
    /// A picture that the triangles are cut from.
    Texture {
        /// The picture: several textures of a file are stacked into one.
        image: Image,
        /// Per triangle, one point of the picture per corner: 0..1 from its upper left, v downwards.
        uvs: Vec<[Vec2; 3]>,
    },
}

/// A picture in memory, rows from the top.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Image {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Three bytes a pixel, sRGB: `width * height * 3` of them.
    pub rgb: Vec<u8>,
}
