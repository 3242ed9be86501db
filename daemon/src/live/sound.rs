//! Sound out, and the clock that comes of it: a device where there is one, else a steady clock.
//!
//! The sound thread mixes speech in ticks and hands it to [`Output`]; what becomes of it (rate,
//! format, a device that dies and comes back) is decided in here.
//!
//! | module | holds |
//! |---|---|
//! | `callback` | what the device calls: no lock, no allocation |
//! | `device` | cpal; nothing else in the program knows it |
//! | `opening` | opening a device, on a thread of its own |
//! | `output` | the device or the steady clock in its place |
//! | `playing` | a device on the air and the watch kept over it |
//! | [`resample`] | any rate to any other, in pieces |

mod callback;
mod device;
mod opening;
mod output;
mod playing;
pub mod resample;

pub use output::{BLOCK_TICKS, Choice, Output};
