//! The vertices of a simplex: its word in the simplex tree.

use crate::complex::Complex;
use crate::id::{Dim, Index, SimplexId, VertexId};

impl<I: Index> Complex<'_, I> {
    /// The vertices of a p-simplex, increasing; one for a vertex.
    ///
    /// Cost: the k-th vertex takes p − k reads, all p(p+1)/2; no marks, unlike B_{p,0} by Algorithm 4, which takes
    /// (p+1)! steps.
    #[must_use]
    #[inline]
    pub fn vertices(&self, simplex: SimplexId) -> Vertices<'_, I> {
        let dim = self.dim_of(simplex);
        Vertices { complex: self, rest: simplex.index(), dim: dim.unwrap_or(0), left: dim.map_or(0, |dim| dim + 1) }
    }

    /// The last vertex of a p-simplex. Cost: p reads, or one where the file has the last vertices.
    #[must_use]
    #[inline]
    pub fn last_vertex(&self, simplex: SimplexId) -> Option<VertexId> {
        let dim = self.dim_of(simplex)?;
        match self.as_tree() {
            Some(tree) => tree.last_vertex(simplex),
            None => self.last_vertex_by_facets(dim, simplex.index()).map(VertexId::new),
        }
    }

    /// The vertex that is left when the first vertex is dropped again and again.
    pub(crate) fn last_vertex_by_facets(&self, dim: Dim, simplex: usize) -> Option<usize> {
        (1..=dim).rev().try_fold(simplex, |face, dim| self.facet(dim, face, 0))
    }

    /// The vertex that is left when the last vertex is dropped again and again.
    #[inline]
    fn first_vertex(&self, dim: Dim, simplex: usize) -> Option<usize> {
        (1..=dim).rev().try_fold(simplex, |face, dim| self.facet(dim, face, dim))
    }

    /// At which vertex positions of `container`, a simplex of dimension `dim`, the vertices of `simplex` lie; `None` if
    /// it is not a face.
    pub(crate) fn positions(&self, simplex: SimplexId, container: SimplexId) -> Option<u32> {
        let mut mask = 0;
        let mut places = self.vertices(container).enumerate();
        for vertex in self.vertices(simplex) {
            let (position, _) = places.find(|&(_, other)| other == vertex)?;
            mask |= 1 << position;
        }
        Some(mask)
    }
}

/// The vertices of a simplex, increasing: see [`Complex::vertices`].
#[derive(Clone, Debug)]
pub struct Vertices<'a, I> {
    complex: &'a Complex<'a, I>,
    /// The face of the vertices that are left.
    rest: usize,
    dim: Dim,
    left: usize,
}

impl<I: Index> Iterator for Vertices<'_, I> {
    type Item = VertexId;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        self.left = self.left.checked_sub(1)?;
        let Some(vertex) = self.complex.first_vertex(self.dim, self.rest) else {
            // Only in a buffer that is not a complex: a facet led nowhere.
            self.left = 0;
            return None;
        };
        if self.left > 0 {
            match self.complex.facet(self.dim, self.rest, 0) {
                Some(rest) => self.rest = rest,
                None => self.left = 0,
            }
            self.dim -= 1;
        }
        Some(VertexId::new(vertex))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.left, Some(self.left))
    }
}

impl<I: Index> ExactSizeIterator for Vertices<'_, I> {}
impl<I: Index> core::iter::FusedIterator for Vertices<'_, I> {}
