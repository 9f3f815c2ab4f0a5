//! Any bytes as a cell complex in text.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sig_tests::fuzz::cells(bytes));
