//! The dynamic simplex tree, against a plain set of words, the definitions, and complexes with known answers.

mod known;
mod model;
mod operations;
mod queries;
mod round_trips;
mod text;
