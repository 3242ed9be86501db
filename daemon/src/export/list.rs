//! Many videos by one command: `mouthpiece export --jobs LIST`. How to spread a list over machines: `daemon/batch.md`.
//!
//! Each row is made by itself: one that fails is said and leaves the others, one that was finished before stays, and
//! nothing appears before it is whole, so that the same command goes on after whatever stopped it. Which rows write
//! where is settled on the whole list, so that no two processes that share it write the same file.
//!
//! | module | does |
//! |---|---|
//! | [`read`] | lines of a list |
//! | [`row`] | a row as the options it stands for |
//! | [`key`] | what a finished video was made of |
//! | [`record`] | which outputs are finished, and which are being made |
//! | [`budget`] | how many at once |
//! | [`crew`] | the threads that make them |
//! | [`report`] | what became of each row |

mod budget;
mod crew;
mod key;
mod read;
mod record;
mod report;
mod row;

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use crate::cli::JobsArgs;
use crate::interrupt::{self, Interrupted};
use crew::{Crew, Outcome};
use report::{Entry, Report, State, rounded};
use row::{Reader, Request};

/// A row of this process's share.
pub struct Planned {
    /// Its number in the list, counted from 0.
    row: usize,
    /// Counted from 1.
    line: u64,
    /// What it asks for, or why that cannot be meant.
    request: Result<Request, String>,
}

impl Planned {
    fn output(&self) -> Option<&Path> {
        self.request
            .as_ref()
            .ok()
            .map(|request| request.output.as_path())
    }
}

/// Runs the command on `list`.
pub fn run(list: &Path, args: &JobsArgs) -> anyhow::Result<()> {
    let rows = plan(list, args)?;
    let entry = |planned: &Planned| Entry {
        row: planned.row,
        line: planned.line,
        output: planned.output().map(Path::to_path_buf),
        ..Entry::default()
    };
    let entries: Vec<_> = rows.iter().map(entry).collect();
    let shard = args.shard.map(|shard| shard.to_string());
    let mut report = Report::new(list, shard, args.report.as_deref(), entries)?;

    let bar = super::bar(rows.len() as u64, "videos");
    let say = |planned: &Planned, why: &str| {
        let output = planned
            .output()
            .map(|output| format!(", {}", output.display()));
        let (list, line, output) = (list.display(), planned.line, output.unwrap_or_default());
        bar.suspend(|| eprintln!("mouthpiece: {list} line {line}{output}: {why}"));
    };
    let workers = args.parallel.map_or_else(budget::workers, usize::from);
    let crew = Crew::new(workers);
    // A report that cannot be written does not stop the work either; it is said at the end.
    let mut unreported = Ok(());
    crew.work(&rows, |at, outcome| {
        match &outcome {
            Outcome::Failed { why, .. } => say(&rows[at], why),
            Outcome::Done { seconds, .. } => {
                let output = rows[at].output().unwrap_or(Path::new(""));
                tracing::info!(seconds, line = rows[at].line, "wrote {}", output.display());
            }
            Outcome::Unchanged | Outcome::Stopped => {}
        }
        bar.inc(1);
        let entered = report.enter(at, |entry| enter(entry, outcome));
        if unreported.is_ok() {
            unreported = entered;
        }
    });
    bar.finish_and_clear();
    let written = report.write();
    conclude(list, &report)?;
    written.and(unreported)
}

fn enter(entry: &mut Entry, outcome: Outcome) {
    match outcome {
        Outcome::Done { seconds, video_s } => {
            entry.state = State::Done;
            entry.seconds = Some(rounded(seconds));
            entry.realtime_factor = Some(rounded(video_s / seconds.max(1e-9)));
        }
        Outcome::Unchanged => entry.state = State::Unchanged,
        Outcome::Failed { seconds, why } => {
            entry.state = State::Failed;
            entry.seconds = Some(rounded(seconds));
            entry.error = Some(why);
        }
        Outcome::Stopped => {}
    }
}

/// The rows of this process's share.
fn plan(list: &Path, args: &JobsArgs) -> anyhow::Result<Vec<Planned>> {
    let mut reader = Reader::new(list, args.output_dir.as_deref(), std::env::args_os())?;
    let rows = read::read(list, reader.columns())?;
    let mut outputs: HashMap<PathBuf, u64> = HashMap::new();
    let mut share = Vec::new();
    for (number, row) in rows.into_iter().enumerate() {
        let line = row.line;
        let request = row.cells.and_then(|cells| reader.read(&cells));
        let request = request.and_then(|request| {
            // `a/./b` is `a/b`.
            let plain = request.output.components().collect();
            match outputs.insert(plain, line) {
                Some(other) => Err(format!(
                    "line {other} writes {} already; name another output",
                    request.output.display()
                )),
                None => Ok(request),
            }
        });
        if args.shard.is_none_or(|shard| shard.has(number)) {
            share.push(Planned {
                row: number,
                line,
                request,
            });
        }
    }
    Ok(share)
}

/// The last word, where not all is well.
fn conclude(list: &Path, report: &Report) -> anyhow::Result<()> {
    let list = list.display();
    let (failed, open) = (report.count(State::Failed), report.count(State::Open));
    let finished = report.count(State::Done) + report.count(State::Unchanged);
    let all = failed + open + finished;
    if interrupt::check().is_err() {
        return Err(Interrupted(format!(
            "{list}: stopped by a signal when {finished} of {all} videos were finished; the same command makes the others"
        ))
        .into());
    }
    tracing::info!(finished, failed, "{list}");
    anyhow::ensure!(
        failed == 0,
        "{list}: {failed} of {all} videos failed; the others are finished, and the same command tries only these again"
    );
    Ok(())
}
