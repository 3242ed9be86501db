//! Words for a live face: its window, sound device and look. What is not said here is as the
//! configuration file has it, so nothing has a default of its own.

use std::path::PathBuf;

use clap::Args;

use super::scene::SceneArgs;
use super::values::Size;
use super::{CastArgs, DriveArg, LiveTierArg};

/// Window, sound device and look of a live face.
#[derive(Clone, Debug, Default, Args)]
pub struct StageArgs {
    /// The configuration, under what is said here [default: mouthpiece/config.toml in
    /// $XDG_CONFIG_HOME, where it is there]
    #[arg(long, value_name = "F")]
    pub config: Option<PathBuf>,
    /// Sound device by its name in `mouthpiece doctor`; `none` for a steady clock without sound
    #[arg(long, value_name = "ID")]
    pub audio_device: Option<String>,
    /// Fill the screen
    #[arg(long)]
    pub fullscreen: bool,
    /// The screen to fill, by its name in `mouthpiece doctor` or its number from 1 [default: the
    /// primary one]
    #[arg(long, value_name = "NAME|N")]
    pub monitor: Option<String>,
    /// Size of the window in pixels [default: 720x720]
    #[arg(long, value_name = "WxH")]
    pub size: Option<Size>,
    /// Quality of the picture [default: auto]
    #[arg(long, value_enum)]
    pub tier: Option<LiveTierArg>,
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Seed of the blinks and glances of an idle face [default: 1]
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Of an utterance that is still coming in so much must be there before it begins: what the mouth knows
    /// ahead [default: 300]
    #[arg(long, value_name = "MS", value_parser = clap::value_parser!(u16).range(0..=500))]
    pub look_ahead: Option<u16>,
    /// Show the picture later by so much, below 0 earlier, where screen or loudspeakers have a delay
    /// of their own (see `mouthpiece doctor --sync`) [default: 0]
    #[arg(long, value_name = "MS", allow_negative_numbers = true,
          value_parser = clap::value_parser!(i16).range(-500..=500))]
    pub av_offset: Option<i16>,
    /// Drive another avatar with what this face does as it is heard; may be repeated. KIND is vmc
    /// (VRM 1.0), vmc0 (VRM 0.x), vmc-arkit (ARKit's shapes), livelink (Unreal Engine) or osc
    #[arg(long, value_name = "KIND:HOST[:PORT]")]
    pub drive: Vec<DriveArg>,
    /// How often a second other avatars are told [default: 60]
    #[arg(long, value_name = "HZ", value_parser = clap::value_parser!(u16).range(1..=240))]
    pub drive_rate: Option<u16>,
    #[command(flatten)]
    pub cast: CastArgs,
}
