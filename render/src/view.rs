//! Where the head is seen from, against what, and how it sits in the frame.
//!
//! The lens is the portrait photographer's 85 mm on a 36 x 24 mm frame: 16 degrees high when the
//! picture is wide, up to 24 when it is tall. The camera then stands as far off as keeps the whole
//! head in any frame from 9:16 to 32:9.

use std::str::FromStr;
use std::sync::Arc;

use glam::{Mat4, Vec3, camera::rh, vec3};
use mouthpiece_rig::{Head, Material};
use thiserror::Error;

use crate::environment::Environment;
use crate::model::SkinModel;
use crate::picture::Picture;
use crate::placing::Placing;

/// Where the camera stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Camera {
    /// Straight in front.
    #[default]
    Front,
    /// At the subject's left.
    Side,
    /// Between the two.
    ThreeQuarter,
}

/// The name is none of front, side, 34.
#[derive(Debug, Error, PartialEq, Eq)]
#[error("there is no view {0:?}: use front, side or 34")]
pub struct UnknownCamera(pub String);

impl FromStr for Camera {
    type Err = UnknownCamera;
    fn from_str(name: &str) -> Result<Self, UnknownCamera> {
        match name {
            "front" => Ok(Self::Front),
            "side" => Ok(Self::Side),
            "34" => Ok(Self::ThreeQuarter),
            _ => Err(UnknownCamera(name.into())),
        }
    }
}

impl Camera {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Front, Self::Side, Self::ThreeQuarter];

    /// Angle round the head, radians, 0 in front, towards the subject's left.
    pub(crate) fn yaw_rad(self) -> f32 {
        match self {
            Self::Front => 0.0,
            Self::Side => std::f32::consts::FRAC_PI_2,
            Self::ThreeQuarter => 0.66,
        }
    }
}

/// What is behind the head. Colours are sRGB bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Background {
    /// One colour.
    Plain([u8; 3]),
    /// A lit studio wall of that colour: brighter behind the head, darker at the corners.
    Studio([u8; 3]),
    /// From one colour at the top to another at the bottom.
    Gradient {
        /// At the top.
        top: [u8; 3],
        /// At the bottom.
        bottom: [u8; 3],
    },
    /// A picture that fills the frame; what juts out is cut off.
    Picture(Arc<Picture>),
    /// Nothing: pixels read back have straight alpha. A window shows black.
    Transparent,
}

impl Background {
    /// Whether pixels read back can be anything but opaque.
    #[must_use]
    pub fn is_opaque(&self) -> bool {
        match self {
            Self::Plain(_) | Self::Studio(_) | Self::Gradient { .. } => true,
            Self::Picture(picture) => picture.is_opaque(),
            Self::Transparent => false,
        }
    }
}

/// What of the head is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Shown {
    /// The face, as everybody knows it.
    #[default]
    Face,
    /// What lies under the skin: bones, teeth, eyes, and the muscles or springs among the head's parts.
    Anatomy,
    /// The mesh of the skin by one plain Blinn-Phong shader with four maps, no shadows and no backdrop: what the cost of
    /// a picture is compared with.
    Yardstick,
}

/// How to look at the head.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Where from.
    pub camera: Camera,
    /// Against what.
    pub background: Background,
    /// In what room's light, beside the lamps'.
    pub environment: Environment,
    /// What of it.
    pub shown: Shown,
    /// How its skin reflects light.
    pub skin: SkinModel,
    /// How the picture sits on the screen.
    pub placing: Placing,
    /// Draws a large white square in the upper left corner: what a test of sound against picture
    /// looks for in its recording of the screen.
    pub flash: bool,
}

impl Default for View {
    fn default() -> Self {
        Self {
            camera: Camera::Front,
            background: Background::Studio([92, 98, 104]),
            environment: Environment::default(),
            shown: Shown::Face,
            skin: SkinModel::default(),
            placing: Placing::default(),
            flash: false,
        }
    }
}

/// The room that a head takes up at rest: what a frame must hold.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Lowest corner (chin, not neck), mm.
    pub min: Vec3,
    /// Highest corner, mm.
    pub max: Vec3,
}

/// A camera set up for a frame.
#[derive(Clone, Copy, Debug)]
pub struct Framing {
    /// World (trunk's frame, mm) to clip space, depth 0 near to 1 far.
    pub clip_from_world: Mat4,
    /// Where the camera is, mm.
    pub eye: Vec3,
    /// Vertical field of view, radians.
    pub fov_y_rad: f32,
}

/// Share of the head's height left free above it.
const ROOM_ABOVE: f32 = 0.07;
/// Share of the head's height shown below the chin.
const ROOM_BELOW: f32 = 0.11;
/// Share of the head's width left free on each side: what it needs to turn and tilt.
const ROOM_BESIDE: f32 = 0.10;
/// Half the diagonal of a 36 x 24 mm frame over the focal length of 85 mm.
const LENS: f32 = 21.633 / 85.0;

impl Extent {
    /// Measures `head` at rest: the skin above the chin, and the hair.
    #[must_use]
    pub fn of(head: &Head) -> Self {
        let skin = &head.skin;
        let mut min = Vec3::splat(f32::INFINITY);
        let mut max = Vec3::splat(f32::NEG_INFINITY);
        let mut take = |p: Vec3| {
            min = min.min(p);
            max = max.max(p);
        };
        // The chin is the lowest skin that stands clear of the neck: in front of the eyeballs' rear.
        let face_z = head.eyes[0].centre.z - 2.0 * head.eyes[0].radius.max(1.0);
        let chin = skin
            .mesh
            .positions
            .iter()
            .zip(&skin.weight)
            .filter(|(p, weight)| p.z > face_z && **weight > 0.95)
            .map(|(p, _)| p.y)
            .fold(f32::INFINITY, f32::min);
        let chin = if chin.is_finite() { chin } else { -80.0 };
        skin.mesh
            .positions
            .iter()
            .filter(|p| p.y >= chin)
            .for_each(|p| take(*p));
        for part in head.parts.iter().filter(|p| p.material == Material::Hair) {
            part.mesh
                .positions
                .iter()
                .filter(|p| p.y >= chin)
                .for_each(|p| take(*p));
        }
        if min.is_finite() && max.is_finite() {
            Self { min, max }
        } else {
            Self {
                min: vec3(-90.0, -80.0, -90.0),
                max: vec3(90.0, 145.0, 131.0),
            }
        }
    }

    /// The middle.
    #[must_use]
    pub fn centre(&self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// The eight corners.
    #[must_use]
    pub fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            let pick = |bit: usize, low: f32, high: f32| if i >> bit & 1 == 0 { low } else { high };
            vec3(
                pick(0, self.min.x, self.max.x),
                pick(1, self.min.y, self.max.y),
                pick(2, self.min.z, self.max.z),
            )
        })
    }

    /// Sets the camera up for a picture of `size` pixels (a side of 0 counts as 1).
    #[must_use]
    pub fn frame(&self, camera: Camera, size: (u32, u32)) -> Framing {
        let aspect = size.0.max(1) as f32 / size.1.max(1) as f32;
        // 24 mm of the film when wide, 36 when tall, the same diagonal between.
        let half_height = (LENS / (1.0 + aspect * aspect).sqrt()).clamp(12.0 / 85.0, 18.0 / 85.0);
        let half_width = half_height * aspect;
        let height = self.max.y - self.min.y;
        let width = self.max.x - self.min.x;
        let room = Self {
            min: self.min - vec3(width * ROOM_BESIDE, height * ROOM_BELOW, 0.0),
            max: self.max + vec3(width * ROOM_BESIDE, height * ROOM_ABOVE, 0.0),
        };
        let yaw = camera.yaw_rad();
        let toward = vec3(yaw.sin(), 0.0, yaw.cos());
        let right = vec3(yaw.cos(), 0.0, -yaw.sin());
        // A tall frame is filled by the width; the head then hangs a little above the middle.
        let centre = (room.min + room.max) * 0.5;
        let mut distance: f32 = 1.0;
        for corner in room.corners() {
            let q = corner - centre;
            let across = q.dot(right).abs() / half_width;
            let up = q.y.abs() / half_height;
            // The corners of the box are empty: the head is round, so they need not all fit.
            distance = distance.max(across.max(up) + q.dot(toward) * 0.75);
        }
        let spare = distance * half_height - (room.max.y - room.min.y) * 0.5;
        let centre = centre - vec3(0.0, spare.max(0.0) * 0.12, 0.0);
        let eye = centre + toward * distance;
        let reach = (self.max - self.min).length() + 600.0;
        let fov_y_rad = 2.0 * half_height.atan();
        let projection = rh::proj::directx::perspective(
            fov_y_rad,
            aspect,
            (distance - reach).max(distance * 0.05),
            distance + reach,
        );
        Framing {
            clip_from_world: projection * rh::view::look_at_mat4(eye, centre, Vec3::Y),
            eye,
            fov_y_rad,
        }
    }
}

/// An sRGB byte colour as shares of 1.
pub(crate) fn srgb(colour: [u8; 3]) -> Vec3 {
    Vec3::from(colour.map(|byte| f32::from(byte) / 255.0))
}
