//! The arrays of the SIG as a simplex tree (simplex-tree-2012, 2.1): each node is a simplex, its word its vertices.
//!
//! In canonical order an id is the number of the node in level order: the parent drops the last vertex, the children of
//! a node are consecutive. A file may carry the tree's sections, and then the [`Tree`](crate::Tree) answers; without them
//! the same answers come from the boundary by binary search.

use core::cmp::Ordering;
use core::ops::Range;

use super::{Complex, SimplexRange};
use crate::id::{Dim, Index, SimplexId, VertexId};
use crate::view::find_word;

impl<I: Index> Complex<'_, I> {
    /// The parent in the simplex tree: the face without the last vertex; `None` for a vertex, whose parent is the root.
    /// Cost: one read.
    #[must_use]
    pub fn parent(&self, simplex: SimplexId) -> Option<SimplexId> {
        let dim = self.dim_of(simplex)?;
        self.facet(dim, simplex.index(), dim).map(SimplexId::new)
    }

    /// The children in the simplex tree: the simplices with one vertex more, after the last one.
    ///
    /// Cost: two reads where the file has child offsets; else two binary searches over the dimension above.
    #[must_use]
    pub fn children(&self, simplex: SimplexId) -> SimplexRange {
        self.as_tree()
            .map_or_else(|| SimplexRange::new(self.child_range(simplex.index())), |tree| tree.children(simplex))
    }

    /// The simplex with the given vertices, which must increase strictly; `None` if there is none, or if they do not.
    ///
    /// Cost: a binary search over the children of each prefix. Without the file's tree sections, a search over each
    /// dimension up to p, with up to p reads a comparison.
    #[must_use]
    pub fn find(&self, vertices: &[VertexId]) -> Option<SimplexId> {
        if let Some(tree) = self.as_tree() {
            return tree.find(vertices);
        }
        find_word(vertices, |dim, node, vertex| match dim.checked_sub(1) {
            Some(parent_dim) => self.child(parent_dim, node, vertex),
            None => Some(vertex).filter(|&vertex| vertex < self.num_vertices()),
        })
    }

    /// The child of a node of dimension `dim` that ends with `vertex`, by the boundary.
    fn child(&self, dim: Dim, node: usize, vertex: usize) -> Option<usize> {
        let child_dim = dim + 1;
        let found = partition_point(self.levels().ids(child_dim), |child| {
            match self.facet(child_dim, child, child_dim).map_or(Ordering::Greater, |parent| parent.cmp(&node)) {
                Ordering::Equal => self.last_vertex_by_facets(child_dim, child).is_some_and(|last| last < vertex),
                order => order == Ordering::Less,
            }
        });
        let is_it = self.levels().ids(child_dim).contains(&found)
            && self.facet(child_dim, found, child_dim) == Some(node)
            && self.last_vertex_by_facets(child_dim, found) == Some(vertex);
        is_it.then_some(found)
    }

    /// The children of a node, by the boundary.
    fn child_range(&self, node: usize) -> Range<usize> {
        let Some(child_dim) = self.levels().dim_of(node).map(|dim| dim + 1) else { return 0..0 };
        let level = self.levels().ids(child_dim);
        let bound = |parent: usize| {
            partition_point(level.clone(), |child| {
                self.facet(child_dim, child, child_dim).is_some_and(|other| other < parent)
            })
        };
        // Clamped, for in a buffer that is not a complex the parents need not be in order.
        let start = bound(node);
        start..bound(node + 1).max(start)
    }
}

/// The first of a range of which a predicate, true up to there, is false.
pub(crate) fn partition_point(range: Range<usize>, is_before: impl Fn(usize) -> bool) -> usize {
    let (mut low, mut high) = (range.start, range.end);
    while low < high {
        let middle = low + (high - low) / 2;
        if is_before(middle) { low = middle + 1 } else { high = middle }
    }
    low
}
