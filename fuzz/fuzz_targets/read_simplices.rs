//! Any bytes as a list of simplices.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sig_tests::fuzz::read(Some(sig_tests::fuzz::Format::SimplexList), bytes));
