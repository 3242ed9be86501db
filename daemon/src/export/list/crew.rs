//! The threads that make the videos of a list, each one after another.
//!
//! A worker keeps its head on its device for the next row that wants the same. Outcomes come back through a
//! bounded queue to the thread that asked, which alone prints and writes the report.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant as Wall;

use crossbeam::channel::{Sender, bounded};
use mouthpiece_rig::TICK_RATE;

use super::Planned;
use super::budget::{self, Budget, Share};
use super::key::Keys;
use super::record::{Claim, Record};
use super::row::Request;
use crate::export::job::Job;
use crate::export::stage::{Stage, Studio};
use crate::interrupt::{self, Interrupted};

/// Outcomes that wait to be told: each worker can leave one and begin the next row.
const OUTCOMES: usize = 64;

/// What became of a row.
pub enum Outcome {
    Done {
        seconds: f64,
        video_s: f64,
    },
    Unchanged,
    Failed {
        seconds: f64,
        why: String,
    },
    /// Ctrl-C came first.
    Stopped,
}

/// Workers and what they share.
pub struct Crew {
    workers: usize,
    budget: Budget,
    studio: Studio,
    keys: Keys,
}

/// What a worker keeps from one video to the next.
#[derive(Default)]
struct Kept<'a> {
    stage: Option<Stage>,
    share: Option<Share<'a>>,
}

impl Crew {
    /// At most so many videos at once.
    pub fn new(workers: usize) -> Self {
        Self {
            workers,
            budget: Budget::of_this_machine(),
            studio: Studio::default(),
            keys: Keys::default(),
        }
    }

    /// Makes all rows and tells what became of each, by its place in `rows`, as it ends.
    pub fn work(&self, rows: &[Planned], mut tell: impl FnMut(usize, Outcome)) {
        let next = AtomicUsize::new(0);
        let (ended, outcomes) = bounded(OUTCOMES);
        std::thread::scope(|scope| {
            let mut started = 0;
            for n in 0..self.workers.min(rows.len()) {
                let (next, ended) = (&next, ended.clone());
                let worker = std::thread::Builder::new()
                    .name(format!("video {n}"))
                    .spawn_scoped(scope, move || self.worker(rows, next, &ended));
                match worker {
                    Ok(_) => started += 1,
                    Err(error) => tracing::warn!(%error, "only {started} videos at once"),
                }
            }
            drop(ended);
            for (at, outcome) in outcomes {
                tell(at, outcome);
            }
        });
    }

    fn worker(&self, rows: &[Planned], next: &AtomicUsize, ended: &Sender<(usize, Outcome)>) {
        let mut kept = Kept::default();
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(planned) = rows.get(at) else {
                return;
            };
            let begun = Wall::now();
            let outcome = match &planned.request {
                Ok(request) => self.make(request, &mut kept),
                Err(why) => Err(anyhow::anyhow!("{why}")),
            };
            let outcome = outcome.unwrap_or_else(|error| {
                // What was under way on it is of no use.
                kept.stage = None;
                if error.is::<Interrupted>() {
                    return Outcome::Stopped;
                }
                Outcome::Failed {
                    seconds: begun.elapsed().as_secs_f64(),
                    why: crate::sentence(&error),
                }
            });
            if ended.send((at, outcome)).is_err() {
                return;
            }
        }
    }

    fn make<'a>(&'a self, request: &Request, kept: &mut Kept<'a>) -> anyhow::Result<Outcome> {
        interrupt::check()?;
        let begun = Wall::now();
        let Request {
            args,
            output,
            kind,
            words,
        } = request;
        let key = self.keys.of(words)?;
        let record = match Record::claim(output, *kind, &key)? {
            Claim::Finished => return Ok(Outcome::Unchanged),
            Claim::Taken => anyhow::bail!("another process is making it; wait for its end"),
            Claim::Mine(record) => record,
        };
        let cost = budget::cost(args);
        if !kept.share.as_ref().is_some_and(|share| share.covers(cost)) {
            // Nobody holds anything while he waits for more.
            *kept = Kept::default();
            kept.share = Some(self.budget.take(cost)?);
        }
        let job = Job::load(args, self.studio.cast(&args.cast)?)?;
        let clip = job.clip();
        let sink = kind.open(output, &clip)?;
        let stage = match kept.stage.take().filter(|stage| stage.suits(&job)) {
            Some(stage) => stage,
            None => Stage::new(&self.studio.gpu()?, &job)?,
        };
        let stage = kept.stage.insert(stage);
        job.export(stage, sink, &clip, &|_| ())?;
        if let Err(error) = record.finish(&key, clip.frames) {
            tracing::warn!("{error}; it will be made again next time");
        }
        Ok(Outcome::Done {
            seconds: begun.elapsed().as_secs_f64(),
            video_s: job.utterance.ticks as f64 / TICK_RATE as f64,
        })
    }
}
