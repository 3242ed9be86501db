//! Which syllables stand out: peaks of loudness among the voiced moments, judged by loudness and pitch
//! against what the voice did lately.

use super::frame::Frame;
use super::{Accent, HOP};

/// Moments that are kept: what a judgement looks back on.
const KEPT: usize = 48;
/// Moments from a peak to its judgement.
const AHEAD: usize = 10;
/// A peak is the loudest for this many moments on either side: less than half a syllable.
const ALONE: usize = 8;
/// Moments over which the voice's habits are learnt: two seconds of voice.
const HABIT: f32 = 200.0;
/// Least deviations, dB and semitones, so that a monotonous voice's ripples are no accents.
const DB_LEAST: f32 = 2.5;
const SEMITONES_LEAST: f32 = 1.2;
/// Pitch goes up by this much to a peak that it rises to, semitones (judgement: 't Hart's threshold for a
/// heard movement is about 1.5 to 3).
const RISE: f32 = 1.5;
/// Prominence from which a syllable stands out; about every third does in read speech (judgement).
const OUT: f32 = 0.35;

/// A running mean and deviation.
#[derive(Clone, Copy, Debug)]
struct Habit {
    mean: f32,
    square: f32,
    count: f32,
    least: f32,
}

impl Habit {
    const fn new(least: f32) -> Self {
        Self {
            mean: 0.0,
            square: 0.0,
            count: 0.0,
            least,
        }
    }

    fn learn(&mut self, value: f32) {
        self.count = (self.count + 1.0).min(HABIT);
        let away = value - self.mean;
        self.mean += away / self.count;
        self.square += (away * away - self.square) / self.count;
    }

    /// `value` in deviations from the mean.
    fn judge(&self, value: f32) -> f32 {
        (value - self.mean) / self.square.max(0.0).sqrt().max(self.least)
    }
}

/// Finds accents among moments.
#[derive(Clone, Debug)]
pub(super) struct Peaks {
    /// The newest last.
    kept: [Frame; KEPT],
    count: i64,
    level: Habit,
    pitch: Habit,
}

impl Peaks {
    pub(super) const fn new() -> Self {
        Self {
            kept: [Frame::SILENT; KEPT],
            count: 0,
            level: Habit::new(DB_LEAST),
            pitch: Habit::new(SEMITONES_LEAST),
        }
    }

    /// Takes a moment: its loudness, and the accent that is certain by now.
    pub(super) fn push(&mut self, frame: Frame) -> (f32, Option<Accent>) {
        self.kept.rotate_left(1);
        self.kept[KEPT - 1] = frame;
        self.count += 1;
        let mut loudness = 0.0;
        if let Some(pitch) = frame.pitch {
            self.level.learn(frame.db);
            self.pitch.learn(pitch);
            loudness = self.level.judge(frame.db).clamp(-1.0, 1.0);
        }
        (loudness, self.accent())
    }

    fn accent(&self) -> Option<Accent> {
        let at = KEPT - 1 - AHEAD;
        let here = self.kept[at];
        here.pitch?;
        let around = at - ALONE..=at + ALONE;
        let louder = |i: usize| {
            let other = self.kept[i];
            // Of equals the first.
            other.pitch.is_some() && (other.db > here.db || (other.db == here.db && i < at))
        };
        if around.clone().any(louder) {
            return None;
        }
        let highest = self.highest(at - 6..at + AHEAD);
        let before = self.before(at - 10);
        let rises = before.is_some_and(|low| highest - low >= RISE);
        let mut size = 0.5 * self.level.judge(here.db) + 0.5 * self.pitch.judge(highest);
        if rises {
            size += 0.25;
        }
        // The moment's middle is 15 ms before the end of its sound.
        let tick = (self.count - AHEAD as i64) * HOP - HOP * 3 / 2;
        (size >= OUT).then(|| Accent {
            at: tick,
            size: (size / 1.5).min(1.0),
            rises,
        })
    }

    fn highest(&self, moments: std::ops::Range<usize>) -> f32 {
        let pitches = self.kept[moments].iter().filter_map(|f| f.pitch);
        pitches.fold(0.0, f32::max)
    }

    /// The lowest pitch shortly before `end`.
    fn before(&self, end: usize) -> Option<f32> {
        let pitches = self.kept[end.saturating_sub(15)..end].iter();
        pitches.filter_map(|f| f.pitch).reduce(f32::min)
    }
}
