//! Any bytes as a file: opened or refused, and if opened, every query ends.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sig_tests::fuzz::open(bytes));
