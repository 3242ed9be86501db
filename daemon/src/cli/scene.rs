//! What is round the head: backdrop and ambient light, as words and files.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;
use std::sync::Arc;

use anyhow::Context as _;
use clap::Args;
use mouthpiece_render::{Background, Environment, Picture, View};
use thiserror::Error;

use super::skin::SkinArg;
use super::values::Rgb;

/// What is round the head.
#[derive(Clone, Debug, Default, Args)]
pub struct SceneArgs {
    /// Behind the head: #rrggbb, gradient:#top,#bottom, a .png or .jpg file, transparent [default: studio, a wall]
    #[arg(long, value_name = "B")]
    pub background: Option<BackgroundArg>,
    /// Ambient light from a panorama, .hdr or .exr; its middle is what the face looks at [default: a studio]
    #[arg(long, value_name = "F")]
    pub environment: Option<PathBuf>,
    /// How the skin reflects light [default: physical]
    #[arg(long, value_enum)]
    pub skin: Option<SkinArg>,
}

/// A backdrop on the command line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BackgroundArg {
    Studio,
    Plain(Rgb),
    Gradient(Rgb, Rgb),
    Picture(PathBuf),
    Transparent,
}

/// Why a backdrop cannot be meant.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum BackgroundError {
    #[error("a gradient is two colours, from above to below: write gradient:#203040,#808890")]
    Gradient,
    #[error("{0:?} is no colour: {1}")]
    Colour(String, String),
    #[error(
        "{0:?} is no backdrop: write a colour (#203040), gradient:#203040,#808890, a .png or .jpg file, or transparent"
    )]
    Unknown(String),
}

impl FromStr for BackgroundArg {
    type Err = BackgroundError;
    fn from_str(text: &str) -> Result<Self, BackgroundError> {
        let colour = |text: &str| {
            let text = text.trim();
            Rgb::from_str(text).map_err(|why| BackgroundError::Colour(text.into(), why))
        };
        match text {
            "studio" => return Ok(Self::Studio),
            "transparent" => return Ok(Self::Transparent),
            _ => {}
        }
        if let Some(both) = text.strip_prefix("gradient:") {
            let (top, bottom) = both.split_once(',').ok_or(BackgroundError::Gradient)?;
            return Ok(Self::Gradient(colour(top)?, colour(bottom)?));
        }
        if text.starts_with('#') {
            return colour(text).map(Self::Plain);
        }
        match colour(text) {
            Ok(plain) => Ok(Self::Plain(plain)),
            // A file has an ending or lies in a folder; anything else is a word mistyped.
            Err(_) if text.contains(['.', '/', '\\']) => Ok(Self::Picture(text.into())),
            Err(_) => Err(BackgroundError::Unknown(text.into())),
        }
    }
}

impl fmt::Display for BackgroundArg {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Studio => f.write_str("studio"),
            Self::Plain(colour) => write!(f, "{colour}"),
            Self::Gradient(top, bottom) => write!(f, "gradient:{top},{bottom}"),
            Self::Picture(path) => write!(f, "{}", path.display()),
            Self::Transparent => f.write_str("transparent"),
        }
    }
}

impl BackgroundArg {
    /// As the renderer wants it. Reads the file that is named.
    pub fn load(&self) -> anyhow::Result<Background> {
        Ok(match self {
            Self::Studio => View::default().background,
            Self::Plain(Rgb(colour)) => Background::Plain(*colour),
            Self::Gradient(Rgb(top), Rgb(bottom)) => Background::Gradient {
                top: *top,
                bottom: *bottom,
            },
            Self::Picture(path) => Background::Picture(Arc::new(Picture::load(path)?)),
            Self::Transparent => Background::Transparent,
        })
    }
}

impl SceneArgs {
    /// The surroundings that are asked for, from the front. Reads the files that are named.
    pub fn view(&self) -> anyhow::Result<View> {
        let view = View::default();
        let background = match &self.background {
            None => view.background,
            Some(background) => background.load().context("--background")?,
        };
        let environment = match &self.environment {
            None => view.environment,
            Some(path) => Environment::load(path).context("--environment")?,
        };
        Ok(View {
            background,
            environment,
            skin: self.skin.unwrap_or_default().into(),
            ..view
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn every_kind_of_backdrop_is_understood_and_what_is_none_is_said_to_be_none() {
        let read = |text: &str| text.parse::<BackgroundArg>();
        let (a, b) = (Rgb([32, 48, 64]), Rgb([255; 3]));
        assert_eq!(read("#203040"), Ok(BackgroundArg::Plain(a)));
        assert_eq!(read("white"), Ok(BackgroundArg::Plain(b)));
        assert_eq!(
            read("gradient:#203040,#ffffff"),
            Ok(BackgroundArg::Gradient(a, b))
        );
        assert_eq!(
            read("gradient:#203040, white"),
            Ok(BackgroundArg::Gradient(a, b))
        );
        assert_eq!(read("transparent"), Ok(BackgroundArg::Transparent));
        assert_eq!(read("studio"), Ok(BackgroundArg::Studio));
        assert_eq!(
            read("my wall.png"),
            Ok(BackgroundArg::Picture("my wall.png".into()))
        );
        assert_eq!(read("gradient:#203040"), Err(BackgroundError::Gradient));
        assert!(matches!(
            read("gradient:#203040,#zzz"),
            Err(BackgroundError::Colour(..))
        ));
        assert!(matches!(read("#20304"), Err(BackgroundError::Colour(..))));
        assert!(matches!(
            read("transparant"),
            Err(BackgroundError::Unknown(_))
        ));
        assert!(matches!(read(""), Err(BackgroundError::Unknown(_))));
    }

    #[test]
    fn a_file_that_is_not_there_is_named() {
        let scene = SceneArgs {
            background: Some(BackgroundArg::Picture("no/such.png".into())),
            ..SceneArgs::default()
        };
        let error = format!("{:#}", scene.view().unwrap_err());
        assert!(
            error.contains("--background") && error.contains("no/such.png"),
            "{error}"
        );
    }

    proptest! {
        #[test]
        fn any_words_are_read_or_refused_and_what_is_read_is_written_so(text in ".{0,40}") {
            for text in [text.clone(), format!("gradient:{text}")] {
                if let Ok(background) = text.parse::<BackgroundArg>() {
                    prop_assert_eq!(background.to_string().parse(), Ok(background));
                }
            }
        }
    }
}
