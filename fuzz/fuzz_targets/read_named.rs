//! Bytes as an input of the format that their first line names.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sig_tests::fuzz::read_named(bytes));
