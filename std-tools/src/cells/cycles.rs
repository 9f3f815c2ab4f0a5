//! Euler operators that change the homology (mcc-2012, 4.1): KiCiCycle kills an i-cell and the i-cycle on which it lies, MiCiCycle
//! makes them. n_i and b_i change by one, over every field, and nothing else.
//!
//! That a cell lies on a cycle cannot be seen from its neighbours, so the caller names the cycle: a chain of i-cells with the
//! cell once, whose boundary is zero. What the cell alone bounds must be nothing; then the cycle bounds nothing either, and
//! without the cell it is no cycle.

use hashbrown::HashMap;
use sig_core::{Arc, CellId, Dim, MAX_DIM, PackedArc};

use super::lists::{Header, Side};
use super::{CellComplex, Infeasible};

/// An i-cell and an i-cycle on it: what KiCiCycle kills, and MiCiCycle makes.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct CellWithCycle {
    /// The cell.
    pub cell: CellId,
    /// i.
    pub dim: Dim,
    /// The (i−1)-cells on its boundary, by number.
    pub boundary: Vec<Arc>,
    /// The coefficients of i-cells in a cycle; that of the cell is 1 or −1.
    pub cycle: Vec<(CellId, i64)>,
}

impl CellComplex {
    /// KiCiCycle: kills an i-cell that bounds nothing and lies on a cycle, and returns what makes it again. b_i falls by one.
    ///
    /// `cycle` has the coefficients of i-cells, the cell's own 1 or −1. A cell whose boundary adds up to zero, such as a loop, is
    /// a cycle alone; an isolated vertex is too.
    ///
    /// Cost: that of the boundary of the cycle, and a search in the co-boundary of each cell on that of `cell`.
    ///
    /// # Errors
    /// [`Infeasible`], which says what rule is broken; nothing is changed then.
    pub fn kill_with_cycle(&mut self, cell: CellId, cycle: &[(CellId, i64)]) -> Result<CellWithCycle, Infeasible> {
        let dim = self.dim_of(cell).ok_or(Infeasible::NoSuchCell(cell))?;
        if let Some(Arc { cell: high, .. }) = self.coboundary(cell).next() {
            return Err(Infeasible::Bounds { cell, high });
        }
        let boundary: Vec<Arc> = self.boundary(cell).collect();
        let killed = CellWithCycle { cell, dim, boundary, cycle: cycle.to_vec() };
        self.check_cycle(&killed)?;
        for arc in &killed.boundary {
            self.cells[arc.cell.index()].remove(Side::Coboundary, cell, &mut self.arena);
            self.elsewhere.remove(&(arc.cell, cell));
        }
        self.cells[cell.index()].release(&mut self.arena);
        self.cells[cell.index()] = Header::VACANT;
        self.counts[dim] -= 1;
        Ok(killed)
    }

    /// MiCiCycle: makes an i-cell and an i-cycle, the exact inverse of [`kill_with_cycle`](Self::kill_with_cycle). b_i rises by
    /// one. The cell has the number of a vacant one, or the next.
    ///
    /// Cost: as there.
    ///
    /// # Errors
    /// [`Infeasible`]; nothing is changed then.
    pub fn make_with_cycle(&mut self, made: &CellWithCycle) -> Result<(), Infeasible> {
        let &CellWithCycle { cell, dim, ref boundary, .. } = made;
        if self.contains(cell) || cell.index() > self.num_ids() || dim > MAX_DIM {
            return Err(Infeasible::CannotMake(cell));
        }
        self.check_joined(dim.checked_sub(1), boundary)?;
        self.check_cycle(made)?;
        let one = |_: usize, _: &Arc| 1_usize;
        let words = Header::words_of(boundary.len());
        let fits = self.arena.has_room(words)
            && boundary.len() <= Side::Boundary.longest()
            && self.reserve_all(std::iter::once((&boundary[..], Side::Coboundary, &one as _)))
            && self.arena.has_room(words);
        if !fits {
            return Err(Infeasible::TooLarge { low: cell, high: cell });
        }
        self.reserve_ids(cell.index() + 1);
        let Self { cells, arena, elsewhere, counts, .. } = self;
        let mut header = Header::new(dim, boundary.len(), arena);
        let packed: Vec<PackedArc> = boundary.iter().copied().map(PackedArc::new).collect();
        header.insert(Side::Boundary, &packed, arena);
        cells[cell.index()] = header;
        for &Arc { cell: face, incidence } in boundary {
            let back = PackedArc::new(Arc { cell, incidence });
            if back.is_elsewhere() {
                elsewhere.insert((face, cell), incidence);
            }
            cells[face.index()].insert(Side::Coboundary, &[back], arena);
        }
        if counts.len() <= dim {
            counts.resize(dim + 1, 0);
        }
        counts[dim] += 1;
        Ok(())
    }

    /// Whether the cycle consists of i-cells, of which the cell is one, once, and its boundary is zero.
    fn check_cycle(&self, with: &CellWithCycle) -> Result<(), Infeasible> {
        let mut own = 0_i128;
        let mut sum: HashMap<CellId, i128> = HashMap::new();
        for &(other, coefficient) in &with.cycle {
            if other != with.cell && self.dim_of(other) != Some(with.dim) {
                return Err(Infeasible::NotInCycle { cell: other, dim: with.dim });
            }
            let coefficient = i128::from(coefficient);
            let mut add = |arc: Arc| *sum.entry(arc.cell).or_insert(0) += coefficient * i128::from(arc.incidence.sign);
            if other == with.cell {
                own += coefficient;
                with.boundary.iter().for_each(|&arc| add(arc));
            } else {
                self.boundary(other).for_each(add);
            }
        }
        if own.abs() != 1 {
            return Err(Infeasible::NotOnCycle { cell: with.cell, coefficient: own });
        }
        match sum.into_iter().filter(|&(_, coefficient)| coefficient != 0).min() {
            Some((face, coefficient)) => Err(Infeasible::NoCycle { face, coefficient }),
            None => Ok(()),
        }
    }
}
