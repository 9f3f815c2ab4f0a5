//! One binary for all tests that cross crates: a module is about one behaviour.

mod relations;
