//! The star of a simplex: everything that contains it.

use super::{Simplices, all_positions, delete_bit};
use crate::complex::Complex;
use crate::id::{Dim, Index, SimplexId};
use crate::scratch::{Scratch, ScratchError};

impl<I: Index> Complex<'_, I> {
    /// ⋆σ: the simplex and all simplices that have it as a face. A top simplex is its own star.
    ///
    /// Cost: O(Σ_r λ_r(σ)) for the top simplices, and for each simplex of the star as many reads as it has vertices
    /// outside σ. The queue of the scratch holds the answer. Source: sig-2004, 2 and 6.2. Where the file has the tree's
    /// sections and lower neighbours, and σ has at least four vertices less than a largest simplex, the tree answers:
    /// see [`Tree::star`](crate::Tree::star).
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

    /// st(σ) = ⋆σ − {σ}: all simplices that have the simplex as a proper face.
    ///
    /// Cost: as [`star`](Self::star).
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

    fn gather_star<'s>(
        &self,
        simplex: SimplexId,
        itself: bool,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        if let Some(tree) = self.upward_tree(simplex) {
            return if itself { tree.star(simplex, scratch) } else { tree.restricted_star(simplex, scratch) };
        }
        scratch.start(self.num_simplices())?;
        let own = self.dim_of(simplex).zip(I::from_usize(simplex.index()));
        let gathered = match own {
            Some((dim, id)) => self.queue_star(simplex, dim, id, itself, scratch),
            None => Ok(()),
        };
        scratch.unmark_queue();
        scratch.unmark(simplex.index());
        gathered?;
        Ok(Simplices::new(scratch.queue.ids()))
    }

    fn queue_star(
        &self,
        simplex: SimplexId,
        dim: Dim,
        id: I,
        itself: bool,
        scratch: &mut Scratch<'_, I>,
    ) -> Result<(), ScratchError> {
        scratch.mark(simplex.index());
        if itself {
            scratch.queue.push(id, all_positions(dim))?;
        }
        let tops = scratch.queue.len();
        for cluster in self.clusters(simplex) {
            self.gather_cluster(simplex, dim, cluster, scratch)?;
        }
        let mut head = tops;
        while let Some((coface, mask)) = scratch.queue.get(head) {
            head += 1;
            self.queue_facets(coface, mask, scratch)?;
        }
        Ok(())
    }

    /// Visits the facets of a simplex of the star that are in the star.
    #[inline]
    fn queue_facets(&self, coface: I, mask: u32, scratch: &mut Scratch<'_, I>) -> Result<(), ScratchError> {
        let Some(dim) = self.dim_of(SimplexId::new(coface.to_usize())) else { return Ok(()) };
        let row = self.row(dim, coface.to_usize());
        let mut free = all_positions(dim) & !mask;
        while free != 0 {
            let position = free.trailing_zeros() as usize;
            free &= free - 1;
            if let Some(&facet) = row.get(position) {
                scratch.visit(facet, delete_bit(mask, position))?;
            }
        }
        Ok(())
    }
}
