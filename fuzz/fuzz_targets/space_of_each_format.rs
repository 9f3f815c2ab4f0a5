//! Bytes as points, distances or a graph of the format that the first of them chooses.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sig_tests::fuzz::space_of_each_format(bytes));
