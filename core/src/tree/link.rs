//! The link of a simplex, and the simplices that are adjacent to it.

use core::ops::Range;

use heapless::Vec;

use super::{Path, Tree};
use crate::id::{Dim, Index, MAX_DIM, SimplexId, VertexId};
use crate::relations::Simplices;
use crate::scratch::{Found, Queue, Scratch, ScratchError};

/// A word \[⋆ℓ₀⋆…⋆ℓⱼ\]: all that is below it, and nothing else, are cofaces of \[ℓ₀…ℓⱼ\].
struct Root<'r> {
    /// The node.
    node: usize,
    /// Its vertices that are not σ's, increasing.
    extra: &'r [usize],
}

/// The greatest number of nodes that a traversal has on its stack: a set of k vertices, k ≤ d − j, has a node for each
/// place between the vertices of σ, and one behind them; (j + 2) · (d − j + 1) is greatest for j = d/2.
const STACK: usize = 17 * 17;

/// A set of common neighbours.
struct Set {
    /// Where on the stack its nodes start: that of itself and the vertices of σ before its greatest vertex, then with one
    /// more vertex of σ after the other, up to the root that it is in.
    start: usize,
    /// How many vertices of σ the first of these nodes has.
    before: usize,
    /// The next common neighbour to add, all of the set coming before it.
    next: usize,
}

/// The children of a coface that are still to be visited, and those of the simplex of the link under it.
struct Pair {
    coface: Range<usize>,
    link: Range<usize>,
}

impl<I: Index> Tree<'_, I> {
    /// The link: the faces of the star that do not meet the simplex, of all dimensions.
    ///
    /// Each is what is left of a coface without the simplex's vertices. Cost: as [`star`](Self::star), and a search among
    /// children for each coface.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small; it can be used again.
    pub fn link<'s>(
        &self,
        simplex: SimplexId,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        scratch.start(0)?;
        let path = self.path(simplex);
        let Scratch { queue, found, .. } = scratch;
        self.common_neighbours(&path, queue)?;
        self.roots(&path, usize::MAX, queue, |root| {
            let mate = self.node_of(root.extra);
            if let Some(mate) = mate {
                self.report(mate, found)?;
            }
            self.report_below(path.len(), &root, mate, found)
        })?;
        Ok(Simplices::new(found.ids()))
    }

    /// Hands each root with at most `max_extra` vertices beside σ's to `visit`, σ itself first, until it says no. The queue
    /// holds the common neighbours.
    ///
    /// On a buffer that is not a tree it ends too, after as many roots as there are simplices.
    fn roots(
        &self,
        path: &Path,
        max_extra: usize,
        common: &Queue<'_, I>,
        mut visit: impl FnMut(Root<'_>) -> Result<bool, ScratchError>,
    ) -> Result<(), ScratchError> {
        let Some(own) = path.last() else { return Ok(()) };
        let mut go_on = visit(Root { node: own.id, extra: &[] })?;
        let max_extra = max_extra.min(self.levels.dims().saturating_sub(path.len()));
        let mut extra: Vec<usize, { MAX_DIM + 1 }> = Vec::new();
        let mut sets: Vec<Set, { MAX_DIM + 1 }> = Vec::new();
        let mut stack: Vec<usize, STACK> = Vec::new();
        // The empty set: the root of the tree, then σ's own path.
        let _ = stack.push(0);
        let _ = path.iter().try_for_each(|node| stack.push(node.id));
        let _ = sets.push(Set { start: 0, before: 0, next: 0 });
        let mut left = self.num_simplices();
        while let (true, Some(set)) = (go_on, sets.last_mut()) {
            let Some((vertex, before)) = common.get(set.next).filter(|_| extra.len() < max_extra) else {
                stack.truncate(set.start);
                sets.pop();
                extra.pop();
                continue;
            };
            set.next += 1;
            let (vertex, before) = (vertex.to_usize(), before as usize);
            let Some(&node) = before.checked_sub(set.before).and_then(|place| stack.get(set.start + place)) else {
                continue;
            };
            let next = set.next;
            let start = stack.len();
            let Some(root) = self.descend(path, before, before + extra.len(), node, vertex, &mut stack) else {
                stack.truncate(start);
                continue;
            };
            // Never full, for a root is at most as deep as the tree.
            let pushed = extra.push(vertex).is_ok() && sets.push(Set { start, before, next }).is_ok();
            left = left.saturating_sub(1);
            go_on = pushed && left > 0 && visit(Root { node: root, extra: &extra })?;
        }
        Ok(())
    }

    /// From a node of `depth` vertices, `before` of them σ's, to the child that ends with `vertex` and on by the rest of
    /// σ: pushes all these nodes.
    #[inline]
    fn descend(
        &self,
        path: &Path,
        before: usize,
        depth: usize,
        node: usize,
        vertex: usize,
        stack: &mut Vec<usize, STACK>,
    ) -> Option<usize> {
        let mut node = self.child(depth, node, vertex)?;
        stack.push(node).ok()?;
        for (depth, next) in (depth + 1..).zip(path.get(before..)?) {
            node = self.child(depth, node, next.label)?;
            stack.push(node).ok()?;
        }
        Some(node)
    }

    /// The simplex of some vertices, increasing; `None` if there is none, or of no vertices.
    fn node_of(&self, vertices: &[usize]) -> Option<usize> {
        let (&first, rest) = vertices.split_first()?;
        let first = self.child(0, 0, first)?;
        (1..).zip(rest).try_fold(first, |node, (depth, &vertex)| self.child(depth, node, vertex))
    }

    /// Adds a simplex to the answer, unless it has as many as there are simplices: only in a buffer that is not a tree.
    fn report(&self, simplex: usize, found: &mut Found<'_, I>) -> Result<bool, ScratchError> {
        if found.len() >= self.num_simplices() {
            return Ok(false);
        }
        I::from_usize(simplex).map_or(Ok(()), |simplex| found.push(simplex))?;
        Ok(true)
    }

    /// Adds what the descendants of a root leave without the simplex's vertices; `mate` is what the root leaves. The two
    /// subtrees are walked in step: the children of a coface are among those of its part in the link.
    fn report_below(
        &self,
        own: usize,
        root: &Root<'_>,
        mate: Option<usize>,
        found: &mut Found<'_, I>,
    ) -> Result<bool, ScratchError> {
        let extra = root.extra.len();
        let mut pairs: Vec<Pair, { MAX_DIM + 1 }> = Vec::new();
        let first = Pair {
            coface: self.child_range(own + extra - 1, root.node),
            link: match (mate, extra.checked_sub(1)) {
                (Some(mate), Some(dim)) => self.child_range(dim, mate),
                _ => self.levels.ids(0),
            },
        };
        let _ = pairs.push(first);
        while let Some(pair) = pairs.last_mut() {
            let Some(coface) = pair.coface.next() else {
                pairs.pop();
                continue;
            };
            let depth = extra + pairs.len() - 1;
            let Some(label) = self.last_vertices.index_at(coface) else { continue };
            let Some(pair) = pairs.last_mut() else { break };
            let mate = match depth {
                0 => self.child(0, 0, label),
                _ => self.last_vertices.find(pair.link.clone(), label),
            };
            let Some(mate) = mate else { continue };
            // What comes next is behind it.
            pair.link.start = if depth == 0 { pair.link.start } else { mate + 1 };
            if !self.report(mate, found)? {
                return Ok(false);
            }
            let below = Pair { coface: self.child_range(own + depth, coface), link: self.child_range(depth, mate) };
            if !below.coface.is_empty() {
                // Never full, for a coface is at most as deep as the tree.
                let _ = pairs.push(below);
            }
        }
        Ok(true)
    }

    /// The other p-simplices that share a k-face with a p-simplex; empty for k ≥ p.
    ///
    /// Cost: that of C_{k,p} for each of the k-faces; the answer's part of the scratch needs room for them all, σ and
    /// repetitions included, and there must be a mark for each simplex.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small; it can be used again.
    pub fn k_adjacency<'s>(
        &self,
        simplex: SimplexId,
        k: Dim,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        scratch.start(self.num_simplices())?;
        let dim = self.dim_of(simplex).unwrap_or(0);
        for face in self.boundary(simplex, k) {
            self.gather_cofaces(face, dim, scratch)?;
        }
        scratch.dedup_found(simplex.index());
        Ok(Simplices::new(scratch.found.ids()))
    }

    /// The other ends of the edges at a vertex.
    pub(crate) fn adjacent_vertices<'s>(
        &self,
        vertex: SimplexId,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        scratch.start(0)?;
        let path = self.path(vertex);
        self.neighbours(&path, 0, |other, _| self.report(other, &mut scratch.found).map(|_| ()))?;
        for edge in self.child_range(0, vertex.index()) {
            let end = self.last_vertex(SimplexId::new(edge)).map(VertexId::index);
            end.map_or(Ok(true), |end| self.report(end, &mut scratch.found))?;
        }
        Ok(Simplices::new(scratch.found.ids()))
    }
}
