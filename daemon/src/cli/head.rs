//! The words of `mouthpiece head …`.

use std::path::PathBuf;

use clap::{Args, Subcommand};
use mouthpiece_shop::landmarks::Unit;

/// The head shop: make a head of a scan, look into one, learn its mouth
#[derive(Debug, Subcommand)]
#[command(after_help = "Examples:\n  mouthpiece head landmarks anna.ply\n  \
                  mouthpiece head fit anna.ply --landmarks anna.landmarks.json -o anna.glb\n  \
                  mouthpiece say --demo --head anna.glb")]
pub enum HeadCommand {
    Info(InfoArgs),
    Fit(FitArgs),
    Landmarks(LandmarksArgs),
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

/// Make a head of a scan: OBJ, PLY, STL or GLB, with at least four landmarks on it
#[derive(Debug, Args)]
#[command(
    after_help = "Landmarks are JSON, in the scan's own coordinates: {\"unit\": \"mm\", \"points\": {\"prn\": [x, y, z], \"en_l\": …}};\n\
                  _l and _r are the subject's left and right, `head info` lists the names. Those left out are estimated.\n\n\
                  Examples:\n  mouthpiece head fit anna.ply --landmarks anna.json -o anna.glb\n  \
                  mouthpiece head fit anna.obj --landmarks anna.json -o anna.glb --unit m --report anna-fit.json"
)]
pub struct FitArgs {
    /// The scan
    #[arg(value_name = "SCAN")]
    pub scan: PathBuf,
    /// Where on the scan its landmarks lie
    #[arg(long, value_name = "L.json")]
    pub landmarks: PathBuf,
    /// Where to write the new head
    #[arg(short, long, value_name = "NEW.glb")]
    pub output: PathBuf,
    /// Where to write how good the fit is, as JSON
    #[arg(long, value_name = "R.json")]
    pub report: Option<PathBuf>,
    /// Unit of the scan: mm, cm, m or in [default: by the landmarks]
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<Unit>,
    /// The head that is bent to the scan [default: the built-in head]
    #[arg(long, value_name = "REF.glb")]
    pub head: Option<PathBuf>,
    /// Print the report as JSON
    #[arg(long)]
    pub json: bool,
}

/// Measure how a head's mouth answers to its muscles, so that speech shapes it rightly
#[derive(Debug, Args)]
#[command(
    after_help = "`mouthpiece head fit` carries the reference head's over, scaled to the new mouth; measured, it is exact.\n\
                  Prints how near random postures came, lips in contact, and which mouths of speech this head cannot make.\n\n\
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

/// Click landmarks onto a scan in a window, for `head fit`; from three on the rest is estimated
#[derive(Debug, Args)]
#[command(
    after_help = "Click to place, drag to turn, drag a dot to move it, wheel to zoom. Enter: next; Space: accept the estimate;\n\
                  Backspace: clear; Alt: in mid-air, where the scan has no data; F, L, R: views; Ctrl+Z, Ctrl+Y, Ctrl+S.\n\
                  Only what you set or accept is saved: `head fit` estimates the rest itself.\n\n\
                  Examples:\n  mouthpiece head landmarks anna.ply\n  mouthpiece head landmarks anna.ply --landmarks rough.json -o anna.json"
)]
pub struct LandmarksArgs {
    /// The scan: OBJ, PLY, STL or GLB
    #[arg(value_name = "SCAN")]
    pub scan: PathBuf,
    /// Where to save; continued from if it is there already [default: beside the scan, anna.landmarks.json]
    #[arg(short, long, value_name = "L.json")]
    pub output: Option<PathBuf>,
    /// Landmarks to start from
    #[arg(long, value_name = "START.json")]
    pub landmarks: Option<PathBuf>,
    /// The head whose landmarks these are [default: the built-in head]
    #[arg(long, value_name = "REF.glb")]
    pub head: Option<PathBuf>,
    /// Unit of the scan: mm, cm, m or in [default: by its size]
    #[arg(long, value_name = "UNIT")]
    pub unit: Option<Unit>,
}
