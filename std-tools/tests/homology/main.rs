//! Homology against the literature and against ranks modulo primes.

// Test data are small.
#![allow(clippy::cast_possible_truncation)]

#[allow(dead_code, reason = "shared with the tests of cell complexes")]
#[path = "../cells/betti.rs"]
mod betti;
mod cycles;
mod known;
mod oracle;
mod spaces;
