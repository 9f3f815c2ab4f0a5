//! A_p: the simplices that share a facet with a simplex, or the vertices that share an edge with a vertex
//! (sig-2004, 6.3).

use super::Simplices;
use crate::complex::Complex;
use crate::id::{Dim, Index, SimplexId};
use crate::scratch::{Scratch, ScratchError};

impl<I: Index> Complex<'_, I> {
    /// The other p-simplices that share a k-face with a p-simplex (sig-2004, 2: k-adjacent); empty for k ≥ p.
    ///
    /// Cost: that of C_{k,p} for each of the k-faces; the answer's part of the scratch needs room for them all, σ and
    /// repetitions included.
    ///
    /// # Errors
    /// [`ScratchError`] if the scratch is too small; it can be used again.
    pub fn k_adjacency<'s>(
        &self,
        simplex: SimplexId,
        k: Dim,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        scratch.start(self.num_simplices())?;
        let dim = self.dim_of(simplex).unwrap_or(0);
        for face in self.boundary(simplex, k) {
            let before = scratch.found.len();
            let gathered = self.gather_cofaces(face, dim, scratch);
            // The next traversal must be free to pass through what this one found.
            scratch.unmark_found(before);
            gathered?;
        }
        scratch.dedup_found(simplex.index());
        Ok(Simplices::new(scratch.found.ids()))
    }

    /// The other ends of the edges at a vertex.
    pub(crate) fn adjacent_vertices<'s>(
        &self,
        vertex: SimplexId,
        scratch: &'s mut Scratch<'_, I>,
    ) -> Result<Simplices<'s, I>, ScratchError> {
        scratch.start(self.num_simplices())?;
        let gathered = self.gather_cofaces(vertex, 1, scratch);
        scratch.unmark_found(0);
        gathered?;
        for edge in scratch.found.ids_mut() {
            let ends = self.row(1, edge.to_usize());
            if let Some(&other) = ends.iter().find(|end| end.to_usize() != vertex.index()) {
                *edge = other;
            }
        }
        Ok(Simplices::new(scratch.found.ids()))
    }
}
