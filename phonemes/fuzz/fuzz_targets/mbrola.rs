//! Any bytes as a file of the format `mbrola`.

#![no_main]

mod shared;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| shared::read("mbrola", bytes));
