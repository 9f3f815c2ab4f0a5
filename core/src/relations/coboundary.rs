//! C_{p,g}: the cofaces of a simplex (sig-2004, 6.2), Algorithm 5 without its rejected candidates.
//!
//! Each cluster of dimension r ≥ g is gathered; the g-faces of a top simplex that contain σ are those that omit vertices
//! outside σ only, so they are enumerated, not tested. Only duplicates between two top simplices need a mark.

use super::{Simplices, all_positions};
use crate::complex::Complex;
use crate::id::{Dim, Index, SimplexId};
use crate::scratch::{Scratch, ScratchError};

impl<I: Index> Complex<'_, I> {
    /// C_{p,g}(σ): the g-simplices in the restricted star of a p-simplex, g > p; empty for g ≤ p or g > d.
    ///
    /// Cost: O(Σ_{g≤r≤d} λ_r(σ)), with a factor that depends on p, g and r only: (r−p over g−p) faces for a top
    /// r-simplex. For g = d it is linear in the answer. Source: Algorithms 5 and 6. By way of the tree where
    /// [`star`](Self::star) goes that way.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small; it can be used again.
    pub fn coboundary<'s>(
        &self,
        simplex: SimplexId,
        dim: Dim,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        if let Some(tree) = self.upward_tree(simplex) {
            return tree.coboundary(simplex, dim, scratch);
        }
        scratch.start(self.num_simplices())?;
        let gathered = self.gather_cofaces(simplex, dim, scratch);
        scratch.unmark_found(0);
        gathered?;
        Ok(Simplices::new(scratch.found.ids()))
    }

    /// Appends the cofaces of dimension `dim` that are not yet marked to the answer, and marks them.
    pub(crate) fn gather_cofaces(
        &self,
        simplex: SimplexId,
        dim: Dim,
        scratch: &mut Scratch<'_, I>,
    ) -> Result<(), ScratchError> {
        let Some(own) = self.dim_of(simplex).filter(|&own| dim > own) else { return Ok(()) };
        // The clusters come by decreasing dimension.
        for cluster in self.clusters(simplex).take_while(|cluster| cluster.dim >= dim) {
            if cluster.dim == own + 1 {
                // The cluster is one simplex, and of dimension `dim`.
                I::from_usize(cluster.representative.index()).map_or(Ok(()), |top| scratch.report(top))?;
                continue;
            }
            scratch.queue.clear();
            let gathered = self.gather_cluster(simplex, own, cluster, scratch);
            // The clusters of one dimension have no simplex in common.
            scratch.unmark_queue();
            gathered?;
            self.report_faces(cluster.dim, dim, scratch)?;
        }
        Ok(())
    }

    /// Reports the faces of dimension `dim` around σ of the queued simplices, whose dimension is `top_dim`.
    fn report_faces(&self, top_dim: Dim, dim: Dim, scratch: &mut Scratch<'_, I>) -> Result<(), ScratchError> {
        let mut head = 0;
        while let Some((top, mask)) = scratch.queue.get(head) {
            head += 1;
            if top_dim == dim {
                scratch.report(top)?;
                continue;
            }
            let deletable = all_positions(top_dim) & !mask;
            for face in self.subfaces(top_dim, top.to_usize(), deletable, top_dim - dim) {
                if let Some(face) = I::from_usize(face.index()) {
                    scratch.report(face)?;
                }
            }
        }
        Ok(())
    }
}
