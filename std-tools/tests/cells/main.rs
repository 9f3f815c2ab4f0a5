//! Cell complexes and their Euler operators against the definitions.

// Test data are small.
#![allow(clippy::cast_possible_truncation)]

mod betti;
mod cycles;
mod fronts;
mod mcc;
mod model;
mod operators;
#[allow(dead_code, reason = "shared with the tests of the builder")]
#[path = "../build/samples.rs"]
mod samples;
mod text;
