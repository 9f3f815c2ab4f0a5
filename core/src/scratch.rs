//! Caller-owned memory for the relations that traverse: marks, a queue, and room for the answer.
//!
//! A buffer is never written, so what a traversal must remember stands here. [`Scratch`] borrows slices of any origin;
//! [`StaticScratch`] owns a chosen capacity and fits in a `static`.

use core::fmt;

use heapless::Vec;

use crate::id::Index;
use crate::slices;

/// Bits a word of marks.
pub(crate) const WORD_BITS: usize = u32::BITS as usize;

/// Words of marks for a complex of so many simplices: one bit each, the paper's visited flag (sig-2004, 4.2).
#[must_use]
pub const fn mark_words(num_simplices: usize) -> usize {
    num_simplices.div_ceil(WORD_BITS)
}

/// What a scratch has too little of, and how much a query needs. The scratch can be used again at once.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum ScratchError {
    /// Words of marks: [`mark_words`] of the number of simplices.
    Marks {
        /// Words that every query on this complex needs: exact.
        needed: usize,
        /// Words that there are.
        available: usize,
    },
    /// Entries of the queue and of the masks, whichever is shorter.
    Queue {
        /// Entries that this query needs: at least so many.
        at_least: usize,
        /// Entries that there are.
        available: usize,
    },
    /// Entries for the answer.
    Found {
        /// Entries that this query needs: at least so many.
        at_least: usize,
        /// Entries that there are.
        available: usize,
    },
}

impl fmt::Display for ScratchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Marks { needed, available } => {
                write!(f, "scratch too small: {needed} words of marks needed, {available} available")
            }
            Self::Queue { at_least, available } => {
                write!(f, "scratch too small: at least {at_least} queue entries needed, {available} available")
            }
            Self::Found { at_least, available } => {
                write!(f, "scratch too small: at least {at_least} entries for the answer needed, {available} available")
            }
        }
    }
}

impl core::error::Error for ScratchError {}

impl ScratchError {
    /// The error of a queue of its own behind some entries of the queue.
    pub(crate) const fn behind(self, entries: usize) -> Self {
        match self {
            Self::Queue { at_least, available } => {
                Self::Queue { at_least: at_least.saturating_add(entries), available: available.saturating_add(entries) }
            }
            other => other,
        }
    }
}

/// Memory for one query at a time, borrowed from the caller.
///
/// # Capacity
///
/// | part | enough for |
/// |---|---|
/// | `marks` | [`mark_words`]`(n)` words, n the number of simplices: for every query |
/// | `queue`, `masks` | on a [`Complex`](crate::Complex) the largest cluster of a co-boundary or cluster query, the whole star for a star query; on a [`Tree`](crate::Tree) the neighbours of a vertex, and the simplices of two dimensions whose words begin cofaces: never more than vertices and simplices together |
/// | `found` | the answer of any query, on a complex but star and cluster; for adjacency, repetitions and σ too |
///
/// A traversal clears its marks before it hands out the first item, walking what it marked: breaking out of a loop over
/// the answer, or an error, leaves the scratch ready for the next query.
#[derive(Debug)]
pub struct Scratch<'s, I> {
    marks: &'s mut [u32],
    pub(crate) queue: Queue<'s, I>,
    pub(crate) found: Found<'s, I>,
}

impl<'s, I: Index> Scratch<'s, I> {
    /// A scratch over slices; what they hold does not matter. Cost: clearing the marks, once.
    #[must_use]
    pub fn new(marks: &'s mut [u32], queue: &'s mut [I], masks: &'s mut [u32], found: &'s mut [I]) -> Self {
        marks.fill(0);
        Self { marks, queue: Queue { ids: queue, masks, len: 0 }, found: Found { ids: found, len: 0 } }
    }

    /// Empties queue and answer, and checks that there is a mark for each simplex.
    pub(crate) fn start(&mut self, num_simplices: usize) -> Result<(), ScratchError> {
        self.queue.len = 0;
        self.found.len = 0;
        let (needed, available) = (mark_words(num_simplices), self.marks.len());
        if available < needed { Err(ScratchError::Marks { needed, available }) } else { Ok(()) }
    }

    /// Marks a simplex; whether it was not marked before. An id past the marks counts as marked: nobody visits it.
    #[inline]
    pub(crate) fn mark(&mut self, simplex: usize) -> bool {
        let Some(word) = self.marks.get_mut(simplex / WORD_BITS) else { return false };
        let bit = 1 << (simplex % WORD_BITS);
        let unmarked = *word & bit == 0;
        *word |= bit;
        unmarked
    }

    #[inline]
    pub(crate) fn unmark(&mut self, simplex: usize) {
        if let Some(word) = self.marks.get_mut(simplex / WORD_BITS) {
            *word &= !(1 << (simplex % WORD_BITS));
        }
    }

    /// Marks a simplex and queues it with a mask, unless it is marked.
    #[inline]
    pub(crate) fn visit(&mut self, simplex: I, mask: u32) -> Result<(), ScratchError> {
        if self.mark(simplex.to_usize()) {
            self.queue.push(simplex, mask).inspect_err(|_| self.unmark(simplex.to_usize()))?;
        }
        Ok(())
    }

    /// Marks a simplex and adds it to the answer, unless it is marked.
    #[inline]
    pub(crate) fn report(&mut self, simplex: I) -> Result<(), ScratchError> {
        if self.mark(simplex.to_usize()) {
            self.found.push(simplex).inspect_err(|_| self.unmark(simplex.to_usize()))?;
        }
        Ok(())
    }

    /// Clears the marks of all that is queued.
    pub(crate) fn unmark_queue(&mut self) {
        unmark_all(self.marks, self.queue.ids());
    }

    /// Clears the marks of all that is found, from position `start` of the answer on.
    pub(crate) fn unmark_found(&mut self, start: usize) {
        unmark_all(self.marks, self.found.ids().get(start..).unwrap_or(&[]));
    }

    /// Drops repetitions from the answer, and a simplex that does not belong to it.
    pub(crate) fn dedup_found(&mut self, excluded: usize) {
        self.mark(excluded);
        let mut kept = 0;
        for position in 0..self.found.len {
            let Some(&id) = self.found.ids.get(position) else { break };
            if let (true, Some(slot)) = (self.mark(id.to_usize()), self.found.ids.get_mut(kept)) {
                *slot = id;
                kept += 1;
            }
        }
        self.found.len = kept;
        self.unmark_found(0);
        self.unmark(excluded);
    }
}

fn unmark_all<I: Index>(marks: &mut [u32], ids: &[I]) {
    for id in ids {
        let id = id.to_usize();
        if let Some(word) = marks.get_mut(id / WORD_BITS) {
            *word &= !(1 << (id % WORD_BITS));
        }
    }
}

/// Simplices to visit, each with the mask of the vertex positions at which the query's simplex lies in it.
#[derive(Debug)]
pub(crate) struct Queue<'s, I> {
    ids: &'s mut [I],
    masks: &'s mut [u32],
    len: usize,
}

impl<I: Index> Queue<'_, I> {
    #[inline]
    pub(crate) fn push(&mut self, simplex: I, mask: u32) -> Result<(), ScratchError> {
        let (Some(id), Some(slot)) = (self.ids.get_mut(self.len), self.masks.get_mut(self.len)) else {
            let available = self.ids.len().min(self.masks.len());
            return Err(ScratchError::Queue { at_least: self.len + 1, available });
        };
        *id = simplex;
        *slot = mask;
        self.len += 1;
        Ok(())
    }

    /// Keeps the simplices to which `next_mask` gives another mask for the one they have, in their order.
    pub(crate) fn retain(&mut self, mut next_mask: impl FnMut(usize, u32) -> Option<u32>) {
        let mut kept = 0;
        for position in 0..self.len {
            let Some((id, mask)) = self.get(position) else { break };
            let Some(mask) = next_mask(id.to_usize(), mask) else { continue };
            if let (Some(slot), Some(mask_slot)) = (self.ids.get_mut(kept), self.masks.get_mut(kept)) {
                (*slot, *mask_slot) = (id, mask);
                kept += 1;
            }
        }
        self.len = kept;
    }

    #[inline]
    pub(crate) fn get(&self, position: usize) -> Option<(I, u32)> {
        if position >= self.len {
            return None;
        }
        Some((*self.ids.get(position)?, *self.masks.get(position)?))
    }

    /// Takes out the last entry.
    #[inline]
    pub(crate) fn pop(&mut self) -> Option<(I, u32)> {
        let entry = self.get(self.len.checked_sub(1)?)?;
        self.len -= 1;
        Some(entry)
    }

    pub(crate) const fn len(&self) -> usize {
        self.len
    }

    pub(crate) fn clear(&mut self) {
        self.len = 0;
    }

    /// What is queued, and the room behind it as a queue of its own.
    pub(crate) fn split(&mut self) -> (Queue<'_, I>, Queue<'_, I>) {
        let len = self.len.min(self.ids.len()).min(self.masks.len());
        let (ids, more_ids) = self.ids.split_at_mut(len);
        let (masks, more_masks) = self.masks.split_at_mut(len);
        (Queue { ids, masks, len }, Queue { ids: more_ids, masks: more_masks, len: 0 })
    }

    /// Takes out the first entries; those behind them move up.
    pub(crate) fn remove_first(&mut self, count: usize) {
        if count <= self.len && self.len <= self.ids.len().min(self.masks.len()) {
            slices::move_down(self.ids.get_mut(..self.len).unwrap_or_default(), count);
            slices::move_down(self.masks.get_mut(..self.len).unwrap_or_default(), count);
            self.len -= count;
        }
    }

    pub(crate) fn ids(&self) -> &[I] {
        self.ids.get(..self.len).unwrap_or(&[])
    }
}

/// The answer of a query.
#[derive(Debug)]
pub(crate) struct Found<'s, I> {
    ids: &'s mut [I],
    len: usize,
}

impl<I: Index> Found<'_, I> {
    #[inline]
    pub(crate) fn push(&mut self, simplex: I) -> Result<(), ScratchError> {
        let available = self.ids.len();
        let slot = self.ids.get_mut(self.len).ok_or(ScratchError::Found { at_least: self.len + 1, available })?;
        *slot = simplex;
        self.len += 1;
        Ok(())
    }

    /// Adds consecutive simplices, which are ids of the width.
    #[inline]
    pub(crate) fn extend(&mut self, ids: core::ops::Range<usize>) -> Result<(), ScratchError> {
        let (at_least, available) = (self.len.saturating_add(ids.len()), self.ids.len());
        let slots = self.ids.get_mut(self.len..at_least).ok_or(ScratchError::Found { at_least, available })?;
        for (slot, id) in slots.iter_mut().zip(ids) {
            *slot = I::from_usize(id).unwrap_or(I::STOP);
        }
        self.len = at_least;
        Ok(())
    }

    pub(crate) const fn len(&self) -> usize {
        self.len
    }

    pub(crate) fn ids(&self) -> &[I] {
        self.ids.get(..self.len).unwrap_or(&[])
    }

    pub(crate) fn truncate(&mut self, len: usize) {
        self.len = self.len.min(len);
    }

    /// The answer, to be rewritten in place.
    pub(crate) fn ids_mut(&mut self) -> &mut [I] {
        self.ids.get_mut(..self.len).unwrap_or_default()
    }
}

/// A scratch of a fixed capacity that owns its memory: `MARKS` words of marks, `QUEUE` entries of the queue, `FOUND`
/// entries of an answer. Made by a `const` function, so it fits in a `static`, in a cell of the caller's choice.
///
/// ```
/// use sig_core::{StaticScratch, mark_words};
/// // For complexes of up to 1,000 simplices with at most 64 in a star.
/// let mut memory: StaticScratch<u16, { mark_words(1_000) }, 64, 64> = StaticScratch::new();
/// let scratch = memory.scratch();
/// # let _ = scratch;
/// ```
#[derive(Debug)]
pub struct StaticScratch<I, const MARKS: usize, const QUEUE: usize, const FOUND: usize> {
    marks: Vec<u32, MARKS>,
    queue: Vec<I, QUEUE>,
    masks: Vec<u32, QUEUE>,
    found: Vec<I, FOUND>,
}

impl<I: Index, const MARKS: usize, const QUEUE: usize, const FOUND: usize> StaticScratch<I, MARKS, QUEUE, FOUND> {
    /// A scratch, all of its memory in itself.
    #[must_use]
    pub const fn new() -> Self {
        Self { marks: Vec::new(), queue: Vec::new(), masks: Vec::new(), found: Vec::new() }
    }

    /// The scratch to query with. Cost: clearing the marks and the rest; keep it over many queries.
    #[must_use]
    pub fn scratch(&mut self) -> Scratch<'_, I> {
        fill(&mut self.marks, 0);
        fill(&mut self.queue, I::ZERO);
        fill(&mut self.masks, 0);
        fill(&mut self.found, I::ZERO);
        Scratch::new(&mut self.marks, &mut self.queue, &mut self.masks, &mut self.found)
    }
}

impl<I: Index, const MARKS: usize, const QUEUE: usize, const FOUND: usize> Default
    for StaticScratch<I, MARKS, QUEUE, FOUND>
{
    fn default() -> Self {
        Self::new()
    }
}

/// Fills a vector up to its capacity.
fn fill<T: Copy, const N: usize>(vec: &mut Vec<T, N>, value: T) {
    while vec.push(value).is_ok() {}
}
