//! How benches compare: rivals take turns, and of each the shortest run counts. Other work on the machine only
//! ever makes a run longer, so that ratios hold where times do not.

use std::time::{Duration, Instant};

/// Turns that each rival takes.
pub(crate) const TURNS: usize = 3;
/// How long a turn is.
pub(crate) const TURN: Duration = Duration::from_millis(80);

/// The shortest of the single runs within one turn, ns.
#[allow(dead_code, reason = "each bench uses what it needs")]
pub(crate) fn shortest_ns(mut run: impl FnMut()) -> f64 {
    let begin = Instant::now();
    let mut shortest = Duration::MAX;
    while begin.elapsed() < TURN {
        let start = Instant::now();
        run();
        shortest = shortest.min(start.elapsed());
    }
    shortest.as_secs_f64() * 1e9
}

/// Whether criterion was only asked for a list or a test run.
pub(crate) fn only_asked() -> bool {
    std::env::args().any(|a| a == "--list" || a == "--test")
}
