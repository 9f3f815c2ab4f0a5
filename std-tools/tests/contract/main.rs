//! Edge contraction on the arrays against a rebuild from the images of the top simplices, and against the definitions.

// Test data are small.
#![allow(clippy::cast_possible_truncation)]

mod agreement;
mod known_answers;
mod link;
mod model;
#[allow(dead_code, reason = "shared with the tests of the builder")]
#[path = "../build/samples.rs"]
mod samples;
