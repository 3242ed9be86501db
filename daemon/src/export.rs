//! `mouthpiece export`: labels and sound in, a finished video out; or a list of them.
//!
//! | module | does |
//! |---|---|
//! | [`job`] | makes one video |
//! | [`stage`] | what one video leaves for the next: heads, the graphics device |
//! | [`sink`] | the kind of output that a name stands for |
//! | [`encoder`] | the encoder's thread |
//! | [`list`] | many videos: lists, shares of them, resuming, the report |

mod encoder;
pub mod job;
mod list;
mod sink;
pub mod stage;

use std::path::Path;
use std::time::Instant as Wall;

use anyhow::Context as _;
use indicatif::{ProgressBar, ProgressStyle};
use mouthpiece_render::Gpu;

use crate::cli::ExportArgs;
use crate::pipeline::Cast;
use job::Job;
use sink::Kind;
use stage::Stage;

/// Runs the command.
pub fn run(args: &ExportArgs) -> anyhow::Result<()> {
    match (&args.list.jobs, &args.output) {
        (Some(list), _) => list::run(list, &args.list),
        (None, Some(output)) => one(args, output),
        (None, None) => Err(crate::cli::Usage("--output is missing".into())).context("export"),
    }
}

fn one(args: &ExportArgs, output: &Path) -> anyhow::Result<()> {
    let kind = Kind::of(output, args)?;
    let job = Job::load(args, Cast::load(&args.cast)?)?;
    let started = Wall::now();
    let clip = job.clip();
    let sink = kind.open(output, &clip)?;
    let bar = bar(clip.frames, "frames");
    let mut stage = Stage::new(&Gpu::headless()?, &job)?;
    let done = job.export(&mut stage, sink, &clip, &|drawn| bar.set_position(drawn));
    bar.finish_and_clear();
    done?;
    tracing::info!(
        frames = clip.frames,
        seconds = started.elapsed().as_secs_f64(),
        "wrote {}",
        output.display()
    );
    Ok(())
}

/// How far the work is, on a terminal.
fn bar(length: u64, what: &str) -> ProgressBar {
    ProgressBar::new(length).with_style(
        ProgressStyle::with_template(&format!(
            "{{bar:40}} {{pos}}/{{len}} {what}, {{eta}} left {{msg}}"
        ))
        .unwrap_or_else(|_| ProgressStyle::default_bar()),
    )
}
