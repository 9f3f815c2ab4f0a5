//! B_{p,q}: the faces of a simplex (sig-2004, 6.1), without marks.
//!
//! A q-face of a p-simplex is reached by deleting p − q vertices. Deleting them by increasing position reaches each
//! face exactly once, so Algorithm 4's visited flags are not needed, and no memory but a path of p − q steps.

use heapless::Vec;

use super::all_positions;
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
    pub(crate) fn subfaces(&self, dim: Dim, simplex: usize, deletable: u32, omitted: usize) -> Boundary<'_, I> {
        let free = deletable.count_ones() as usize;
        Boundary {
            complex: self,
            dim,
            simplex,
            deletable,
            omitted,
            path: Vec::new(),
            left: if omitted > free { 0 } else { binomial(free, omitted) },
            started: false,
        }
    }
}

/// The facets of a simplex: see [`Complex::facets`].
#[derive(Clone, Debug)]
pub struct Facets<'a, I> {
    row: core::slice::Iter<'a, I>,
}

impl<I: Index> Iterator for Facets<'_, I> {
    type Item = SimplexId;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        self.row.next().map(|id| SimplexId::new(id.to_usize()))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.row.size_hint()
    }
}

impl<I: Index> DoubleEndedIterator for Facets<'_, I> {
    #[inline]
    fn next_back(&mut self) -> Option<Self::Item> {
        self.row.next_back().map(|id| SimplexId::new(id.to_usize()))
    }
}

impl<I: Index> ExactSizeIterator for Facets<'_, I> {}
impl<I: Index> core::iter::FusedIterator for Facets<'_, I> {}

/// A face on the way from a simplex down to a face of it, and the position, in the simplex, of the vertex that was
/// deleted to reach it.
#[derive(Clone, Copy, Debug)]
struct Step {
    face: usize,
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
    path: Vec<Step, MAX_DIM>,
    left: usize,
    started: bool,
}

impl<I: Index> Boundary<'_, I> {
    /// How many vertices each face omits.
    pub(crate) const fn omitted(&self) -> usize {
        self.omitted
    }

    /// The face that the path ends at.
    fn face(&self) -> usize {
        self.path.last().map_or(self.simplex, |step| step.face)
    }

    /// Deletes one more vertex, at `position` of the simplex, after all that were deleted below it.
    fn descend(&mut self, position: u32) -> Option<()> {
        let deleted = self.path.len();
        let face = self.complex.facet(self.dim.checked_sub(deleted)?, self.face(), position as usize - deleted)?;
        self.path.push(Step { face, position }).ok()
    }

    /// Deletes the last free positions until `omitted` vertices are deleted.
    fn descend_to_end(&mut self) -> Option<()> {
        let missing = self.omitted - self.path.len();
        let mut chosen = self.deletable;
        for _ in missing..chosen.count_ones() as usize {
            chosen &= chosen - 1;
        }
        while chosen != 0 {
            self.descend(chosen.trailing_zeros())?;
            chosen &= chosen - 1;
        }
        Some(())
    }

    /// Moves to the combination of positions before this one: the last position that can move down does, and those
    /// after it start again from the end.
    fn step_back(&mut self) -> Option<()> {
        loop {
            let last = self.path.pop()?;
            let floor = self.path.last().map_or(0, |step| step.position + 1);
            let lower = self.deletable & ((1 << last.position) - 1) & (u32::MAX << floor);
            if lower != 0 {
                self.descend(lower.ilog2())?;
                return self.descend_to_end();
            }
        }
    }
}

impl<I: Index> Iterator for Boundary<'_, I> {
    type Item = SimplexId;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        self.left = self.left.checked_sub(1)?;
        let moved = if self.started { self.step_back() } else { self.descend_to_end() };
        self.started = true;
        if moved.is_none() {
            // Only in a buffer that is not a complex: a facet led nowhere.
            self.left = 0;
            return None;
        }
        Some(SimplexId::new(self.face()))
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
