//! The packet of Live Link Face, as Unreal Engine's "Apple ARKit Face Support" takes it (version 6).
//!
//! Epic documents the app, not the packet; this is its layout by the engine's published source and by
//! independent readers of it, all numbers big-endian:
//!
//! | bytes | hold |
//! |---|---|
//! | 1 | version, 6 |
//! | 4 + n | device: length and text; some readers expect 36 characters, a UUID |
//! | 4 + n | subject, under which the engine lists it: length and text |
//! | 4 + 4 | frame number, and a float: the part of a frame that has gone since |
//! | 4 + 4 | frames a second, as numerator and denominator |
//! | 1 | how many values follow, 61 |
//! | 61 x 4 | floats: 52 shapes, 9 angles |
//!
//! The shapes come in the engine's order, which is not that of the app's recordings: jaw and mouth
//! have left before right.

use super::Moment;
use crate::avatar::arkit;
use crate::live::time::seconds;

const VERSION: u8 = 6;
/// Our name in the engine.
const SUBJECT: &str = "Mouthpiece";
/// Pairs that the engine has the other way round.
const SWAPPED: [(&str, &str); 2] = [("JawRight", "JawLeft"), ("MouthRight", "MouthLeft")];

/// The packet of an instant.
pub(super) fn packet(moment: &Moment<'_>) -> Vec<u8> {
    // The name of this program in hexadecimal, and the process, so that two of them can be told apart.
    let device = format!("6d6f7574-6870-6965-8365-{:012x}", std::process::id());
    let mut bytes = vec![VERSION];
    for text in [device.as_str(), SUBJECT] {
        bytes.extend(u32::try_from(text.len()).unwrap_or(0).to_be_bytes());
        bytes.extend(text.bytes());
    }
    let frames = seconds(moment.ticks) * f64::from(moment.rate_hz);
    // Signed over there: a year at 60 a second, then it starts anew.
    let frame = (frames.floor() as i64).rem_euclid(i64::from(i32::MAX)) as i32;
    bytes.extend(frame.to_be_bytes());
    bytes.extend((frames.fract() as f32).to_be_bytes());
    bytes.extend(u32::from(moment.rate_hz).to_be_bytes());
    bytes.extend(1_u32.to_be_bytes());

    let mut shapes = arkit::shapes(&moment.face);
    for (a, b) in SWAPPED {
        let at = |name| arkit::names().position(|known| known == name);
        if let (Some(a), Some(b)) = (at(a), at(b)) {
            shapes.swap(a, b);
        }
    }
    let angles = arkit::angles(moment.face.is);
    bytes.push(u8::try_from(shapes.len() + angles.len()).unwrap_or(0));
    for value in shapes.into_iter().chain(angles) {
        bytes.extend(value.to_be_bytes());
    }
    bytes
}
