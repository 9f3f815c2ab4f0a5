//! The structures that the SIG is compared with (sig-2004, 7), and [`Structure`], through which they and the SIG are asked.
//!
//! | structure | for | encodes | finds what is not encoded |
//! |---|---|---|---|
//! | SIG: [`sig_core::Complex`], asked through [`Sig`] | any complex | all simplices | in its top simplices alone |
//! | [incidence graph](crate::incidence_graph) | any complex | all simplices, all immediate cofaces | level by level |
//! | [`IndexedAdjacencies`] (IA) | pseudo-manifolds of any dimension | the d-simplices | by looking at all of them |
//! | [`TriangleSegment`] (TS) | complexes of dimension up to 2 | vertices, triangles | around vertices and edges |
//! | [`NonManifoldIndexed`] (NMIA) | complexes of dimension up to 3 | vertices, top simplices | around vertices and edges |
//! | [combinatorial map](crate::combinatorial_map) | closed orientable quasi-manifolds | darts, the cells of each | around cells |
//!
//! IA, TS and NMIA are built from the [`Tops`] of a complex, name a simplex as a [`Face`] of a top simplex, and are asked
//! through a [`Session`]. Each holds the integers that the paper lists for it, at a width of the caller's choice, and no
//! others; [`formulas`] has the paper's numbers.
//!
//! # Which one to take
//!
//! The SIG, unless memory decides and the complex is of a kind that a smaller one can hold. IA takes a third of its space
//! on tetrahedral meshes and half on triangle meshes, and is the one to take where nothing is asked but the d-simplices,
//! their faces and their neighbours. Where stars of vertices are asked too, TS and NMIA take about three quarters of the
//! space of the SIG and answer in time linear in the top simplices around a vertex; what they cannot do is to attach
//! something to an edge or a triangle, for these have no number. The incidence graph takes more space than the SIG on
//! meshes, and is faster where only the next dimension up is asked. `benches/README.md` has the figures.

mod around;
pub mod conjecture;
mod faces;
pub mod formulas;
mod indexed;
mod lists;
mod nmia;
mod refusal;
mod sig;
mod tops;
mod triangle_segment;

use std::fmt::Debug;

use sig_core::storage::Storage;
use sig_core::{Dim, VertexId};

pub use faces::{Face, Marks, Session, TopSimplices};
pub use indexed::IndexedAdjacencies;
pub use nmia::NonManifoldIndexed;
pub use refusal::Refusal;
pub use sig::Sig;
pub use tops::Tops;
pub use triangle_segment::TriangleSegment;

/// A structure that answers for the topological relations of a simplicial complex (sig-2004, 2).
///
/// Answers replace what `found` holds, each simplex once, in no particular order. A structure that needs memory to
/// traverse has it in itself, so that nothing is allocated once `found` is large enough.
pub trait Structure {
    /// How the structure names a simplex. One simplex may have several names, and each will do.
    type Simplex: Copy + Debug;

    /// The dimension of the complex; `None` for the empty complex.
    fn dim(&self) -> Option<Dim>;

    /// The integers and bits that the structure holds of those that the paper counts.
    fn storage(&self) -> Storage;

    /// Bytes of the structure's arrays, memory for queries not counted.
    fn bytes(&self) -> usize;

    /// The simplex with the given vertices, which increase strictly.
    fn find(&mut self, vertices: &[VertexId]) -> Option<Self::Simplex>;

    /// Replaces `vertices` by those of a simplex, increasing.
    fn vertices(&self, simplex: Self::Simplex, vertices: &mut Vec<VertexId>);

    /// B_{p,q}: the faces of dimension `dim` of a simplex; none for q ≥ p.
    fn boundary(&mut self, simplex: Self::Simplex, dim: Dim, found: &mut Vec<Self::Simplex>);

    /// C_{p,g}: the cofaces of dimension `dim` of a simplex; none for g ≤ p.
    fn coboundary(&mut self, simplex: Self::Simplex, dim: Dim, found: &mut Vec<Self::Simplex>);

    /// The simplex and all its cofaces.
    fn star(&mut self, simplex: Self::Simplex, found: &mut Vec<Self::Simplex>);

    /// The faces of its cofaces that have no vertex in common with the simplex.
    fn link(&mut self, simplex: Self::Simplex, found: &mut Vec<Self::Simplex>);

    /// A_p: the other p-simplices that share a (p−1)-face with a simplex; for p = 0 the other ends of its edges.
    fn adjacency(&mut self, simplex: Self::Simplex, found: &mut Vec<Self::Simplex>);
}

/// Bytes of an array.
fn array_bytes<T>(array: &[T]) -> usize {
    size_of_val(array)
}
