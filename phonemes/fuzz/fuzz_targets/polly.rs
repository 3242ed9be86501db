//! Any bytes as a file of the format `polly`.

#![no_main]

mod shared;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| shared::read("polly", bytes));
