//! What the sound thread goes by when several clients speak, and how much it holds.

use mouthpiece_rig::TICK_RATE;

use crate::config::{Config, Turns};

/// An utterance that has not begun may get nothing for so many times as long as one that speaks: its
/// client may still be thinking about the words.
const PATIENT: i64 = 3;

/// The rules.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Rules {
    /// How much of an utterance must be there before it begins, ticks: what covers for a sender that
    /// stutters, and what the mouth knows ahead.
    pub look_ahead: i64,
    pub turns: Turns,
    /// Utterances of all clients that have not ended.
    pub utterances_max: usize,
    /// Sound of all of them, ticks.
    pub sound_ticks_max: i64,
    /// The same of one client.
    pub client_ticks_max: i64,
    /// An utterance that has begun, is not whole and gets nothing more for this long is over.
    pub starved_ticks: i64,
}

impl Rules {
    pub fn of(config: &Config) -> Self {
        let wire = &config.wire;
        Self {
            look_ahead: config.sound.look_ahead_ms.get() * TICK_RATE / 1000,
            turns: wire.turns,
            utterances_max: usize::try_from(wire.queue.get()).unwrap_or(1),
            sound_ticks_max: wire.sound_seconds.get() * TICK_RATE,
            client_ticks_max: wire.client_sound_seconds.get() * TICK_RATE,
            starved_ticks: wire.starved_seconds.get() * TICK_RATE,
        }
    }

    /// How long an utterance that has not begun may get nothing, ticks.
    pub fn unbegun_ticks(&self) -> i64 {
        self.starved_ticks * PATIENT
    }
}
