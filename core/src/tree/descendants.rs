//! The descendants of a node, dimension by dimension.

use core::ops::Range;

use crate::id::{SimplexId, VertexId};
use crate::view::Relations;

/// The descendants of a node and itself, by dimension, then lexicographically: see
/// [`Tree::with_prefix`](crate::Tree::with_prefix).
#[derive(Clone, Debug)]
pub struct Descendants<'v, V> {
    view: &'v V,
    /// The descendants of one dimension: consecutive.
    level: Range<usize>,
    /// Those of them that were not handed out.
    next: Range<usize>,
}

impl<'v, V: Relations> Descendants<'v, V> {
    pub(crate) fn new(view: &'v V, prefix: &[VertexId]) -> Self {
        let level = match view.find(prefix) {
            _ if prefix.is_empty() => 0..view.num_vertices(),
            Some(node) => node.index()..node.index() + 1,
            None => 0..0,
        };
        Self { view, next: level.clone(), level }
    }
}

impl<V: Relations> Iterator for Descendants<'_, V> {
    type Item = SimplexId;

    fn next(&mut self) -> Option<Self::Item> {
        if self.next.is_empty() {
            let last = self.level.end.checked_sub(1).filter(|_| !self.level.is_empty())?;
            let (first, _) = self.view.children(SimplexId::new(self.level.start)).bounds();
            let (_, end) = self.view.children(SimplexId::new(last)).bounds();
            self.level = first.index()..end.index();
            self.next = self.level.clone();
        }
        self.next.next().map(SimplexId::new)
    }
}

impl<V: Relations> core::iter::FusedIterator for Descendants<'_, V> {}
