//! Any bytes as an input in STL.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sig_tests::fuzz::read(Some(sig_tests::fuzz::Format::Stl), bytes));
