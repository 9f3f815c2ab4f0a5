//! The clusters around a simplex: Algorithm 6 (sig-2004), iteratively.
//!
//! The queue of the scratch is the list of what was found: it grows while it is walked. With each top simplex stands
//! the mask of the positions of σ's vertices in it, so whether a facet contains σ is one bit, and crossing a facet
//! updates the mask: drop the bit of the vertex left behind, insert a zero for the vertex that comes in.

use super::partial::PartialCoboundary;
use super::{Simplices, all_positions, delete_bit, insert_zero};
use crate::complex::Complex;
use crate::id::{Dim, Index, SimplexId};
use crate::scratch::{Scratch, ScratchError};

/// A g-cluster around a simplex: top g-simplices in its restricted star, connected through (g−1)-simplices there.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Cluster {
    /// g: the dimension of its simplices.
    pub dim: Dim,
    /// The one of its simplices with the least id.
    pub representative: SimplexId,
}

impl<I: Index> Complex<'_, I> {
    /// The clusters in the restricted star of a simplex, by decreasing dimension, then increasing representative; none
    /// for a top simplex.
    ///
    /// Cost: Σ_g κ_g(σ) + 1 reads in a row.
    #[must_use]
    pub fn clusters(&self, simplex: SimplexId) -> Clusters<'_, I> {
        Clusters { complex: self, entries: self.partial_coboundary(simplex) }
    }

    /// The simplices of the cluster around `simplex` to which `representative`, any of its simplices, belongs; empty if
    /// that is not a top simplex in the restricted star.
    ///
    /// Cost: O(λ_g(σ)), the number of simplices reported, with about 3g reads for each, and
    /// the entries of higher dimension in the lists of their facets. Source: Algorithm 6.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small; it can be used again.
    pub fn cluster_members<'s>(
        &self,
        simplex: SimplexId,
        representative: SimplexId,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        scratch.start(self.num_simplices())?;
        let gathered = match self.dim_of(simplex) {
            Some(dim) if self.is_top(representative) => {
                let cluster = Cluster { dim: self.dim_of(representative).unwrap_or(0), representative };
                self.gather_cluster(simplex, dim, cluster, scratch)
            }
            _ => Ok(()),
        };
        scratch.unmark_queue();
        gathered?;
        Ok(Simplices::new(scratch.queue.ids()))
    }

    /// Appends a cluster around a p-simplex to the queue, marked, each simplex with the mask of σ in it.
    pub(crate) fn gather_cluster(
        &self,
        simplex: SimplexId,
        dim: Dim,
        cluster: Cluster,
        scratch: &mut Scratch<'_, I>,
    ) -> Result<(), ScratchError> {
        let Cluster { dim: top_dim, representative } = cluster;
        let Some(first) = I::from_usize(representative.index()) else { return Ok(()) };
        if top_dim == dim + 1 {
            // A cluster by itself; the one vertex that σ lacks is opposite to it.
            let row = self.row(top_dim, representative.index());
            let opposite = row.iter().position(|facet| facet.to_usize() == simplex.index());
            let mask = opposite.map(|position| all_positions(top_dim) ^ 1 << position);
            return mask.map_or(Ok(()), |mask| scratch.visit(first, mask));
        }
        // A representative that does not contain σ: only in a buffer that is not a complex.
        let Some(mask) = self.positions(simplex, representative).filter(|_| top_dim > dim) else { return Ok(()) };
        let mut head = scratch.queue.len();
        scratch.visit(first, mask)?;
        while let Some((top, mask)) = scratch.queue.get(head) {
            head += 1;
            self.cross_facets(top, top_dim, mask, scratch)?;
        }
        Ok(())
    }

    /// Visits the top simplices that share a facet around σ with `top`.
    ///
    /// The first of them leads to all others, and each other one to the first: so the list of a facet with many is read to
    /// its end once, not once for each of them. Else a book of n pages would take n² steps.
    #[inline]
    fn cross_facets(&self, top: I, dim: Dim, mask: u32, scratch: &mut Scratch<'_, I>) -> Result<(), ScratchError> {
        let row = self.row(dim, top.to_usize());
        let ids = self.levels().ids(dim);
        let mut free = all_positions(dim) & !mask;
        while free != 0 {
            let position = free.trailing_zeros() as usize;
            free &= free - 1;
            let Some(&facet) = row.get(position) else { continue };
            let mut entries = self.partial_coboundary(SimplexId::new(facet.to_usize()));
            let mut is_first = true;
            while let Some(other) = entries.next_index() {
                if !ids.contains(&other.to_usize()) {
                    continue;
                }
                if other != top && scratch.mark(other.to_usize()) {
                    let other_row = self.row(dim, other.to_usize());
                    let entered = other_row.iter().position(|&shared| shared == facet).unwrap_or(0);
                    let mask = insert_zero(delete_bit(mask, position), entered);
                    scratch.queue.push(other, mask).inspect_err(|_| scratch.unmark(other.to_usize()))?;
                }
                if is_first && other != top {
                    break;
                }
                is_first = false;
            }
        }
        Ok(())
    }
}

/// The clusters around a simplex: see [`Complex::clusters`].
#[derive(Clone, Debug)]
pub struct Clusters<'a, I> {
    complex: &'a Complex<'a, I>,
    entries: PartialCoboundary<'a, I>,
}

impl<I: Index> Iterator for Clusters<'_, I> {
    type Item = Cluster;

    fn next(&mut self) -> Option<Self::Item> {
        let representative = self.entries.next()?;
        Some(Cluster { dim: self.complex.dim_of(representative)?, representative })
    }
}

impl<I: Index> core::iter::FusedIterator for Clusters<'_, I> {}
