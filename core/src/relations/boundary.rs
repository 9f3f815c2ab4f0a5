//! B_{p,q}: the faces of a simplex (sig-2004, 6.1), without marks.
//!
//! A q-face of a p-simplex is reached by deleting p − q vertices. Deleting them by increasing position reaches each
//! face exactly once, so Algorithm 4's visited flags are not needed, and no memory but a path of p − q steps.

use heapless::Vec;

use super::{all_positions, delegate_iterator, simplex_at};
use crate::complex::Complex;
use crate::id::{Dim, Index, MAX_DIM, SimplexId};

impl<'a, I: Index> Complex<'a, I> {
    /// B_{p,p−1}(σ): the facets of a p-simplex, the one without the first vertex first; empty for a vertex.
    ///
    /// Cost: a slice of p + 1 indices.
    #[must_use]
    #[inline]
    pub fn facets(&self, simplex: SimplexId) -> Facets<'a, I> {
        let row = self.dim_of(simplex).map_or(&[][..], |dim| self.row(dim, simplex.index()));
        Facets { row: row.iter() }
    }

    /// B_{p,q}(σ): the q-faces of a p-simplex, q < p, in the order of their ids; empty for q ≥ p.
    ///
    /// Cost: the binomial number of faces, each about one read; constant for given p and q. Source: Algorithm 4.
    #[must_use]
    pub fn boundary(&self, simplex: SimplexId, dim: Dim) -> Boundary<'_, I> {
        match self.dim_of(simplex) {
            Some(own) if dim < own => self.subfaces(own, simplex.index(), all_positions(own), own - dim),
            _ => self.subfaces(0, simplex.index(), 0, 1),
        }
    }

    /// The faces of a simplex of dimension `dim` that omit exactly `omitted` of the vertex positions in `deletable`, in
    /// the order of their ids.
    #[inline]
    pub(crate) fn subfaces(&self, dim: Dim, simplex: usize, deletable: u32, omitted: usize) -> Boundary<'_, I> {
        let free = deletable.count_ones() as usize;
        let left = if omitted > free { 0 } else { binomial(free, omitted) };
        Boundary { complex: self, dim, simplex, deletable, omitted, path: Vec::new(), left }
    }
}

/// The facets of a simplex: see [`Complex::facets`].
#[derive(Clone, Debug)]
pub struct Facets<'a, I> {
    row: core::slice::Iter<'a, I>,
}

delegate_iterator!([I: Index] Facets<'_, I>, row, simplex_at);

/// A deleted vertex on the way from a simplex down to a face of it.
#[derive(Clone, Copy, Debug)]
struct Step<'a, I> {
    /// The facets of the face from which the vertex is deleted.
    row: &'a [I],
    /// The position of the vertex in the simplex.
    position: u32,
}

/// The faces of one dimension of a simplex, in the order of their ids: see [`Complex::boundary`].
///
/// Lexicographic order of the faces is the reverse of that of the deleted positions, which are enumerated from the last
/// combination to the first.
#[derive(Clone, Debug)]
pub struct Boundary<'a, I> {
    complex: &'a Complex<'a, I>,
    dim: Dim,
    simplex: usize,
    deletable: u32,
    omitted: usize,
    /// The deletions that lead to the face that was handed out last: none before the first.
    path: Vec<Step<'a, I>, { MAX_DIM + 1 }>,
    left: usize,
}

impl<I: Index> Boundary<'_, I> {
    /// How many vertices each face omits.
    pub(crate) const fn omitted(&self) -> usize {
        self.omitted
    }

    /// The face that the path leads to.
    #[inline]
    fn face(&self) -> Option<usize> {
        let Some(last) = self.path.last() else { return Some(self.simplex) };
        // Each vertex deleted before moves the later ones down by one.
        let column = last.position as usize - (self.path.len() - 1);
        last.row.get(column).map(|face| face.to_usize())
    }

    /// Deletes the last free positions, as many as are missing.
    fn descend(&mut self) -> Option<()> {
        let missing = self.omitted - self.path.len();
        let mut chosen = self.deletable;
        for _ in missing..chosen.count_ones() as usize {
            chosen &= chosen - 1;
        }
        while chosen != 0 {
            let row = self.complex.row(self.dim.checked_sub(self.path.len())?, self.face()?);
            self.path.push(Step { row, position: chosen.trailing_zeros() }).ok()?;
            chosen &= chosen - 1;
        }
        Some(())
    }

    /// Moves the last deletion that can move to the free position before; whether there was one.
    #[inline]
    fn move_down(&mut self) -> bool {
        loop {
            let above = self.path.len().checked_sub(2).and_then(|index| self.path.get(index));
            let floor = above.map_or(0, |step| step.position + 1);
            let Some(last) = self.path.last_mut() else { return false };
            let lower = self.deletable & ((1 << last.position) - 1) & (u32::MAX << floor);
            if let Some(position) = lower.checked_ilog2() {
                last.position = position;
                return true;
            }
            self.path.pop();
        }
    }
}

impl<I: Index> Iterator for Boundary<'_, I> {
    type Item = SimplexId;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        self.left = self.left.checked_sub(1)?;
        let first = self.path.is_empty();
        let moved = first || self.move_down();
        let complete = moved && (self.path.len() == self.omitted || self.descend().is_some());
        let face = if complete { self.face() } else { None };
        if face.is_none() {
            // Only in a buffer that is not a complex: a facet led nowhere.
            self.left = 0;
        }
        face.map(SimplexId::new)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<I: Index> ExactSizeIterator for Boundary<'_, I> {}
impl<I: Index> core::iter::FusedIterator for Boundary<'_, I> {}

/// n over k, for k ≤ n ≤ 32: at most 601,080,390.
pub(crate) fn binomial(n: usize, k: usize) -> usize {
    let k = k.min(n - k);
    let exact = (0..k as u64).fold(1u64, |product, i| product * (n as u64 - i) / (i + 1));
    usize::try_from(exact).unwrap_or(usize::MAX)
}
