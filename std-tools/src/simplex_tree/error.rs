//! Why a simplex tree refuses what it is asked for.

use sig_core::{Dim, MAX_DIM};

/// The tree would need more than 2³² words of memory, 16 GiB, or more than [`crate::frozen::MAX_SIMPLICES`].
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("the simplex tree has outgrown its 32-bit handles (16 GiB)")]
pub struct SizeError;

/// Vertices that are not the word of a simplex.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum WordError {
    /// No vertices.
    #[error("a simplex has at least one vertex")]
    Empty,
    /// Labels that do not increase strictly.
    #[error("vertex {0} does not stand after a smaller one: the vertices of a simplex increase")]
    NotIncreasing(u32),
    /// More vertices than a simplex may have.
    #[error("a simplex of {vertices} vertices; at most {} are possible (dimension {MAX_DIM})", MAX_DIM + 1)]
    TooManyVertices {
        /// How many.
        vertices: usize,
    },
    /// The largest number is no label.
    #[error("{} is no vertex label", u32::MAX)]
    ReservedLabel,
}

/// Why a simplex is not inserted.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum InsertError {
    /// The vertices are not the word of a simplex.
    #[error(transparent)]
    Word(#[from] WordError),
    /// The filtration value is not a number.
    #[error("the filtration value is not a number")]
    NotANumber,
    /// A facet is not in the complex.
    #[error("the facet {facet:?} is not in the complex")]
    MissingFacet {
        /// The facet.
        facet: Vec<u32>,
    },
    /// The filtration value is below that of a facet.
    #[error("the filtration value {value} is below {facet_value}, that of the facet {facet:?}")]
    BelowFacet {
        /// The value.
        value: f64,
        /// The facet.
        facet: Vec<u32>,
        /// Its value.
        facet_value: f64,
    },
    /// The tree is full. It may then hold some of the faces that were to be inserted, and is to be dropped.
    #[error(transparent)]
    Size(#[from] SizeError),
}

/// Why an edge is not contracted.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ContractError {
    /// The two vertices do not span an edge.
    #[error("there is no edge between {0} and {1}")]
    NoEdge(u32, u32),
    /// The tree is full; it is to be dropped.
    #[error(transparent)]
    Size(#[from] SizeError),
}

/// Why a pair of simplices is not collapsed.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{face:?} and {coface:?} are no free pair: the second is not the only proper coface of the first")]
pub struct NotFree {
    /// The face.
    pub face: Vec<u32>,
    /// The coface.
    pub coface: Vec<u32>,
}

/// Why a tree is not expanded.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExpandError {
    /// The complex is more than a graph.
    #[error("the complex has dimension {0}, and only a graph can be expanded; take its skeleton of dimension 1")]
    NotAGraph(Dim),
    /// A vertex of the edge is not in the complex, the ends are the same, or the value is not a number.
    #[error("({0}, {1}) is no edge that can be inserted: both ends must be vertices that enter no later")]
    NotAnEdge(u32, u32),
    /// Dimensions have a limit.
    #[error("dimension {0} is more than {MAX_DIM}")]
    TooManyDimensions(Dim),
    /// The tree is full; it is to be dropped.
    #[error(transparent)]
    Size(#[from] SizeError),
}

/// Why vertices are not relabelled.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RelabelError {
    /// Two vertices would have one label.
    #[error("vertices {0} and {1} would both be called {2}")]
    Collision(u32, u32, u32),
    /// The largest number is no label.
    #[error("{} is no vertex label", u32::MAX)]
    ReservedLabel,
    /// The tree is full.
    #[error(transparent)]
    Size(#[from] SizeError),
}

/// Why arrays are not thawed.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ThawError {
    /// The arrays are not a complex in canonical order.
    #[error("simplex #{0} is damaged: the arrays are not a complex in canonical order")]
    Damaged(usize),
    /// The tree is full.
    #[error(transparent)]
    Size(#[from] SizeError),
}
