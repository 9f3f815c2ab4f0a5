//! The topological relations of sig-2004, section 2, one file each.
//!
//! Boundary relations are iterators and need no memory. Relations that go up, and so traverse, write into a
//! caller-owned [`Scratch`](crate::Scratch). None recurses, none allocates.
//!
//! Costs are given in the paper's terms: λ_r(σ) is the number of top r-simplices in the restricted star of σ, κ_g(σ)
//! the number of its g-clusters.

mod adjacency;
mod boundary;
mod closure;
mod clusters;
mod coboundary;
mod link;
mod partial;
mod star;
mod vertices;

pub(crate) use boundary::binomial;
pub use boundary::{Boundary, Facets};
pub use closure::Closure;
pub use clusters::{Cluster, Clusters};
pub use partial::PartialCoboundary;
pub use vertices::Vertices;

use crate::id::{Index, SimplexId};

/// Iterators over simplices that hand on to an inner one of exact size, from both ends.
macro_rules! delegate_iterator {
    ([$($generics:tt)*] $name:ty, $inner:ident, $map:expr) => {
        impl<$($generics)*> Iterator for $name {
            type Item = $crate::SimplexId;

            #[inline]
            fn next(&mut self) -> Option<Self::Item> {
                self.$inner.next().map($map)
            }

            fn size_hint(&self) -> (usize, Option<usize>) {
                self.$inner.size_hint()
            }

            fn nth(&mut self, n: usize) -> Option<Self::Item> {
                self.$inner.nth(n).map($map)
            }
        }

        impl<$($generics)*> DoubleEndedIterator for $name {
            #[inline]
            fn next_back(&mut self) -> Option<Self::Item> {
                self.$inner.next_back().map($map)
            }
        }

        impl<$($generics)*> ExactSizeIterator for $name {}
        impl<$($generics)*> core::iter::FusedIterator for $name {}
    };
}
pub(crate) use delegate_iterator;

/// The simplex that an index in a buffer stands for.
#[inline]
pub(crate) fn simplex_at<I: Index>(index: &I) -> SimplexId {
    SimplexId::new(index.to_usize())
}

/// Simplices that a query found, in the scratch of the query; in no particular order.
#[derive(Clone, Debug)]
pub struct Simplices<'s, I> {
    ids: core::slice::Iter<'s, I>,
}

impl<'s, I: Index> Simplices<'s, I> {
    pub(crate) fn new(ids: &'s [I]) -> Self {
        Self { ids: ids.iter() }
    }

    /// Whether the simplex is among those that are left. Cost: one pass over them.
    #[must_use]
    pub fn contains(&self, simplex: SimplexId) -> bool {
        self.clone().any(|found| found == simplex)
    }
}

delegate_iterator!([I: Index] Simplices<'_, I>, ids, simplex_at);

/// The mask without bit `position`: the positions above move down by one.
#[inline]
pub(crate) const fn delete_bit(mask: u32, position: usize) -> u32 {
    let low = (1 << position) - 1;
    mask & low | (mask >> 1) & !low
}

/// The mask with a zero inserted at bit `position`: the positions from there on move up by one.
#[inline]
pub(crate) const fn insert_zero(mask: u32, position: usize) -> u32 {
    let low = (1 << position) - 1;
    mask & low | (mask & !low) << 1
}

/// The mask of all vertex positions of a simplex of dimension `dim`.
#[inline]
pub(crate) const fn all_positions(dim: usize) -> u32 {
    u32::MAX >> (31 - (dim & 31))
}
