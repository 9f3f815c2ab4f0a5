//! Oracles and helpers for the tests that cross crates: slow, obvious implementations of the definitions.
//!
//! [`oracle`] holds a complex as a plain set of vertex words and answers every relation by its definition; [`encode`]
//! writes it as a file in the slow, obvious way; [`paper`] has the algorithms of the paper as printed;
//! [`conformance`] compares a view with them; [`strategies`] makes random complexes; [`queries`] asks a view that need
//! not be a complex everything, [`mcc`] a multi-resolution complex; [`fuzz`] has the bodies of the fuzz targets, which the tests replay.

pub mod conformance;
pub mod encode;
pub mod fuzz;
pub mod known;
pub mod mcc;
pub mod mutants;
pub mod oracle;
pub mod paper;
pub mod queries;
pub mod strategies;
