//! Any bytes as a landmark file: no panic, and what is read is written so that it reads again.

#![no_main]

use libfuzzer_sys::fuzz_target;
use mouthpiece_shop::landmarks::Landmarks;

fuzz_target!(|bytes: &[u8]| {
    let Ok(landmarks) = Landmarks::parse(bytes) else {
        return;
    };
    let Ok(text) = landmarks.json() else {
        return;
    };
    match Landmarks::parse(text.as_bytes()) {
        Ok(again) => assert!(again.points.keys().eq(landmarks.points.keys())),
        Err(error) => panic!("{error} in {text}"),
    }
});
