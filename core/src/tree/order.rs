//! The simplices in other orders than that of their ids: depth-first, and by filtration value.

use core::cmp::Ordering;
use core::ops::Range;

use heapless::Vec;

use super::Tree;
use crate::id::{Index, MAX_DIM, SimplexId};
use crate::relations::Simplices;
use crate::scratch::ScratchError;

impl<'a, I: Index> Tree<'a, I> {
    /// All simplices, each before its children and these before its next sibling: the lexicographic order of the words.
    ///
    /// Cost: two reads a simplex, no memory but the way down. By dimension they come from
    /// [`simplices`](Self::simplices).
    #[must_use]
    pub fn depth_first(&self) -> DepthFirst<'_, 'a, I> {
        let mut levels = Vec::new();
        let _ = levels.push(self.levels.ids(0));
        DepthFirst { tree: self, levels, left: self.num_simplices() }
    }

    /// All simplices by (filtration value, dimension, lexicographic order of the words), in `order`, which has room for
    /// them: each comes after its faces. By (dimension, word) where the file has no filtration values.
    ///
    /// Cost: a sort in place.
    ///
    /// # Errors
    /// [`ScratchError::Found`] if `order` is shorter than the number of simplices.
    pub fn filtration_order<'o>(&self, order: &'o mut [I]) -> Result<Simplices<'o, I>, ScratchError> {
        let (available, at_least) = (order.len(), self.num_simplices());
        let order = order.get_mut(..at_least).ok_or(ScratchError::Found { at_least, available })?;
        for (slot, id) in order.iter_mut().zip(0..) {
            *slot = I::from_usize(id).unwrap_or(I::STOP);
        }
        if let Some(values) = self.filtration() {
            let value = |id: &I| values.get(id.to_usize());
            order.sort_unstable_by(|left, right| {
                let by_value = value(left).zip(value(right)).map_or(Ordering::Equal, |(left, right)| left.total_cmp(right));
                by_value.then(left.cmp(right))
            });
        }
        Ok(Simplices::new(order))
    }
}

/// All simplices, depth first: see [`Tree::depth_first`].
#[derive(Clone, Debug)]
pub struct DepthFirst<'v, 'a, I> {
    tree: &'v Tree<'a, I>,
    /// The siblings that are still to be visited, of each dimension on the way.
    levels: Vec<Range<usize>, { MAX_DIM + 1 }>,
    left: usize,
}

impl<I: Index> Iterator for DepthFirst<'_, '_, I> {
    type Item = SimplexId;

    fn next(&mut self) -> Option<Self::Item> {
        self.left = self.left.checked_sub(1)?;
        loop {
            let Some(siblings) = self.levels.last_mut() else {
                // Only in a buffer that is not a tree: simplices that are nobody's children.
                self.left = 0;
                return None;
            };
            let Some(node) = siblings.next() else {
                self.levels.pop();
                continue;
            };
            // Empty at the last dimension, so never full.
            let children = self.tree.child_range(self.levels.len() - 1, node);
            if !children.is_empty() {
                let _ = self.levels.push(children);
            }
            return Some(SimplexId::new(node));
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<I: Index> ExactSizeIterator for DepthFirst<'_, '_, I> {}
impl<I: Index> core::iter::FusedIterator for DepthFirst<'_, '_, I> {}
