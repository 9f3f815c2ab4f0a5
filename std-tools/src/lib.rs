//! Build, write, map and query Simplified Incidence Graphs.

pub mod io;
pub mod soup;
