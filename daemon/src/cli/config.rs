//! Words of `mouthpiece config`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

/// The configuration of `run` and `say`: check a file, or print one with every key documented
#[derive(Debug, Subcommand)]
pub enum ConfigCommand {
    /// Say whether the file is right, and if not where and what to write instead
    #[command(
        after_help = "Examples:\n  mouthpiece config check\n  mouthpiece config check kiosk.toml"
    )]
    Check(ConfigArgs),
    /// Print all keys as TOML with what they mean: as the file has them, and else their defaults
    #[command(
        after_help = "Examples:\n  mouthpiece config print > kiosk.toml\n  mouthpiece config print kiosk.toml"
    )]
    Print(ConfigArgs),
}

/// Which file.
#[derive(Debug, Args)]
pub struct ConfigArgs {
    /// The file [default: mouthpiece/config.toml in $XDG_CONFIG_HOME, where it is there]
    #[arg(value_name = "F")]
    pub file: Option<PathBuf>,
}
