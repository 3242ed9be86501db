//! What a label says: phones and words with times.
//!
//! The plain types that go from every reader to speech. Times are ticks of 48 kHz, ends exclusive.

use serde::{Deserialize, Serialize};

use crate::{Note, Phone};

/// Stress of the syllable that a phone belongs to, as the CMU dictionary marks it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Stress {
    /// ARPAbet's 0.
    Unstressed,
    /// ARPAbet's 1.
    Primary,
    /// ARPAbet's 2.
    Secondary,
}

/// One phone and when it sounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Segment {
    /// What sounds.
    pub phone: Phone,
    /// First tick, of [`TICK_RATE`](crate::TICK_RATE).
    pub start: i64,
    /// The tick after the last.
    pub end: i64,
    /// Stress, where the source says it; TIMIT does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stress: Option<Stress>,
}

impl Segment {
    /// A segment without stress.
    pub const fn new(phone: Phone, start: i64, end: i64) -> Self {
        Self {
            phone,
            start,
            end,
            stress: None,
        }
    }

    /// Ticks from start to end.
    pub const fn duration(&self) -> i64 {
        self.end - self.start
    }

    /// Whether `tick` lies inside.
    pub const fn contains(&self, tick: i64) -> bool {
        self.start <= tick && tick < self.end
    }
}

/// One word and when it sounds. Neighbours may share sounds, so words may overlap.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Word {
    /// The word as the source spells it.
    pub text: String,
    /// First tick, of [`TICK_RATE`](crate::TICK_RATE).
    pub start: i64,
    /// The tick after the last.
    pub end: i64,
}

/// All that one label file said.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Labels {
    /// Phones in order of time, none overlapping; there may be gaps.
    pub segments: Vec<Segment>,
    /// Words in order of their start, where the source has them.
    #[serde(default)]
    pub words: Vec<Word>,
    /// What the reader had to guess or change.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<Note>,
}

impl Labels {
    /// The tick after the last label; 0 when there is none.
    pub fn end(&self) -> i64 {
        let phones = self.segments.last().map_or(0, |s| s.end);
        let words = self.words.iter().map(|w| w.end).max().unwrap_or(0);
        phones.max(words)
    }

    /// The segment that sounds at `tick`.
    pub fn segment_at(&self, tick: i64) -> Option<&Segment> {
        let after = self.segments.partition_point(|s| s.end <= tick);
        self.segments.get(after).filter(|s| s.contains(tick))
    }
}
