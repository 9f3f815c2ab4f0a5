//! The facets of the simplices of a dimension, transposed by tasks.
//!
//! A task transposes what is in a range of [blocks](crate::build::blocks), in arrays that fit its cache: the facets of a
//! simplex are in the block of its first vertex, but for the one that leaves out that vertex. Where this one is of another
//! task, it is sent there first. It comes from a block before, so taken in first it stands first in the list.

use std::ops::Range;

use hashbrown::HashMap;
use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::blocks::{bounds, descendant};
use crate::build::{SigArrays, index};

/// Top simplices and facets that one task handles, about, at least and at most.
const TASK: Range<usize> = 1 << 14..1 << 18;
/// Tasks, about, where these are not too small or too large.
const TASKS: usize = 1 << 5;

/// Simplices of two dimensions that a task handles.
pub(super) fn task_size<I: Index>(arrays: &SigArrays<I>, dim: Dim) -> usize {
    ((arrays.ids(dim - 1).len() + arrays.ids(dim).len()) / TASKS).clamp(TASK.start, TASK.end)
}

/// Some simplices of a dimension, with their facets.
pub(super) struct Columns<'a, I, W> {
    pub(super) dim: Dim,
    rows: &'a [I],
    pub(super) first_facet: usize,
    pub(super) first_top: usize,
    /// Those in a range of numbers.
    pub(super) wanted: W,
    pub(super) tasks: Vec<Task>,
}

/// What is in the blocks of a task, as numbers in the dimensions.
pub(super) struct Task {
    pub(super) facets: Range<usize>,
    pub(super) tops: Range<usize>,
}

/// Pairs of a first facet that is of another task and its cofacet, by that task. The cofacets of each increase.
pub(super) type Outbox<I> = HashMap<usize, Vec<(I, I)>>;

/// What is sent to each task.
pub(super) fn inboxes<'a, I>(tasks: &[Task], outboxes: &'a [Outbox<I>]) -> Vec<Vec<&'a [(I, I)]>> {
    let mut inboxes = vec![Vec::new(); tasks.len()];
    for outbox in outboxes {
        outbox.iter().for_each(|(&to, pairs)| inboxes[to].push(pairs.as_slice()));
    }
    inboxes
}

impl<'a, I: Index, W: Fn(Range<usize>) -> R + Sync, R: Iterator<Item = usize>> Columns<'a, I, W> {
    pub(super) fn new(arrays: &'a SigArrays<I>, dim: Dim, size: usize, wanted: W) -> Self {
        let bounds = bounds(arrays, &[dim - 1, dim], size);
        let numbers =
            |bounds: &[usize], dim| descendant(arrays, bounds[0], 0, dim)..descendant(arrays, bounds[1], 0, dim);
        Self {
            dim,
            rows: arrays.facets(dim),
            first_facet: arrays.first[dim - 1],
            first_top: arrays.first[dim],
            wanted,
            tasks: bounds
                .windows(2)
                .map(|bounds| Task { facets: numbers(bounds, dim - 1), tops: numbers(bounds, dim) })
                .collect(),
        }
    }

    pub(super) fn num_facets(&self) -> usize {
        self.tasks.last().map_or(0, |task| task.facets.end)
    }

    fn row(&self, top: usize) -> &'a [I] {
        &self.rows[top * (self.dim + 1)..][..self.dim + 1]
    }

    fn number(&self, facet: I) -> usize {
        facet.to_usize() - self.first_facet
    }

    /// What each task sends to the others.
    pub(super) fn deal(&self) -> Vec<Outbox<I>> {
        let outbox = |task: &Task| {
            let mut outbox = Outbox::new();
            // Neighbours are often of the same task as the one before.
            let (mut to, mut pairs) = (0, Vec::new());
            for top in (self.wanted)(task.tops.clone()) {
                let facet = self.number(self.rows[top * (self.dim + 1)]);
                if !task.facets.contains(&facet) {
                    if !self.tasks[to].facets.contains(&facet) {
                        outbox.entry(to).or_insert_with(Vec::new).append(&mut pairs);
                        to = self.tasks.partition_point(|task| task.facets.end <= facet);
                    }
                    pairs.push((index(facet), index(top)));
                }
            }
            outbox.entry(to).or_insert_with(Vec::new).append(&mut pairs);
            outbox
        };
        self.tasks.par_iter().map(outbox).collect()
    }

    /// Writes the lists of a task, and where each starts if the first starts at `offset`. Calls
    /// `visit` with each simplex of which nothing was sent, and what it shares; the others are given back, with what they
    /// share but for the first facet.
    pub(super) fn transpose(
        &self,
        task: &Task,
        inbox: &[&[(I, I)]],
        pointers: &mut [I],
        lists: &mut [I],
        offset: usize,
        mut visit: impl FnMut(usize, u32),
    ) -> Vec<(I, u32)> {
        let own = |facet: I| self.number(facet).wrapping_sub(task.facets.start);
        let sent = || {
            inbox.iter().copied().flatten().map(|(facet, top)| (facet.to_usize() - task.facets.start, top.to_usize()))
        };
        // Counts at first. That new memory is 0 is no use: to be read before it is written costs a page twice.
        pointers.fill(I::ZERO);
        for (facet, _) in sent() {
            pointers[facet] = index(pointers[facet].to_usize() + 1);
        }
        for top in (self.wanted)(task.tops.clone()) {
            for &facet in self.row(top) {
                if let Some(count) = pointers.get_mut(own(facet)) {
                    *count = index(count.to_usize() + 1);
                }
            }
        }
        // Then where the next entry of each list goes.
        let mut start = 0;
        for pointer in &mut *pointers {
            let end = start + pointer.to_usize();
            lists[end] = I::STOP;
            *pointer = index(start);
            start = end + 1;
        }
        // Whether it is not the first of its list.
        let mut enter = |pointer: &mut I, top: usize| {
            let place = pointer.to_usize();
            lists[place] = index(self.first_top + top);
            *pointer = index(place + 1);
            place > 0 && lists[place - 1] != I::STOP
        };
        for (facet, top) in sent() {
            enter(&mut pointers[facet], top);
        }
        let mut others = Vec::new();
        for top in (self.wanted)(task.tops.clone()) {
            let (mut shared, mut is_own) = (0, true);
            for (i, &facet) in self.row(top).iter().enumerate() {
                match pointers.get_mut(own(facet)) {
                    Some(pointer) => shared |= u32::from(enter(pointer, top)) << i,
                    None => is_own = false,
                }
            }
            if is_own {
                visit(top, shared);
            } else {
                others.push((index(top), shared));
            }
        }
        let mut start = offset;
        for pointer in pointers {
            let end = offset + pointer.to_usize();
            *pointer = index(start);
            start = end + 1;
        }
        others
    }

    /// Calls `visit` with the simplices that [`transpose`](Self::transpose) has given back, and what they share.
    pub(super) fn visit_others<'b, V: Send>(
        &self,
        others: &[Vec<(I, u32)>],
        cofacets: impl Fn(usize) -> &'b [I] + Sync,
        new_visitor: &(impl Fn() -> V + Sync),
        visit: &(impl Fn(&mut V, usize, u32) + Sync),
    ) -> Vec<V>
    where
        I: 'b,
    {
        let visit_all = |others: &Vec<(I, u32)>| {
            let mut visitor = new_visitor();
            for &(top, shared) in others {
                let (top, facet) = (top.to_usize(), self.rows[top.to_usize() * (self.dim + 1)]);
                let is_first = cofacets(self.number(facet)).first() == Some(&index(self.first_top + top));
                visit(&mut visitor, top, shared | u32::from(!is_first));
            }
            visitor
        };
        others.par_iter().map(visit_all).collect()
    }
}
