//! The top simplices of a complex with their orientations: what exporters write and a rebuild starts from.

use sig_core::complex::SimplexRange;
use sig_core::format::Column;
use sig_core::{Dim, Relations, SimplexId, VertexId};

/// A top simplex: a face of no other.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct TopSimplex {
    /// The simplex.
    pub id: SimplexId,
    /// Its dimension.
    pub dim: Dim,
    /// Whether its vertices in increasing order are an odd permutation of the order in which its input had them.
    pub is_odd: bool,
}

/// The top simplices of a complex in the order of their ids: see [`top_simplices`].
#[derive(Clone, Debug)]
pub struct TopSimplices<'v, V> {
    complex: &'v V,
    ids: SimplexRange,
    parity: Option<Column<'v>>,
    /// How many were found: the row in the parity.
    found: usize,
}

/// The top simplices of `complex` in the order of their ids. Cost: [`Relations::is_top`] a simplex of the complex.
#[must_use]
pub fn top_simplices<V: Relations>(complex: &V) -> TopSimplices<'_, V> {
    TopSimplices { complex, ids: complex.simplices(), parity: complex.parity(), found: 0 }
}

impl<V: Relations> Iterator for TopSimplices<'_, V> {
    type Item = TopSimplex;

    fn next(&mut self) -> Option<TopSimplex> {
        let complex = self.complex;
        let id = self.ids.find(|&id| complex.is_top(id))?;
        let is_odd = self.parity.and_then(|parity| parity.bit_at(self.found)).unwrap_or(false);
        self.found += 1;
        Some(TopSimplex { id, dim: complex.dim_of(id)?, is_odd })
    }
}

impl<V: Relations> std::iter::FusedIterator for TopSimplices<'_, V> {}

impl TopSimplex {
    /// Fills `vertices` with the vertices in an order of the orientation that the input gave: increasing, the last two
    /// exchanged if that is odd.
    pub fn oriented_vertices(&self, complex: &impl Relations, vertices: &mut Vec<VertexId>) {
        vertices.clear();
        vertices.extend(complex.vertices(self.id));
        if let ([.., a, b], true) = (vertices.as_mut_slice(), self.is_odd) {
            std::mem::swap(a, b);
        }
    }
}
