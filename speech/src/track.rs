//! An utterance over time: segments in, controls at any tick out. For the simulation thread, which asks
//! for one tick after another or goes back, and for whoever pushes labels as they arrive.
//!
//! An evaluation allocates nothing and looks only at segments within the dominance functions' bounded
//! support. Before the first segment, after the last, and in holes between them there is silence.

use std::sync::Arc;

use mouthpiece_phonemes::Phone;
use mouthpiece_phonemes::Segment;
use mouthpiece_rig::Controls;

mod voicing;

use crate::Speech;
use crate::blend::{Blend, Piece};
use crate::contact::{self, Hold, ease};
use crate::prosody::{Accent, Delivery};
use crate::speech::Voice;
use crate::tables::Group;
use voicing::{Pauses, Sound};

/// How long before the first and after the last sound [`Track::speaking_at`] falls to nothing, ticks.
const SPEAKING_FADE: i64 = 19_200;

/// Segments in order of time, ready to be evaluated.
#[derive(Clone, Debug)]
pub struct Track {
    voice: Arc<Voice>,
    segments: Vec<Segment>,
    pieces: Vec<Piece>,
    holds: Vec<Hold>,
    pauses: Pauses,
    sound: Sound,
}

impl Track {
    /// An empty track: rest at all times.
    #[must_use]
    pub fn new(speech: &Speech) -> Self {
        Self {
            voice: speech.voice(),
            segments: Vec::new(),
            pieces: Vec::new(),
            holds: Vec::new(),
            pauses: Pauses::default(),
            sound: Sound::default(),
        }
    }

    /// Learns how the utterance sounds, from where it was heard last: louder is wider, and
    /// [`Idle::accompany`](crate::Idle::accompany) goes with what is stressed.
    pub fn hear(&mut self, delivery: &Delivery) {
        self.sound.hear(delivery);
    }

    /// Adds a segment behind the others. What overlaps the segment before begins where that ends
    /// (the reader has already complained), and what ends before it begins has no length.
    pub fn push(&mut self, segment: Segment) {
        let start = self
            .segments
            .last()
            .map_or(segment.start, |last| segment.start.max(last.end));
        let segment = Segment {
            start,
            end: segment.end.max(start),
            ..segment
        };
        self.lay_out(segment);
        self.segments.push(segment);
    }

    /// Forgets what begins at or after `ticks` and ends there what is sounding then: for `stop` and for
    /// labels that replace others.
    pub fn truncate_after(&mut self, ticks: i64) {
        let keep = self.segments.partition_point(|s| s.start < ticks);
        self.segments.truncate(keep);
        if let Some(last) = self.segments.last_mut() {
            last.end = last.end.min(ticks);
        }
        self.lay_out_again();
    }

    /// Forgets what ended so long before `ticks` that it is not felt any more, so that a process that
    /// runs for days does not grow.
    pub fn forget_before(&mut self, ticks: i64) {
        let reach = self.reach() + self.voice.windows.reach();
        let horizon = ticks.saturating_sub(reach.saturating_mul(2));
        let gone = self.segments.partition_point(|s| s.end < horizon);
        self.sound.forget_before(horizon);
        if gone > 0 {
            self.segments.drain(..gone);
            self.lay_out_again();
        }
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.segments.clear();
        self.sound = Sound::default();
        self.lay_out_again();
    }

    /// The segments as they are spoken.
    #[must_use]
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Where the first segment begins, ticks; 0 without any.
    #[must_use]
    pub fn start(&self) -> i64 {
        self.segments.first().map_or(0, |s| s.start)
    }

    /// Where the last segment ends, ticks; 0 without any.
    #[must_use]
    pub fn end(&self) -> i64 {
        self.segments.last().map_or(0, |s| s.end)
    }

    /// What the head is to be told at `ticks`, so that what is seen at `ticks` fits what is heard. Only
    /// the controls that speech drives are set; all are within their ranges.
    #[must_use]
    pub fn controls_at(&self, ticks: i64) -> Controls {
        // Told earlier by as much as the tissue is late.
        let time = ticks.saturating_add(self.voice.lag);
        let mut controls = self.blended(time);
        self.open_by_loudness(time, &mut controls);
        contact::apply(&self.voice, &self.holds, time, &mut controls);
        controls.clamped()
    }

    /// Whether something is being said at `ticks`: 1 within sounds, falling to 0 within 0.4 s of them. For
    /// [`Idle::add`](crate::Idle::add).
    #[must_use]
    pub fn speaking_at(&self, ticks: i64) -> f32 {
        let first = self
            .segments
            .partition_point(|s| s.end < ticks.saturating_sub(SPEAKING_FADE));
        self.segments[first..]
            .iter()
            .take_while(|s| s.start < ticks.saturating_add(SPEAKING_FADE))
            .filter(|s| !s.phone.is_silence())
            .map(|s| {
                let away = s
                    .start
                    .saturating_sub(ticks)
                    .max(ticks.saturating_sub(s.end))
                    .max(0);
                ease(1.0 - away as f32 / SPEAKING_FADE as f32)
            })
            .fold(0.0, f32::max)
    }

    /// How far lips touch or are about to, 0 to 1.
    #[must_use]
    pub fn contact_at(&self, ticks: i64) -> f32 {
        contact::closing(
            &self.voice,
            &self.holds,
            ticks.saturating_add(self.voice.lag),
        )
    }

    /// Stressed syllables within `reach` of `ticks`: those heard, or where no sound was heard those that
    /// labels mark.
    pub(crate) fn accents_near(&self, ticks: i64, reach: i64) -> impl Iterator<Item = Accent> {
        let (from, to) = (ticks.saturating_sub(reach), ticks.saturating_add(reach));
        let heard = self.sound.accents(from, to);
        let first = self.segments.partition_point(|s| s.end < from);
        let marked = self.segments[first..].iter();
        let silent = self.sound.is_empty();
        heard.iter().copied().chain(
            marked
                .take_while(move |s| s.start <= to)
                .filter(move |_| silent)
                .filter_map(voicing::marked),
        )
    }

    /// Pauses (start, end) within `reach` of `ticks`. The first begins at `i64::MIN`; one that no sound has
    /// followed yet ends at `i64::MAX`.
    pub(crate) fn pauses_near(&self, ticks: i64, reach: i64) -> impl Iterator<Item = (i64, i64)> {
        self.pauses.near(ticks, reach)
    }

    /// Speech that is louder opens jaw and lips further from rest, and softer less; contact comes after.
    fn open_by_loudness(&self, time: i64, controls: &mut Controls) {
        let loud = self.sound.loudness_at(time);
        if loud != 0.0 {
            let factor = 1.0 + self.voice.loudness_gain * loud;
            for group in [Group::Lips, Group::Jaw] {
                for &control in &self.voice.driven[group as usize] {
                    let rest = self.voice.rest[control];
                    controls[control] = rest + (controls[control] - rest) * factor;
                }
            }
        }
    }

    /// The plain blend, at a time that already has the tissue's lag.
    fn blended(&self, time: i64) -> Controls {
        let voice = &*self.voice;
        let mut blend = Blend::new(voice);
        let reach = self.reach();
        let (from, to) = (time.saturating_sub(reach), time.saturating_add(reach));
        let near = self.pieces.partition_point(|p| p.end < from);
        for piece in self.pieces[near..].iter().take_while(|p| p.start <= to) {
            blend.add_scaled(time, piece.core, voice.posture(piece.posture), piece.scale);
        }
        if let (Some(first), Some(last)) = (self.pieces.first(), self.pieces.last()) {
            let silence = voice.posture(voice.sound(Phone::HSharp).posture);
            let edge = voice.edges[silence.class];
            let before = (i64::MIN, first.start.saturating_sub(edge));
            let after = (last.end.saturating_add(edge), i64::MAX);
            blend.add(time, before, silence);
            blend.add(time, after, silence);
        }
        blend.controls()
    }

    /// How far from its ends a piece is felt, ticks.
    fn reach(&self) -> i64 {
        self.voice.support + self.voice.shift_max
    }

    fn lay_out_again(&mut self) {
        self.pieces.clear();
        self.holds.clear();
        self.pauses.clear();
        let segments = std::mem::take(&mut self.segments);
        for (i, &segment) in segments.iter().enumerate() {
            self.lay_out_after(i.checked_sub(1).map(|i| segments[i]), segment);
        }
        self.segments = segments;
    }

    fn lay_out(&mut self, segment: Segment) {
        self.lay_out_after(self.segments.last().copied(), segment);
    }

    /// Makes the pieces of `segment`: silence in a hole before it, a closure that it does not bring, the
    /// two halves of a diphthong.
    fn lay_out_after(&mut self, last: Option<Segment>, segment: Segment) {
        let Segment {
            phone, start, end, ..
        } = segment;
        let voice = Arc::clone(&self.voice);
        self.pauses.push(&segment);
        if let Some(last) = last
            && start.saturating_sub(last.end) > voice.gap
        {
            self.lay(last.end, start, voice.sound(Phone::HSharp).posture, 1.0);
        }
        let start = breathed(&voice, last, segment).unwrap_or(start);
        let sound = voice.sound(phone);
        let scale = voicing::scale(&voice, &segment);
        if let Some(closure) = missing_closure(&voice, last, segment) {
            let split = start + share_of(start, end, voice.hold_share);
            self.lay(start, split, closure, 1.0);
            self.lay(split, end, sound.posture, scale);
        } else if let Some((share, to)) = sound.glide {
            let split = end - share_of(start, end, share);
            self.lay(start, split, sound.posture, scale);
            self.lay(split, end, to, scale);
        } else {
            self.lay(start, end, sound.posture, scale);
        }
    }

    fn lay(&mut self, start: i64, end: i64, index: u16, scale: f32) {
        let posture = self.voice.posture(index);
        let edge = self.voice.edges[posture.class];
        if let Some(kind) = posture.kind {
            match self.holds.last_mut() {
                // /m/ before /p/ is one closure.
                Some(hold) if hold.kind == kind && hold.end >= start => {
                    hold.end = end;
                    hold.parts.1 = start;
                }
                _ => self.holds.push(Hold {
                    start,
                    end,
                    parts: (end, start),
                    kind,
                    posture: index,
                }),
            }
        }
        self.pieces.push(Piece {
            scale,
            ..Piece::new(start, end, edge, index)
        });
    }
}

/// Where the mouth of a vowel begins that an /h/ stands before: an /h/ is that vowel, breathed.
fn breathed(voice: &Voice, last: Option<Segment>, vowel: Segment) -> Option<i64> {
    let h = last.filter(|last| matches!(last.phone, Phone::Hh | Phone::Hv))?;
    let follows = vowel.start.saturating_sub(h.end) <= voice.gap;
    (follows && vowel.phone.is_vowel()).then_some(h.start)
}

/// The closure's posture, where `segment` is the release of a visible one that no label stands for:
/// engines other than TIMIT's labellers give a /p/ one label for both.
fn missing_closure(voice: &Voice, last: Option<Segment>, segment: Segment) -> Option<u16> {
    let closure = voice.sound(segment.phone.closure()?).posture;
    let kind = voice.posture(closure).kind?;
    let closed = last.is_some_and(|last| {
        last.phone.is_closure()
            && voice.posture(voice.sound(last.phone).posture).kind == Some(kind)
            && segment.start.saturating_sub(last.end) <= voice.gap
    });
    (!closed).then_some(closure)
}

/// `share` of the ticks from `start` to `end`.
fn share_of(start: i64, end: i64, share: f32) -> i64 {
    let whole = end.saturating_sub(start);
    ((whole as f64 * f64::from(share)) as i64).clamp(0, whole)
}

#[cfg(test)]
mod tests;
