//! Batches: rounds of simplifications that involve no cell of one another (mcc-2012, 7).
//!
//! A round looks at entries of the queue, in parallel, and kills, the least first, what involves no cell that was involved
//! before in this round. What is put off waits for the cell that was: of those that wait for the same cell only the least is
//! looked at in the next round. So a round costs in proportion to what it does and what becomes feasible by it, also where all
//! that is left is around one cell.
//!
//! What the three-dimensional complexes end with depends on the order. Operators on 1- and 2-cells are feasible now and then
//! only; if many others come first, the walls that are left meet in threes and nothing is feasible any more. So these go first
//! among those of like cost ([`rank`](Work::rank)), and the next part of the queue is taken when nothing is put off.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use hashbrown::HashMap;
use rayon::prelude::*;
use sig_core::{Arc, CellId};

use super::criterion::{Criterion, Pair};
use super::queue::{Entry, Queue};
use super::simplify::Work;
use crate::build::narrow;
use crate::cells::Instance;

/// So many entries are taken from the queue at once.
const PART: usize = 4096;

/// So few entries are looked at by one thread.
const FEW: usize = 128;

/// What was taken from the queue and not yet done.
#[derive(Default)]
struct Waiting {
    /// What was put off, by the cell for which it waits: there is an item for each cell for which one is on its way.
    for_cell: HashMap<CellId, BinaryHeap<Reverse<Entry>>>,
    /// Those that come up in the next rounds, some with the cell for which they waited.
    next: Vec<(Entry, Option<CellId>)>,
    /// The greatest of those that were taken: what becomes feasible and is less joins them.
    last: Option<Entry>,
}

impl Waiting {
    fn put_off(&mut self, entry: Entry, cell: CellId) {
        if let Some(others) = self.for_cell.get_mut(&cell) {
            others.push(Reverse(entry));
        } else {
            self.for_cell.insert(cell, BinaryHeap::new());
            self.next.push((entry, Some(cell)));
        }
    }

    /// The one that was on its way has been looked at: the next one is.
    fn release(&mut self, cell: CellId) {
        match self.for_cell.get_mut(&cell).and_then(BinaryHeap::pop) {
            Some(Reverse(entry)) => self.next.push((entry, Some(cell))),
            None => _ = self.for_cell.remove(&cell),
        }
    }
}

impl<C: Criterion + ?Sized> Work<'_, C> {
    pub(super) fn in_batches(&mut self) {
        // The last round that involved each cell.
        let mut involved = vec![0; self.complex.num_ids()];
        loop {
            let before = self.recorder.len();
            let mut queue = Queue::new();
            self.pivots().into_iter().for_each(|entry| queue.push(entry));
            let mut waiting = Waiting::default();
            while queue.len() > 0 || !waiting.next.is_empty() {
                self.report.rounds += 1;
                if !self.round(&mut queue, &mut waiting, &mut involved) {
                    return;
                }
            }
            if self.recorder.len() == before {
                return;
            }
        }
    }

    /// Operators between middle dimensions go first.
    pub(super) fn rank(&self, cell: CellId, instance: Instance) -> u32 {
        let dim = self.complex.dim_of(cell).unwrap_or(0);
        let low = if instance == Instance::First { dim.saturating_sub(1) } else { dim };
        let from_ends = low.min(self.recorder.num_dims().saturating_sub(low + 2));
        Entry::LAST - narrow(from_ends).min(Entry::LAST)
    }

    /// One round; false if a target is met or an interrupt came.
    fn round(&mut self, queue: &mut Queue, waiting: &mut Waiting, involved: &mut [u32]) -> bool {
        let round = narrow(self.report.rounds);
        if waiting.next.is_empty() {
            waiting.next.extend((0..PART).map_while(|_| queue.pop()).map(|entry| (entry, None)));
            waiting.last = waiting.next.last().map(|&(entry, _)| entry);
        }
        let least = waiting.next.iter().map(|(entry, _)| entry.class()).min();
        let mut taken: Vec<_> = waiting.next.extract_if(.., |(entry, _)| Some(entry.class()) == least).collect();
        taken.sort_unstable();
        let look = |&(entry, _): &(Entry, Option<CellId>)| {
            let (pivot, instance) = entry.pivot();
            self.best(pivot, instance)
        };
        let looked = look_at(&taken, look);
        let mut touched = Vec::new();
        for (&(entry, waited_for), looked) in taken.iter().zip(looked) {
            if let Some((cost, pair)) = looked {
                let (pivot, instance) = entry.pivot();
                let now = self.entry(cost, pivot, instance);
                if now > entry {
                    queue.push(now);
                    self.report.put_back += 1;
                } else if self.is_done() {
                    return false;
                } else if let Some(cell) = self.involve(pair, round, involved) {
                    waiting.put_off(entry, cell);
                } else if self.kill(pair, cost) {
                    self.touch(&mut touched);
                }
            }
            waited_for.into_iter().for_each(|cell| waiting.release(cell));
        }
        let new = look_at(&touched, |&(cell, instance)| {
            self.best(cell, instance).map(|(cost, _)| self.entry(cost, cell, instance))
        });
        for entry in new.into_iter().flatten() {
            if Some(entry) <= waiting.last {
                waiting.next.push((entry, None));
            } else {
                queue.push(entry);
            }
        }
        true
    }

    /// Marks the cells of a pair and their neighbours, unless one is marked in this round: then it returns that.
    fn involve(&self, pair: Pair, round: u32, involved: &mut [u32]) -> Option<CellId> {
        let complex = &*self.complex;
        let around = || {
            let of = |cell| complex.boundary(cell).chain(complex.coboundary(cell)).map(|arc| arc.cell);
            of(pair.low).chain(of(pair.high))
        };
        let marked = around().find(|cell| involved[cell.index()] == round);
        if marked.is_none() {
            around().for_each(|cell| involved[cell.index()] = round);
        }
        marked
    }

    /// Adds the cells of which the last kill changed the lists, if they may be pivots.
    fn touch(&self, touched: &mut Vec<(CellId, Instance)>) {
        let mut add = |arcs: &[Arc], instance| {
            let few = arcs.iter().filter(|arc| self.complex.one_or_two(arc.cell, instance).is_some());
            touched.extend(few.map(|arc| (arc.cell, instance)));
        };
        add(self.refinement.below_low(), Instance::Second);
        add(self.refinement.below_high(), Instance::Second);
        add(self.refinement.above_low(), Instance::First);
        add(self.refinement.above_high(), Instance::First);
    }
}

/// Looks at items, in parallel if there are many; the results in their order.
fn look_at<T: Sync, R: Send>(items: &[T], look: impl Fn(&T) -> R + Sync + Send) -> Vec<R> {
    if items.len() < FEW { items.iter().map(look).collect() } else { items.par_iter().map(look).collect() }
}
