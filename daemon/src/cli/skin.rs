//! How the skin reflects light, as a word.

use clap::ValueEnum;
use mouthpiece_render::SkinModel;

/// A reflection model of the skin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum SkinArg {
    /// Two glossy lobes and light scattered under the surface
    #[default]
    Physical,
    /// Blinn and Phong's model
    BlinnPhong,
}

impl From<SkinArg> for SkinModel {
    fn from(arg: SkinArg) -> Self {
        match arg {
            SkinArg::Physical => Self::Physical,
            SkinArg::BlinnPhong => Self::BlinnPhong,
        }
    }
}
