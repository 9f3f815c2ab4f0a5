//! Build, write, map and query Simplified Incidence Graphs.

pub mod soup;
