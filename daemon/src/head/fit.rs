//! `mouthpiece head fit`: a scan and its landmarks in, a head out, with a report on how good it is.

use std::io::Write as _;

use anyhow::Context as _;
use indicatif::{ProgressBar, ProgressFinish, ProgressStyle};
use mouthpiece_rig::Head;
use mouthpiece_shop::landmarks::{Landmarks, Unit};
use mouthpiece_shop::mesh;
use mouthpiece_shop::refit::{FitReport, Fitted, Options, RefitError, Stage, fit_head};

use crate::cli::FitArgs;
use crate::interrupt;
use crate::media::output::{self, Output, unwritable};

/// A size beyond these is worth a word: the head of an infant, and of nobody.
const USUAL_SIZE: std::ops::RangeInclusive<f64> = 0.7..=1.3;

/// Runs the command.
pub fn run(args: &FitArgs) -> anyhow::Result<()> {
    // First, so that what cannot be written costs nothing.
    let mut head_file = Output::create(&args.output)?;
    let mut report_file = args.report.as_deref().map(Output::create).transpose()?;
    let reference = match &args.head {
        Some(file) => Head::load(file)?,
        None => Head::reference()?,
    };
    let landmarks = Landmarks::read(&args.landmarks)?;
    let bar = bar();
    bar.set_message("reading the scan");
    let reading = mesh::read(&args.scan)?;
    for note in &reading.notes {
        bar.suspend(|| eprintln!("note: {note}"));
    }
    interrupt::check()?;
    let options = Options {
        scan: mesh::Options {
            mm_per_unit: args.unit.map(Unit::mm),
            scan_file: args.scan.display().to_string(),
            landmarks_file: args.landmarks.display().to_string(),
        },
        ..Options::default()
    };
    let fitted = fit_head(&reference, reading.scan, &landmarks, &options, |stage| {
        bar.set_message(stage.words());
        bar.inc(1);
    });
    let Fitted { head, report } = match fitted {
        Ok(fitted) => fitted,
        // This one names the file itself: the scan's or the landmarks'.
        Err(RefitError::Prepare(cause)) => return Err(cause.into()),
        Err(cause) => return Err(cause).with_context(|| args.scan.display().to_string()),
    };
    bar.set_message("writing");
    interrupt::check()?;
    let bytes = head.write();
    // What cannot be read again is no head: better none than a broken one.
    Head::read(&bytes).context("the new head is not sound")?;
    let json = serde_json::to_string_pretty(&report)? + "\n";
    head_file
        .file()
        .write_all(&bytes)
        .map_err(|e| unwritable(&args.output, &e))?;
    if let (Some(file), Some(path)) = (&mut report_file, &args.report) {
        file.file()
            .write_all(json.as_bytes())
            .map_err(|e| unwritable(path, &e))?;
    }
    bar.finish_and_clear();
    for note in notes(&report) {
        eprintln!("note: {note}");
    }
    head_file.commit()?;
    if let Some(file) = report_file {
        file.commit()?;
    }
    tracing::info!("wrote {}", args.output.display());
    output::print(&if args.json {
        json
    } else {
        summary(args, &report)
    })
}

fn bar() -> ProgressBar {
    // Reading and writing, and what is between them.
    ProgressBar::new(Stage::ALL.len() as u64 + 1)
        .with_style(
            ProgressStyle::with_template("{bar:24} {msg}")
                .unwrap_or_else(|_| ProgressStyle::default_bar()),
        )
        // Whatever ends the work, the bar makes room for what is said about it.
        .with_finish(ProgressFinish::AndClear)
}

/// What the user should know about this scan.
fn notes(report: &FitReport) -> Vec<String> {
    let mut notes = report.preparation.notes.clone();
    let dropped = &report.preparation.dropped;
    if dropped.islands > 0 {
        notes.push(format!(
            "{} loose pieces of the scan ({} triangles) were left out",
            dropped.islands, dropped.island_triangles
        ));
    }
    let size = report.preparation.size_ratio;
    if !USUAL_SIZE.contains(&size) {
        notes.push(format!(
            "the head is {size:.2} times as large as the reference head: if that is not so, say the scan's unit with --unit"
        ));
    }
    if !report.estimated_landmarks.is_empty() {
        notes.push(format!(
            "{} landmarks were estimated: {}",
            report.estimated_landmarks.len(),
            report.estimated_landmarks.join(" ")
        ));
    }
    if report.turned_at_features > 0 {
        notes.push(format!(
            "{} triangles at lips, lids or nostrils are turned over: check the landmarks there",
            report.turned_at_features
        ));
    }
    notes
}

fn summary(args: &FitArgs, report: &FitReport) -> String {
    let row = |name: &str, s: &mouthpiece_shop::fit::report::Spread| {
        format!("{name:<22} {:>6.2} {:>6.2} {:>6.2}\n", s.mean, s.p95, s.max)
    };
    [
        format!(
            "{} in {:.2} s\n\nmm                       mean    p95    max\n",
            args.output.display(),
            report.seconds.total
        ),
        row("landmarks", &report.landmark_error_mm),
        row("skin to scan (face)", &report.skin_to_scan_mm),
        row("scan to skin (face)", &report.scan_to_skin_mm),
        format!(
            "faces turned over      {:>6.3} %\n",
            report.turned_faces * 100.0
        ),
        format!(
            "colour of the scan     {:>6.1} % of the map\n",
            report.scan_colour * 100.0
        ),
    ]
    .concat()
}
