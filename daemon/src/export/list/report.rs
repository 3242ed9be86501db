//! What became of each row, for programs to read: JSON with a summary, or NDJSON with a line for each row.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::Serialize;

use crate::cli::Usage;
use crate::media::output;

/// While the work goes on the report is written this often: whoever looks sees how far it is, and a long list is not
/// written thousands of times.
const PERIOD: Duration = Duration::from_secs(5);

/// What became of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum State {
    /// Not yet begun, or stopped before its end.
    #[default]
    Open,
    /// Made now.
    Done,
    /// Made before of the same inputs: nothing was to be done.
    Unchanged,
    Failed,
}

/// A row in the report.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Entry {
    /// Counted from 0, as shards do.
    pub row: usize,
    /// In the list, counted from 1.
    pub line: u64,
    pub output: Option<PathBuf>,
    pub state: State,
    /// How long it took.
    pub seconds: Option<f64>,
    /// Seconds of video for each second of work.
    pub realtime_factor: Option<f64>,
    pub error: Option<String>,
}

/// All rows of this process.
#[derive(Serialize)]
pub struct Report {
    version: &'static str,
    list: PathBuf,
    shard: Option<String>,
    seconds: f64,
    open: usize,
    done: usize,
    unchanged: usize,
    failed: usize,
    jobs: Vec<Entry>,
    #[serde(skip)]
    target: Option<(PathBuf, Kind)>,
    #[serde(skip)]
    begun: Instant,
    #[serde(skip)]
    written: Instant,
}

#[derive(Clone, Copy)]
enum Kind {
    Json,
    Ndjson,
}

impl Report {
    /// Of `jobs`, to be written to `target` where there is one.
    pub fn new(
        list: &Path,
        shard: Option<String>,
        target: Option<&Path>,
        jobs: Vec<Entry>,
    ) -> anyhow::Result<Self> {
        let kind = |path: &Path| match path.extension().and_then(|e| e.to_str()) {
            Some("json") => Ok((path.to_path_buf(), Kind::Json)),
            Some("ndjson" | "jsonl") => Ok((path.to_path_buf(), Kind::Ndjson)),
            _ => Err(Usage(format!(
                "--report: {} must end in .json or .ndjson, so that its kind is known",
                path.display()
            ))),
        };
        let now = Instant::now();
        let mut report = Self {
            version: env!("CARGO_PKG_VERSION"),
            list: list.to_path_buf(),
            shard,
            seconds: 0.0,
            open: 0,
            done: 0,
            unchanged: 0,
            failed: 0,
            jobs,
            target: target.map(kind).transpose()?,
            begun: now,
            written: now,
        };
        // What cannot be written is said before the work.
        report.write()?;
        Ok(report)
    }

    /// How many rows ended so.
    pub fn count(&self, state: State) -> usize {
        self.jobs.iter().filter(|job| job.state == state).count()
    }

    /// Enters what became of a row.
    pub fn enter(&mut self, at: usize, change: impl FnOnce(&mut Entry)) -> anyhow::Result<()> {
        if let Some(entry) = self.jobs.get_mut(at) {
            change(entry);
        }
        if self.written.elapsed() >= PERIOD {
            self.write()?;
        }
        Ok(())
    }

    /// Writes it, whole or not at all.
    pub fn write(&mut self) -> anyhow::Result<()> {
        let Some((target, kind)) = &self.target else {
            return Ok(());
        };
        self.seconds = rounded(self.begun.elapsed().as_secs_f64());
        self.open = self.count(State::Open);
        self.done = self.count(State::Done);
        self.unchanged = self.count(State::Unchanged);
        self.failed = self.count(State::Failed);
        let text = match kind {
            Kind::Json => serde_json::to_vec_pretty(&self)?,
            Kind::Ndjson => {
                let mut text = Vec::new();
                for job in &self.jobs {
                    serde_json::to_writer(&mut text, job)?;
                    text.push(b'\n');
                }
                text
            }
        };
        output::write(target, &text)?;
        self.written = Instant::now();
        Ok(())
    }
}

/// Milliseconds are enough.
pub fn rounded(seconds: f64) -> f64 {
    (seconds * 1e3).round() / 1e3
}
