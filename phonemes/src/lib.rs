//! Phones, times and label files: everything that Mouthpiece knows of what is said and when.
//!
//! Nothing here knows of sound or faces. Readers turn label files and streams into [`Segment`]s
//! in ticks of 48 kHz; speech turns those into muscles.
//!
//! | module | holds |
//! |---|---|
//! | `phone` | the 61 phones of TIMIT |
//! | `segment` | what a label says: phone, word, stress, times |
//! | `tick` | integer time and sample rates |
//! | `nearest` | which code an unknown one resembles |

#![forbid(unsafe_code)]

mod nearest;
mod phone;
mod segment;
mod tick;

pub use nearest::nearest;
pub use phone::{Class, Phone, UnknownCode};
pub use segment::{Labels, Segment, Stress, Word};
pub use tick::{BadRate, RATE_MAX, RATE_MIN, SampleRate, TICK_RATE, TICKS_MAX};
