//! Simplification until no operator is feasible, or a target is met: step by step, or in batches (mcc-2012, 7).
//!
//! What is queued is not a pair but its *pivot*: the (i+1)-cell that is bounded by at most two i-cells (first instance), or the
//! i-cell that bounds at most two (i+1)-cells (second instance). Which of the two neighbours goes with it is decided when the
//! pivot comes up. Entries are never taken out: one that comes up is looked at anew, thrown away if its pivot is none any
//! more, put back if it costs more by now, and done otherwise. `queue` has the entries, `batch` the rounds.

use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use rayon::prelude::*;
use sig_core::{Arc, CellId};

use super::criterion::{Criterion, Pair};
use super::queue::{Entry, Queue};
use super::record::{MultiResolution, Recorder};
use crate::build::narrow;
use crate::cells::{CellComplex, Instance, OperatorType, Refinement};

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

/// How far costs are told apart: pairs whose costs are not go by number, which is along the complex.
///
/// A coarser order is faster, because cells that are near lie near in memory, and because fewer costs grow into another class
/// while they wait. In dimension 3 and more it ends with fewer cells too: see [`simplify()`]. The errors that are recorded are
/// exact all the same.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug, Default)]
pub enum Precision {
    /// As they are: the cheapest pair comes first.
    Exact,
    /// By the power of 2.
    #[default]
    Two,
    /// By the power of 4.
    Four,
    /// By the power of 16.
    Sixteen,
}

impl Precision {
    /// The bits of a cost that do not count: those of the fraction, and the lowest of the exponent.
    const DROPPED: [u32; 4] = [0, 23, 24, 25];

    #[inline]
    pub(super) const fn dropped_bits(self) -> u32 {
        Self::DROPPED[self as usize]
    }
}

/// How to simplify, and how far.
#[derive(Clone, Copy, Default)]
pub struct SimplifyOptions<'a> {
    /// In which order.
    pub strategy: Strategy,
    /// By which operators.
    pub types: Types,
    /// How far costs are told apart.
    pub precision: Precision,
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
#[derive(Clone, PartialEq, Debug, Default)]
pub struct SimplifyReport {
    /// Pairs killed.
    pub simplifications: usize,
    /// For each dimension of the lower cell of a pair, how many were killed by operators of the first type and of the second.
    pub by_dimension: Vec<[usize; 2]>,
    /// The cells of the base, by dimension.
    pub base: Vec<usize>,
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
/// The result is the same on any number of threads. Cost: a place in the queue and an operator for each simplification, some
/// 1 µs on surfaces and 1.2 to 1.6 µs on 0.1 to 2 million tetrahedra, one thread; 2.5 µs in batches. Costs of all pivots at the
/// start are computed in parallel, and so are those of the larger rounds of a batch.
///
/// # What is left
///
/// In dimension 2, as many cells as the Betti numbers add up to. In dimension 3, one vertex and no 3-cell, or one for each
/// component, but pairs of 1- and 2-cells beyond the homology: each 1-cell bounds three 2-cells or more, or appears twice, and
/// each 2-cell has three 1-cells or more, so no operator is feasible. How many depends on the order. They are left when cells
/// of like size grow everywhere and meet as the walls of a foam do, as by [`Extent`](super::Extent), not when one grows at a
/// time: fields, lengths and [`Free`](super::Free) leave next to none. Of 493,638 cells of a bracket with Betti numbers 1, 9, 0
/// there are left, step by step by the extent, 2090 in the exact order, 476 by powers of 2, 96 by powers of 4, 30 by powers
/// of 16; in batches 1178, for these have to grow everywhere; by a coordinate 10.
pub fn simplify<C: Criterion + ?Sized>(
    mut complex: CellComplex,
    criterion: &mut C,
    options: &SimplifyOptions<'_>,
) -> (MultiResolution, SimplifyReport) {
    let start = Instant::now();
    let (recorder, mut report) = run(&mut complex, criterion, options);
    report.simplify_seconds = start.elapsed().as_secs_f64();
    report.base = complex.counts().to_vec();
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
    let (max_error, refinement) = (options.max_error.unwrap_or(f32::INFINITY), Refinement::default());
    let mut work = Work { complex, criterion, options, max_error, recorder, report, refinement };
    match options.strategy {
        Strategy::Step => work.step_by_step(),
        Strategy::Batch => work.in_batches(),
    }
    work.report.simplifications = work.recorder.len();
    (work.recorder, work.report)
}

pub(super) struct Work<'w, C: ?Sized> {
    pub(super) complex: &'w mut CellComplex,
    pub(super) criterion: &'w mut C,
    pub(super) options: &'w SimplifyOptions<'w>,
    pub(super) max_error: f32,
    pub(super) recorder: Recorder,
    pub(super) report: SimplifyReport,
    pub(super) refinement: Refinement,
}

impl<C: Criterion + ?Sized> Work<'_, C> {
    /// The cheapest pair of a pivot, if it is one, and its cost. Of equal ones, the cell with the fewer neighbours goes, then
    /// that with the larger number.
    #[inline]
    pub(super) fn best(&self, pivot: CellId, instance: Instance) -> Option<(f32, Pair)> {
        let (first, second) = self.complex.one_or_two(pivot, instance)?;
        let one = self.candidate(pivot, instance, first, second);
        let Some((second, other)) =
            second.and_then(|arc| self.candidate(pivot, instance, arc, Some(first)).map(|candidate| (arc, candidate)))
        else {
            return one;
        };
        let Some(one) = one else { return Some(other) };
        let is_better = other.0 < one.0
            || other.0 == one.0 && {
                // The other has the larger number.
                let neighbours = |cell| match instance {
                    Instance::First => self.complex.num_coboundary(cell),
                    Instance::Second => self.complex.num_boundary(cell),
                };
                neighbours(second.cell) <= neighbours(first.cell)
            };
        Some(if is_better { other } else { one })
    }

    /// The pair of a pivot and one of its neighbours, if it may be killed, and its cost.
    #[inline]
    fn candidate(&self, pivot: CellId, instance: Instance, arc: Arc, other: Option<Arc>) -> Option<(f32, Pair)> {
        let complex = &*self.complex;
        let (low, high) = if instance == Instance::First { (arc.cell, pivot) } else { (pivot, arc.cell) };
        if arc.incidence.multiplicity != 1
            || self.options.types == Types::First
                && (complex.num_boundary(high) == 1 || complex.num_coboundary(low) == 1)
        {
            return None;
        }
        let pair = Pair { low, high, kept: other.map(|other| other.cell) };
        let cost = self.criterion.cost(complex, pair);
        (cost < f32::INFINITY && cost <= self.max_error).then_some((cost, pair))
    }

    #[inline]
    pub(super) fn entry(&self, cost: f32, cell: CellId, instance: Instance) -> Entry {
        let rank = if self.options.strategy == Strategy::Batch { self.rank(cell, instance) } else { 0 };
        Entry::new(cost, self.options.precision, rank, cell, instance)
    }

    /// The entries of all pivots.
    pub(super) fn pivots(&self) -> Vec<Entry> {
        let entries = |cell: u32| {
            let cell = CellId::new(cell);
            let entry = move |instance| self.best(cell, instance).map(|(cost, _)| self.entry(cost, cell, instance));
            [Instance::First, Instance::Second].into_iter().filter_map(entry)
        };
        (0..narrow(self.complex.num_ids())).into_par_iter().flat_map_iter(entries).collect()
    }

    /// Whether a target is met or an interrupt came; tells the progress.
    pub(super) fn is_done(&self) -> bool {
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
    pub(super) fn kill(&mut self, pair: Pair, cost: f32) -> bool {
        // Only numbers that grow too large can forbid it.
        if self.complex.kill_into(pair.low, pair.high, &mut self.refinement).is_err() {
            return false;
        }
        let is_second = self.refinement.kinds().any(|kind| kind.operator_type == OperatorType::Second);
        let dim = self.refinement.dim;
        if self.report.by_dimension.len() <= dim {
            self.report.by_dimension.resize(dim + 1, [0; 2]);
        }
        self.report.by_dimension[dim][usize::from(is_second)] += 1;
        self.recorder.push(&self.refinement, cost);
        self.criterion.killed(pair);
        true
    }

    fn step_by_step(&mut self) {
        loop {
            self.report.rounds += 1;
            let before = self.recorder.len();
            let mut queue = Queue::new();
            self.pivots().into_iter().for_each(|entry| queue.push(entry));
            // Operators that come with a neighbour's neighbours are not queued when they come.
            if self.drain(&mut queue).is_break() || self.recorder.len() == before {
                return;
            }
        }
    }

    /// Kills what is queued and what becomes feasible by it, the cheapest first; a break if a target is met or an interrupt came.
    pub(super) fn drain(&mut self, queue: &mut Queue) -> ControlFlow<()> {
        let is_monotone = self.criterion.is_monotone();
        let mut lengths = Vec::new();
        while let Some(entry) = queue.pop() {
            if self.is_done() {
                return ControlFlow::Break(());
            }
            let (pivot, instance) = entry.pivot();
            let Some((cost, pair)) = self.best(pivot, instance) else { continue };
            let now = self.entry(cost, pivot, instance);
            if now > entry {
                queue.push(now);
                self.report.put_back += 1;
                continue;
            }
            self.lengths_around(pair, &mut lengths);
            if self.kill(pair, cost) {
                self.queue_new(queue, &lengths, is_monotone);
            }
        }
        ControlFlow::Continue(())
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
    fn queue_new(&self, queue: &mut Queue, lengths: &[usize], is_monotone: bool) {
        let complex = &*self.complex;
        let mut add = |cell: CellId, instance: Instance, before: usize| {
            let after = match instance {
                Instance::First => complex.num_boundary(cell),
                Instance::Second => complex.num_coboundary(cell),
            };
            if after > 2 || is_monotone && before == after {
                return;
            }
            if let Some((cost, _)) = self.best(cell, instance) {
                queue.push(self.entry(cost, cell, instance));
            }
        };
        let (below, above) = (self.refinement.below_high(), self.refinement.above_low());
        let (below_lengths, above_lengths) = lengths.split_at(below.len());
        below.iter().zip(below_lengths).for_each(|(s, &before)| add(s.cell, Instance::Second, before));
        above.iter().zip(above_lengths).for_each(|(r, &before)| add(r.cell, Instance::First, before));
        self.refinement.below_low().iter().for_each(|arc| add(arc.cell, Instance::Second, usize::MAX));
        self.refinement.above_high().iter().for_each(|arc| add(arc.cell, Instance::First, usize::MAX));
    }
}
