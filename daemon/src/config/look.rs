//! `[look]`: who is seen, and how.

use std::path::PathBuf;

use anyhow::Context as _;
use glam::vec2;
use mouthpiece_render::{Environment, Placing, View};
use serde::de::Error as _;
use serde::{Deserialize as _, Deserializer};

use super::section::section;
use super::value::Whole;
use crate::cli::{BackgroundArg, LiveTierArg, SkinArg, TissueArg};

section! {
    /// Who is seen, and how. Files are looked for from the folder of this file on.
    pub struct Look {
        /// A head file (.glb). Not set: the built-in head.
        head: Option<PathBuf> = None => at_start,
        /// What moves the skin: "springs" or "layered". Not set: what the head says.
        tissue: Option<TissueArg> = None => at_start,
        /// Quality of the picture: "auto" is the best that this machine draws in time; or "low", "medium", "high".
        tier: LiveTierArg = LiveTierArg::Auto,
        /// Behind the head: "studio", a colour ("#203040"), "gradient:#top,#bottom", or a .png or .jpg file.
        #[serde(deserialize_with = "opaque")]
        background: BackgroundArg = BackgroundArg::Studio,
        /// Ambient light from a panorama, .hdr or .exr. Not set: a studio.
        environment: Option<PathBuf> = None,
        /// How the skin reflects light: "physical" or "blinn-phong".
        skin: SkinArg = SkinArg::Physical,
        /// Size of the head in the picture: 100 fills it, 60 leaves room above and shows the shoulders, 140 comes closer.
        framing_percent: Whole<50, 200> = Whole::new(100),
        /// Moves the head to the right (below 0: to the left), hundredths of the picture's width.
        across_percent: Whole<-50, 50> = Whole::new(0),
        /// Moves the head up (below 0: down), hundredths of the picture's height.
        up_percent: Whole<-50, 50> = Whole::new(0),
    }
}

impl Look {
    /// How the renderer is to look at the head. Reads the files that are named.
    pub fn view(&self) -> anyhow::Result<View> {
        let view = View::default();
        let environment = match &self.environment {
            None => view.environment,
            Some(path) => Environment::load(path).context("look.environment")?,
        };
        Ok(View {
            background: self.background.load().context("look.background")?,
            environment,
            skin: self.skin.into(),
            placing: Placing {
                zoom: self.framing_percent.percent(),
                shift: vec2(self.across_percent.percent(), self.up_percent.percent()),
                ..Placing::default()
            },
            ..view
        })
    }
}

/// A window shows something behind the head.
fn opaque<'de, D: Deserializer<'de>>(from: D) -> Result<BackgroundArg, D::Error> {
    match BackgroundArg::deserialize(from)? {
        BackgroundArg::Transparent => Err(D::Error::custom(
            "a window is not transparent, write \"studio\", a colour, a gradient or a picture file",
        )),
        background => Ok(background),
    }
}
