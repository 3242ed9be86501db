//! `[sound]`: what is heard, and when.

use super::section::section;
use super::value::Whole;

section! {
    /// What is heard, and when.
    pub struct Sound {
        /// Sound device: "default", its name as `mouthpiece doctor` lists it, or "none" for a steady clock without sound.
        device: String = "default".into() => at_start,
        /// Of an utterance that is still coming in so many milliseconds must be there before it
        /// begins: what the mouth knows ahead.
        look_ahead_ms: Whole<0, 500> = Whole::new(300),
        /// Shows the picture later by so many milliseconds (below 0: earlier), for a screen or
        /// loudspeakers with a delay of their own.
        picture_delay_ms: Whole<-500, 500> = Whole::new(0),
    }
}
