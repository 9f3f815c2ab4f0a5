//! One binary for all tests that cross crates: a module is about one behaviour.

mod format;
mod hostile;
mod paper_figures;
mod relations;
mod scratch;
mod storage;
