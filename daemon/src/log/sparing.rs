//! Lines that repeat: the first few are written, the rest of ten seconds are counted.

use std::collections::HashMap;
use std::fmt;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use tracing::callsite::Identifier;
use tracing::{Event, Level, Metadata, Subscriber};
use tracing_subscriber::fmt::format::Writer;
use tracing_subscriber::fmt::{FmtContext, FormatEvent, FormatFields};
use tracing_subscriber::registry::LookupSpan;

/// Lines of one place in the source that are written within [`SPAN`]: enough to see what goes on.
const LINES_MAX: u32 = 5;
const SPAN: Duration = Duration::from_secs(10);

/// Writes events as `format` does, those that repeat sparingly.
#[derive(Debug)]
pub struct Sparing<F> {
    format: F,
    json: bool,
    /// As many as there are places in the source that log.
    places: Mutex<HashMap<Identifier, Place>>,
}

/// A place in the source that logs.
#[derive(Clone, Copy, Debug)]
struct Place {
    since: Instant,
    written: u32,
    left_out: u64,
}

impl<F> Sparing<F> {
    pub fn new(format: F, json: bool) -> Self {
        Self {
            format,
            json,
            places: Mutex::default(),
        }
    }

    /// Whether a line of this place is written now, and how many were left out before it.
    fn turn(&self, metadata: &Metadata<'_>, now: Instant) -> Option<u64> {
        if *metadata.level() > Level::INFO {
            return Some(0); // who asks for details gets all of them
        }
        let Ok(mut places) = self.places.lock() else {
            return Some(0);
        };
        let place = places.entry(metadata.callsite()).or_insert(Place {
            since: now,
            written: 0,
            left_out: 0,
        });
        place.turn(now)
    }
}

impl Place {
    fn turn(&mut self, now: Instant) -> Option<u64> {
        let mut left_out = 0;
        if now.duration_since(self.since) >= SPAN {
            left_out = self.left_out;
            *self = Self {
                since: now,
                written: 0,
                left_out: 0,
            };
        }
        if self.written == LINES_MAX {
            self.left_out += 1;
            return None;
        }
        self.written += 1;
        Some(left_out)
    }
}

impl<S, N, F> FormatEvent<S, N> for Sparing<F>
where
    S: Subscriber + for<'a> LookupSpan<'a>,
    N: for<'a> FormatFields<'a> + 'static,
    F: FormatEvent<S, N>,
{
    fn format_event(
        &self,
        context: &FmtContext<'_, S, N>,
        mut writer: Writer<'_>,
        event: &Event<'_>,
    ) -> fmt::Result {
        let metadata = event.metadata();
        let Some(left_out) = self.turn(metadata, Instant::now()) else {
            return Ok(()); // nothing to write
        };
        if left_out > 0 {
            let (level, target) = (metadata.level(), metadata.target());
            if self.json {
                writeln!(
                    writer,
                    r#"{{"level":"{level}","target":"{target}","message":"lines like the next one were left out","left_out":{left_out}}}"#
                )?;
            } else {
                writeln!(
                    writer,
                    "{level} {target}: {left_out} lines like the next one were left out"
                )?;
            }
        }
        self.format.format_event(context, writer, event)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fault_that_repeats_is_written_five_times_in_ten_seconds_and_counted() {
        let start = Instant::now();
        let mut place = Place {
            since: start,
            written: 0,
            left_out: 0,
        };
        let turns: Vec<_> = (0..100)
            .filter_map(|n| place.turn(start + Duration::from_millis(150 * n)))
            .collect();
        // 67 of them in the first ten seconds, 33 in the next five.
        assert_eq!(turns, [0, 0, 0, 0, 0, 62, 0, 0, 0, 0]);
    }
}
