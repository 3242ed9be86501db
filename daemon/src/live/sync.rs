//! A test of sound against picture that others judge: clicks, and a flash at the same audible instant.
//!
//! The clicks are an utterance like any other and the flash goes by the tick that each picture is
//! drawn for, so both take the very path that speech takes. The mouth opens with each click, too.
//! Whoever records sound and screen from outside finds how far apart they are (tests/live_sync.py).
//! `doctor --sync` records the sound itself, with [`ear`], and takes the moment at which a picture
//! was handed over for when it is seen; [`skew`] says what comes of it.

use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};
use std::time::Instant;

use anyhow::Result;
use crossbeam::queue::ArrayQueue;
use mouthpiece_phonemes::{Phone, Segment};
use mouthpiece_rig::TICK_RATE;

use super::source::Source;
use super::utterance::NOT_STARTED;

pub mod ear;
pub mod skew;

/// How long a flash and the open mouth last.
const FLASH_TICKS: i64 = TICK_RATE / 10;
/// How long a click lasts: short, for a sharp onset, long enough for a recorder at any rate.
const CLICK_TICKS: i64 = TICK_RATE * 8 / 1000;
/// Clicks are a second apart and a little more or less, so that their phase against the pictures
/// on the screen varies instead of favouring one.
const DITHER_MS: i64 = 37;

/// When the picture flashes.
#[derive(Clone, Debug)]
pub struct Flash {
    /// First tick of the clicks' utterance, once it is known.
    pub start: Arc<AtomicI64>,
    clicks: Arc<[i64]>,
    onsets: Option<Arc<Onsets>>,
    lit: bool,
    /// When the first picture of each flash was handed to the screen; without clicks known before there
    /// is room for one, and nobody asks.
    pub seen: Arc<ArrayQueue<Instant>>,
}

impl Flash {
    /// With whatever clicks are said, in any utterance.
    pub fn of_onsets(onsets: Arc<Onsets>) -> Self {
        Self {
            start: Arc::new(AtomicI64::new(NOT_STARTED)),
            clicks: Arc::default(),
            onsets: Some(onsets),
            lit: false,
            seen: Arc::new(ArrayQueue::new(1)),
        }
    }

    /// The picture of `tick` is on its way to the screen.
    pub fn shown(&mut self, tick: i64) {
        let lit = self.is_lit(tick);
        if lit && !self.lit {
            // There is room for as many as there are clicks.
            let _ = self.seen.push(Instant::now());
        }
        self.lit = lit;
    }

    /// Whether the picture of `tick` flashes.
    pub fn is_lit(&self, tick: i64) -> bool {
        if let Some(onsets) = &self.onsets {
            return onsets.is_lit(tick);
        }
        let start = self.start.load(Ordering::Acquire);
        let Some(local) = tick.checked_sub(start).filter(|_| start != NOT_STARTED) else {
            return false;
        };
        let next = self.clicks.partition_point(|c| *c <= local);
        next > 0 && local - self.clicks[next - 1] < FLASH_TICKS
    }
}

/// Louder than this is a click, in what tests have a face say.
const LOUD: f32 = 0.5;
/// And it is a new one after so long without.
const QUIET_TICKS: i64 = TICK_RATE / 5;
/// How long a click flashes here: a busy machine may take a tenth of a second for a picture, and each click is to
/// be seen.
const ONSET_FLASH_TICKS: i64 = TICK_RATE / 5;
/// Clicks that are remembered: more than are mixed ahead of the picture.
const KEPT: usize = 8;

/// Clicks in what is said, found while it is mixed: written by the sound thread, read by the one that draws.
#[derive(Debug)]
pub struct Onsets([AtomicI64; KEPT]);

impl Default for Onsets {
    fn default() -> Self {
        Self(std::array::from_fn(|_| AtomicI64::new(NOT_STARTED)))
    }
}

impl Onsets {
    fn is_lit(&self, tick: i64) -> bool {
        let started = self.0.iter().map(|o| o.load(Ordering::Acquire));
        started
            .filter(|o| *o != NOT_STARTED)
            .any(|o| (0..ONSET_FLASH_TICKS).contains(&(tick - o)))
    }
}

/// The sound thread's end of [`Onsets`].
#[derive(Debug)]
pub struct Listening {
    onsets: Arc<Onsets>,
    next: usize,
    loud: i64,
}

impl Listening {
    pub fn new(onsets: Arc<Onsets>) -> Self {
        Self {
            onsets,
            next: 0,
            loud: i64::MIN / 2,
        }
    }

    /// Takes in what is heard from tick `at` on.
    pub fn hear(&mut self, at: i64, block: &[f32]) {
        for (tick, sample) in (at..).zip(block) {
            if sample.abs() > LOUD {
                if tick - self.loud > QUIET_TICKS {
                    self.onsets.0[self.next].store(tick, Ordering::Release);
                    self.next = (self.next + 1) % KEPT;
                }
                self.loud = tick;
            }
        }
    }
}

/// `seconds` of clicks as something to say, and the flashes that go with them.
pub fn clicks(seconds: u32) -> Result<(Source, Flash)> {
    let clicks: Vec<i64> = (0..i64::from(seconds))
        .map(|n| (n + 1) * TICK_RATE + (n * 13 % DITHER_MS) * TICK_RATE / 1000)
        .collect();
    let ticks = (i64::from(seconds) + 2) * TICK_RATE;
    let mut sound = vec![0.0_f32; usize::try_from(ticks)?];
    let mut segments = Vec::new();
    let mut quiet_from = 0;
    for &click in &clicks {
        let from = usize::try_from(click)?;
        for (n, sample) in sound[from..][..usize::try_from(CLICK_TICKS)?]
            .iter_mut()
            .enumerate()
        {
            // 2 kHz, square: as loud in its first sample as in any.
            *sample = if n / 12 % 2 == 0 { 0.7 } else { -0.7 };
        }
        segments.push(Segment::new(Phone::Pau, quiet_from, click));
        segments.push(Segment::new(Phone::Aa, click, click + FLASH_TICKS));
        quiet_from = click + FLASH_TICKS;
    }
    segments.push(Segment::new(Phone::HSharp, quiet_from, ticks));
    let flash = Flash {
        start: Arc::new(AtomicI64::new(NOT_STARTED)),
        lit: false,
        seen: Arc::new(ArrayQueue::new(clicks.len().max(1))),
        clicks: clicks.into(),
        onsets: None,
    };
    Ok((Source::of(segments, Some(sound))?, flash))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clicks_in_what_is_said_flash_for_as_long() {
        let onsets = Arc::new(Onsets::default());
        let flash = Flash::of_onsets(Arc::clone(&onsets));
        let mut listening = Listening::new(onsets);
        let mut block = [0.1; 480];
        block[100..300].fill(-0.7);
        listening.hear(9_600, &block);
        let from = 9_700;
        let lit = [
            from - 1,
            from,
            from + ONSET_FLASH_TICKS - 1,
            from + ONSET_FLASH_TICKS,
        ];
        assert_eq!(
            lit.map(|tick| flash.is_lit(tick)),
            [false, true, true, false]
        );
    }

    #[test]
    fn it_flashes_from_each_click_on_and_not_before_the_start_is_known() {
        let (_, mut flash) = clicks(3).unwrap();
        let at = flash.clicks[1];
        assert!(!flash.is_lit(at));
        flash.start.store(1000, Ordering::Release);
        let lit = |tick: i64| flash.is_lit(1000 + tick);
        assert!(!lit(at - 1) && lit(at) && lit(at + FLASH_TICKS - 1) && !lit(at + FLASH_TICKS));
        for tick in [
            at - 1,
            at + 9,
            at + 10,
            at + FLASH_TICKS,
            at + 2 * TICK_RATE,
        ] {
            flash.shown(1000 + tick);
        }
        assert_eq!(flash.seen.len(), 1);
    }
}
