//! A track whose labels arrive while it is spoken.
//!
//! What a listener to a source hears that gives each label so long before it is spoken: nothing jumps,
//! and what is known later changes what is shown later only. For `curves --look-ahead`, which tells what
//! a shorter look-ahead costs; the live face does the same with cues ([`Correction`] is what they share).

use mouthpiece_phonemes::Segment;
use mouthpiece_rig::Controls;

use crate::Speech;
use crate::correction::Correction;
use crate::track::Track;

/// An utterance as it becomes known.
#[derive(Clone, Debug)]
pub struct Stream {
    track: Track,
    correction: Correction,
}

impl Stream {
    /// Nothing is known yet.
    #[must_use]
    pub fn new(speech: &Speech) -> Self {
        Self {
            track: Track::new(speech),
            correction: Correction::default(),
        }
    }

    /// Learns at `now` what comes behind the labels that it has.
    pub fn learn(&mut self, segments: &[Segment], now: i64) {
        if segments.is_empty() {
            return;
        }
        let told = self.controls_at(now);
        for &segment in segments {
            self.track.push(segment);
        }
        let known = self.track.controls_at(now);
        self.correction = Correction::new(now, &told, &known);
    }

    /// What the head is to be told at `ticks`, for all that is known.
    #[must_use]
    pub fn controls_at(&self, ticks: i64) -> Controls {
        let mut controls = self.track.controls_at(ticks);
        self.correction.add(ticks, &mut controls);
        controls
    }

    /// What is known.
    #[must_use]
    pub const fn track(&self) -> &Track {
        &self.track
    }

    /// The same, for what is heard of it or forgotten.
    pub const fn track_mut(&mut self) -> &mut Track {
        &mut self.track
    }
}

/// An utterance given out label by label: each so long before it begins.
#[derive(Clone, Debug)]
pub struct LookAhead {
    stream: Stream,
    coming: Vec<Segment>,
    next: usize,
    ticks: i64,
}

impl LookAhead {
    /// Gives out `segments`, in order of time, `ticks` before each begins.
    #[must_use]
    pub fn new(speech: &Speech, segments: &[Segment], ticks: i64) -> Self {
        Self {
            stream: Stream::new(speech),
            coming: segments.to_vec(),
            next: 0,
            ticks: ticks.max(0),
        }
    }

    /// Goes on to `now`: labels whose time has come are known from now on.
    pub fn advance(&mut self, now: i64) {
        let until = now.saturating_add(self.ticks);
        let rest = &self.coming[self.next..];
        let count = rest.iter().take_while(|s| s.start <= until).count();
        let news = &self.coming[self.next..self.next + count];
        self.stream.learn(news, now);
        self.next += count;
    }

    /// What is known by now.
    #[must_use]
    pub const fn stream(&self) -> &Stream {
        &self.stream
    }

    /// The same, for what is heard of it.
    pub const fn stream_mut(&mut self) -> &mut Stream {
        &mut self.stream
    }
}

#[cfg(test)]
mod tests;
