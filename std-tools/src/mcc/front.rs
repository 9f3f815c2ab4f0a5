//! Complexes at intermediate resolutions: [`Front`], and which refinements they take.

use std::ops::ControlFlow;

use sig_core::mcc::{AxisBox, Mcc, RefinementView};
use sig_core::{CellId, PackedArc, mark_words};

use super::record::MultiResolution;
use crate::build::narrow;
use crate::cells::{CellComplex, Infeasible, Refinement};

/// The complex after a closed set of refinements (mcc-2012, 6). Its cells have the numbers of the multi-resolution complex.
///
/// A front knows which refinements are wanted, and has these and what they depend on, no more: each refinement that is applied
/// is wanted, or another one that is applied depends on it. It counts these uses, so that it moves by the refinements in which
/// the two sets differ, and in time that depends on them alone.
///
/// Memory: that of the complex, four bytes and two bits for each refinement, and 12 bytes for each cell of the full complex.
#[derive(Clone, Debug)]
pub struct Front<'a> {
    mcc: Mcc<'a>,
    complex: CellComplex,
    /// A bit for each refinement that is applied.
    applied: Vec<u32>,
    /// A bit for each refinement that is wanted.
    wanted: Vec<u32>,
    /// For each refinement, how many arcs of others that are applied lead to its cells, and one more if it is wanted.
    uses: Vec<u32>,
    /// Memory that operators use again.
    refinement: Refinement,
    room: Vec<PackedArc>,
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

/// Bits a word of marks.
const BITS: usize = u32::BITS as usize;

fn has(marks: &[u32], refinement: usize) -> bool {
    marks.get(refinement / BITS).is_some_and(|word| word >> (refinement % BITS) & 1 == 1)
}

/// The numbers of the bits that are set in one word.
fn bits(number: usize, word: u32) -> impl Iterator<Item = usize> {
    let next = |left: &u32| Some(left & (left - 1)).filter(|&left| left != 0);
    std::iter::successors(Some(word).filter(|&word| word != 0), next)
        .map(move |left| number * BITS + left.trailing_zeros() as usize)
}

impl<'a> Front<'a> {
    /// The base complex. Cost: its cells, and 12 bytes for each cell of the full complex.
    ///
    /// The base of a file of unknown origin should be [validated](Mcc::validate_base) first: on what that refuses, a front may
    /// panic. Refinements are checked when they are applied.
    #[must_use]
    pub fn new(mcc: Mcc<'a>) -> Self {
        let marks = vec![0; mark_words(mcc.num_refinements())];
        let (wanted, uses) = (marks.clone(), vec![0; mcc.num_refinements()]);
        let (refinement, room) = (Refinement::default(), Vec::new());
        Self { mcc, complex: base(&mcc), applied: marks, wanted, uses, refinement, room }
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
        has(&self.applied, refinement)
    }

    /// Whether a refinement was asked for, not only what depends on it.
    #[must_use]
    pub fn is_wanted(&self, refinement: usize) -> bool {
        has(&self.wanted, refinement)
    }

    /// The number of refinements that are applied.
    #[must_use]
    pub fn num_applied(&self) -> usize {
        self.applied.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Moves to the least closed set with all refinements that are wanted, by a predicate.
    ///
    /// Cost: a call for each refinement, whether it comes to be applied or not, and that of [`change`](Self::change).
    ///
    /// # Errors
    /// As [`change`](Self::change).
    pub fn select(&mut self, is_wanted: impl FnMut(usize) -> bool) -> Result<Moved, BadRefinement> {
        let mut marks = vec![0; self.wanted.len()];
        self.mcc.select(&mut marks, is_wanted);
        self.move_to(&marks)
    }

    /// Moves to the least closed set with the refinements that are marked, a bit each.
    ///
    /// Cost: a look at each word of marks, and that of [`change`](Self::change).
    ///
    /// # Errors
    /// As [`change`](Self::change).
    pub fn move_to(&mut self, marks: &[u32]) -> Result<Moved, BadRefinement> {
        let differing = |is_more: bool| {
            let pairs = self.wanted.iter().zip(marks.iter().chain(std::iter::repeat(&0)));
            let words = pairs.map(move |(&old, &new)| if is_more { new & !old } else { old & !new });
            words.enumerate().flat_map(|(number, word)| bits(number, word)).collect::<Vec<_>>()
        };
        let (more, fewer) = (differing(true), differing(false));
        self.change(more, fewer)
    }

    /// Moves from one box to another: to the least closed set with the refinements whose sites are in it, if those in the other
    /// one are what is wanted now.
    ///
    /// Cost: that of [`Mcc::in_box`] for what is in one of them only, and of [`change`](Self::change). Without a tree over the sites
    /// in the file, that of [`select`](Self::select).
    ///
    /// # Errors
    /// As [`change`](Self::change).
    pub fn move_box(&mut self, from: AxisBox, to: AxisBox) -> Result<Moved, BadRefinement> {
        let mcc = self.mcc;
        match (mcc.in_box(to, from), mcc.in_box(from, to)) {
            (Some(more), Some(fewer)) => self.change(more, fewer),
            _ => self.select(|refinement| mcc.is_in_box(refinement, &to) == Some(true)),
        }
    }

    /// Wants some refinements more, and some not any more, and moves to the least closed set with all that are wanted then.
    ///
    /// Cost: the arcs of the refinements that are applied or taken back, and an operator for each; to sort those that are applied.
    ///
    /// # Errors
    /// [`BadRefinement`] where a file is damaged, or was made by another program and is none; the front is the base complex then.
    pub fn change(
        &mut self,
        more: impl IntoIterator<Item = usize>,
        fewer: impl IntoIterator<Item = usize>,
    ) -> Result<Moved, BadRefinement> {
        let moved = self.try_change(more, fewer);
        if moved.is_err() {
            *self = Self::new(self.mcc);
        }
        moved
    }

    fn try_change(
        &mut self,
        more: impl IntoIterator<Item = usize>,
        fewer: impl IntoIterator<Item = usize>,
    ) -> Result<Moved, BadRefinement> {
        let mut new = self.demand(more);
        // Increasing order is feasible, and that of the arcs in the file.
        new.sort_unstable();
        new.iter().try_for_each(|&refinement| self.refine(refinement as usize))?;
        let coarsened = self.drop_unused(fewer)?;
        Ok(Moved { refined: new.len(), coarsened })
    }

    /// Wants some refinements, and returns those of the least closed set with them that are not applied yet; they count as
    /// applied from here on.
    fn demand(&mut self, more: impl IntoIterator<Item = usize>) -> Vec<u32> {
        let mut new = Vec::new();
        for refinement in more {
            if refinement >= self.uses.len() || self.is_wanted(refinement) {
                continue;
            }
            self.wanted[refinement / BITS] |= 1 << (refinement % BITS);
            let mut next = new.len();
            self.use_one(refinement, &mut new);
            while let Some(&number) = new.get(next) {
                next += 1;
                for dependency in self.mcc.dependencies(number as usize) {
                    self.use_one(dependency, &mut new);
                }
            }
        }
        new
    }

    /// Counts a use of a refinement, which is new if it is not applied.
    fn use_one(&mut self, refinement: usize, new: &mut Vec<u32>) {
        self.uses[refinement] += 1;
        let (word, bit) = (&mut self.applied[refinement / BITS], 1 << (refinement % BITS));
        if *word & bit == 0 {
            *word |= bit;
            new.push(narrow(refinement));
        }
    }

    /// Takes back what is neither wanted any more nor used; returns how many that are.
    fn drop_unused(&mut self, fewer: impl IntoIterator<Item = usize>) -> Result<usize, BadRefinement> {
        let (mut unused, mut coarsened) = (Vec::new(), 0);
        for refinement in fewer {
            if !self.is_wanted(refinement) {
                continue;
            }
            self.wanted[refinement / BITS] &= !(1 << (refinement % BITS));
            unused.push(refinement);
            while let Some(refinement) = unused.pop() {
                self.uses[refinement] -= 1;
                if self.uses[refinement] == 0 {
                    self.coarsen(refinement)?;
                    coarsened += 1;
                    unused.extend(self.mcc.dependencies(refinement));
                }
            }
        }
        Ok(coarsened)
    }

    /// Applies a refinement, of which all dependencies are applied.
    fn refine(&mut self, number: usize) -> Result<(), BadRefinement> {
        let bad = |error| BadRefinement { refinement: number, error };
        let view = self.mcc.refinement(number).ok_or(bad(Infeasible::NoSuchCell(CellId::new(0))))?;
        // A pair without neighbours could be of any dimension.
        if view.dim + 1 >= self.mcc.num_dims() {
            return Err(bad(Infeasible::CannotMake(view.low)));
        }
        self.complex.refine(&view, &mut self.room).map_err(bad)
    }

    /// Takes a refinement back, on which no other one that is applied depends.
    fn coarsen(&mut self, number: usize) -> Result<(), BadRefinement> {
        let bad = |error| BadRefinement { refinement: number, error };
        let view = self.mcc.refinement(number).ok_or(bad(Infeasible::NoSuchCell(CellId::new(0))))?;
        self.complex.kill_into(view.low, view.high, &mut self.refinement).map_err(bad)?;
        self.applied[number / BITS] &= !(1 << (number % BITS));
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

/// The base complex of a multi-resolution complex, with room for all cells.
fn base(mcc: &Mcc<'_>) -> CellComplex {
    let base = narrow(mcc.num_base_cells());
    let dims = (0..base).map(|cell| mcc.dim_of(CellId::new(cell)).unwrap_or(0));
    let mut complex = CellComplex::lay_out(dims, |cell, visit| {
        // Arcs of a damaged file to cells that come later are none.
        let cell = CellId::new(cell);
        mcc.base_boundary(cell).filter(|arc| arc.cell < cell).for_each(visit);
    });
    complex.reserve_ids(mcc.num_cells());
    complex
}

/// Applies refinements of a closed set to a base complex one by one, in any feasible order. All of them are wanted then.
///
/// # Errors
/// [`BadRefinement`]: the first that cannot be applied, because one on which it depends comes later, or is missing.
pub fn apply_in_order<'a>(mcc: Mcc<'a>, order: &[usize]) -> Result<Front<'a>, BadRefinement> {
    let mut front = Front::new(mcc);
    for &refinement in order {
        front.refine(refinement)?;
        front.demand([refinement]);
    }
    Ok(front)
}

/// The refinements of a closed set, in the order of [`Mcc::stream`].
#[must_use]
pub fn members(mcc: &Mcc<'_>, marks: &[u32]) -> Vec<usize> {
    let mut members = Vec::new();
    let all = mcc.stream(marks, |refinement| {
        members.push(refinement.number);
        ControlFlow::<()>::Continue(())
    });
    debug_assert!(all.is_some());
    members
}
