//! The cofaces of a simplex (simplex-tree-2012, 2.2.1): the words \[⋆ℓ₀⋆ℓ₁⋆…⋆ℓⱼ⋆\].
//!
//! Every vertex of a coface that sorts before ℓⱼ is a neighbour of all ℓᵢ, so the words \[⋆ℓ₀⋆…⋆ℓⱼ\] are made of σ and
//! sets of common neighbours. The sets are enumerated by increasing vertex, each from the one without its greatest
//! vertex: if that with σ is no simplex, nothing that contains it is. So no search fails but the first of each kind, and
//! the paper's walks up from all nodes with the label ℓⱼ are not needed. What lies below such a word is all coface, and
//! consecutive in each dimension.

use core::ops::Range;

use heapless::Vec;

use super::{Path, Tree};
use crate::format::Column;
use crate::id::{Dim, Index, MAX_DIM, SimplexId};
use crate::relations::Simplices;
use crate::scratch::{Queue, Scratch, ScratchError};

/// A word \[⋆ℓ₀⋆…⋆ℓⱼ\]: all that is below it, and nothing else, are cofaces of \[ℓ₀…ℓⱼ\].
pub(super) struct Root<'r> {
    /// The node.
    pub(super) node: usize,
    /// Its vertices that are not σ's, increasing.
    pub(super) extra: &'r [usize],
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

impl<I: Index> Tree<'_, I> {
    /// ⋆σ: the simplex and all simplices that have it as a face.
    ///
    /// Cost: [`vertices`](Self::vertices); the common neighbours of the vertices, each list searched for those of the
    /// shortest; then p + 2 searches among children for each word \[⋆ℓ₀⋆…⋆ℓⱼ\], and a sequential write of what is below.
    /// The queue of the scratch holds the common neighbours, no marks are needed. Without the file's lower neighbours
    /// those are looked for among all vertices before σ's first one.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small; it can be used again.
    pub fn star<'s>(
        &self,
        simplex: SimplexId,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        self.gather_star(simplex, true, scratch)
    }

    /// st(σ) = ⋆σ − {σ}: all simplices that have the simplex as a proper face. Cost: as [`star`](Self::star).
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small; it can be used again.
    pub fn restricted_star<'s>(
        &self,
        simplex: SimplexId,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        self.gather_star(simplex, false, scratch)
    }

    /// C_{p,g}(σ): the g-simplices in the restricted star of a p-simplex, g > p; empty for g ≤ p or g > d.
    ///
    /// Cost: as [`star`](Self::star), but of the words of at most g + 1 vertices.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small; it can be used again.
    pub fn coboundary<'s>(
        &self,
        simplex: SimplexId,
        dim: Dim,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        scratch.start(0)?;
        self.gather_cofaces(simplex, dim, scratch)?;
        Ok(Simplices::new(scratch.found.ids()))
    }

    /// Whether the simplex is a top simplex: a face of no other.
    ///
    /// Cost: two reads if it has children; else [`vertices`](Self::vertices), and for each neighbour of the vertex of σ
    /// that has the fewest up to p + 2 searches among children.
    #[must_use]
    pub fn is_top(&self, simplex: SimplexId) -> bool {
        let Some(dim) = self.dim_of(simplex) else { return false };
        if dim + 1 == self.levels.dims() {
            return true;
        }
        if !self.child_range(dim, simplex.index()).is_empty() {
            return false;
        }
        let path = self.path(simplex);
        // Stops at the first coface.
        let look = |vertex, _| if self.is_coface_with(&path, vertex) { Err(()) } else { Ok(()) };
        self.neighbours(&path, self.rarest(&path), look).is_ok()
    }

    /// Whether a vertex before the last one of a simplex and the simplex are a simplex.
    fn is_coface_with(&self, path: &Path, vertex: usize) -> bool {
        let before = path.iter().take_while(|node| node.label < vertex).count();
        let prefix = before.checked_sub(1).and_then(|last| path.get(last)).map_or(0, |node| node.id);
        let rest = path.iter().skip(before);
        let word = core::iter::once(vertex).chain(rest.map(|node| node.label));
        word.zip(before..).try_fold(prefix, |node, (label, depth)| self.child(depth, node, label)).is_some()
    }

    fn gather_star<'s>(
        &self,
        simplex: SimplexId,
        itself: bool,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        scratch.start(0)?;
        let path = self.path(simplex);
        let Scratch { queue, found, .. } = scratch;
        self.common_neighbours(&path, queue)?;
        let mut skip_first = !itself;
        self.roots(&path, usize::MAX, queue, |root| {
            let mut dim = path.len() + root.extra.len() - 1;
            let mut level = root.node..root.node + 1;
            if core::mem::take(&mut skip_first) {
                (level, dim) = (self.children_of(dim, level), dim + 1);
            }
            while !level.is_empty() {
                // In a buffer that is not a tree subtrees may overlap.
                if found.len() + level.len() > self.num_simplices() {
                    return Ok(false);
                }
                found.extend(level.clone())?;
                level = self.children_of(dim, level);
                dim += 1;
            }
            Ok(true)
        })?;
        Ok(Simplices::new(found.ids()))
    }

    /// Appends the cofaces of dimension `dim` to the answer.
    pub(super) fn gather_cofaces(
        &self,
        simplex: SimplexId,
        dim: Dim,
        scratch: &mut Scratch<'_, I>,
    ) -> Result<(), ScratchError> {
        if dim >= self.levels.dims() || self.dim_of(simplex).is_none_or(|own| own >= dim) {
            return Ok(());
        }
        let path = self.path(simplex);
        let more = (dim + 1).saturating_sub(path.len());
        let Scratch { queue, found, .. } = scratch;
        queue.clear();
        self.common_neighbours(&path, queue)?;
        let most = found.len() + self.num_simplices();
        self.roots(&path, more, queue, |root| {
            let own = path.len() + root.extra.len() - 1;
            let level = (own..dim).fold(root.node..root.node + 1, |level, dim| self.children_of(dim, level));
            if found.len() + level.len() > most {
                return Ok(false);
            }
            found.extend(level)?;
            Ok(true)
        })
    }

    /// Hands each root with at most `max_extra` vertices beside σ's to `visit`, σ itself first, until it says no. The queue
    /// holds the common neighbours.
    ///
    /// On a buffer that is not a tree it ends too, after as many roots as there are simplices.
    pub(super) fn roots(
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

    /// Queues the vertices before σ's last one that are neighbours of all of σ's vertices, increasing, each with the number
    /// of σ's vertices before it in place of the mask.
    pub(super) fn common_neighbours(&self, path: &Path, queue: &mut Queue<'_, I>) -> Result<(), ScratchError> {
        let rarest = self.rarest(path);
        self.neighbours(path, rarest, |vertex, before| {
            I::from_usize(vertex).map_or(Ok(()), |vertex| queue.push(vertex, before))
        })?;
        for node in path.iter().enumerate().filter_map(|(place, node)| (place != rarest).then_some(node)) {
            if queue.len() == 0 {
                break;
            }
            let vertex = node.label;
            let (mut lower, mut upper) = (self.lower_rows(vertex), self.child_range(0, vertex));
            queue.retain(|other, before| {
                if other > vertex {
                    return advance(&self.last_vertices, &mut upper, other).then_some(before + 1);
                }
                let adjacent = match (&self.lower, &mut lower) {
                    (Some(lower), Some(rows)) => advance(&lower.vertices, rows, other),
                    _ => self.child(1, other, vertex).is_some(),
                };
                adjacent.then_some(before)
            });
        }
        Ok(())
    }

    /// The place in the word of the vertex that has the fewest neighbours, as far as they have to be looked through.
    fn rarest(&self, path: &Path) -> usize {
        let degree = |vertex: usize| {
            let lower = self.lower_rows(vertex).map_or(vertex, |rows| rows.len());
            lower.saturating_add(self.child_range(0, vertex).len())
        };
        let degrees = path.iter().enumerate().map(|(place, node)| (degree(node.label), place));
        degrees.min().map_or(0, |(_, place)| place)
    }

    /// Hands the neighbours of one of σ's vertices that come before σ's last vertex to `each`, increasing, with 0 before
    /// that vertex and 1 after it.
    pub(super) fn neighbours<E>(
        &self,
        path: &Path,
        place: usize,
        mut each: impl FnMut(usize, u32) -> Result<(), E>,
    ) -> Result<(), E> {
        let (Some(vertex), Some(last)) = (path.get(place), path.last()) else { return Ok(()) };
        match (&self.lower, self.lower_rows(vertex.label)) {
            (Some(lower), Some(mut rows)) => {
                rows.try_for_each(|row| lower.vertices.index_at(row).map_or(Ok(()), |other| each(other, 0)))?;
            }
            _ => {
                let is_lower = |&other: &usize| self.child(1, other, vertex.label).is_some();
                (0..vertex.label.min(self.num_vertices())).filter(is_lower).try_for_each(|other| each(other, 0))?;
            }
        }
        let upper = self.child_range(0, vertex.label).map_while(|edge| self.last_vertices.index_at(edge));
        upper.take_while(|&other| other < last.label).try_for_each(|other| each(other, 1))
    }

    /// Where the lower neighbours of a vertex stand, if the file has them; nothing past the end.
    #[inline]
    pub(super) fn lower_rows(&self, vertex: usize) -> Option<Range<usize>> {
        let lower = self.lower.as_ref()?;
        let len = lower.vertices.len();
        let bound = |vertex: usize| lower.offsets.get(vertex).map_or(len, |offset| offset.to_usize());
        // Clamped, for in a buffer that is not a tree an offset may be anything.
        let start = bound(vertex).min(len);
        Some(start..bound(vertex.saturating_add(1)).clamp(start, len))
    }
}

/// Moves the start of `rows`, in which `column` increases, to the first that holds `value` or more; whether it holds
/// `value`.
#[inline]
fn advance(column: &Column<'_>, rows: &mut Range<usize>, value: usize) -> bool {
    rows.start = column.lower_bound(rows.clone(), value);
    rows.start < rows.end && column.index_at(rows.start) == Some(value)
}
