//! The closure of a simplex: all of its faces, and itself.

use super::{Boundary, all_positions};
use crate::complex::Complex;
use crate::id::{Dim, Index, SimplexId};

impl<I: Index> Complex<'_, I> {
    /// The faces of a p-simplex of all dimensions and the simplex itself, in the order of their ids.
    ///
    /// Cost: about one read a face, of 2^(p+1) − 1.
    #[must_use]
    pub fn closure(&self, simplex: SimplexId) -> Closure<'_, I> {
        let dim = self.dim_of(simplex);
        let own = dim.unwrap_or(0);
        let faces = self.subfaces(own, simplex.index(), dim.map_or(0, all_positions), own);
        Closure { complex: self, simplex, dim: own, faces, left: dim.map_or(0, |dim| all_positions(dim) as usize) }
    }
}

/// The faces of a simplex and itself, in the order of their ids: see [`Complex::closure`].
#[derive(Clone, Debug)]
pub struct Closure<'a, I> {
    complex: &'a Complex<'a, I>,
    simplex: SimplexId,
    dim: Dim,
    /// The faces of the dimension that is being walked.
    faces: Boundary<'a, I>,
    left: usize,
}

impl<I: Index> Iterator for Closure<'_, I> {
    type Item = SimplexId;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        self.left = self.left.checked_sub(1)?;
        loop {
            if let Some(face) = self.faces.next() {
                return Some(face);
            }
            let Some(omitted) = self.faces.omitted().checked_sub(1) else {
                self.left = 0;
                return None;
            };
            self.faces = self.complex.subfaces(self.dim, self.simplex.index(), all_positions(self.dim), omitted);
        }
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<I: Index> ExactSizeIterator for Closure<'_, I> {}
impl<I: Index> core::iter::FusedIterator for Closure<'_, I> {}
