//! The link of a simplex: the faces of its star that do not meet it.

use super::Simplices;
use crate::complex::Complex;
use crate::id::{Dim, Index, SimplexId};
use crate::scratch::{Scratch, ScratchError};

impl<I: Index> Complex<'_, I> {
    /// Lk(σ): the simplices τ with τ ∩ σ = ∅ and τ ∪ σ in the complex. Empty for a top simplex.
    ///
    /// Its simplices stand one to one for those of the restricted star, which are σ ∪ τ. Cost: O(Σ_r λ_r(σ)) for the
    /// top simplices, and for each simplex of the link as many reads as it has vertices.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small; it can be used again.
    pub fn link<'s>(
        &self,
        simplex: SimplexId,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        scratch.start(self.num_simplices())?;
        let gathered = self.gather_link(simplex, scratch);
        scratch.unmark_found(0);
        gathered?;
        Ok(Simplices::new(scratch.found.ids()))
    }

    fn gather_link(&self, simplex: SimplexId, scratch: &mut Scratch<'_, I>) -> Result<(), ScratchError> {
        let Some(dim) = self.dim_of(simplex) else { return Ok(()) };
        for cluster in self.clusters(simplex) {
            scratch.queue.clear();
            let gathered = self.gather_cluster(simplex, dim, cluster, scratch);
            scratch.unmark_queue();
            gathered?;
            let mut head = 0;
            while let Some((top, mask)) = scratch.queue.get(head) {
                head += 1;
                if let Some(opposite) = self.opposite(cluster.dim, top.to_usize(), mask) {
                    scratch.report(opposite)?;
                }
            }
        }
        let mut head = 0;
        while let Some(&face) = scratch.found.ids().get(head) {
            head += 1;
            let face = SimplexId::new(face.to_usize());
            let row = self.dim_of(face).map_or(&[][..], |dim| self.row(dim, face.index()));
            row.iter().try_for_each(|&facet| scratch.report(facet))?;
        }
        Ok(())
    }

    /// The face of a simplex that omits the vertex positions in a mask, which are not all of them.
    fn opposite(&self, dim: Dim, simplex: usize, mask: u32) -> Option<I> {
        let (mut face, mut face_dim, mut omitted) = (simplex, dim, mask);
        while omitted != 0 {
            let last = omitted.ilog2();
            omitted ^= 1 << last;
            face = self.facet(face_dim, face, last as usize)?;
            face_dim = face_dim.checked_sub(1)?;
        }
        I::from_usize(face)
    }
}
