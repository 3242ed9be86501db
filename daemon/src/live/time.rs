//! Nanoseconds since the process started, and ticks: the two integer times of the live threads.

use std::time::{Duration, Instant};

use mouthpiece_rig::TICK_RATE;

/// Where this process's nanoseconds count from; every thread has the same one.
#[derive(Clone, Copy, Debug)]
pub struct Origin(Instant);

impl Origin {
    pub fn new() -> Self {
        Self(Instant::now())
    }

    /// Nanoseconds since the origin; 292 years fit.
    pub fn now_ns(self) -> i64 {
        i64::try_from(self.0.elapsed().as_nanos()).unwrap_or(i64::MAX)
    }

    /// The instant that is `ns` after the origin.
    pub fn instant(self, ns: i64) -> Instant {
        self.0 + Duration::from_nanos(u64::try_from(ns).unwrap_or(0))
    }
}

/// 48 kHz and 1 GHz have 16 kHz in common: 3 ticks are 62,500 ns.
const TICKS: i64 = 3;
const NS: i64 = 62_500;
const _: () = assert!(TICKS * 1_000_000_000 == NS * TICK_RATE);

/// The last tick at or before `ns`.
pub const fn ticks_from_ns(ns: i64) -> i64 {
    // Divided first, so that no span of a process's life overflows.
    ns.div_euclid(NS) * TICKS + ns.rem_euclid(NS) * TICKS / NS
}

/// The first nanosecond at or after `ticks`.
pub const fn ns_from_ticks(ticks: i64) -> i64 {
    ticks.div_euclid(TICKS) * NS + (ticks.rem_euclid(TICKS) * NS + TICKS - 1) / TICKS
}

/// Ticks of `frames` at `rate` Hz, the nearest below.
pub fn ticks_from_frames(frames: i64, rate: u32) -> i64 {
    let rate = i64::from(rate.max(1));
    frames.div_euclid(rate) * TICK_RATE + frames.rem_euclid(rate) * TICK_RATE / rate
}

/// Seconds, for people.
pub fn seconds(ticks: i64) -> f64 {
    ticks as f64 / TICK_RATE as f64
}

/// What a thread's `step` asks of the loop that calls it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// Call again at once.
    Continue,
    /// Call again after this long, or earlier when unparked.
    Wait(Duration),
    /// The thread's work is over.
    End,
}

/// Calls `step` until it ends; between calls the thread is parked, never spinning.
pub fn drive(mut step: impl FnMut() -> Flow) {
    loop {
        match step() {
            Flow::Continue => {}
            Flow::Wait(time) => std::thread::park_timeout(time),
            Flow::End => return,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn ticks_survive_nanoseconds(ticks in -1_000_000_000_000_i64..1_000_000_000_000) {
            prop_assert_eq!(ticks_from_ns(ns_from_ticks(ticks)), ticks);
            prop_assert_eq!(ticks_from_ns(ns_from_ticks(ticks) - 1), ticks - 1);
        }
    }

    #[test]
    fn frames_of_any_device_rate_become_ticks() {
        assert_eq!(
            ticks_from_frames(44_100 * 7 + 441, 44_100),
            48_000 * 7 + 480
        );
        assert_eq!(ticks_from_frames(-44_100, 44_100), -48_000);
        assert_eq!(
            ticks_from_frames(i64::MAX / 48_000, 48_000),
            i64::MAX / 48_000
        );
    }
}
