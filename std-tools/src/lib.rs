//! Build, write, map and query Simplified Incidence Graphs.

pub mod build;
pub mod incidence_graph;
pub mod io;
pub mod soup;
