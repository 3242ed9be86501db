//! `mouthpiece head calibrate`: tries out postures of the mouth and writes the head with what it learnt; then says how
//! near random postures come with everything on, and which mouths that speech asks for this head cannot make.

use std::fmt::Write as _;
use std::io::Write as _;
use std::sync::Arc;

use indicatif::{ProgressBar, ProgressStyle};
use mouthpiece_rig::{Calibration, Head, Miss, Verification};
use mouthpiece_speech::Tables;
use serde_json::{Value, json};

use crate::cli::CalibrateArgs;
use crate::interrupt;
use crate::media::output::{self, Output, unwritable};

/// Which random postures are tried: always the same, so that two heads can be compared.
const SEED: u64 = 1;

/// Runs the command.
pub fn run(args: &CalibrateArgs) -> anyhow::Result<()> {
    let head = Arc::new(Head::load(&args.file)?);
    // First, so that what cannot be written costs nothing.
    let mut output = Output::create(&args.output)?;
    let bar = ProgressBar::new(0).with_style(
        ProgressStyle::with_template("{bar:40} {pos}/{len} postures, {eta} left")
            .unwrap_or_else(|_| ProgressStyle::default_bar()),
    );
    let calibration = Calibration::fit_reporting(&head, |done, all| {
        bar.set_length(all as u64);
        bar.set_position(done as u64);
        interrupt::check()
    });
    bar.finish_and_clear();
    let calibration = calibration?;
    let verified = calibration.verify(&head, SEED);
    let mut head = Arc::unwrap_or_clone(head);
    head.calibration = calibration;
    output
        .file()
        .write_all(&head.write())
        .map_err(|e| unwritable(&args.output, &e))?;
    output.commit()?;
    tracing::info!("wrote {}", args.output.display());
    let unreachable = Unreachable::of(&head.calibration)?;
    output::print(&(errors(&verified) + &unreachable.text()))
}

/// How far postures came out from what was wanted, a line per measure.
fn errors(verified: &Verification) -> String {
    if verified.postures == 0 {
        return "no posture of speech can be reached: the mouth does not answer to its muscles\n"
            .into();
    }
    let mut out = format!(
        "{} random postures, lips in contact\nmeasure       median    90 %   worst  mm\n",
        verified.postures
    );
    for error in &verified.errors {
        // Writing to a String cannot fail.
        let _ = writeln!(
            out,
            "{:<12} {:>7.2} {:>7.2} {:>7.2}",
            error.measure.name(),
            error.median_mm,
            error.p90_mm,
            error.worst_mm
        );
    }
    out
}

/// Which of the mouths that speech asks for a head cannot make.
pub struct Unreachable {
    /// How many speech asks for.
    asked: usize,
    /// By the names of their rows.
    missed: Vec<(String, Vec<Miss>)>,
}

impl Unreachable {
    /// Of a head with this calibration.
    pub fn of(calibration: &Calibration) -> anyhow::Result<Self> {
        let mouths = Tables::built_in()?.mouths();
        let asked = mouths.len();
        let missed = mouths.into_iter().map(|(name, articulation)| {
            let misses = calibration.reach(&articulation).misses().collect();
            (name, misses)
        });
        Ok(Self {
            asked,
            missed: missed
                .filter(|(_, m): &(_, Vec<_>)| !m.is_empty())
                .collect(),
        })
    }

    /// A line each.
    pub fn text(&self) -> String {
        let (asked, count) = (self.asked, self.missed.len());
        if count == 0 {
            return format!("all {asked} mouths of speech can be made\n");
        }
        let mut out = format!("of {asked} mouths of speech, {count} come out otherwise\n");
        for (name, misses) in &self.missed {
            let said: Vec<_> = misses.iter().map(Miss::to_string).collect();
            // Writing to a String cannot fail.
            let _ = writeln!(out, "{name:<12} {}", said.join("; "));
        }
        out
    }

    /// The same for programs.
    pub fn json(&self) -> Value {
        let missed = self.missed.iter().flat_map(|(name, misses)| {
            misses.iter().map(move |miss| {
                json!({
                    "row": name,
                    "measure": miss.measure.name(),
                    "wanted_mm": miss.wanted_mm,
                    "expected_mm": miss.expected_mm,
                    "by_mm": miss.by_mm(),
                })
            })
        });
        json!({ "asked": self.asked, "missed": missed.collect::<Vec<_>>() })
    }
}
