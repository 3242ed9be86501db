//! Any bytes as a file of the format `azure`.

#![no_main]

mod shared;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| shared::read("azure", bytes));
