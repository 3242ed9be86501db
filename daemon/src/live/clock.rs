//! The one clock: which tick the listener hears now.
//!
//! Wanted: what is read never goes back, never runs ahead of what the device was given, is right
//! within a millisecond or two when the device's stamps jitter, recovers by itself when stamps are
//! wrong or the device stalls, and reading never waits for the audio callback.
//!
//! So the callback publishes a [`Stamp`] per buffer into a [`ClockCell`] (a sequence lock made of
//! atomics: one writer, which never waits; readers try again), and each reading thread owns an
//! [`AudibleClock`], which smooths the stamps it saw. Without a device the sound thread publishes
//! the stamps of a steady clock into the same cell; readers see no difference.

use std::sync::Arc;
use std::sync::atomic::{AtomicI64, AtomicU64, Ordering, fence};

use super::time::{ns_from_ticks, ticks_from_ns};

/// What is known of one buffer: which ticks it holds and when the first of them is heard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    /// First tick of the buffer.
    pub first: i64,
    /// The tick after its last: all that was handed over.
    pub end: i64,
    /// When `first` leaves the device, in nanoseconds of [`Origin`](super::time::Origin).
    pub playback_ns: i64,
}

/// The last stamp, shared. One thread writes at any time.
#[derive(Debug, Default)]
pub struct ClockCell {
    /// Odd while a stamp is being written; twice the number of stamps otherwise.
    sequence: AtomicU64,
    first: AtomicI64,
    end: AtomicI64,
    playback_ns: AtomicI64,
}

impl ClockCell {
    /// Replaces the stamp. Called by the one writer; never waits, never allocates.
    pub fn publish(&self, stamp: Stamp) {
        let sequence = self.sequence.load(Ordering::Relaxed);
        self.sequence
            .store(sequence.wrapping_add(1), Ordering::Relaxed);
        // Readers that see any of the new values below also see the odd number above.
        fence(Ordering::Release);
        self.first.store(stamp.first, Ordering::Relaxed);
        self.end.store(stamp.end, Ordering::Relaxed);
        self.playback_ns.store(stamp.playback_ns, Ordering::Relaxed);
        self.sequence
            .store(sequence.wrapping_add(2), Ordering::Release);
    }

    /// How many stamps there were, and the last; `None` before the first.
    pub fn read(&self) -> Option<(u64, Stamp)> {
        loop {
            let before = self.sequence.load(Ordering::Acquire);
            let stamp = Stamp {
                first: self.first.load(Ordering::Relaxed),
                end: self.end.load(Ordering::Relaxed),
                playback_ns: self.playback_ns.load(Ordering::Relaxed),
            };
            fence(Ordering::Acquire);
            let after = self.sequence.load(Ordering::Relaxed);
            if before == after && before.is_multiple_of(2) {
                return (before > 0).then_some((before / 2, stamp));
            }
            std::hint::spin_loop();
        }
    }

    /// How many stamps there were.
    pub fn count(&self) -> u64 {
        self.sequence.load(Ordering::Acquire) / 2
    }
}

/// Stamps whose median is believed: outvotes seven wrong ones, a third of a second at 20 ms each.
const WINDOW: usize = 15;
/// This many stamps that agree with each other against the window are a jump, not jitter.
const JUMP_STAMPS: usize = 4;
/// How closely they must agree, and how far from the window they must lie.
const JUMP_AGREE_NS: i64 = 10_000_000;
const JUMP_NS: i64 = 40_000_000;
/// How fast smoothing follows the median: slow against jitter, fast against a quartz's drift.
const FOLLOW_NS: i64 = 400_000_000;

/// One thread's view of the clock.
#[derive(Debug)]
pub struct AudibleClock {
    cell: Arc<ClockCell>,
    seen: u64,
    /// Speech time minus process time by each of the last stamps, ns, oldest first.
    offsets: [i64; WINDOW],
    known: usize,
    /// The smoothed one, and when it was last moved.
    offset: Option<(i64, i64)>,
    /// What was read last.
    last: i64,
}

impl AudibleClock {
    pub fn new(cell: Arc<ClockCell>) -> Self {
        Self {
            cell,
            seen: 0,
            offsets: [0; WINDOW],
            known: 0,
            offset: None,
            last: 0,
        }
    }

    /// The tick that is heard at `now_ns`; stands still until there is a first stamp and when
    /// nothing is handed over any more.
    pub fn at(&mut self, now_ns: i64) -> i64 {
        let Some((count, stamp)) = self.cell.read() else {
            return self.last;
        };
        if count != self.seen {
            self.seen = count;
            self.learn(ns_from_ticks(stamp.first).saturating_sub(stamp.playback_ns));
        }
        let offset = self.smoothed(now_ns);
        let heard = ticks_from_ns(now_ns.saturating_add(offset)).min(stamp.end);
        self.last = self.last.max(heard);
        self.last
    }

    /// Takes in what one stamp says.
    fn learn(&mut self, offset: i64) {
        if self.known == WINDOW {
            self.offsets.rotate_left(1);
            self.known -= 1;
        }
        self.offsets[self.known] = offset;
        self.known += 1;
        let recent = &self.offsets[self.known.saturating_sub(JUMP_STAMPS)..self.known];
        let (low, high) = recent
            .iter()
            .fold((i64::MAX, i64::MIN), |(l, h), &o| (l.min(o), h.max(o)));
        if recent.len() == JUMP_STAMPS
            && high - low < JUMP_AGREE_NS
            && (median(&self.offsets[..self.known]) - low).abs() > JUMP_NS
        {
            self.offsets
                .copy_within(self.known - JUMP_STAMPS..self.known, 0);
            self.known = JUMP_STAMPS;
        }
    }

    /// The offset to use at `now_ns`: glides to the median, or jumps when that is far.
    fn smoothed(&mut self, now_ns: i64) -> i64 {
        let target = median(&self.offsets[..self.known]);
        let (offset, moved_ns) = self.offset.unwrap_or((target, now_ns));
        let behind = target - offset;
        let elapsed = (now_ns - moved_ns).clamp(0, FOLLOW_NS);
        let next = if behind.abs() > JUMP_NS {
            target
        } else {
            offset + behind * elapsed / FOLLOW_NS
        };
        self.offset = Some((next, now_ns));
        next
    }
}

/// The middle value; 0 of none.
fn median(values: &[i64]) -> i64 {
    let mut sorted = [0_i64; WINDOW];
    let sorted = &mut sorted[..values.len()];
    sorted.copy_from_slice(values);
    sorted.sort_unstable();
    sorted.get(values.len() / 2).copied().unwrap_or(0)
}

#[cfg(test)]
mod tests;
