//! How the window looks: the part of the configuration that this thread uses, with everything that has
//! to be read from files read.

use anyhow::Result;
use mouthpiece_render::{Tier, View};
use mouthpiece_rig::TICK_RATE;

use crate::config::{self, Config};

/// How the window looks.
#[derive(Clone, Debug)]
pub struct Look {
    pub window: config::Window,
    /// None: the best that keeps pace, found while it runs.
    pub tier: Option<Tier>,
    pub view: View,
    pub captions: config::Captions,
    /// How much later the picture is to be shown, ticks.
    pub delay: i64,
}

impl Look {
    /// As `config` has it. Reads the files that are named, so not for the thread that draws.
    pub fn load(config: &Config) -> Result<Self> {
        let mut view = config.look.view()?;
        view.placing.quarters = config.window.rotate.quarters();
        if config.window.fullscreen {
            view.placing.wander_max_px = config.window.burn_in_shift_px.get() as f32;
        }
        Ok(Self {
            window: config.window.clone(),
            tier: config.look.tier.fixed(),
            view,
            captions: config.captions.clone(),
            delay: config.sound.picture_delay_ms.get() * TICK_RATE / 1000,
        })
    }

    /// What does not change while the face lives stays as it is in `old`.
    pub fn keeping(mut self, old: &Self) -> Self {
        let shift = if old.window.fullscreen {
            self.window.burn_in_shift_px.get() as f32
        } else {
            0.0
        };
        self.view.placing.wander_max_px = shift;
        self.window.fullscreen = old.window.fullscreen;
        self.window.monitor.clone_from(&old.window.monitor);
        self.window.size = old.window.size;
        self
    }
}
