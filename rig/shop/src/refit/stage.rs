//! The stages of a fit: in words for who waits, in seconds for the report.

use std::time::Instant;

/// What is being done, for who shows progress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names say it")]
pub enum Stage {
    Prepare,
    Skin,
    Parts,
    Colour,
    Measure,
}

impl Stage {
    /// All of them, in order.
    pub const ALL: [Self; 5] = [
        Self::Prepare,
        Self::Skin,
        Self::Parts,
        Self::Colour,
        Self::Measure,
    ];

    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Prepare => "looking at the scan",
            Self::Skin => "fitting the skin",
            Self::Parts => "bones, eyes, mouth and hair follow",
            Self::Colour => "colour",
            Self::Measure => "measuring",
        }
    }
}

/// Wall clock, stage by stage.
pub(super) struct Clock {
    begun: Instant,
    last: Instant,
}

impl Clock {
    pub(super) fn new() -> Self {
        let begun = Instant::now();
        Self { begun, last: begun }
    }

    /// Seconds since the last lap.
    pub(super) fn lap(&mut self) -> f64 {
        let last = std::mem::replace(&mut self.last, Instant::now());
        (self.last - last).as_secs_f64()
    }

    /// Seconds since the beginning.
    pub(super) fn total(&self) -> f64 {
        self.begun.elapsed().as_secs_f64()
    }
}
