//! `mouthpiece head calibrate`: tries out postures of the mouth and writes the head with what it learnt.

use std::io::Write as _;
use std::sync::Arc;

use indicatif::{ProgressBar, ProgressStyle};
use mouthpiece_rig::{Calibration, Head};

use crate::cli::CalibrateArgs;
use crate::interrupt;
use crate::media::output::{Output, unwritable};

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
    let mut head = Arc::unwrap_or_clone(head);
    head.calibration = calibration?;
    output
        .file()
        .write_all(&head.write())
        .map_err(|e| unwritable(&args.output, &e))?;
    output.commit()?;
    tracing::info!("wrote {}", args.output.display());
    Ok(())
}
