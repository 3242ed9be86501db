//! `[life]`: what the face does by itself.

use super::section::section;
use crate::cli::StateArg;

section! {
    /// What the face does by itself.
    pub struct Life {
        /// Seed of blinks and glances: the same seed, the same life.
        seed: u64 = 1 => at_start,
        /// What it does while nobody speaks: "idle", "listening", "thinking" or "speaking".
        state: StateArg = StateArg::Idle,
    }
}
