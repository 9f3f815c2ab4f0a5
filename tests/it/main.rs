//! One binary for all tests that cross crates: a module is about one behaviour.
//!
//! Those that change bytes of files, or look at them one by one, run on little-endian hosts only, where the bytes in memory
//! are those of the file.

mod baselines;
mod builder;
mod combinatorial_map;
#[cfg(target_endian = "little")]
mod format;
#[cfg(target_endian = "little")]
mod format_book;
#[cfg(target_endian = "little")]
mod fuzz_corpus;
mod golden;
#[cfg(target_endian = "little")]
mod hostile;
mod hostile_inputs;
mod known_triangulations;
mod paper_figures;
mod relations;
mod rules;
mod scratch;
mod storage;
mod sweep;
