//! One binary for all tests that cross crates: a module is about one behaviour.

mod baselines;
mod builder;
mod combinatorial_map;
mod format;
mod format_book;
mod fuzz_corpus;
mod golden;
mod hostile;
mod known_triangulations;
mod paper_figures;
mod relations;
mod rules;
mod scratch;
mod storage;
