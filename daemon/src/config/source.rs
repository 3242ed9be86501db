//! Flag over file over default.

use std::path::PathBuf;

use anyhow::Result;

use super::value::Whole;
use super::{Config, file};
use crate::cli::{BackgroundArg, DriveArg, StageArgs, Usage, WireArgs};
use crate::health::Door;

/// Where a live face's configuration comes from; asked again when the file has changed.
#[derive(Clone, Debug)]
pub struct Source {
    file: Option<PathBuf>,
    flags: StageArgs,
    wire: WireArgs,
    http: Option<Door>,
}

impl Source {
    /// What the command line says.
    pub fn new(stage: &StageArgs, wire: &WireArgs) -> Self {
        Self {
            file: stage.config.clone().or_else(file::user_default),
            flags: stage.clone(),
            wire: wire.clone(),
            http: None,
        }
    }

    /// And the flag of who tells health.
    pub fn with_http(self, http: Option<Door>) -> Self {
        Self { http, ..self }
    }

    /// The file that is read, where there is one.
    pub fn file(&self) -> Option<&std::path::Path> {
        self.file.as_deref()
    }

    /// Reads the file and puts the flags on top.
    pub fn load(&self) -> Result<Config> {
        let mut config = match &self.file {
            Some(path) => file::read(path)?,
            None => Config::default(),
        };
        self.flags.lay_over(&mut config);
        if !self.wire.listen.is_empty() {
            config.wire.listen.clone_from(&self.wire.listen);
        }
        if self.wire.token_file.is_some() {
            config.wire.token_file.clone_from(&self.wire.token_file);
        }
        set(&mut config.health.http, self.http.as_ref());
        DriveArg::check(&config.drive.to).map_err(|why| Usage(format!("--drive: {why}")))?;
        if config.look.background == BackgroundArg::Transparent {
            let why = "--background transparent: a window is not; write out-%05d.png with `mouthpiece export`";
            return Err(Usage(why.into()).into());
        }
        Ok(config)
    }
}

/// What a flag says goes first.
fn set<T: Clone>(value: &mut T, flag: Option<&T>) {
    if let Some(flag) = flag {
        value.clone_from(flag);
    }
}

impl StageArgs {
    fn lay_over(&self, config: &mut Config) {
        let Config {
            window,
            look,
            sound,
            life,
            drive,
            ..
        } = config;
        window.fullscreen |= self.fullscreen;
        set(&mut window.monitor, self.monitor.as_ref());
        set(&mut window.size, self.size.as_ref());
        set(&mut look.tier, self.tier.as_ref());
        set(&mut look.background, self.scene.background.as_ref());
        set(&mut look.skin, self.scene.skin.as_ref());
        if self.scene.environment.is_some() {
            look.environment.clone_from(&self.scene.environment);
        }
        if self.cast.head.is_some() {
            look.head.clone_from(&self.cast.head);
        }
        if self.cast.tissue.is_some() {
            look.tissue = self.cast.tissue;
        }
        set(&mut sound.device, self.audio_device.as_ref());
        if let Some(ms) = self.look_ahead {
            sound.look_ahead_ms = Whole::new(i64::from(ms));
        }
        if let Some(ms) = self.av_offset {
            sound.picture_delay_ms = Whole::new(i64::from(ms));
        }
        set(&mut life.seed, self.seed.as_ref());
        if !self.drive.is_empty() {
            drive.to.clone_from(&self.drive);
        }
        if let Some(hz) = self.drive_rate {
            drive.rate_hz = Whole::new(i64::from(hz));
        }
    }
}
