//! What a track knows of its utterance beside phones: where it pauses, how loud it is, what is stressed.

use std::collections::VecDeque;

use mouthpiece_phonemes::{Segment, Stress};

use crate::blend::ticks;
use crate::prosody::{Accent, Delivery, HOP};
use crate::speech::Voice;

/// Silence from this length on parts phrases, ms (judgement; longer than any closure).
const PAUSE_MS: f32 = 180.0;
/// Loudness is that of so many moments on either side: it moves at the rate of syllables, 2 to 7 Hz
/// (Chandrasekaran et al. 2009).
const AROUND: i64 = 6;

/// Silences between sounds.
#[derive(Clone, Debug, Default)]
pub(super) struct Pauses {
    /// In order of time; the last may have no end yet.
    all: Vec<(i64, i64)>,
    /// Where the last sound ended.
    sound_end: Option<i64>,
}

impl Pauses {
    pub(super) fn clear(&mut self) {
        self.all.clear();
        self.sound_end = None;
    }

    /// Takes the next segment.
    pub(super) fn push(&mut self, segment: &Segment) {
        let least = ticks(PAUSE_MS);
        let since = self.sound_end.unwrap_or(i64::MIN);
        if segment.phone.is_silence() {
            let open = self.all.last().is_some_and(|p| p.1 == i64::MAX);
            if !open && segment.end.saturating_sub(since) >= least {
                self.all.push((since, i64::MAX));
            }
            return;
        }
        match self.all.last_mut() {
            Some(pause) if pause.1 == i64::MAX => pause.1 = segment.start,
            _ if segment.start.saturating_sub(since) >= least => {
                self.all.push((since, segment.start));
            }
            _ => {}
        }
        self.sound_end = Some(segment.end);
    }

    pub(super) fn near(&self, ticks: i64, reach: i64) -> impl Iterator<Item = (i64, i64)> {
        let from = ticks.saturating_sub(reach);
        let to = ticks.saturating_add(reach);
        let first = self.all.partition_point(|p| p.1 < from);
        self.all[first..]
            .iter()
            .copied()
            .take_while(move |p| p.0 <= to)
    }
}

/// What was heard of the utterance.
#[derive(Clone, Debug, Default)]
pub(super) struct Sound {
    /// The moment that `loudness` begins with.
    first: i64,
    loudness: VecDeque<f32>,
    accents: Vec<Accent>,
}

impl Sound {
    pub(super) fn hear(&mut self, delivery: &Delivery) {
        self.loudness.extend(&delivery.loudness);
        self.accents.extend(&delivery.accents);
    }

    pub(super) fn is_empty(&self) -> bool {
        self.first == 0 && self.loudness.is_empty()
    }

    pub(super) fn accents(&self, from: i64, to: i64) -> &[Accent] {
        let first = self.accents.partition_point(|a| a.at < from);
        let last = self.accents.partition_point(|a| a.at <= to);
        &self.accents[first..last.max(first)]
    }

    /// Loudness around `ticks` in deviations from the voice's mean, -1 to 1; 0 where nothing was heard.
    pub(super) fn loudness_at(&self, ticks: i64) -> f32 {
        if self.loudness.is_empty() {
            return 0.0;
        }
        // A moment's value is that of the 30 ms before its end.
        let ticks = ticks.saturating_add(HOP / 2);
        let here = ticks.div_euclid(HOP).saturating_sub(self.first);
        let share = ticks.rem_euclid(HOP) as f32 / HOP as f32;
        let (mut sum, mut weights) = (0.0, 0.0);
        for i in -AROUND..=AROUND + 1 {
            let weight = 1.0 - ((i as f32 - share) / (AROUND + 1) as f32).abs();
            let moment = usize::try_from(here.saturating_add(i)).ok();
            let value = moment.and_then(|m| self.loudness.get(m));
            sum += weight.max(0.0) * value.copied().unwrap_or(0.0);
            weights += weight.max(0.0);
        }
        sum / weights
    }

    pub(super) fn forget_before(&mut self, ticks: i64) {
        let moments = ticks.div_euclid(HOP).saturating_sub(self.first);
        let gone = usize::try_from(moments)
            .unwrap_or(0)
            .min(self.loudness.len());
        self.loudness.drain(..gone);
        self.first += gone as i64;
        let gone = self.accents.partition_point(|a| a.at < ticks);
        self.accents.drain(..gone);
    }
}

/// The opening of `segment`, by its stress.
pub(super) fn scale(voice: &Voice, segment: &Segment) -> f32 {
    let [primary, secondary, unstressed] = voice.stress;
    match segment.stress {
        _ if !segment.phone.is_vowel() => 1.0,
        Some(Stress::Primary) => primary,
        Some(Stress::Secondary) => secondary,
        Some(Stress::Unstressed) => unstressed,
        None => 1.0,
    }
}

/// A vowel that its label marks as stressed: longer ones stand out more. English raises pitch on most.
pub(super) fn marked(segment: &Segment) -> Option<Accent> {
    if segment.stress != Some(Stress::Primary) || !segment.phone.is_vowel() {
        return None;
    }
    let length = segment.duration() as f32 / ticks(200.0) as f32;
    Some(Accent {
        at: segment.start.saturating_add(segment.duration() / 2),
        size: length.clamp(0.2, 1.0),
        // Every other, by its place: labels do not say.
        rises: segment.start.div_euclid(ticks(10.0)) % 2 == 0,
    })
}
