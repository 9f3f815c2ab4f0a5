//! Complexes at intermediate resolutions: [`Front`], and which refinements they take.

use std::ops::ControlFlow;

use sig_core::mcc::{Mcc, RefinementView};
use sig_core::{CellId, mark_words};

use super::record::MultiResolution;
use crate::build::narrow;
use crate::cells::{CellComplex, Infeasible, Refinement};

/// The complex after a closed set of refinements (mcc-2012, 6). Its cells have the numbers of the multi-resolution complex.
///
/// It moves to another closed set by the refinements in which the two differ.
#[derive(Clone, Debug)]
pub struct Front<'a> {
    mcc: Mcc<'a>,
    complex: CellComplex,
    /// A bit for each refinement that is applied.
    applied: Vec<u64>,
    refinement: Refinement,
}

/// What moving a front did.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Moved {
    /// Refinements applied.
    pub refined: usize,
    /// Refinements taken back.
    pub coarsened: usize,
}

/// A refinement that cannot be applied, or taken back: the multi-resolution complex is none.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("refinement {refinement} of the file is not feasible: {error}")]
pub struct BadRefinement {
    /// Its number.
    pub refinement: usize,
    /// What is wrong.
    pub error: Infeasible,
}

impl<'a> Front<'a> {
    /// The base complex. Cost: its cells, and 12 bytes for each cell of the full complex.
    ///
    /// A file of unknown origin should be [validated](Mcc::validate) first: on what that refuses, a front may panic.
    #[must_use]
    pub fn new(mcc: Mcc<'a>) -> Self {
        let base = narrow(mcc.num_base_cells());
        let dims = (0..base).map(|cell| mcc.dim_of(CellId::new(cell)).unwrap_or(0));
        let mut complex = CellComplex::lay_out(dims, |cell, visit| {
            // Arcs of a damaged file to cells that come later are none.
            let cell = CellId::new(cell);
            mcc.base_boundary(cell).filter(|arc| arc.cell < cell).for_each(visit);
        });
        complex.reserve_ids(mcc.num_cells());
        let applied = vec![0; mark_words(mcc.num_refinements())];
        Self { mcc, complex, applied, refinement: Refinement::default() }
    }

    /// The complex.
    #[must_use]
    pub fn complex(&self) -> &CellComplex {
        &self.complex
    }

    /// The multi-resolution complex.
    #[must_use]
    pub fn mcc(&self) -> &Mcc<'a> {
        &self.mcc
    }

    /// Whether a refinement is applied.
    #[must_use]
    pub fn is_applied(&self, refinement: usize) -> bool {
        self.applied.get(refinement / 64).is_some_and(|word| word >> (refinement % 64) & 1 == 1)
    }

    /// The number of refinements that are applied.
    #[must_use]
    pub fn num_applied(&self) -> usize {
        self.applied.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Moves to the least closed set with all refinements that are wanted.
    ///
    /// Cost: a call for each refinement, [`Mcc::close`], and an operator for each refinement that is applied or taken back.
    ///
    /// # Errors
    /// [`BadRefinement`] for a file that [`Mcc::validate`] does not accept, or that was made by another program; the front is
    /// then at a resolution between.
    pub fn select(&mut self, is_wanted: impl FnMut(usize) -> bool) -> Result<Moved, BadRefinement> {
        let mut marks = vec![0; self.applied.len()];
        self.mcc.select(&mut marks, is_wanted);
        self.move_to(&mut marks)
    }

    /// Moves to the least closed set with the refinements that are marked, a bit each, to which it adds the others.
    ///
    /// # Errors
    /// As [`select`](Self::select).
    pub fn move_to(&mut self, marks: &mut [u64]) -> Result<Moved, BadRefinement> {
        self.mcc.close(marks);
        let mut moved = Moved::default();
        // The last first: what depends on others goes before them.
        for word in (0..self.applied.len()).rev() {
            let wanted = marks.get(word).copied().unwrap_or(0);
            while let Some(bit) = (self.applied[word] & !wanted).checked_ilog2() {
                self.coarsen(word * 64 + bit as usize)?;
                moved.coarsened += 1;
            }
        }
        for word in 0..self.applied.len() {
            let wanted = marks.get(word).copied().unwrap_or(0);
            while wanted & !self.applied[word] != 0 {
                let bit = (wanted & !self.applied[word]).trailing_zeros();
                self.refine(word * 64 + bit as usize)?;
                moved.refined += 1;
            }
        }
        Ok(moved)
    }

    /// Applies a refinement, of which all dependencies are applied.
    fn refine(&mut self, number: usize) -> Result<(), BadRefinement> {
        let bad = |error| BadRefinement { refinement: number, error };
        let view = self.mcc.refinement(number).ok_or(bad(Infeasible::NoSuchCell(CellId::new(0))))?;
        copy(view, &mut self.refinement);
        self.complex.make(&self.refinement).map_err(bad)?;
        self.applied[number / 64] |= 1 << (number % 64);
        Ok(())
    }

    /// Takes a refinement back, on which no other one that is applied depends.
    fn coarsen(&mut self, number: usize) -> Result<(), BadRefinement> {
        let bad = |error| BadRefinement { refinement: number, error };
        let view = self.mcc.refinement(number).ok_or(bad(Infeasible::NoSuchCell(CellId::new(0))))?;
        self.complex.kill_into(view.low, view.high, &mut self.refinement).map_err(bad)?;
        self.applied[number / 64] &= !(1 << (number % 64));
        Ok(())
    }

    /// The cell of the front in which each cell of the full complex has come to be, by the numbers of the multi-resolution
    /// complex: itself if it is there. Of a pair that is merged with a cell, both become that cell, but for the (i+1)-cell where
    /// the i-cell is merged: it becomes the (i+1)-cell beyond, if there is one. `None` where nothing is left of a pair.
    ///
    /// Cost: linear in the full complex.
    #[must_use]
    pub fn survivors(&self) -> Vec<Option<CellId>> {
        let base = narrow(self.mcc.num_base_cells());
        let mut survivors: Vec<Option<CellId>> = (0..base).map(|cell| Some(CellId::new(cell))).collect();
        survivors.reserve_exact(self.mcc.num_cells() - survivors.len());
        for number in 0..self.mcc.num_refinements() {
            let Some(RefinementView { low, high, lists, .. }) = self.mcc.refinement(number) else { break };
            let pair = if self.is_applied(number) {
                [Some(low), Some(high)]
            } else {
                let num_above = lists[2].len();
                let [below_low, below_high, above_low, _] = lists.map(|mut list| list.next().map(|arc| arc.cell));
                let is_merged_above = num_above == 1;
                let of_low = if is_merged_above { above_low.or(below_high) } else { below_high.or(above_low) };
                let of_high = above_low.or(below_high);
                [of_low.or(below_low), of_high.or(below_low)]
                    .map(|cell| cell.and_then(|cell| survivors.get(cell.index()).copied().flatten()))
            };
            survivors.extend(pair);
        }
        survivors
    }

    /// The front as a complex of its own, without refinements: its cells are numbered anew, and know which cells of the full
    /// complex they are.
    #[must_use]
    pub fn to_complex(&self) -> MultiResolution {
        MultiResolution::of_complex(&self.complex, |cell| narrow(self.mcc.origin(cell).unwrap_or(0)))
    }
}

/// A refinement of a file in memory that is used again.
fn copy(view: RefinementView<'_>, refinement: &mut Refinement) {
    refinement.reset(view.low, view.high, view.dim, view.sign);
    view.lists.into_iter().enumerate().for_each(|(part, list)| refinement.extend(part, list));
}

/// Applies refinements of a closed set to a base complex one by one, in any feasible order.
///
/// # Errors
/// [`BadRefinement`]: the first that cannot be applied, because one on which it depends comes later, or is missing.
pub fn apply_in_order<'a>(mcc: Mcc<'a>, order: &[usize]) -> Result<Front<'a>, BadRefinement> {
    let mut front = Front::new(mcc);
    order.iter().try_for_each(|&refinement| front.refine(refinement))?;
    Ok(front)
}

/// The refinements of a closed set, in the order of [`Mcc::stream`].
#[must_use]
pub fn members(mcc: &Mcc<'_>, marks: &[u64]) -> Vec<usize> {
    let mut members = Vec::new();
    let all = mcc.stream(marks, |refinement| {
        members.push(refinement.number);
        ControlFlow::<()>::Continue(())
    });
    debug_assert!(all.is_some());
    members
}
