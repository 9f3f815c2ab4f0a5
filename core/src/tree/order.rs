//! The simplices depth first: the lexicographic order of the words.

use heapless::Vec;

use crate::complex::SimplexRange;
use crate::id::{MAX_DIM, SimplexId};
use crate::view::Relations;

/// All simplices, depth first: see [`Relations::depth_first`].
#[derive(Clone, Debug)]
pub struct DepthFirst<'v, V> {
    view: &'v V,
    /// The siblings that are still to be visited, of each dimension on the way.
    levels: Vec<SimplexRange, { MAX_DIM + 1 }>,
    left: usize,
}

impl<'v, V: Relations> DepthFirst<'v, V> {
    pub(crate) fn new(view: &'v V) -> Self {
        let mut levels = Vec::new();
        let _ = levels.push(view.simplices_of_dim(0));
        Self { view, levels, left: view.num_simplices() }
    }
}

impl<V: Relations> Iterator for DepthFirst<'_, V> {
    type Item = SimplexId;

    fn next(&mut self) -> Option<Self::Item> {
        self.left = self.left.checked_sub(1)?;
        loop {
            let Some(siblings) = self.levels.last_mut() else {
                // Only in a buffer that is not a complex: simplices that are nobody's children.
                self.left = 0;
                return None;
            };
            let Some(node) = siblings.next() else {
                self.levels.pop();
                continue;
            };
            let children = self.view.children(node);
            if children.len() > 0 {
                // Never full: those of the last dimension are none.
                let _ = self.levels.push(children);
            }
            return Some(node);
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<V: Relations> ExactSizeIterator for DepthFirst<'_, V> {}
impl<V: Relations> core::iter::FusedIterator for DepthFirst<'_, V> {}
