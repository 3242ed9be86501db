//! `mouthpiece head landmarks`: a window in which landmarks are clicked onto a scan while the rest is warped along
//! (HEADSHOP 6.1). What clicks mean is decided in `mouthpiece_shop::marking`; here is what one sees.
//!
//! | module | does |
//! |---|---|
//! | `session` | the marking with its file: saving, what was said last |
//! | `window` | the window, its surface, egui's frames |
//! | `view` | the scan, the dots on it, the pointing device |
//! | `panel` | the list of landmarks, the reference picture, keys and buttons |
//! | `mesh` | meshes drawn into pictures |
//! | `shape` | scans and heads as vertices |

mod mesh;
mod panel;
mod session;
mod shape;
mod view;
mod window;

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use mouthpiece_rig::Head;
use mouthpiece_shop::closest::Surface;
use mouthpiece_shop::landmarks::Landmarks;
use mouthpiece_shop::marking::Marking;
use mouthpiece_shop::mesh as scans;
use mouthpiece_shop::refit::landmarks_of;

use crate::cli::LandmarksArgs;
use session::Session;
use shape::Shape;

/// Runs the command.
pub fn run(args: &LandmarksArgs) -> anyhow::Result<()> {
    // First, so that a machine without a display says so before it reads a large scan.
    let events = window::connect()?;
    let head = match &args.head {
        Some(file) => Head::load(file)?,
        None => Head::reference()?,
    };
    let whose = args.head.as_ref().map_or_else(
        || "the built-in head".to_owned(),
        |file| file.display().to_string(),
    );
    let reading = scans::read(&args.scan)?;
    for note in &reading.notes {
        tracing::info!("{}: {note}", args.scan.display());
    }
    // The same cleaning as before a fit, so that what cannot be fitted is known before the work is done.
    let (scan, _) = scans::tidy(reading.scan).with_context(|| args.scan.display().to_string())?;
    let surface = Surface::new(&scan.positions, &scan.triangles)
        .with_context(|| args.scan.display().to_string())?;
    let scan_shape = Shape::of_scan(&surface, scan.colour);
    let mut marking = Marking::new(surface, landmarks_of(&head)?, args.unit)
        .with_context(|| format!("{whose} has no landmarks: choose another with --head"))?;

    let output = match &args.output {
        Some(output) => output.clone(),
        None => beside(&args.scan),
    };
    let start = match &args.landmarks {
        Some(start) => Some(start),
        None => Some(&output).filter(|output| output.exists()),
    };
    let mut said = String::new();
    if let Some(start) = start {
        let file = Landmarks::read(start)?;
        let count = file.points.len();
        marking
            .load(&file)
            .map_err(|fault| fault.in_file(&start.display().to_string()))?;
        said = format!("{count} landmarks from {}", start.display());
    }
    let session = Session::new(marking, output, said, args.landmarks.is_some());
    window::show(events, session, scan_shape, Shape::of_head(&head)?)
}

/// The scan's name with the ending of landmark files.
fn beside(scan: &Path) -> PathBuf {
    scan.with_extension("landmarks.json")
}
