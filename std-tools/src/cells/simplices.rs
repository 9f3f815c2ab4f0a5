//! Simplicial complexes as cell complexes.

use sig_core::{Arc, CellId, Dim, Incidence, Index, Relations, SimplexId};

use super::CellComplex;
use crate::build::{Arrays, Built, SigArrays, narrow};

/// A complex has more cells than can be told apart.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("{cells} cells are more than {}", CellId::LIMIT)]
pub struct TooManyCells {
    /// How many cells it has.
    pub cells: usize,
}

impl CellComplex {
    /// The cell complex of a complex that was built: cell `i` is simplex `i`, and the facet without vertex `k` of a simplex has
    /// the incidence number (−1)^k.
    ///
    /// Cost: two passes over the facets.
    ///
    /// # Errors
    /// [`TooManyCells`].
    pub fn from_built(built: &Built) -> Result<Self, TooManyCells> {
        match &built.arrays {
            Arrays::Narrow(arrays) => Self::from_arrays(arrays),
            Arrays::Wide(arrays) => Self::from_arrays(arrays),
        }
    }

    /// The same of a complex in a file, a SIG or a tree.
    ///
    /// # Errors
    /// [`TooManyCells`].
    pub fn from_complex(complex: &impl Relations) -> Result<Self, TooManyCells> {
        let dims = complex.dim().map_or(0, |dim| dim + 1);
        let counts: Vec<usize> = (0..dims).map(|dim| complex.num_simplices_of_dim(dim)).collect();
        Self::from_facets(&counts, |number, visit| {
            // Facets come by decreasing number.
            let facets = complex.facets(SimplexId::new(number as usize));
            let last = facets.len().wrapping_sub(1);
            for (back, facet) in facets.rev().enumerate() {
                visit(last - back, facet.index());
            }
        })
    }

    fn from_arrays<I: Index>(arrays: &SigArrays<I>) -> Result<Self, TooManyCells> {
        let counts: Vec<usize> = (0..arrays.first.len()).map(|dim| arrays.ids(dim).len()).collect();
        let levels: Vec<(usize, &[I])> =
            arrays.first.iter().enumerate().map(|(dim, &first)| (first, arrays.facets(dim))).collect();
        Self::from_facets(&counts, |number, visit| {
            let number = number as usize;
            let dim = levels.iter().rposition(|&(first, _)| first <= number).unwrap_or(0);
            let (first, facets) = levels[dim];
            if dim > 0 {
                let row = &facets[(number - first) * (dim + 1)..][..=dim];
                row.iter().enumerate().rev().for_each(|(position, facet)| visit(position, facet.to_usize()));
            }
        })
    }

    /// `facets(simplex, visit)` calls `visit(k, facet)` for the facets that lack vertex k, k decreasing.
    fn from_facets(counts: &[usize], facets: impl Fn(u32, &mut dyn FnMut(usize, usize))) -> Result<Self, TooManyCells> {
        let cells = counts.iter().sum();
        if cells > CellId::LIMIT {
            return Err(TooManyCells { cells });
        }
        let dims = counts.iter().enumerate().flat_map(|(dim, &count): (Dim, &usize)| std::iter::repeat_n(dim, count));
        Ok(Self::lay_out(dims, |number, visit| {
            facets(number, &mut |position, facet| {
                let sign = if position % 2 == 0 { 1 } else { -1 };
                visit(Arc { cell: CellId::new(narrow(facet)), incidence: Incidence::once(sign) });
            });
        }))
    }
}
