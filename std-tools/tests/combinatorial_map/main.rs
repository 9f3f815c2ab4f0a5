//! Combinatorial maps against flags and orbits by brute force, against the complex that they are made of, and their operators
//! against those on incidence graphs.

// Test data are small.
#![allow(clippy::cast_possible_truncation)]

mod construction;
mod known_answers;
mod model;
mod operators;
mod pyramids;
mod relations;
