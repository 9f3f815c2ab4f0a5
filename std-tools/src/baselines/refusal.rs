//! Why a structure cannot represent a complex.

use sig_core::Dim;

use crate::combinatorial_map::MapError;

/// Why a structure cannot represent a complex; the simplex is the first, in canonical order, that it has no room for, by
/// the labels of its vertices.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// A simplex of a dimension that the structure does not have.
    #[error("simplex {simplex} has dimension {dim}, and the structure ends at {most}")]
    Dimension {
        /// The simplex.
        simplex: String,
        /// Its dimension.
        dim: Dim,
        /// The largest dimension that the structure has.
        most: Dim,
    },
    /// A top simplex of a dimension less than that of the complex, in a structure for regular complexes.
    #[error("simplex {simplex} of dimension {dim} is a face of no simplex of dimension {of}")]
    NotRegular {
        /// The simplex.
        simplex: String,
        /// Its dimension.
        dim: Dim,
        /// The dimension of the complex.
        of: Dim,
    },
    /// A (d−1)-simplex with three or more d-simplices, in a structure that has room for two.
    #[error(
        "simplex {simplex} is a face of {cofaces} simplices of dimension {dim}, and the structure has room for two"
    )]
    Crowded {
        /// The simplex of dimension d − 1.
        simplex: String,
        /// d.
        dim: Dim,
        /// How many d-simplices have it as a face.
        cofaces: usize,
    },
    /// Numbers that the integers of the structure are too narrow for.
    #[error("the structure needs numbers up to {largest}, and integers of {bits} bits hold less")]
    TooNarrow {
        /// The largest number.
        largest: usize,
        /// The width of the integers.
        bits: u32,
    },
    /// What a combinatorial map has no room for.
    #[error(transparent)]
    NoMap(#[from] MapError),
}
