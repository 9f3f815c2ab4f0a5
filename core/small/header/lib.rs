//! Keeps the header for C, `ffi/include/sig.h`, equal to the code: `tests/header.rs` makes it anew and compares.
