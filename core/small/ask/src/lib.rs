//! Every relation of a complex by number, and the checksum of all answers.
//!
//! [`ask`] is what the interface for C and WebAssembly exports; [`survey`] asks everything of every simplex, so that the
//! firmware, the library for C and the WebAssembly module can be compared with the host, line by line.
#![no_std]

mod relation;
mod survey;

pub use relation::{Relation, ask, ask_view};
pub use survey::{Line, Memory, ReportError, Summary, mix, report, survey, survey_view};
