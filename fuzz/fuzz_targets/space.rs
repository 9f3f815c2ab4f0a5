//! Any bytes as points, distances or a graph whose format is found by its content.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sig_tests::fuzz::space(None, bytes));
