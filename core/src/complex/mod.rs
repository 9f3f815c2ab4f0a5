//! The view of a simplicial complex in a buffer: [`Complex`].
//!
//! Opening it takes the five arrays of the paper and the optional sections from a [`Container`] and checks that their
//! lengths fit together. The relations are in [`crate::relations`], the same arrays as a simplex tree in
//! [`crate::tree`], what belongs to vertices and simplices beside them in [`columns`].

mod any;
pub mod columns;
mod levels;
mod open;
mod sections;
mod tree;
pub(crate) mod validate;

pub use any::AnyComplex;
pub(crate) use levels::Levels;
pub(crate) use sections::Sections;

use crate::format::Container;
use crate::id::{Dim, Index, SimplexId};
use crate::tree::Tree;
use crate::view::common_methods;

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
    /// Two d-simplices for each simplex of dimension d − 1, where the file has them in place of lists.
    pairs: Option<&'a [I]>,
    tree: Option<Tree<'a, I>>,
}

common_methods!(Complex);

impl<'a, I: Index> Complex<'a, I> {
    /// The same complex as a simplex tree, if the file carries the tree's sections. Cost: O(1).
    #[must_use]
    #[inline]
    pub const fn as_tree(&self) -> Option<&Tree<'a, I>> {
        self.tree.as_ref()
    }

    /// The tree, if it finds the cofaces of a simplex faster than its clusters do: when it knows lower neighbours, and the
    /// simplex is not so large that it has but a few top simplices, which the clusters name at once.
    pub(crate) fn upward_tree(&self, simplex: SimplexId) -> Option<&Tree<'a, I>> {
        let few = self.levels.start(self.levels.dims().saturating_sub(4));
        self.as_tree().filter(|tree| tree.has_lower_neighbours() && simplex.index() < few)
    }

    pub(crate) const fn levels(&self) -> &Levels {
        &self.levels
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

    /// Whether the d-simplices at each (d−1)-simplex stand in pairs, not in lists (sig-2004, 7.4).
    #[must_use]
    pub const fn has_pairs(&self) -> bool {
        self.pairs.is_some()
    }

    /// The pair of a simplex of dimension d − 1, if it has one: its d-simplices, and stop codes behind them.
    #[inline]
    pub(crate) fn pair(&self, simplex: usize) -> Option<&'a [I]> {
        let start = simplex.checked_sub(self.levels.flags_end())?.checked_mul(2)?;
        self.pairs?.get(start..start.checked_add(2)?)
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
