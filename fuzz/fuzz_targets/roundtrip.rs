//! A small complex: built in two ways, encoded, decoded, and compared with the oracle.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sig_tests::fuzz::roundtrip(bytes));
