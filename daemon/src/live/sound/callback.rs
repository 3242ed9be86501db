//! What the sound device calls, on its own thread: no lock, no allocation, no logging, no panic.
//!
//! Takes frames out of the ring, counts them, and publishes which tick leaves the device when. Time
//! is what was taken out of the ring: when the ring runs dry there is silence and time stands.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicI64, AtomicU64, Ordering};

use rtrb::Consumer;

use crate::live::clock::{ClockCell, Stamp};
use crate::live::time::ticks_from_frames;

/// Seconds over which sound that is stopped fades out, so that it does not click.
const FADE_S: f32 = 0.005;
/// A device that has failed for this long and not asked for sound in between is gone, whatever it calls its errors:
/// ALSA's PulseAudio plugin reports a plain input/output error, again and again, once its server has died.
const FAILING_NS: i64 = 300_000_000;

/// What the callback and the sound thread tell each other.
#[derive(Debug, Default)]
pub(super) struct Link {
    /// Frames before this one are silent though they count: written by the sound thread to stop what
    /// it handed over already.
    pub(super) silent_until: AtomicI64,
    /// Frames taken out of the ring so far: written by the callback.
    pub(super) taken: AtomicI64,
    /// How long after the last callback its first frame is heard, as the device says: written by the
    /// callback.
    pub(super) latency_ns: AtomicI64,
    /// Callbacks that found too little in the ring.
    pub(super) underruns: AtomicU64,
    /// The device says that it is gone or must be opened anew.
    pub(super) lost: AtomicBool,
    /// When the first error since the last callback came, running dry apart; 0: there was none.
    failing_since_ns: AtomicI64,
    /// The tick of the first frame that is taken: written by the sound thread before `on_air`.
    pub(super) base: AtomicI64,
    /// This device keeps the clock: written by the sound thread. Before, it plays silence and says
    /// nothing; nor does one that was given up and wakes up again.
    pub(super) on_air: AtomicBool,
}

impl Link {
    /// Takes in an error that the device reports at `now_ns`; never waits, never allocates.
    pub(super) fn failed(&self, now_ns: i64) {
        match self.failing_since_ns.load(Ordering::Relaxed) {
            0 => self.failing_since_ns.store(now_ns, Ordering::Relaxed),
            since_ns if now_ns - since_ns > FAILING_NS => self.lost.store(true, Ordering::Release),
            _ => {}
        }
    }
}

/// The callback's state.
pub(super) struct Callback {
    pub(super) ring: Consumer<f32>,
    pub(super) link: Arc<Link>,
    pub(super) cell: Arc<ClockCell>,
    pub(super) rate: u32,
    pub(super) channels: usize,
    taken: i64,
    gain: f32,
}

impl Callback {
    pub(super) fn new(
        ring: Consumer<f32>,
        link: Arc<Link>,
        cell: Arc<ClockCell>,
        rate: u32,
        channels: usize,
    ) -> Self {
        Self {
            ring,
            link,
            cell,
            rate,
            channels,
            taken: 0,
            gain: 1.0,
        }
    }

    /// Fills `out`, which is silent already, with frames that are heard from `playback_ns` on.
    pub(super) fn fill<T: Copy>(
        &mut self,
        out: &mut [T],
        playback_ns: i64,
        sample: impl Fn(f32) -> T,
    ) {
        self.link.failing_since_ns.store(0, Ordering::Relaxed);
        if !self.link.on_air.load(Ordering::Acquire) {
            return;
        }
        let base = self.link.base.load(Ordering::Relaxed);
        let wanted = out.len() / self.channels.max(1);
        let frames = self.ring.slots().min(wanted);
        let silent_until = self.link.silent_until.load(Ordering::Acquire);
        let fade = 1.0 / (FADE_S * self.rate as f32);
        let first = self.taken;
        for frame in out.chunks_exact_mut(self.channels.max(1)).take(frames) {
            let Ok(value) = self.ring.pop() else { break };
            let goal: f32 = if self.taken < silent_until { 0.0 } else { 1.0 };
            self.gain += (goal - self.gain).clamp(-fade, fade);
            frame.fill(sample(value * self.gain));
            self.taken += 1;
        }
        if frames < wanted {
            self.link.underruns.fetch_add(1, Ordering::Relaxed);
        }
        self.link.taken.store(self.taken, Ordering::Release);
        self.cell.publish(Stamp {
            first: base + ticks_from_frames(first, self.rate),
            end: base + ticks_from_frames(self.taken, self.rate),
            playback_ns,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rig(rate: u32) -> (rtrb::Producer<f32>, Callback) {
        let (tx, rx) = rtrb::RingBuffer::new(10_000);
        let callback = Callback::new(
            rx,
            Arc::new(Link::default()),
            Arc::new(ClockCell::default()),
            rate,
            2,
        );
        callback.link.base.store(1_000, Ordering::Relaxed);
        callback.link.on_air.store(true, Ordering::Release);
        (tx, callback)
    }

    #[test]
    fn every_channel_gets_the_sound_and_the_clock_its_ticks() {
        let (mut tx, mut callback) = rig(24_000);
        tx.push_entire_slice(&[0.5; 300]).unwrap();
        let mut out = [0.0_f32; 400];
        callback.fill(&mut out, 77, |x| x);
        assert_eq!(out, [0.5; 400]);
        let (_, stamp) = callback.cell.read().unwrap();
        assert_eq!(
            (stamp.first, stamp.end, stamp.playback_ns),
            (1000, 1400, 77)
        );
    }

    #[test]
    fn who_is_not_on_air_says_nothing_and_takes_nothing() {
        let (mut tx, mut callback) = rig(48_000);
        callback.link.on_air.store(false, Ordering::Release);
        tx.push_entire_slice(&[0.5; 300]).unwrap();
        let mut out = [0.0_f32; 400];
        callback.fill(&mut out, 77, |x| x);
        assert_eq!(out, [0.0; 400]);
        assert_eq!(callback.cell.read(), None);
        assert_eq!(tx.slots(), 10_000 - 300);
    }

    #[test]
    fn a_device_that_only_fails_is_lost_and_one_that_goes_on_is_not() {
        let (_tx, mut callback) = rig(48_000);
        let lost = |callback: &Callback| callback.link.lost.load(Ordering::Acquire);
        for now_ns in [1, FAILING_NS, 3 * FAILING_NS] {
            callback.link.failed(now_ns);
            callback.link.failed(now_ns + FAILING_NS);
            assert!(!lost(&callback));
            callback.fill(&mut [0.0_f32; 4], 0, |x| x);
        }
        callback.link.failed(1);
        callback.link.failed(2 + FAILING_NS);
        assert!(lost(&callback));
    }

    #[test]
    fn a_dry_ring_is_silent_and_stops_time() {
        let (mut tx, mut callback) = rig(48_000);
        tx.push_entire_slice(&[0.5; 50]).unwrap();
        let mut out = [0_i16; 400];
        callback.fill(&mut out, 0, |x| (x * 100.0) as i16);
        assert_eq!((out[99], out[100]), (50, 0));
        let (_, stamp) = callback.cell.read().unwrap();
        assert_eq!(stamp.end, 1050);
        assert_eq!(callback.link.underruns.load(Ordering::Relaxed), 1);
    }

    #[test]
    fn what_is_stopped_fades_within_five_milliseconds_and_time_goes_on() {
        let (mut tx, mut callback) = rig(48_000);
        tx.push_entire_slice(&[0.5; 2_000]).unwrap();
        callback.link.silent_until.store(1_500, Ordering::Release);
        let mut out = [0.0_f32; 4_000];
        callback.fill(&mut out, 0, |x| x);
        assert!(out[..4].iter().all(|x| *x > 0.4), "faded, not cut");
        assert!(out[2 * 241..2 * 1500].iter().all(|x| *x == 0.0));
        assert!(out[2 * 1760..].iter().all(|x| (*x - 0.5).abs() < 1e-3));
        let (_, stamp) = callback.cell.read().unwrap();
        assert_eq!(stamp.end, 3_000);
    }
}
