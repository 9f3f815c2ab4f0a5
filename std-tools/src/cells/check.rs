//! What is true of every cell complex.

use hashbrown::HashMap;
use sig_core::{CellId, Dim, Incidence};

use super::CellComplex;
use super::lists::{self, Side};

/// An invariant that does not hold, and where.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BrokenInvariant {
    /// A boundary or co-boundary does not name cells of the dimension below or above, in increasing order.
    #[error(
        "cell {cell}: the list of neighbours is out of order, or names {neighbour}, which is not of the dimension beside"
    )]
    List {
        /// The cell.
        cell: CellId,
        /// The neighbour.
        neighbour: CellId,
    },
    /// The two ends of an arc do not say the same.
    #[error("cells {low} and {high} are not incident in the same way seen from either")]
    Ends {
        /// The cell of lower dimension.
        low: CellId,
        /// The other.
        high: CellId,
    },
    /// A multiplicity is 0, or no number of appearances has that sign: see [`Incidence::is_consistent`].
    #[error("cells {low} and {high}: no {} appearances add up to {}", incidence.multiplicity, incidence.sign)]
    Incidence {
        /// The cell of lower dimension.
        low: CellId,
        /// The other.
        high: CellId,
        /// What is said of them.
        incidence: Incidence,
    },
    /// The boundary of the boundary of a cell is not zero.
    #[error("cell {cell}: the boundary of its boundary is {coefficient} times {face}, not zero")]
    BoundaryOfBoundary {
        /// The cell.
        cell: CellId,
        /// A cell two dimensions below.
        face: CellId,
        /// Its coefficient.
        coefficient: i64,
    },
    /// The cells of a dimension were miscounted.
    #[error("{counted} cells of dimension {dim} are counted, {found} found")]
    Count {
        /// The dimension.
        dim: Dim,
        /// The count.
        counted: usize,
        /// The number of cells.
        found: usize,
    },
}

impl CellComplex {
    /// Checks that boundaries and co-boundaries say the same, that signs fit multiplicities, that the boundary of every
    /// boundary is zero, and the numbers of cells. With these, the Euler–Poincaré formula is a theorem.
    ///
    /// Cost: linear in the arcs, but for the boundaries of boundaries, which take a step for each pair of arcs that follow on
    /// one another.
    ///
    /// # Errors
    /// The first [`BrokenInvariant`].
    pub fn check(&self) -> Result<(), BrokenInvariant> {
        let mut found = vec![0; self.counts.len()];
        let mut sum = HashMap::new();
        for cell in self.cells() {
            let dim = self.dim_of(cell).unwrap_or(0);
            found[dim] += 1;
            self.check_lists(cell, dim)?;
            sum.clear();
            for facet in self.boundary(cell) {
                for face in self.boundary(facet.cell) {
                    let product = i64::from(facet.incidence.sign) * i64::from(face.incidence.sign);
                    *sum.entry(face.cell).or_insert(0_i64) += product;
                }
            }
            if let Some((&face, &coefficient)) = sum.iter().filter(|&(_, &sum)| sum != 0).min() {
                return Err(BrokenInvariant::BoundaryOfBoundary { cell, face, coefficient });
            }
        }
        for (dim, (&counted, found)) in self.counts.iter().zip(found).enumerate() {
            if counted != found {
                return Err(BrokenInvariant::Count { dim, counted, found });
            }
        }
        Ok(())
    }

    fn check_lists(&self, cell: CellId, dim: Dim) -> Result<(), BrokenInvariant> {
        let mut before = None;
        for arc in self.boundary(cell) {
            if before.replace(arc.cell) >= Some(arc.cell) || self.dim_of(arc.cell).map(|below| below + 1) != Some(dim) {
                return Err(BrokenInvariant::List { cell, neighbour: arc.cell });
            }
            let (low, high, incidence) = (arc.cell, cell, arc.incidence);
            let back = self.list(low, Side::Coboundary);
            let back = lists::find(back, high).map(|at| self.incidence_of(low, high, back[at]));
            if back != Some(incidence) {
                return Err(BrokenInvariant::Ends { low, high });
            }
            if incidence.multiplicity == 0 || !incidence.is_consistent() {
                return Err(BrokenInvariant::Incidence { low, high, incidence });
            }
        }
        before = None;
        for arc in self.coboundary(cell) {
            if before.replace(arc.cell) >= Some(arc.cell) || self.dim_of(arc.cell) != Some(dim + 1) {
                return Err(BrokenInvariant::List { cell, neighbour: arc.cell });
            }
            if self.incidence(cell, arc.cell) != arc.incidence {
                return Err(BrokenInvariant::Ends { low: cell, high: arc.cell });
            }
        }
        Ok(())
    }
}
