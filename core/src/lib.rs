//! Simplicial complexes as a Simplified Incidence Graph, read in place from a byte buffer: a mapped file, a `static` in
//! flash, WebAssembly memory. `no_std`, no `alloc`, no `unsafe`.
//!
//! The Simplified Incidence Graph (SIG; De Floriani, Greenfieldboyce and Hui, 2004, *sig-2004* below) holds every
//! simplex of a complex of any dimension, all boundary relations, and for each simplex one representative of each
//! cluster of top simplices around it. That is enough for every co-boundary and adjacency relation in time linear in
//! the top simplices around the simplex. Complexes may be non-manifold, non-regular, of mixed dimension.
//!
//! ```
//! use sig_core::{Complex, Scratch, SimplexId, VertexId, mark_words};
//! # use sig_core::FormatError;
//!
//! // Two tetrahedra on a common triangle, with a dangling edge: see the end of this page for how to embed a file.
//! # static BYTES: &[u8] = sig_core::include_aligned!("../tests/two-tetrahedra.sigc");
//! let complex = Complex::<u16>::from_bytes(BYTES)?;
//! assert_eq!(complex.dim(), Some(3));
//! assert_eq!(complex.num_simplices_of_dim(3), 2);
//!
//! // Downwards, relations are iterators.
//! let triangle = complex.find(&[1, 2, 3].map(VertexId::new)).expect("the common triangle");
//! assert_eq!(complex.facets(triangle).len(), 3);
//!
//! // Upwards, they take memory from the caller: here for complexes of up to 64 simplices.
//! let (mut marks, mut queue, mut masks, mut found) = ([0; mark_words(64)], [0; 64], [0; 64], [0; 64]);
//! let mut scratch = Scratch::new(&mut marks, &mut queue, &mut masks, &mut found);
//! let tetrahedra = complex.coboundary(triangle, 3, &mut scratch).expect("enough memory");
//! assert_eq!(tetrahedra.len(), 2);
//! # Ok::<(), FormatError>(())
//! ```
//!
//! | looking for | see |
//! |---|---|
//! | the view, and the three widths of indices | [`Complex`], [`AnyComplex`] |
//! | boundary, co-boundary, adjacency, star, link, clusters | the methods of [`Complex`], by file in [`relations`] |
//! | a file that is a simplex tree and no more | [`Tree`], [`AnyTree`] |
//! | the SIG's arrays as a simplex tree | [`Complex::as_tree`], [`tree`] |
//! | code for either | [`Relations`] |
//! | memory for queries | [`Scratch`], [`StaticScratch`] |
//! | cells and their incidences | [`mod@cell`] |
//! | multi-resolution cell complexes: closed sets, streams of refinements | [`mcc::Mcc`] |
//! | the bytes: header, sections, checksums, encoding | [`mod@format`] |
//! | embedding a file in a program | [`include_aligned!`] |
//! | the paper's storage formulas | [`storage`] |
//!
//! # Small machines
//!
//! A program that links this crate needs neither `std` nor an allocator, and gets neither formatting nor a way to panic from
//! it, built with optimisation: all relations and opening take about 20 KB of Thumb-2 code for one width of indices. Memory
//! for queries is one bit a simplex, and for each simplex of the largest star two indices and a mask: see [`Scratch`].
//! `core/small` in the project's repository has a firmware, the library for C and the modules for WebAssembly.
#![no_std]

pub mod cell;
pub mod complex;
mod embed;
pub mod format;
pub mod id;
pub mod mcc;
pub mod relations;
pub mod scratch;
mod slices;
pub mod storage;
pub mod tree;
mod view;

pub use cell::{Arc, CellId, Incidence, PackedArc};
pub use complex::{AnyComplex, Complex};
pub use embed::Aligned;
pub use format::FormatError;
pub use id::{Dim, Index, IndexWidth, MAX_DIM, SimplexId, VertexId};
pub use scratch::{Scratch, ScratchError, StaticScratch, mark_words};
pub use tree::{AnyTree, Tree};
pub use view::Relations;
