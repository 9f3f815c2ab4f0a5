//! The partial co-boundary relations as the paper stores them: pointers, lists with stop codes, and one flag a simplex
//! (sig-2004, 4.2).

use std::ops::Range;

use rayon::prelude::*;
use sig_core::Index;

use crate::build::cofaces::Cofacets;
use crate::build::{Arrays, SigArrays, index};

/// Simplices whose lists one task writes; a multiple of eight, for the flags.
const TASK: usize = 1 << 14;

/// Completes `arrays` with the relations, at the width that the list offsets need. `write` is called with ranges of
/// simplices below dimension d and [pushes](Part::push) the list of each, in order.
pub(crate) fn pack<I: Index>(arrays: SigArrays<I>, write: impl Fn(Range<usize>, &mut Part<I>) + Sync) -> Arrays
where
    Arrays: From<SigArrays<I>>,
{
    let count = arrays.first.last().copied().unwrap_or(0);
    pack_parts(arrays, count, Cofacets::default(), write)
}

/// As [`pack`], but `write` is called for simplices below dimension d − 1 only: in that one the lists are the cofacets.
pub(super) fn pack_below_facets<I: Index>(
    arrays: SigArrays<I>,
    cofacets: Cofacets<I>,
    write: impl Fn(Range<usize>, &mut Part<I>) + Sync,
) -> Arrays
where
    Arrays: From<SigArrays<I>>,
{
    let count = flaggable(&arrays.first);
    pack_parts(arrays, count, cofacets, write)
}

/// How many simplices are below dimension d − 1: only those are flagged.
pub(super) fn flaggable(first: &[usize]) -> usize {
    first.len().checked_sub(2).map_or(0, |facets| first[facets])
}

/// Writes the lists of the first `count` simplices by `write`; those of the others below dimension d are `cofacets`.
fn pack_parts<I: Index>(
    arrays: SigArrays<I>,
    count: usize,
    cofacets: Cofacets<I>,
    write: impl Fn(Range<usize>, &mut Part<I>) + Sync,
) -> Arrays
where
    Arrays: From<SigArrays<I>>,
{
    let top_start = arrays.first.last().copied().unwrap_or(0);
    let flaggable = flaggable(&arrays.first);
    let parts: Vec<Part<I>> = (0..count.div_ceil(TASK))
        .into_par_iter()
        .map(|task| {
            let range = task * TASK..count.min((task + 1) * TASK);
            let mut part = Part::new(range.clone(), flaggable, top_start);
            write(range, &mut part);
            part
        })
        .collect();
    let len = parts.iter().map(|part| part.lists.len()).sum::<usize>() + cofacets.lists.len();
    if I::from_usize(len).is_some() {
        concatenate(arrays, parts, cofacets).into()
    } else {
        concatenate(arrays.widen(), parts, cofacets.widen()).into()
    }
}

/// The lists and flags of a range of simplices. Where a list starts is told by the flags and the stop codes.
pub(crate) struct Part<I> {
    range: Range<usize>,
    /// The simplex whose list comes next.
    next: usize,
    /// Where the simplices start that are not flagged.
    flaggable: usize,
    /// Where the simplices of dimension d start.
    top_start: usize,
    /// The top simplices of the flagged ones.
    tops: Vec<I>,
    lists: Vec<I>,
    flags: Vec<u8>,
}

impl<I: Index> Part<I> {
    fn new(range: Range<usize>, flaggable: usize, top_start: usize) -> Self {
        Self {
            next: range.start,
            flaggable,
            top_start,
            tops: Vec::with_capacity(range.len()),
            lists: Vec::new(),
            flags: vec![0; range.len().div_ceil(8)],
            range,
        }
    }

    /// Writes C\*(σ) of the next simplex σ, by decreasing dimension, then increasing id.
    #[inline]
    pub(crate) fn push(&mut self, list: &[I]) {
        match list {
            [top] if self.next < self.flaggable && top.to_usize() >= self.top_start => self.push_flagged(*top),
            _ => {
                // Cheaper than a call to copy a few.
                self.lists.extend(list.iter().copied().chain([I::STOP]));
                self.next += 1;
            }
        }
    }

    #[inline]
    fn push_flagged(&mut self, top: I) {
        let number = self.next - self.range.start;
        self.flags[number / 8] |= 1 << (number % 8);
        self.tops.push(top);
        self.next += 1;
    }

    /// Writes the relations of the next simplices as those of `range` in the arrays `before`, of a complex of the same
    /// dimension, with every id replaced by its entry in `new_ids`. Cheaper than one [`push`](Self::push) for each, as
    /// nothing is looked at but the flags.
    pub(crate) fn push_renumbered(&mut self, before: &SigArrays<I>, range: Range<usize>, new_ids: &[I]) {
        // Where the lists of the range start in `before`, and where the last of them does.
        let mut lists = None;
        for (id, pointer) in range.clone().zip(&before.pointers[range]) {
            let pointer = pointer.to_usize();
            if before.flags[id / 8] >> (id % 8) & 1 == 1 {
                self.push_flagged(new_ids[pointer]);
            } else {
                let (first, _) = lists.unwrap_or((pointer, pointer));
                lists = Some((first, pointer));
                self.next += 1;
            }
        }
        let Some((first, last)) = lists else { return };
        let len = before.lists[last..].iter().position(|&entry| entry == I::STOP).map_or(0, |len| len + 1);
        let entries = before.lists[first..last + len].iter();
        self.lists.extend(entries.map(|&top| if top == I::STOP { top } else { new_ids[top.to_usize()] }));
    }

    /// Copies the part to where it belongs, if the lists before it take `start` entries.
    fn copy_to<J: Index>(&self, start: usize, pointers: &mut [J], lists: &mut [J]) {
        let mut tops = self.tops.iter();
        let mut place = 0;
        for (number, pointer) in pointers.iter_mut().enumerate() {
            if self.flags[number / 8] >> (number % 8) & 1 == 1 {
                *pointer = tops.next().map_or(J::STOP, |top| index(top.to_usize()));
                continue;
            }
            *pointer = index(start + place);
            for (entry, &top) in lists[place..].iter_mut().zip(&self.lists[place..]) {
                place += 1;
                if top == I::STOP {
                    *entry = J::STOP;
                    break;
                }
                *entry = index(top.to_usize());
            }
        }
    }
}

/// Completes `arrays` with the parts, and with the cofacets of the simplices that are in none.
fn concatenate<I: Index, J: Index>(
    mut arrays: SigArrays<J>,
    parts: Vec<Part<I>>,
    cofacets: Cofacets<J>,
) -> SigArrays<J> {
    let count = arrays.first.last().copied().unwrap_or(0);
    arrays.flags = Vec::with_capacity(count.div_ceil(8));
    parts.iter().for_each(|part| arrays.flags.extend_from_slice(&part.flags));
    arrays.flags.resize(count.div_ceil(8), 0);
    let before: usize = parts.iter().map(|part| part.lists.len()).sum();
    arrays.pointers = cofacets.pointers;
    // Nothing if there are no cofacets.
    arrays.pointers.resize(count, J::ZERO);
    arrays.lists = cofacets.lists;
    if before > 0 {
        // Of most meshes the lists are nearly all cofacets, so moving them up is cheap against a copy of all.
        let len = arrays.lists.len();
        arrays.lists.resize(before + len, J::ZERO);
        arrays.lists.copy_within(..len, before);
    }
    let (mut pointers, mut lists) = (arrays.pointers.as_mut_slice(), arrays.lists.as_mut_slice());
    let mut start = 0;
    let mut jobs = Vec::with_capacity(parts.len());
    for part in parts {
        let pointers = pointers.split_off_mut(..part.range.len()).unwrap_or_default();
        let lists = lists.split_off_mut(..part.lists.len()).unwrap_or_default();
        start += lists.len();
        jobs.push((part, start - lists.len(), pointers, lists));
    }
    jobs.into_par_iter().for_each(|(part, start, pointers, lists)| part.copy_to(start, pointers, lists));
    if before > 0 {
        pointers.par_chunks_mut(TASK).for_each(|pointers| {
            pointers.iter_mut().for_each(|pointer| *pointer = index(before + pointer.to_usize()));
        });
    }
    arrays
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Many edges on two vertices, each in a list of its own: an entry and a stop code.
    #[test]
    fn offsets_that_do_not_fit_widen_the_arrays() {
        let with = |count: usize| {
            let arrays = SigArrays::<u32> { first: vec![0, count], num_simplices: count + 1, ..SigArrays::default() };
            pack(arrays, |range, part| range.for_each(|_| part.push(&[7])))
        };
        let Arrays::Narrow(narrow) = with(40_000) else { panic!("a short list") };
        let parts = vec![Part { lists: [7, u16::STOP].repeat(40_000), ..Part::new(0..40_000, 0, 40_000) }];
        let arrays = SigArrays::<u32> { first: vec![0, 40_000], num_simplices: 40_001, ..SigArrays::default() };
        assert_eq!(concatenate(arrays, parts, Cofacets::default()), narrow);
    }
}
