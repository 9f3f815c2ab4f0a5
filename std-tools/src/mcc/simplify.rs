//! Simplification until no operator is feasible, or a target is met: step by step, or in batches (mcc-2012, 7).
//!
//! What is queued is not a pair but its *pivot*: the (i+1)-cell that is bounded by at most two i-cells (first instance), or the
//! i-cell that bounds at most two (i+1)-cells (second instance). Which of the two neighbours goes with it is decided when the
//! pivot comes up. Entries are never taken out: one that comes up is looked at anew, thrown away if its pivot is none any
//! more, put back if it costs more by now, and done otherwise.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use rayon::prelude::*;
use sig_core::CellId;

use super::criterion::{Criterion, Pair};
use super::record::{MultiResolution, Recorder};
use crate::cells::{CellComplex, Instance, Refinement};

/// In which order pairs are killed.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Strategy {
    /// One at a time, the cheapest first.
    #[default]
    Step,
    /// In rounds: of all that are feasible, the cheapest first, those that involve no cell that another one involves.
    Batch,
}

/// Which operators are used.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Types {
    /// Those of the first type.
    First,
    /// Those of both.
    #[default]
    Both,
}

/// How to simplify, and how far.
#[derive(Clone, Copy, Default)]
pub struct SimplifyOptions<'a> {
    /// In which order.
    pub strategy: Strategy,
    /// By which operators.
    pub types: Types,
    /// Stop at so many cells.
    pub target_cells: usize,
    /// Do not do what costs more.
    pub max_error: Option<f32>,
    /// Told the number of simplifications, now and then.
    pub progress: Option<&'a (dyn Fn(u64) + Sync)>,
    /// Stop when this is set; what was done until then is a complex like any other.
    pub interrupt: Option<&'a AtomicBool>,
}

/// What a simplification did.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct SimplifyReport {
    /// Pairs killed.
    pub simplifications: usize,
    /// Entries of the queue that were put back because they cost more.
    pub put_back: usize,
    /// Rounds: of a batch each round, of steps each search for what is feasible, of which the last finds nothing unless a
    /// target is met.
    pub rounds: usize,
    /// Seconds until the last one, without making the multi-resolution complex of them.
    pub simplify_seconds: f64,
}

/// Simplifies a complex, and returns the multi-resolution complex of what was done.
///
/// The result is the same on any number of threads. Cost: a search of the queue and an operator for each simplification; costs
/// of all pivots at the start are computed and sorted in parallel, and so is each round of a batch.
pub fn simplify<C: Criterion + ?Sized>(
    mut complex: CellComplex,
    criterion: &mut C,
    options: &SimplifyOptions<'_>,
) -> (MultiResolution, SimplifyReport) {
    let start = Instant::now();
    let (recorder, mut report) = run(&mut complex, criterion, options);
    report.simplify_seconds = start.elapsed().as_secs_f64();
    (recorder.finish(&complex), report)
}

/// The simplification alone: what is left stands in `complex`.
fn run<C: Criterion + ?Sized>(
    complex: &mut CellComplex,
    criterion: &mut C,
    options: &SimplifyOptions<'_>,
) -> (Recorder, SimplifyReport) {
    let recorder = Recorder::new(complex);
    let report = SimplifyReport::default();
    let mut work = Work { complex, criterion, options, recorder, report, refinement: Refinement::default() };
    match options.strategy {
        Strategy::Step => work.step_by_step(),
        Strategy::Batch => work.in_batches(),
    }
    work.report.simplifications = work.recorder.len();
    (work.recorder, work.report)
}

/// An entry of the queue: the bits of the cost, which is not negative, so that they compare as it does; then the pivot, and the
/// instance in the lowest bit.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Entry {
    cost: u32,
    pivot: u32,
}

impl Entry {
    fn new(cost: f32, pivot: CellId, instance: Instance) -> Self {
        // −0 is 0.
        let cost = (cost + 0.0).to_bits();
        Self { cost, pivot: pivot.number() << 1 | u32::from(instance == Instance::Second) }
    }

    fn cost(self) -> f32 {
        f32::from_bits(self.cost)
    }

    fn pivot(self) -> (CellId, Instance) {
        let instance = if self.pivot & 1 == 1 { Instance::Second } else { Instance::First };
        (CellId::new(self.pivot >> 1), instance)
    }
}

/// The cheapest entries first: those that were there at the start, sorted, and a heap of those that came since.
struct Queue {
    sorted: Vec<Entry>,
    next: usize,
    heap: BinaryHeap<Reverse<Entry>>,
}

impl Queue {
    fn pop(&mut self) -> Option<Entry> {
        match (self.sorted.get(self.next), self.heap.peek()) {
            (Some(&first), Some(&Reverse(other))) if other < first => self.heap.pop().map(|Reverse(entry)| entry),
            (Some(&first), _) => {
                self.next += 1;
                Some(first)
            }
            (None, _) => self.heap.pop().map(|Reverse(entry)| entry),
        }
    }
}

struct Work<'w, C: ?Sized> {
    complex: &'w mut CellComplex,
    criterion: &'w mut C,
    options: &'w SimplifyOptions<'w>,
    recorder: Recorder,
    report: SimplifyReport,
    refinement: Refinement,
}

impl<C: Criterion + ?Sized> Work<'_, C> {
    /// The cheapest pair of a pivot, if it is one, and its cost. Of equal ones, the cell with the fewer neighbours goes, then
    /// that with the larger number.
    #[inline]
    fn best(&self, pivot: CellId, instance: Instance) -> Option<(f32, Pair)> {
        let complex = &*self.complex;
        let count = match instance {
            Instance::First => complex.num_boundary(pivot),
            Instance::Second => complex.num_coboundary(pivot),
        };
        if count == 0 || count > 2 {
            return None;
        }
        let mut best: Option<(f32, usize, Reverse<CellId>, Pair)> = None;
        let mut consider = |cell: CellId, other: Option<CellId>, multiplicity: u32| {
            let (low, high) = if instance == Instance::First { (cell, pivot) } else { (pivot, cell) };
            let (below, above) = (complex.num_boundary(high), complex.num_coboundary(low));
            let is_second_type = below.min(above) == 1;
            if multiplicity != 1 || is_second_type && self.options.types == Types::First {
                return;
            }
            let pair = Pair { low, high, kept: other };
            let cost = self.criterion.cost(complex, pair);
            let neighbours = if instance == Instance::First { above } else { below };
            let candidate = (cost, neighbours, Reverse(cell), pair);
            let is_better = |best: &(f32, usize, Reverse<CellId>, Pair)| {
                (candidate.0, candidate.1, candidate.2) < (best.0, best.1, best.2)
            };
            if cost < f32::INFINITY && best.as_ref().is_none_or(is_better) {
                best = Some(candidate);
            }
        };
        let (mut cells, mut times) = ([None; 2], [0; 2]);
        let mut take = |place: usize, arc: sig_core::Arc| {
            cells[place] = Some(arc.cell);
            times[place] = arc.incidence.multiplicity;
        };
        match instance {
            Instance::First => complex.boundary(pivot).enumerate().for_each(|(place, arc)| take(place, arc)),
            Instance::Second => complex.coboundary(pivot).enumerate().for_each(|(place, arc)| take(place, arc)),
        }
        for place in 0..2 {
            if let Some(cell) = cells[place] {
                consider(cell, cells[1 - place], times[place]);
            }
        }
        best.map(|(cost, _, _, pair)| (cost, pair))
    }

    /// All pivots among some cells, by cost.
    fn pivots(&self, cells: &[CellId]) -> Vec<Entry> {
        let max_error = self.options.max_error.unwrap_or(f32::INFINITY);
        let entries = |&cell: &CellId| {
            [Instance::First, Instance::Second].into_iter().filter_map(move |instance| {
                let (cost, _) = self.best(cell, instance).filter(|&(cost, _)| cost <= max_error)?;
                Some(Entry::new(cost, cell, instance))
            })
        };
        let mut entries: Vec<Entry> = cells.par_iter().flat_map_iter(entries).collect();
        entries.par_sort_unstable();
        entries
    }

    fn is_done(&self) -> bool {
        let done = self.recorder.len();
        if done.is_multiple_of(4096) {
            if let Some(progress) = self.options.progress {
                progress(done as u64);
            }
            if self.options.interrupt.is_some_and(|interrupt| interrupt.load(Ordering::Relaxed)) {
                return true;
            }
        }
        self.complex.num_cells() < self.options.target_cells.saturating_add(2)
    }

    /// Kills a pair; whether that was feasible.
    fn kill(&mut self, pair: Pair, cost: f32) -> bool {
        // Only numbers that grow too large can forbid it.
        if self.complex.kill_into(pair.low, pair.high, &mut self.refinement).is_err() {
            return false;
        }
        self.recorder.push(&self.refinement, cost);
        self.criterion.killed(pair);
        true
    }

    fn step_by_step(&mut self) {
        let max_error = self.options.max_error.unwrap_or(f32::INFINITY);
        let is_monotone = self.criterion.is_monotone();
        let mut lengths = Vec::new();
        loop {
            let cells: Vec<CellId> = self.complex.cells().collect();
            let mut queue = Queue { sorted: self.pivots(&cells), next: 0, heap: BinaryHeap::new() };
            drop(cells);
            self.report.rounds += 1;
            let before = self.recorder.len();
            while let Some(entry) = queue.pop() {
                if self.is_done() {
                    return;
                }
                let (pivot, instance) = entry.pivot();
                let Some((cost, pair)) = self.best(pivot, instance) else { continue };
                if cost > entry.cost() {
                    if cost <= max_error {
                        queue.heap.push(Reverse(Entry::new(cost, pivot, instance)));
                        self.report.put_back += 1;
                    }
                    continue;
                }
                self.lengths_around(pair, &mut lengths);
                if self.kill(pair, cost) {
                    self.queue_new(&mut queue, &lengths, is_monotone, max_error);
                }
            }
            // Operators that come with a neighbour's neighbours are not queued when they come.
            if self.recorder.len() == before {
                return;
            }
        }
    }

    /// The lengths of the lists that a kill will join, in the order of the refinement.
    fn lengths_around(&self, pair: Pair, lengths: &mut Vec<usize>) {
        let complex = &*self.complex;
        lengths.clear();
        let below = complex.boundary(pair.high).filter(|arc| arc.cell != pair.low);
        lengths.extend(below.map(|arc| complex.num_coboundary(arc.cell)));
        let above = complex.coboundary(pair.low).filter(|arc| arc.cell != pair.high);
        lengths.extend(above.map(|arc| complex.num_boundary(arc.cell)));
    }

    /// Queues the pivots that the last kill made. If costs never fall, those that were pivots before are queued already.
    fn queue_new(&self, queue: &mut Queue, lengths: &[usize], is_monotone: bool, max_error: f32) {
        let complex = &*self.complex;
        let mut add = |cell: CellId, instance: Instance, before: usize| {
            let after = match instance {
                Instance::First => complex.num_boundary(cell),
                Instance::Second => complex.num_coboundary(cell),
            };
            if after > 2 || is_monotone && before == after {
                return;
            }
            if let Some((cost, _)) = self.best(cell, instance).filter(|&(cost, _)| cost <= max_error) {
                queue.heap.push(Reverse(Entry::new(cost, cell, instance)));
            }
        };
        let (below, above) = (self.refinement.below_high(), self.refinement.above_low());
        let (below_lengths, above_lengths) = lengths.split_at(below.len());
        below.iter().zip(below_lengths).for_each(|(s, &before)| add(s.cell, Instance::Second, before));
        above.iter().zip(above_lengths).for_each(|(r, &before)| add(r.cell, Instance::First, before));
        self.refinement.below_low().iter().for_each(|arc| add(arc.cell, Instance::Second, usize::MAX));
        self.refinement.above_high().iter().for_each(|arc| add(arc.cell, Instance::First, usize::MAX));
    }

    fn in_batches(&mut self) {
        let mut cells: Vec<CellId> = self.complex.cells().collect();
        // The last round that involved each cell.
        let mut involved = vec![0_u32; self.complex.num_ids()];
        for round in 1.. {
            self.report.rounds += 1;
            let before = self.recorder.len();
            for entry in self.pivots(&cells) {
                if self.is_done() {
                    return;
                }
                let (pivot, instance) = entry.pivot();
                if involved[pivot.index()] == round {
                    continue;
                }
                let Some((cost, pair)) = self.best(pivot, instance) else { continue };
                let complex = &*self.complex;
                let [low, high] = [pair.low, pair.high];
                let around = || {
                    let of_low = complex.boundary(low).chain(complex.coboundary(low));
                    of_low.chain(complex.boundary(high)).chain(complex.coboundary(high)).map(|arc| arc.cell.index())
                };
                if around().any(|cell| involved[cell] == round) {
                    continue;
                }
                around().for_each(|cell| involved[cell] = round);
                self.kill(pair, cost);
            }
            if self.recorder.len() == before {
                return;
            }
            cells.retain(|&cell| self.complex.contains(cell));
        }
    }
}
