//! One binary for all tests that cross crates: a module is about one behaviour.

mod builder;
mod format;
mod format_book;
mod fuzz_corpus;
mod golden;
mod hostile;
mod hostile_inputs;
mod known_triangulations;
mod paper_figures;
mod relations;
mod rules;
mod scratch;
mod storage;
