//! Build, write, map and query Simplified Incidence Graphs.

pub mod analysis;
pub mod build;
pub mod export;
pub mod incidence_graph;
pub mod io;
pub mod names;
pub mod soup;
pub mod store;
pub mod tops;

pub use store::{Loaded, Mapped, OwnedScratch};
