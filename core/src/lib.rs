//! Simplicial complexes as a Simplified Incidence Graph, read in place from a byte buffer.
#![no_std]

pub mod id;

pub use id::{Dim, Index, IndexWidth, MAX_DIM, SimplexId, VertexId};
