//! Trees with damaged arrays: every query ends, and what validation accepts is right.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| sig_tests::fuzz::tree(bytes));
