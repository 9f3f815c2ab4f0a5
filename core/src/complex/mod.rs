//! The view of a simplicial complex in a buffer: [`Complex`].
//!
//! Opening it takes the five arrays of the paper and the optional sections from a [`Container`] and checks that their
//! lengths fit together. The relations are in [`crate::relations`], the same arrays as a simplex tree in
//! [`crate::tree`], what belongs to vertices and simplices beside them in [`columns`].

mod any;
pub mod columns;
mod levels;
mod open;
mod validate;

pub use any::AnyComplex;
pub(crate) use levels::Levels;

use crate::format::{Column, Container};
use crate::id::{Dim, Index, SimplexId};

/// A simplicial complex as a Simplified Incidence Graph (sig-2004, 4), read where it lies.
///
/// `Copy`, `Send` and `Sync`: any number of threads query one buffer, each with its own
/// [`Scratch`](crate::Scratch). `I` is the width of the indices in the buffer; [`AnyComplex`] picks it at run time.
///
/// # Trust
///
/// [`from_bytes`](Self::from_bytes) makes every query safe whatever the arrays hold: it ends, within the buffer,
/// without a panic. That its answers are *right* is known after [`validate`](Self::validate).
///
/// # Conventions
///
/// Simplices are numbered by (dimension, lexicographic order of the sorted vertex word). A relation of an id past the
/// end, or of a dimension that the complex does not have, is empty.
#[derive(Clone, Copy, Debug)]
pub struct Complex<'a, I> {
    container: Container<'a>,
    levels: Levels,
    boundary: &'a [I],
    pointers: &'a [I],
    lists: &'a [I],
    flags: &'a [u8],
    tree: Option<TreeSections<'a, I>>,
}

/// The optional sections that make descending the simplex tree fast.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TreeSections<'a, I> {
    pub(crate) child_offsets: &'a [I],
    pub(crate) last_vertices: Column<'a>,
}

impl<'a, I: Index> Complex<'a, I> {
    /// The dimension of the complex; `None` for the empty complex, whose dimension is −1.
    #[must_use]
    pub const fn dim(&self) -> Option<Dim> {
        self.levels.dims().checked_sub(1)
    }

    /// The number of simplices of all dimensions.
    #[must_use]
    pub fn num_simplices(&self) -> usize {
        self.levels.total()
    }

    /// n_p: the number of p-simplices.
    #[must_use]
    pub fn num_simplices_of_dim(&self, dim: Dim) -> usize {
        self.levels.ids(dim).len()
    }

    /// n_0: the number of vertices.
    #[must_use]
    pub fn num_vertices(&self) -> usize {
        self.num_simplices_of_dim(0)
    }

    /// All simplices, in the order of their ids.
    #[must_use]
    pub fn simplices(&self) -> SimplexRange {
        SimplexRange::new(0..self.levels.total())
    }

    /// The p-simplices, in the order of their ids: lexicographically by their vertices.
    #[must_use]
    pub fn simplices_of_dim(&self, dim: Dim) -> SimplexRange {
        SimplexRange::new(self.levels.ids(dim))
    }

    /// The dimension of a simplex; `None` past the end. Cost: O(d), a look-up in a table of d + 1 numbers.
    #[must_use]
    #[inline]
    pub fn dim_of(&self, simplex: SimplexId) -> Option<Dim> {
        self.levels.dim_of(simplex.index())
    }

    /// χ = Σ (−1)^p n_p.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        (0..self.levels.dims()).fold(0, |sum, dim| {
            let count = i64::try_from(self.num_simplices_of_dim(dim)).unwrap_or(i64::MAX);
            if dim % 2 == 0 { sum + count } else { sum - count }
        })
    }

    /// The file that the complex lies in.
    #[must_use]
    pub const fn container(&self) -> &Container<'a> {
        &self.container
    }

    pub(crate) const fn levels(&self) -> &Levels {
        &self.levels
    }

    pub(crate) const fn tree_sections(&self) -> Option<&TreeSections<'a, I>> {
        self.tree.as_ref()
    }

    /// F\[σ\]\[0..=p\] of p-simplex σ, p > 0: the facet in column i omits vertex i. Empty where there is no such row.
    #[inline]
    pub(crate) fn row(&self, dim: Dim, simplex: usize) -> &'a [I] {
        self.levels.row(dim, simplex).and_then(|range| self.boundary.get(range)).unwrap_or(&[])
    }

    /// F\[σ\]\[i\] of a p-simplex σ.
    #[inline]
    pub(crate) fn facet(&self, dim: Dim, simplex: usize, position: usize) -> Option<usize> {
        self.row(dim, simplex).get(position).map(|facet| facet.to_usize())
    }

    /// Whether the pointer of a simplex is itself the only entry of its partial co-boundary.
    #[inline]
    pub(crate) fn flag(&self, simplex: usize) -> bool {
        simplex < self.levels.flags_end()
            && self.flags.get(simplex / 8).is_some_and(|byte| byte >> (simplex % 8) & 1 == 1)
    }

    /// The pointer of a simplex of dimension below d.
    #[inline]
    pub(crate) fn pointer(&self, simplex: usize) -> Option<I> {
        self.pointers.get(simplex).copied()
    }

    /// The pointers from that of a simplex on.
    #[inline]
    pub(crate) fn pointers_from(&self, simplex: usize) -> &'a [I] {
        self.pointers.get(simplex..).unwrap_or(&[])
    }

    /// The lists from `offset` on.
    #[inline]
    pub(crate) fn lists_from(&self, offset: usize) -> &'a [I] {
        self.lists.get(offset..).unwrap_or(&[])
    }
}

/// Consecutive simplices.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SimplexRange {
    range: core::ops::Range<usize>,
}

impl SimplexRange {
    pub(crate) const fn new(range: core::ops::Range<usize>) -> Self {
        Self { range }
    }

    /// The first id, and the id after the last.
    #[must_use]
    pub const fn bounds(&self) -> (SimplexId, SimplexId) {
        (SimplexId::new(self.range.start), SimplexId::new(self.range.end))
    }

    /// Whether the simplex is among them.
    #[must_use]
    pub fn contains(&self, simplex: SimplexId) -> bool {
        self.range.contains(&simplex.index())
    }
}

crate::relations::delegate_iterator!([] SimplexRange, range, SimplexId::new);
