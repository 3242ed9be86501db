//! The head as data: skin mesh, rigid parts, the bodies they hang on, and where each body is for given controls.

use glam::{Affine3A, Quat, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use crate::mesh::{Body, Lid, Lips, Part, Skin};
use crate::muscle::{Fibre, MuscleGrid};
use crate::{Calibration, Control, Controls, KeyFrame, LipStencils, TissueRecord, jaw, tongue};

/// A place on a triangle of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SurfacePoint {
    /// The triangle's corners.
    pub vertices: [u32; 3],
    /// Their shares, adding up to 1.
    pub shares: [f32; 3],
}

impl SurfacePoint {
    /// The place for given vertices.
    #[must_use]
    pub fn on(&self, positions: &[Vec3]) -> Vec3 {
        self.vertices
            .iter()
            .zip(self.shares)
            .filter_map(|(v, share)| Some(*positions.get(*v as usize)? * share))
            .sum()
    }
}

/// What a landmark lies on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Layer {
    /// The skin.
    Skin,
    /// The part `skull`.
    Skull,
    /// The part `mandible`.
    Mandible,
}

/// A point by its name in Farkas, Anthropometry of the Head and Face (1994); `_l` and `_r` are the
/// subject's sides.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Landmark {
    /// `prn`, `en_l` …
    pub name: String,
    /// What it lies on.
    pub layer: Layer,
    /// Where.
    pub at: SurfacePoint,
    /// Of a landmark on bone: the skin landmark over it (HEADSHOP 5.2).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
}

/// An eyeball.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Eye {
    /// Its centre, mm.
    pub centre: Vec3,
    /// Its radius, mm.
    pub radius: f32,
}

/// From the reference head to this one, for what keeps its form: teeth and tongue (HEADSHOP 5.2).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Placement {
    /// Factor along each axis.
    pub scale: Vec3,
    /// Added afterwards, mm.
    pub shift: Vec3,
}

impl Default for Placement {
    fn default() -> Self {
        Self {
            scale: Vec3::ONE,
            shift: Vec3::ZERO,
        }
    }
}

impl Placement {
    /// The place on this head.
    #[must_use]
    pub fn place(&self, reference: Vec3) -> Vec3 {
        reference * self.scale + self.shift
    }

    /// The place on the reference head.
    #[must_use]
    pub fn reference(&self, place: Vec3) -> Vec3 {
        (place - self.shift) / self.scale
    }
}

/// An image, row by row from the upper left.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ColourMap {
    /// Texels across.
    pub width: usize,
    /// Texels down.
    pub height: usize,
    /// Red, green, blue of each texel, sRGB.
    pub rgb: Vec<u8>,
}

/// The reference or any other head, at rest.
#[derive(Clone, Debug)]
pub struct Head {
    /// The skin.
    pub skin: Skin,
    /// Everything else that is drawn: `eye_l`, `eye_r`, `teeth_upper`, `teeth_lower`, `gums_upper`,
    /// `gums_lower`, `tongue`, `cavity`, `hair`, `lashes_l`, `lashes_r`, `cloth`; and the bones,
    /// `skull` and `mandible`.
    pub parts: Vec<Part>,
    /// Lines on the skin that the colour map is painted by.
    pub features: Vec<Feature>,
    /// Named points on skin and bones.
    pub landmarks: Vec<Landmark>,
    /// The lips' columns.
    pub lips: Lips,
    /// Where the lips' columns are drawn; [`LipStencils::default`] for a new head.
    pub lip_stencils: LipStencils,
    /// What the lids carry.
    pub lids: Vec<Lid>,
    /// Muscles as they are painted on the skin.
    pub muscles: Vec<MuscleGrid>,
    /// Their fibres in the space between skin and bones: rebuilt from `muscles`, never stored.
    pub fibres: Vec<Fibre>,
    /// The subject's left and right eyeball.
    pub eyes: [Eye; 2],
    /// Where teeth and tongue stand.
    pub bite: Placement,
    /// A point of the axis through the condyles, mm: the axis runs along x.
    pub condyle_axis: Vec3,
    /// What the head turns about.
    pub neck_pivot: Vec3,
    /// Which tissue moves the skin, and its mass.
    pub tissue: TissueRecord,
    /// How this head's mouth answers to its muscles.
    pub calibration: Calibration,
    /// Colour of the skin over its `uv`; none where nothing is known of it.
    pub colour: Option<ColourMap>,
}

/// A line on the skin, as points of its chart (`uv`).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Feature {
    /// `brow_upper_l`, `brow_lower_l`, `hairline`, `lid_crease_l` … and `_r`.
    pub name: String,
    /// Its points in order.
    pub points: Vec<Vec2>,
}

impl Head {
    /// Where each [`Body`] is for `controls`: maps points at rest to the trunk's frame, mm.
    #[must_use]
    pub fn bodies(&self, controls: &Controls) -> [Affine3A; Body::COUNT] {
        let skull = about(
            self.neck_pivot,
            Quat::from_rotation_y(controls[Control::HeadYaw])
                * Quat::from_rotation_x(-controls[Control::HeadPitch])
                * Quat::from_rotation_z(-controls[Control::HeadRoll]),
        );
        let mandible = skull * self.mandible(controls[Control::Jaw]);
        let gaze = Quat::from_rotation_y(controls[Control::GazeYaw])
            * Quat::from_rotation_x(-controls[Control::GazePitch]);
        let tongue = tongue::poses(self, controls);
        let mut bodies = [Affine3A::IDENTITY; Body::COUNT];
        bodies[Body::Skull as usize] = skull;
        bodies[Body::Mandible as usize] = mandible;
        bodies[Body::EyeL as usize] = skull * about(self.eyes[0].centre, gaze);
        bodies[Body::EyeR as usize] = skull * about(self.eyes[1].centre, gaze);
        for (body, pose) in [Body::TongueRoot, Body::TongueBlade, Body::TongueTip]
            .into_iter()
            .zip(tongue)
        {
            bodies[body as usize] = mandible * pose;
        }
        bodies
    }

    /// The mandible in the skull's frame: rotation about the condyles with the forward slide that
    /// goes with it (HABER 4.1); an angle beyond the jaw's limits counts as the limit.
    #[must_use]
    pub fn mandible(&self, jaw_rad: f32) -> Affine3A {
        jaw::pose(self.condyle_axis, jaw_rad)
    }

    /// The head at rest, as a key frame at time 0.
    #[must_use]
    pub fn rest_frame(&self) -> KeyFrame {
        KeyFrame {
            skin: self.skin.mesh.positions.clone(),
            velocity: vec![Vec3::ZERO; self.skin.mesh.positions.len()],
            ..KeyFrame::default()
        }
    }

    /// The named part, where this head has it.
    #[must_use]
    pub fn part(&self, name: &str) -> Option<&Part> {
        self.parts.iter().find(|p| p.name == name)
    }

    /// The vertices that a landmark is a place among.
    #[must_use]
    pub fn layer(&self, layer: Layer) -> &[Vec3] {
        let part = |name| self.part(name).map_or(&[][..], |p| &p.mesh.positions[..]);
        match layer {
            Layer::Skin => &self.skin.mesh.positions,
            Layer::Skull => part("skull"),
            Layer::Mandible => part("mandible"),
        }
    }

    /// Where each of the head's landmarks lies at rest, mm: those of the skin where it is drawn.
    #[must_use]
    pub fn landmark_places(&self) -> Vec<Vec3> {
        let drawn = self.drawn_rest();
        self.landmarks
            .iter()
            .map(|mark| match mark.layer {
                Layer::Skin => mark.at.on(&drawn),
                layer => mark.at.on(self.layer(layer)),
            })
            .collect()
    }

    /// The named line on the skin, where this head has it.
    #[must_use]
    pub fn feature(&self, name: &str) -> Option<&Feature> {
        self.features.iter().find(|f| f.name == name)
    }
}

/// Rotation about a point.
pub(crate) fn about(pivot: Vec3, rotation: Quat) -> Affine3A {
    Affine3A::from_rotation_translation(rotation, pivot - rotation * pivot)
}
