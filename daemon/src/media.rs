//! Sound and video files, in and out; knows nothing of labels, faces or the GPU.
//!
//! | module | does |
//! |---|---|
//! | [`wav`] | reads a user's sound file into 48 kHz mono |
//! | [`resample`] | another rate to 48 kHz, without a shift |

pub mod resample;
pub mod wav;
