//! How fast a client may send: a bucket that fills steadily and may be emptied at once.

use std::time::Duration;

use tokio::time::Instant;

/// What may come at once, seconds' worth: a sentence's labels in one go.
const BURST_S: f64 = 2.0;

/// A bucket.
#[derive(Debug)]
pub struct Rate {
    per_second: f64,
    left: f64,
    since: Instant,
}

impl Rate {
    pub fn new(per_second: u32, now: Instant) -> Self {
        let per_second = f64::from(per_second.max(1));
        Self {
            per_second,
            left: per_second * BURST_S,
            since: now,
        }
    }

    /// Takes `amount` out, if need be in advance; says how long to take no more.
    pub fn take(&mut self, amount: f64, now: Instant) -> Duration {
        let gained = now.duration_since(self.since).as_secs_f64() * self.per_second;
        self.left = (self.left + gained).min(self.per_second * BURST_S) - amount;
        self.since = now;
        // The amount is bounded by what is read at once, so that this is finite.
        Duration::from_secs_f64((-self.left / self.per_second).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_burst_is_free_and_what_is_beyond_waits_as_long_as_it_takes() {
        let mut now = Instant::now();
        let mut rate = Rate::new(100, now);
        assert_eq!(rate.take(200.0, now), Duration::ZERO);
        assert_eq!(rate.take(50.0, now), Duration::from_millis(500));
        now += Duration::from_millis(500);
        assert_eq!(rate.take(0.0, now), Duration::ZERO);
        // An hour of silence is worth no more than a burst.
        now += Duration::from_secs(3600);
        assert_eq!(rate.take(300.0, now), Duration::from_secs(1));
    }
}
