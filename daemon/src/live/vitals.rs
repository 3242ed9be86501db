//! What the live threads say of themselves: figures that health shows and the watchdog judges by.
//!
//! One struct of atomics for the whole process, shared by `Arc`. Each group belongs to one thread, and that thread
//! alone writes it, so nothing waits for anything; whoever reads gets each figure as it was a moment
//! ago, not all of one instant. Nothing is judged here: [`health`](crate::health) does that.

use std::sync::atomic::{AtomicI64, AtomicU64, Ordering};

use mouthpiece_render::Tier;

use super::time::Origin;

/// Something that has not happened yet, where a time is asked for.
pub const NEVER: i64 = i64::MIN;

/// The figures of one process.
#[derive(Debug)]
pub struct Vitals {
    /// What its times count from.
    pub origin: Origin,
    /// Written by the main thread.
    pub window: WindowVitals,
    /// Written by the simulation thread.
    pub simulation: SimulationVitals,
    /// Written by the sound thread.
    pub sound: SoundVitals,
    /// Written by the net thread.
    pub net: NetVitals,
}

/// What is on the screen.
#[derive(Debug, Default)]
pub struct WindowVitals {
    /// Pictures that the screen took.
    pub presented: Count,
    /// When the last of them was handed over.
    pub presented_ns: Moment,
    /// When the last of them that shows another face than the one before it was.
    pub moved_ns: Moment,
    /// Time between two pictures, smoothed.
    pub interval_ns: Level,
    /// The same of each picture but the first.
    pub intervals_ns: Spread,
    /// From taking the time to having the picture handed over, ns.
    pub draw_ns: Spread,
    /// By how much the picture is later than the sound of its instant, by our own clocks, ns, smoothed; below zero it is
    /// early.
    pub skew_ns: Level,
    /// The same of each picture, without its sign.
    pub skews_ns: Spread,
    /// Times that the window had to be set up again.
    pub failures: Count,
    /// What pictures are drawn in, from 1 for low to 3 for high; 0 before the first.
    tier: Level,
}

/// How the head moves.
#[derive(Debug, Default)]
pub struct SimulationVitals {
    /// Key frames made.
    pub key_frames: Count,
    /// When the last of them that differs from the one before it was made.
    pub moved_ns: Moment,
    /// How far ahead of what is heard the simulation is, ticks.
    pub lead: Level,
    /// Times that it went back to what is heard, for `stop` and late labels.
    pub rewinds: Count,
    /// Times that it was left behind and skipped what nobody saw.
    pub skips: Count,
}

/// What is heard, and the utterances.
#[derive(Debug, Default)]
pub struct SoundVitals {
    /// What plays: a [`DeviceState`].
    device: Level,
    /// Times that a device was lost.
    pub losses: Count,
    /// Times that a device ran dry, over all devices of this process.
    pub underruns: Level,
    /// The tick that is heard.
    pub audible: Level,
    /// Utterances that were accepted and have not ended.
    pub queue: Level,
    /// Sound that they hold, ticks.
    pub held: Level,
    /// Labels that came too late for their place.
    pub dropped_labels: Count,
    /// Labels and sound that came too late, ticks.
    pub dropped: Count,
    /// Utterances accepted.
    pub begun: Count,
    /// Those that were heard to their end.
    pub finished: Count,
    /// Those that were stopped.
    pub stopped: Count,
    /// Those that ended in an error.
    pub failed: Count,
}

/// Who is connected.
#[derive(Debug, Default)]
pub struct NetVitals {
    /// Clients connected now.
    pub clients: Level,
    /// Clients that there were.
    pub connected: Count,
    /// Clients for whom there was no room.
    pub turned_away: Count,
}

/// What becomes of the sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeviceState {
    /// None is wanted: a steady clock keeps time.
    Unwanted,
    /// A device plays.
    Playing,
    /// The device is gone, or there never was one: a steady clock keeps time until there is.
    Missing,
}

impl Vitals {
    /// All at zero; times count from `origin`.
    pub fn new(origin: Origin) -> Self {
        Self {
            origin,
            window: WindowVitals::default(),
            simulation: SimulationVitals::default(),
            sound: SoundVitals::default(),
            net: NetVitals::default(),
        }
    }
}

impl WindowVitals {
    /// A picture counts one in so many.
    const SMOOTH: i64 = 16;

    /// A picture was begun at `begun_ns` and handed to the screen at `now_ns`; `moved` when it shows another face than
    /// the last one. `skew_ns` as the field's.
    pub fn shown(&self, begun_ns: i64, now_ns: i64, moved: bool, skew_ns: i64) {
        if let Some(last_ns) = self.presented_ns.get() {
            let (interval, mean) = (now_ns - last_ns, self.interval_ns.get());
            self.intervals_ns.record(interval);
            let step = if mean == 0 {
                interval
            } else {
                (interval - mean) / Self::SMOOTH
            };
            self.interval_ns.set(mean + step);
        }
        self.presented.add(1);
        self.presented_ns.set(now_ns);
        if moved {
            self.moved_ns.set(now_ns);
        }
        self.draw_ns.record(now_ns - begun_ns);
        let mean_ns = self.skew_ns.get();
        self.skew_ns
            .set(mean_ns + (skew_ns - mean_ns) / Self::SMOOTH);
        self.skews_ns.record(skew_ns.abs());
    }

    /// Says what pictures are drawn in.
    pub fn set_tier(&self, tier: Tier) {
        self.tier.set(match tier {
            Tier::Low => 1,
            Tier::Medium => 2,
            Tier::High => 3,
        });
    }

    /// What pictures are drawn in; none before the first.
    pub fn tier(&self) -> Option<Tier> {
        match self.tier.get() {
            1 => Some(Tier::Low),
            2 => Some(Tier::Medium),
            3 => Some(Tier::High),
            _ => None,
        }
    }

    /// Pictures a second: falls while none comes.
    pub fn per_second(&self, now_ns: i64) -> f64 {
        let Some(last_ns) = self.presented_ns.get() else {
            return 0.0;
        };
        let interval = self.interval_ns.get().max(now_ns - last_ns);
        if interval > 0 {
            1e9 / interval as f64
        } else {
            0.0
        }
    }
}

impl SoundVitals {
    /// What plays.
    pub fn device(&self) -> DeviceState {
        match self.device.get() {
            1 => DeviceState::Playing,
            2 => DeviceState::Missing,
            _ => DeviceState::Unwanted,
        }
    }

    /// Says what plays; a device that played and does so no more counts as lost.
    pub fn set_device(&self, state: DeviceState) {
        if state == DeviceState::Missing && self.device() == DeviceState::Playing {
            self.losses.add(1);
        }
        self.device.set(match state {
            DeviceState::Unwanted => 0,
            DeviceState::Playing => 1,
            DeviceState::Missing => 2,
        });
    }
}

/// Grows only.
#[derive(Debug, Default)]
pub struct Count(AtomicU64);

impl Count {
    pub fn add(&self, n: u64) {
        self.0.fetch_add(n, Ordering::Relaxed);
    }
    pub fn get(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }
}

/// A figure as it is now.
#[derive(Debug, Default)]
pub struct Level(AtomicI64);

impl Level {
    pub fn set(&self, value: i64) {
        self.0.store(value, Ordering::Relaxed);
    }
    pub fn add(&self, more: i64) {
        self.0.fetch_add(more, Ordering::Relaxed);
    }
    pub fn get(&self) -> i64 {
        self.0.load(Ordering::Relaxed)
    }
}

/// When something happened last, nanoseconds of the origin.
#[derive(Debug)]
pub struct Moment(AtomicI64);

impl Default for Moment {
    fn default() -> Self {
        Self(AtomicI64::new(NEVER))
    }
}

impl Moment {
    pub fn set(&self, now_ns: i64) {
        self.0.store(now_ns, Ordering::Release);
    }
    /// None: it never did.
    pub fn get(&self) -> Option<i64> {
        let ns = self.0.load(Ordering::Acquire);
        (ns != NEVER).then_some(ns)
    }
}

/// How nanoseconds, never below zero, are distributed: how many lay at or below each of [`Spread::BOUNDS_MS`], and their sum.
#[derive(Debug, Default)]
pub struct Spread {
    buckets: [AtomicU64; Self::BOUNDS_MS.len() + 1],
    sum_ns: AtomicI64,
}

impl Spread {
    /// Upper bounds, ms: a picture's time at 60, 30 and 10 a second, and the 20 ms of skew, are among them.
    pub const BOUNDS_MS: [f64; 12] = [
        1.0, 2.0, 5.0, 10.0, 16.0, 20.0, 33.0, 50.0, 80.0, 100.0, 200.0, 500.0,
    ];

    pub fn record(&self, ns: i64) {
        let ms = ns as f64 * 1e-6;
        let at = Self::BOUNDS_MS.partition_point(|bound| *bound < ms);
        self.buckets[at].fetch_add(1, Ordering::Relaxed);
        self.sum_ns.fetch_add(ns, Ordering::Relaxed);
    }

    /// How many in each bucket, the last one without a bound.
    pub fn counts(&self) -> [u64; Self::BOUNDS_MS.len() + 1] {
        std::array::from_fn(|n| self.buckets[n].load(Ordering::Relaxed))
    }

    /// All of them added up, seconds.
    pub fn sum_s(&self) -> f64 {
        self.sum_ns.load(Ordering::Relaxed) as f64 * 1e-9
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;

    #[test]
    fn the_rate_of_pictures_falls_while_none_comes() {
        let window = WindowVitals::default();
        assert!(window.per_second(0) < 1e-9);
        for n in 0..200 {
            window.shown(n * 20 * MS, (n * 20 + 5) * MS, n < 100, -3 * MS);
        }
        let last = 199 * 20 * MS + 5 * MS;
        assert!((window.per_second(last) - 50.0).abs() < 0.1);
        assert!((window.per_second(last + 2000 * MS) - 0.5).abs() < 0.01);
        assert_eq!(window.moved_ns.get(), Some((99 * 20 + 5) * MS));
        assert_eq!(window.draw_ns.counts().iter().sum::<u64>(), 200);
        assert_eq!(window.intervals_ns.counts()[5], 199);
        assert_eq!(
            (window.skews_ns.counts()[2], window.skews_ns.counts()[1]),
            (200, 0)
        );
        assert!((window.skew_ns.get() + 3 * MS).abs() < 1000);
    }

    #[test]
    fn a_value_at_a_bound_lies_below_it() {
        let spread = Spread::default();
        for ms in [0, 20, 21, 1_000] {
            spread.record(ms * MS);
        }
        let counts = spread.counts();
        assert_eq!((counts[0], counts[5], counts[6], counts[12]), (1, 1, 1, 1));
    }

    #[test]
    fn a_device_is_lost_once() {
        let sound = SoundVitals::default();
        for state in [
            DeviceState::Missing,
            DeviceState::Playing,
            DeviceState::Missing,
            DeviceState::Missing,
        ] {
            sound.set_device(state);
            assert_eq!(sound.device(), state);
        }
        assert_eq!(sound.losses.get(), 1);
    }
}
