//! The cofaces of a simplex (simplex-tree-2012, 2.2.1): the words \[⋆ℓ₀⋆ℓ₁⋆…⋆ℓⱼ⋆\].
//!
//! Every vertex of a coface that sorts before ℓⱼ is a neighbour of all ℓᵢ, so the words \[⋆ℓ₀⋆…⋆ℓⱼ\] are made of σ and
//! common neighbours. The tree is descended breadth first by such words only; what lies below one that has all of σ is
//! all coface, and consecutive in each dimension. In a flag complex every word on the way leads to a coface, so the
//! paper's walks up from all nodes with the label ℓⱼ are not needed.
//!
//! Breadth first, because the nodes of one dimension do not wait for each other: what is read for all of them is asked of
//! the memory at once, and a query waits for it once a dimension instead of once a node. It also gives the cofaces in the
//! order of their ids.

use core::ops::Range;

use super::neighbours::{Filter, MANY};
use super::{Path, Tree};
use crate::format::{Column, WAITS, first_from};
use crate::id::{Dim, Index, IndexWidth, SimplexId};
use crate::relations::Simplices;
use crate::scratch::{Found, Queue, Scratch, ScratchError};

/// A node on the way to cofaces, or consecutive nodes that are cofaces.
#[derive(Clone, Copy)]
struct Pending {
    node: usize,
    /// How many vertices of σ the word has; not more than there are bits in a mask.
    own: u32,
    /// If it has all: how many nodes there are. Else nothing.
    rest: usize,
}

impl Pending {
    /// The bits that hold how many vertices of σ a word has: up to 32.
    const OWN_BITS: u32 = 6;
    /// What [`rest`](Self::rest) can be in a queue.
    const MOST: usize = (u32::MAX >> Self::OWN_BITS) as usize;

    const fn new(node: usize, own: u32, rest: usize) -> Self {
        Self { node, own, rest }
    }

    #[inline]
    fn unpack(node: usize, mask: u32) -> Self {
        let own = mask & ((1 << Self::OWN_BITS) - 1);
        Self { node, own, rest: (mask >> Self::OWN_BITS) as usize }
    }

    /// The nodes, where σ has `size` vertices.
    #[inline]
    fn nodes(&self, size: usize) -> Range<usize> {
        let count = if self.own as usize == size { self.rest } else { 1 };
        self.node..self.node.saturating_add(count)
    }

    /// Queues it; more nodes than a mask can count as several.
    #[inline]
    fn push<I: Index>(mut self, size: usize, queue: &mut Queue<'_, I>) -> Result<(), ScratchError> {
        loop {
            let part = self.rest.min(Self::MOST);
            let mask = u32::try_from(part).unwrap_or(0) << Self::OWN_BITS | self.own;
            queue.push(I::from_usize(self.node).unwrap_or(I::STOP), mask)?;
            if self.own as usize != size || self.rest == part {
                return Ok(());
            }
            self.node += part;
            self.rest -= part;
        }
    }
}

/// What is looked for: cofaces of σ of some dimensions.
struct Wanted<'p> {
    /// σ.
    path: &'p Path,
    /// The least dimension that is wanted.
    from: Dim,
    /// The greatest.
    to: Dim,
    /// The vertices that may be in a word beside σ's, as far as they come before σ's last one.
    common: Filter,
}

impl Wanted<'_> {
    #[inline]
    fn size(&self) -> usize {
        self.path.len()
    }

    /// Whether a word of dimension `dim` may get one more vertex that is not σ's and still become a coface.
    #[inline]
    fn has_room(&self, dim: Dim, own: u32) -> bool {
        dim + 1 + self.size() <= self.to + own as usize
    }
}

impl<I: Index> Tree<'_, I> {
    /// ⋆σ: the simplex and all simplices that have it as a face, in the order of their ids.
    ///
    /// Cost: [`vertices`](Self::vertices); a pass over the neighbours of each vertex, or where they are many a search
    /// for each of those of the vertex that has the fewest; then a pass over the children of each simplex whose word
    /// is made of common neighbours and the first vertices of σ (in a flag complex each is a prefix of a coface), and
    /// a sequential write of what is below. The queue of the scratch holds the common neighbours and such simplices
    /// of two dimensions; no marks are needed. Without the file's lower neighbours the common ones are looked for
    /// among all vertices before σ's first one.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small; it can be used again.
    pub fn star<'s>(
        &self,
        simplex: SimplexId,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        self.gather_star(simplex, 0, scratch)
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
        self.gather_star(simplex, 1, scratch)
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

    /// The cofaces of all dimensions from that of the simplex and `more` on.
    fn gather_star<'s>(
        &self,
        simplex: SimplexId,
        more: Dim,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        scratch.start(0)?;
        if let (Some(dim), Some(to)) = (self.dim_of(simplex), self.levels.dims().checked_sub(1)) {
            self.gather(simplex, dim + more..to + 1, scratch)?;
        }
        Ok(Simplices::new(scratch.found.ids()))
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
        self.gather(simplex, dim..dim + 1, scratch)
    }

    /// Appends the cofaces of some dimensions to the answer, in the order of their ids.
    fn gather(&self, simplex: SimplexId, dims: Range<Dim>, scratch: &mut Scratch<'_, I>) -> Result<(), ScratchError> {
        let Scratch { queue, found, .. } = scratch;
        if self.levels.ids(self.levels.dims().saturating_sub(1)).contains(&simplex.index()) {
            // It is its own only coface.
            return if dims.is_empty() { Ok(()) } else { found.extend(simplex.index()..simplex.index() + 1) };
        }
        let path = self.path(simplex);
        queue.clear();
        self.common_neighbours(&path, queue)?;
        let mut wanted = Wanted { path: &path, from: dims.start, to: dims.end.saturating_sub(1), common: Filter::NONE };
        queue.ids().iter().for_each(|vertex| wanted.common.insert(vertex.to_usize()));
        let num_common = queue.len();
        let (common, mut level) = queue.split();
        // Never wider than an index where there are edges: opening refuses that, and it is less code.
        let gathered = match self.last_vertices {
            Column::U16(labels) => self.gather_words(&wanted, labels, &common, &mut level, found),
            Column::U32(labels) if I::WIDTH >= IndexWidth::Bits32 => {
                self.gather_words(&wanted, labels, &common, &mut level, found)
            }
            Column::U64(labels) if I::WIDTH >= IndexWidth::Bits64 => {
                self.gather_words(&wanted, labels, &common, &mut level, found)
            }
            _ => Ok(()),
        };
        gathered.map_err(|error| error.behind(num_common))
    }

    /// Appends the cofaces that are made of σ's vertices and common neighbours, level by level.
    fn gather_words<L: Index>(
        &self,
        wanted: &Wanted<'_>,
        labels: &[L],
        common: &Queue<'_, I>,
        level: &mut Queue<'_, I>,
        found: &mut Found<'_, I>,
    ) -> Result<(), ScratchError> {
        let first = self.push_first(wanted, common, level)?;
        // In a tree all that is queued is different simplices. On a buffer that is not a tree it ends too, after as many.
        let (mut queued, most) = (level.len(), found.len() + self.num_simplices());
        for dim in first..=wanted.to {
            let below = self.levels.ids(if dim < wanted.to { dim + 1 } else { self.levels.dims() });
            let mut reported = Ok(());
            // What has no children is done with.
            level.retain(|node, mask| {
                let pending = Pending::unpack(node, mask);
                let nodes = pending.nodes(wanted.size());
                let is_wanted = pending.own as usize == wanted.size() && dim >= wanted.from;
                if is_wanted && found.len() <= most && reported.is_ok() {
                    reported = found.extend(nodes.start..nodes.end.min(self.num_simplices()));
                }
                let children = self.children_in(&below, nodes);
                self.fetch_children(labels, &children);
                (!children.is_empty()).then_some(mask)
            });
            reported?;
            let count = level.len();
            for place in 0..count {
                let Some((node, mask)) = level.get(place) else { break };
                let pending = Pending::unpack(node.to_usize(), mask);
                let children = self.children_in(&below, pending.nodes(wanted.size()));
                let before = level.len();
                if pending.own as usize == wanted.size() {
                    Pending::new(children.start, pending.own, children.len()).push(wanted.size(), level)?;
                } else {
                    let may_add = wanted.has_room(dim, pending.own);
                    next_words(wanted, labels, children, (pending, may_add), common, level)?;
                }
                queued += level.len() - before;
                if queued > self.num_simplices() {
                    return Ok(());
                }
            }
            if found.len() > most {
                found.truncate(most);
                return Ok(());
            }
            level.remove_first(count);
        }
        Ok(())
    }

    /// Queues the words that cofaces begin with, of one dimension, and gives it: up to where the first common neighbour
    /// may stand there is only σ's own; before σ's first vertex, each common neighbour and that vertex.
    fn push_first(
        &self,
        wanted: &Wanted<'_>,
        common: &Queue<'_, I>,
        level: &mut Queue<'_, I>,
    ) -> Result<Dim, ScratchError> {
        let common = |place| common.get(place).filter(|_| wanted.has_room(0, 1));
        let own = common(0).map_or(wanted.size(), |(_, before)| before as usize).min(wanted.size()).max(1);
        let mut next = 0;
        while let Some((vertex, 0)) = common(next) {
            next += 1;
            Pending::new(vertex.to_usize(), 0, 0).push(wanted.size(), level)?;
        }
        if let Some(node) = wanted.path.get(own - 1) {
            let rest = usize::from(own == wanted.size());
            Pending::new(node.id, u32::try_from(own).unwrap_or(0), rest).push(wanted.size(), level)?;
        }
        Ok(own - 1)
    }

    /// Reads the first of what will be read of some children, so that the memory delivers it before it is waited for.
    #[inline]
    fn fetch_children<L: Index>(&self, labels: &[L], children: &Range<usize>) {
        if WAITS && !children.is_empty() {
            self.fetch_offset(children.start);
            core::hint::black_box(labels.get(children.start).copied());
        }
    }
}

/// Queues the children of a node that end with a common neighbour before the next vertex of σ, if there may be more of
/// those, or with that vertex.
#[inline]
fn next_words<I: Index, L: Index>(
    wanted: &Wanted<'_>,
    labels: &[L],
    children: Range<usize>,
    (from, may_add): (Pending, bool),
    common: &Queue<'_, I>,
    level: &mut Queue<'_, I>,
) -> Result<(), ScratchError> {
    let (Some(own), Some(labels)) = (wanted.path.get(from.own as usize), labels.get(children.clone())) else {
        return Ok(());
    };
    let size = wanted.size();
    let mut child = 0;
    if may_add && labels.len() < MANY {
        while let Some(label) = labels.get(child).map(|label| label.to_usize()).filter(|&label| label < own.label) {
            if wanted.common.may_have(label) {
                Pending::new(children.start + child, from.own, 0).push(size, level)?;
            }
            child += 1;
        }
    } else if may_add {
        for vertex in common.ids().iter().map(|vertex| vertex.to_usize()).take_while(|&vertex| vertex < own.label) {
            child = first_from(labels, child, vertex);
            if labels.get(child).is_some_and(|label| label.to_usize() == vertex) {
                Pending::new(children.start + child, from.own, 0).push(size, level)?;
            }
        }
    }
    child = first_from(labels, child, own.label);
    if labels.get(child).is_some_and(|label| label.to_usize() == own.label) {
        let is_coface = from.own as usize + 1 == size;
        Pending::new(children.start + child, from.own + 1, usize::from(is_coface)).push(size, level)?;
    }
    Ok(())
}
