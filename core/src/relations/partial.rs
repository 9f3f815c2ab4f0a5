//! C*_{p,g}: the stored partial co-boundary, one representative of each cluster (sig-2004, 4.1).

use crate::complex::Complex;
use crate::id::{Dim, Index, SimplexId};

impl<'a, I: Index> Complex<'a, I> {
    /// C*_{p,g}(σ) for all g > p: the least top simplex of each cluster in the restricted star, by decreasing g, then
    /// increasing id. Empty for a top simplex.
    ///
    /// Cost: Σ_g κ_g(σ) + 1 reads in a row.
    #[must_use]
    #[inline]
    pub fn partial_coboundary(&self, simplex: SimplexId) -> PartialCoboundary<'a, I> {
        let index = simplex.index();
        let entries = match self.pointer(index) {
            None => self.pair(index).unwrap_or(&[]),
            // The pointer is itself the only entry.
            Some(_) if self.flag(index) => self.pointers_from(index).get(..1).unwrap_or(&[]),
            Some(offset) => self.lists_from(offset.to_usize()),
        };
        PartialCoboundary { entries: entries.iter() }
    }

    /// C*_{p,g}(σ) for one g. Cost: as [`partial_coboundary`](Self::partial_coboundary).
    pub fn partial_coboundary_of_dim(
        &self,
        simplex: SimplexId,
        dim: Dim,
    ) -> impl Iterator<Item = SimplexId> + Clone + use<'a, I> {
        let ids = self.levels().ids(dim);
        self.partial_coboundary(simplex).filter(move |entry| ids.contains(&entry.index()))
    }

    /// Whether the simplex is a top simplex: a face of no other. Cost: O(1).
    #[must_use]
    #[inline]
    pub fn is_top(&self, simplex: SimplexId) -> bool {
        simplex.index() < self.num_simplices() && self.partial_coboundary(simplex).next().is_none()
    }

    /// The paper's manifold flag (sig-2004, 4.2): whether C*(σ) is exactly one simplex, of the dimension d of the
    /// complex, and p < d − 1.
    ///
    /// That is *one cluster* of d-simplices and no other; it does not say that the complex is a manifold at σ: the apex
    /// of a cone over a torus has it. False for p ≥ d − 1, where the file has no such flag. Cost: O(1).
    #[must_use]
    #[inline]
    pub fn is_single_cluster(&self, simplex: SimplexId) -> bool {
        self.flag(simplex.index())
    }
}

/// The entries of a partial co-boundary: see [`Complex::partial_coboundary`].
#[derive(Clone, Debug)]
pub struct PartialCoboundary<'a, I> {
    /// What is left of the entries, and perhaps a stop code and more behind them.
    entries: core::slice::Iter<'a, I>,
}

impl<I: Index> PartialCoboundary<'_, I> {
    /// The next entry at the width of the buffer.
    #[inline]
    pub(crate) fn next_index(&mut self) -> Option<I> {
        match self.entries.next() {
            Some(&entry) if entry != I::STOP => Some(entry),
            _ => {
                self.entries = [].iter();
                None
            }
        }
    }
}

impl<I: Index> Iterator for PartialCoboundary<'_, I> {
    type Item = SimplexId;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        self.next_index().map(|entry| SimplexId::new(entry.to_usize()))
    }
}

impl<I: Index> core::iter::FusedIterator for PartialCoboundary<'_, I> {}
