//! Flag complexes against their definition and against known answers.

// Test data are small.
#![allow(clippy::cast_possible_truncation)]

mod definition;
mod known_answers;
mod limits;
