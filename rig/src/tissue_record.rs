//! What a head says of its tissue: which model moves the skin, and how heavy it is.
//!
//! Stored in the head's file as `tissue` (see [`file`](crate::HeadError)); the simulation reads it.
//! It holds no springs: those follow from the mesh.

use serde::{Deserialize, Serialize};

/// How skin is made into a body that forces move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TissueModel {
    /// One layer: edges of the skin are springs, others go to muscle and bone (HEADSHOP 4.2).
    #[default]
    Springs,
    /// Epidermis, fascia and skull in triangular prisms (LEE 4 to 7).
    Layered,
}

/// A head's tissue.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TissueRecord {
    /// Which model.
    #[serde(default)]
    pub model: TissueModel,
    /// Mass of a vertex that moves, g. All have the same, but at the mouth's corners: on a mesh graded to 1.5 mm at the lips,
    /// masses by area would make the smallest so light that steps had to be about five times shorter.
    ///
    /// The papers give no masses. The face that moves on the reference head is 566 cm² of skin in
    /// 4104 vertices; skin and the fat under it are about 5 mm thick in the mean over brow, cheek,
    /// lips and chin and as dense as water, which makes 0.28 kg, or 0.07 g for each vertex.
    #[serde(default = "default_mass")]
    pub vertex_mass_g: f32,
}

impl TissueRecord {
    /// The mass that stiffnesses per mass are meant at, g; reasoned at [`Self::vertex_mass_g`].
    pub const MASS_G: f32 = 0.07;
    /// Lightest mass that the default step is stable with: springs per mass grow as mass falls.
    pub const MASS_MIN_G: f32 = 0.8 * Self::MASS_G;
    /// Heaviest: beyond it skin would lag behind speech visibly.
    pub const MASS_MAX_G: f32 = 10.0 * Self::MASS_G;

    /// Factor of all stiffnesses per mass at this head's mass: springs are as stiff on every head,
    /// and light skin is quicker.
    #[must_use]
    pub fn stiffness_scale(&self) -> f32 {
        Self::MASS_G / self.vertex_mass_g
    }
}

impl Default for TissueRecord {
    fn default() -> Self {
        Self {
            model: TissueModel::Springs,
            vertex_mass_g: Self::MASS_G,
        }
    }
}

fn default_mass() -> f32 {
    TissueRecord::MASS_G
}
