//! Any bytes as a file of the format `whisper`.

#![no_main]

mod shared;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| shared::read("whisper", bytes));
