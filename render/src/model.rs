//! How the skin reflects light: the choice between today's model and the paper's.

use std::str::FromStr;

use thiserror::Error;

/// A reflection model of the skin. Both read the same four maps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SkinModel {
    /// Two glossy lobes, light scattered under the surface, what is mirrored taken from what is scattered.
    #[default]
    Physical,
    /// HEADSHOP 4.4's: Blinn and Phong's, with gloss and bump intensity from the mask.
    BlinnPhong,
}

/// The name is none of physical, blinn-phong.
#[derive(Debug, Error, PartialEq, Eq)]
#[error("there is no skin {0:?}: use physical or blinn-phong")]
pub struct UnknownSkinModel(pub String);

impl FromStr for SkinModel {
    type Err = UnknownSkinModel;
    fn from_str(name: &str) -> Result<Self, UnknownSkinModel> {
        match name {
            "physical" => Ok(Self::Physical),
            "blinn-phong" => Ok(Self::BlinnPhong),
            _ => Err(UnknownSkinModel(name.into())),
        }
    }
}
