//! Multi-resolution complexes, damaged or not: every query ends, fronts are made or refused.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sig_tests::fuzz::mcc(bytes));
