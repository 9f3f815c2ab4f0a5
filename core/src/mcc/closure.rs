//! Closed sets of refinements, and their streams (mcc-2012, 6).

use core::ops::ControlFlow;

use super::{Mcc, RefinementView};
use crate::cell::PackedArc;
use crate::scratch::{Scratch, ScratchError, WORD_BITS, mark_words};

impl<'a> Mcc<'a> {
    /// Sets the marks of the refinements that are wanted, and clears the others. `None` if there are fewer than
    /// [`mark_words`]`(m)` words of marks.
    ///
    /// Cost: a call for each refinement.
    pub fn select(&self, marks: &mut [u32], mut is_wanted: impl FnMut(usize) -> bool) -> Option<()> {
        let marks = marks.get_mut(..mark_words(self.num_refinements()))?;
        marks.fill(0);
        for refinement in 0..self.num_refinements() {
            if let Some(word) = marks.get_mut(refinement / WORD_BITS) {
                *word |= u32::from(is_wanted(refinement)) << (refinement % WORD_BITS);
            }
        }
        Some(())
    }

    /// Adds to a set all refinements on which those in it depend: the result is the least closed set with them. Returns its
    /// size; `None` if there are too few marks.
    ///
    /// Cost: the arcs of the refinements in the result, and a look at each word of marks.
    pub fn close(&self, marks: &mut [u32]) -> Option<usize> {
        let words = mark_words(self.num_refinements());
        let marks = marks.get_mut(..words)?;
        let mut size = 0;
        for word in (0..words).rev() {
            // Dependencies come before what depends on them, so those of a word may be in it, below the one at hand.
            let mut done = 0;
            loop {
                let left = marks.get(word).copied().unwrap_or(0) & !done;
                let Some(bit) = left.checked_ilog2() else { break };
                done |= 1 << bit;
                size += 1;
                for dependency in self.dependencies(word * WORD_BITS + bit as usize) {
                    if let Some(word) = marks.get_mut(dependency / WORD_BITS) {
                        *word |= 1 << (dependency % WORD_BITS);
                    }
                }
            }
        }
        Some(size)
    }

    /// Hands over the refinements of a closed set in a feasible order, until `visit` breaks. `None` if there are too few marks.
    ///
    /// Cost: O(1) for each, and a look at each word of marks.
    pub fn stream<B>(
        &self,
        marks: &[u32],
        mut visit: impl FnMut(RefinementView<'a>) -> ControlFlow<B>,
    ) -> Option<ControlFlow<B>> {
        let marks = marks.get(..mark_words(self.num_refinements()))?;
        for (word, &bits) in marks.iter().enumerate() {
            let mut left = bits;
            while left != 0 {
                let bit = left.trailing_zeros() as usize;
                left &= left - 1;
                if let Some(refinement) = self.refinement(word * WORD_BITS + bit)
                    && let ControlFlow::Break(value) = visit(refinement)
                {
                    return Some(ControlFlow::Break(value));
                }
            }
        }
        Some(ControlFlow::Continue(()))
    }

    /// The least closed set with some refinements, in a feasible order: depth first, each after all on which it depends. What is
    /// no refinement is left out.
    ///
    /// Of the scratch it takes a mark for each refinement of the complex, an entry of the answer for each of the set, and of the
    /// queue as many as a refinement of the set has others below it, one below the other.
    ///
    /// Cost: the arcs of the refinements in the set, whatever the size of the complex.
    ///
    /// # Errors
    /// [`ScratchError`].
    pub fn closed_set<'q>(
        &self,
        wanted: impl IntoIterator<Item = usize>,
        scratch: &'q mut Scratch<'_, u32>,
    ) -> Result<&'q [u32], ScratchError> {
        scratch.start(self.num_refinements())?;
        let closed = wanted.into_iter().try_for_each(|refinement| self.visit_below(refinement, scratch));
        scratch.unmark_queue();
        scratch.unmark_found(0);
        closed?;
        Ok(scratch.found.ids())
    }

    /// Adds a refinement to the answer, behind those on which it depends.
    fn visit_below(&self, refinement: usize, scratch: &mut Scratch<'_, u32>) -> Result<(), ScratchError> {
        if refinement >= self.num_refinements() {
            return Ok(());
        }
        scratch.visit(id(refinement), 0)?;
        // The mask of a queued refinement is how many of its arcs were looked at.
        while let Some((number, looked)) = scratch.queue.pop() {
            let arcs = self.all_arcs(number as usize);
            let next = (looked as usize..arcs.len()).find_map(|at| {
                let creator = arcs.get(at).and_then(|&word| self.creator(PackedArc::from_word(word).cell()))?;
                (creator < number as usize && scratch.mark(creator)).then_some((at, creator))
            });
            match next {
                Some((at, creator)) => {
                    scratch.queue.push(number, id(at + 1))?;
                    scratch.queue.push(id(creator), 0).inspect_err(|_| scratch.unmark(creator))?;
                }
                None => scratch.found.push(number).inspect_err(|_| scratch.unmark(number as usize))?,
            }
        }
        Ok(())
    }
}

/// A number that is less than that of the arcs or refinements, which are stored in 32 bits.
fn id(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(u32::MAX)
}
