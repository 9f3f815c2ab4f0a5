//! Counting the simplices of each part of the graph, before anything is allocated for them.

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::{Stage, narrow};
use crate::flag::walk::{Batch, Letters, Nodes, Sink, Walk};
use crate::flag::{Budget, FlagError, Phase, Progress};
use crate::graph::Graph;

/// Vertices and edges that a part has about, unless there would be more than [`MOST_PARTS`].
const PART: usize = 1 << 9;
/// The most parts; each takes a few hundred bytes.
const MOST_PARTS: usize = 1 << 14;
/// Simplices that a task counts before it looks at the limit.
const SHARE: u64 = 1 << 16;

/// Consecutive vertices, and how many simplices of each dimension have their least vertex among them.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) vertices: Range<u32>,
    pub(super) counts: Vec<u64>,
}

/// All parts of a graph.
pub(super) struct Parts {
    /// The number of simplices of each dimension, as far as there are any.
    pub(super) counts: Vec<u64>,
    pub(super) parts: Vec<Part>,
}

/// Counts the cliques of up to `max_dim` + 1 vertices.
pub(super) fn parts<L: Index>(
    graph: &Graph,
    max_dim: Dim,
    budget: &Budget,
    progress: Option<Progress<'_>>,
) -> Result<Parts, FlagError> {
    let total = Total::new(budget.most_simplices());
    let done = Stage::new(progress, Phase::Counting, graph.num_vertices());
    let parts: Vec<Part> = divide(graph)
        .into_par_iter()
        .map_init(
            || Walk::<L>::new(graph, max_dim),
            |walk, vertices| {
                let mut counter = Counter::new(max_dim, &total);
                for vertex in vertices.clone() {
                    walk.below_vertex(vertex, &mut counter);
                }
                counter.settle();
                done.add(vertices.len());
                Part { vertices, counts: counter.counts }
            },
        )
        .collect();
    let mut counts: Vec<u64> = (0..=max_dim).map(|dim| parts.iter().map(|part| part.counts[dim]).sum()).collect();
    while counts.pop_if(|count| *count == 0).is_some() {}
    // What was counted is a lower bound if counting stopped.
    let (all, leaves) = (counts.iter().sum::<u64>(), counts.last().copied().unwrap_or(0));
    budget.check(all, all - leaves)?;
    Ok(Parts { counts, parts })
}

/// Consecutive ranges of vertices, with about as many edges each.
fn divide(graph: &Graph) -> Vec<Range<u32>> {
    let size = ((graph.num_vertices() + graph.num_edges()) / MOST_PARTS).max(PART);
    let mut ranges = Vec::new();
    let mut start = 0;
    for end in 1..=graph.num_vertices() {
        let edges = graph.edges_of(end - 1).end - graph.edges_of(start).start;
        if edges + (end - start) >= size || end == graph.num_vertices() {
            ranges.push(narrow(start)..narrow(end));
            start = end;
        }
    }
    ranges
}

/// How many simplices all tasks together have found.
pub(super) struct Total {
    most: u64,
    count: AtomicU64,
}

impl Total {
    /// None yet; counting stops when there are more than `most`.
    pub(super) fn new(most: u64) -> Self {
        Self { most, count: AtomicU64::new(0) }
    }

    /// Whether counting has stopped.
    pub(super) fn is_exceeded(&self) -> bool {
        self.count.load(Ordering::Relaxed) > self.most
    }
}

/// Counts simplices by dimension.
pub(super) struct Counter<'a> {
    pub(super) counts: Vec<u64>,
    max_dim: Dim,
    total: &'a Total,
    /// Simplices that are not in the total yet.
    pending: u64,
    is_full: bool,
    /// Bits are counted by one instruction where the processor has it.
    arch: pulp::Arch,
}

impl<'a> Counter<'a> {
    pub(super) fn new(max_dim: Dim, total: &'a Total) -> Self {
        let counts = vec![0; max_dim + 1];
        Self { counts, max_dim, total, pending: 0, is_full: false, arch: pulp::Arch::new() }
    }

    fn add(&mut self, dim: Dim, count: u64) {
        self.counts[dim] += count;
        self.pending += count;
        if self.pending >= SHARE {
            self.settle();
        }
    }

    /// Brings the total up to date.
    pub(super) fn settle(&mut self) {
        let pending = std::mem::take(&mut self.pending);
        self.is_full = self.total.count.fetch_add(pending, Ordering::Relaxed) + pending > self.total.most;
    }
}

/// Children are counted with their parents, so the leaves need not be visited.
impl<L: Index> Sink<L> for Counter<'_> {
    fn node(&mut self, dim: Dim, _: u32) {
        self.add(dim, 1);
    }

    fn list(&mut self, dim: Dim, candidates: &[u32]) {
        self.add(dim, candidates.len() as u64);
    }

    fn start(&mut self, dim: Dim, num_children: usize) {
        self.add(dim, num_children as u64);
    }

    fn grow(&mut self, dim: Dim, nodes: Nodes<'_>, letters: &Letters<L>, below: &mut Batch) {
        let mut count = 0;
        if dim + 1 == self.max_dim {
            nodes.for_each_child(letters, self.arch, |_, mask| count += u64::from(mask.count_ones()));
        } else {
            nodes.for_each_child(letters, self.arch, |_, mask| {
                count += u64::from(mask.count_ones());
                below.push(mask);
            });
        }
        self.add(dim + 1, count);
    }

    fn leaves(&mut self, _: Dim, _: Nodes<'_>, _: &Letters<L>) {}

    fn is_full(&self) -> bool {
        self.is_full
    }
}
