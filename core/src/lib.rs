//! Simplicial complexes as a Simplified Incidence Graph, read in place from a byte buffer.
#![no_std]

pub mod complex;
mod embed;
pub mod format;
pub mod id;
pub mod relations;
pub mod scratch;
pub mod storage;
pub mod tree;

pub use complex::{AnyComplex, Complex};
pub use embed::Aligned;
pub use format::FormatError;
pub use id::{Dim, Index, IndexWidth, MAX_DIM, SimplexId, VertexId};
pub use scratch::{Scratch, ScratchError, StaticScratch, mark_words};
