//! What the sound thread is told, and what it tells the simulation thread.

use std::sync::Arc;

use mouthpiece_phonemes::Segment;
use mouthpiece_protocol::ErrorCode;
use mouthpiece_speech::{Delivery, Track};

use crate::live::rules::Rules;
use crate::live::showing::Showing;
use crate::live::utterance::Begin;

/// What the sound thread is told.
#[derive(Debug)]
pub enum Command {
    /// A new utterance.
    Begin(Begin),
    /// Its labels, in order.
    Segments(u64, Vec<Segment>),
    /// Its sound, 48 kHz, one channel.
    Sound(u64, Vec<f32>),
    /// All of it was sent.
    End(u64),
    /// It cannot be had.
    Fail(u64, ErrorCode, String),
    /// Stop one utterance, or everything.
    Stop(Option<u64>),
    /// What the face shows from now on.
    Show(Showing),
    /// A text for the screen: from this tick of an utterance's sound on, or at once.
    Caption(Option<u64>, i64, Arc<str>),
    /// Other rules from now on.
    Rules(Box<Rules>),
    /// The process ends.
    Quit,
}

/// What the simulation thread is told, by an utterance's key.
#[derive(Debug)]
pub enum Cue {
    /// Speak `track` from tick `start` on.
    Start {
        key: u64,
        start: i64,
        track: Box<Track>,
    },
    /// More labels, in ticks from its start.
    Segments { key: u64, segments: Vec<Segment> },
    /// More of how it sounds.
    Heard { key: u64, delivery: Delivery },
    /// Nothing of it from tick `at` on.
    Stop { key: u64, at: i64 },
    /// It is over and may be forgotten.
    Done { key: u64 },
    /// Show this from the instant on that is heard when it comes.
    Show(Showing),
}
