//! The words of `mouthpiece head …`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

/// The head shop: what is in a head file, and how its mouth answers
#[derive(Debug, Subcommand)]
pub enum HeadCommand {
    Info(InfoArgs),
    Calibrate(CalibrateArgs),
}

/// What a head holds: parts, landmarks, measurements in mm, how good its mesh is
#[derive(Debug, Args)]
#[command(
    after_help = "Measurements are straight distances between Farkas's landmarks; of paired ones the mean, and each side.\n\n\
                  Examples:\n  mouthpiece head info\n  mouthpiece head info anna.glb --json"
)]
pub struct InfoArgs {
    /// The head file [default: the built-in head]
    #[arg(value_name = "F")]
    pub file: Option<PathBuf>,
    /// Machine-readable output
    #[arg(long)]
    pub json: bool,
}

/// Measure how a head's mouth answers to its muscles, so that speech shapes it rightly
#[derive(Debug, Args)]
#[command(
    after_help = "`mouthpiece head fit` does this already; a head that another program has changed may need it.\n\n\
                  Example:\n  mouthpiece head calibrate anna.glb -o anna-calibrated.glb"
)]
pub struct CalibrateArgs {
    /// The head file
    #[arg(value_name = "F")]
    pub file: PathBuf,
    /// Where to write the same head with its new calibration
    #[arg(short, long, value_name = "OUT.glb")]
    pub output: PathBuf,
}
