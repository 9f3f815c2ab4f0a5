//! The faces of a simplex: each a descent from the root by some of its vertices.
//!
//! A face shares with the one before it the prefix up to the first vertex in which they differ, and with the simplex
//! itself the prefix up to the first vertex that it lacks: only what is after these is searched.

use heapless::Vec;

use super::{Path, Tree};
use crate::id::{Dim, Index, MAX_DIM, SimplexId, VertexId};
use crate::relations::binomial;

impl<'a, I: Index> Tree<'a, I> {
    /// The vertices of a p-simplex, increasing; one for a vertex. Cost: p times [`parent`](Self::parent).
    #[must_use]
    pub fn vertices(&self, simplex: SimplexId) -> Vertices {
        Vertices { path: self.path(simplex), next: 0 }
    }

    /// The facets of a p-simplex, the one without the first vertex first; empty for a vertex.
    ///
    /// Cost: [`vertices`](Self::vertices), and p(p−1)/2 searches among children for all.
    #[must_use]
    pub fn facets(&self, simplex: SimplexId) -> Facets<'_, 'a, I> {
        let path = self.path(simplex);
        let end = if path.len() > 1 { path.len() } else { 0 };
        Facets { tree: self, path, next: 0, end }
    }

    /// The q-faces of a p-simplex, q < p, in the order of their ids; empty for q ≥ p.
    ///
    /// Cost: [`vertices`](Self::vertices), and for each face as many searches among children as it has vertices after the
    /// prefix that it shares with the face before it.
    #[must_use]
    pub fn boundary(&self, simplex: SimplexId, dim: Dim) -> Boundary<'_, 'a, I> {
        self.faces(self.path(simplex), dim)
    }

    /// The faces of a p-simplex of all dimensions and the simplex itself, in the order of their ids.
    ///
    /// Cost: as [`boundary`](Self::boundary), 2^(p+1) − 1 faces.
    #[must_use]
    pub fn closure(&self, simplex: SimplexId) -> Closure<'_, 'a, I> {
        let path = self.path(simplex);
        let left = u32::try_from(path.len()).map_or(0, |size| (1_u64 << size) - 1);
        let left = usize::try_from(left).unwrap_or(usize::MAX);
        Closure { faces: self.faces(path, 0), simplex, left }
    }

    fn faces(&self, path: Path, dim: Dim) -> Boundary<'_, 'a, I> {
        let size = dim.saturating_add(1);
        let left = if size < path.len() { binomial(path.len(), size) } else { 0 };
        Boundary { tree: self, path, size, kept: Vec::new(), nodes: Vec::new(), left }
    }
}

/// The vertices of a simplex, increasing: see [`Tree::vertices`].
#[derive(Clone, Debug)]
pub struct Vertices {
    path: Path,
    next: usize,
}

impl Iterator for Vertices {
    type Item = VertexId;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        let node = self.path.get(self.next)?;
        self.next += 1;
        Some(VertexId::new(node.label))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.path.len() - self.next;
        (left, Some(left))
    }
}

impl ExactSizeIterator for Vertices {}
impl core::iter::FusedIterator for Vertices {}

/// The facets of a simplex: see [`Tree::facets`].
#[derive(Clone, Debug)]
pub struct Facets<'v, 'a, I> {
    tree: &'v Tree<'a, I>,
    path: Path,
    /// The positions of the vertices that are still to be omitted.
    next: usize,
    end: usize,
}

impl<I: Index> Facets<'_, '_, I> {
    /// The facet without the vertex at `position`.
    fn facet(&self, position: usize) -> Option<usize> {
        let before = position.checked_sub(1).and_then(|before| self.path.get(before)).map_or(0, |node| node.id);
        let after = self.path.iter().enumerate().skip(position + 1);
        after.into_iter().try_fold(before, |node, (depth, next)| self.tree.child(depth - 1, node, next.label))
    }

    fn found(&mut self, facet: Option<usize>) -> Option<SimplexId> {
        if facet.is_none() {
            // Only in a buffer that is not a tree: a facet lacks.
            self.next = self.end;
        }
        facet.map(SimplexId::new)
    }
}

impl<I: Index> Iterator for Facets<'_, '_, I> {
    type Item = SimplexId;

    fn next(&mut self) -> Option<Self::Item> {
        if self.next == self.end {
            return None;
        }
        let facet = self.facet(self.next);
        self.next += 1;
        self.found(facet)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.end - self.next;
        (left, Some(left))
    }
}

impl<I: Index> DoubleEndedIterator for Facets<'_, '_, I> {
    fn next_back(&mut self) -> Option<Self::Item> {
        if self.next == self.end {
            return None;
        }
        self.end -= 1;
        let facet = self.facet(self.end);
        self.found(facet)
    }
}

impl<I: Index> ExactSizeIterator for Facets<'_, '_, I> {}
impl<I: Index> core::iter::FusedIterator for Facets<'_, '_, I> {}

/// The faces of one dimension of a simplex, in the order of their ids: see [`Tree::boundary`].
#[derive(Clone, Debug)]
pub struct Boundary<'v, 'a, I> {
    tree: &'v Tree<'a, I>,
    path: Path,
    /// How many vertices a face has.
    size: usize,
    /// The positions of the vertices of the face that was handed out last: none before the first.
    kept: Vec<usize, { MAX_DIM + 1 }>,
    /// The nodes on the way to it.
    nodes: Vec<usize, { MAX_DIM + 1 }>,
    left: usize,
}

impl<I: Index> Boundary<'_, '_, I> {
    /// Moves to the next positions in lexicographic order and forgets the nodes that change; whether there were any.
    fn advance(&mut self) -> bool {
        let (size, vertices) = (self.size, self.path.len());
        if self.kept.is_empty() {
            // Never full: a simplex has no more vertices than that.
            return (0..size).all(|position| self.kept.push(position).is_ok());
        }
        // The last one behind which there is room for those after it.
        let movable = |&(place, position): &(usize, usize)| position + (size - place) < vertices;
        let Some((place, position)) = self.kept.iter().copied().enumerate().rev().find(movable) else { return false };
        self.nodes.truncate(place);
        for (kept, next) in self.kept.iter_mut().skip(place).zip(position + 1..) {
            *kept = next;
        }
        true
    }

    /// Descends to the face at the positions.
    fn descend(&mut self) -> Option<usize> {
        for place in self.nodes.len()..self.size {
            let position = *self.kept.get(place)?;
            let next = self.path.get(position)?;
            let node = match self.nodes.last() {
                // All vertices of the simplex up to there.
                _ if position == place => next.id,
                None => self.tree.child(0, 0, next.label)?,
                Some(&node) => self.tree.child(place, node, next.label)?,
            };
            self.nodes.push(node).ok()?;
        }
        self.nodes.last().copied()
    }
}

impl<I: Index> Iterator for Boundary<'_, '_, I> {
    type Item = SimplexId;

    fn next(&mut self) -> Option<Self::Item> {
        self.left = self.left.checked_sub(1)?;
        let face = if self.advance() { self.descend() } else { None };
        if face.is_none() {
            // Only in a buffer that is not a tree: a face lacks.
            self.left = 0;
        }
        face.map(SimplexId::new)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<I: Index> ExactSizeIterator for Boundary<'_, '_, I> {}
impl<I: Index> core::iter::FusedIterator for Boundary<'_, '_, I> {}

/// The faces of a simplex and itself, in the order of their ids: see [`Tree::closure`].
#[derive(Clone, Debug)]
pub struct Closure<'v, 'a, I> {
    /// The faces of the dimension that is being walked.
    faces: Boundary<'v, 'a, I>,
    simplex: SimplexId,
    left: usize,
}

impl<I: Index> Iterator for Closure<'_, '_, I> {
    type Item = SimplexId;

    fn next(&mut self) -> Option<Self::Item> {
        self.left = self.left.checked_sub(1)?;
        if self.left == 0 {
            return Some(self.simplex);
        }
        if self.faces.left == 0 {
            self.faces = self.faces.tree.faces(self.faces.path.clone(), self.faces.size);
        }
        let face = self.faces.next();
        if face.is_none() {
            self.left = 0;
        }
        face
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<I: Index> ExactSizeIterator for Closure<'_, '_, I> {}
impl<I: Index> core::iter::FusedIterator for Closure<'_, '_, I> {}
