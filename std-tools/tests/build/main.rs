//! The builder and the incidence graph against the definitions, against each other, and against known answers.

// Test data are small.
#![allow(clippy::cast_possible_truncation)]

mod agreement;
mod complete;
mod known_answers;
mod oracle;
mod order;
mod samples;
mod soups;
