//! Filling the arrays of the tree: every part knows how many simplices it has, so each writes where they belong.

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::{Stage, index, narrow};
use crate::flag::count::{Part, Parts};
use crate::flag::walk::{Batch, Letters, Nodes, Sink, Walk};
use crate::flag::{Phase, Progress};
use crate::frozen::{FrozenTree, LastVertices};
use crate::graph::Graph;
use crate::soup::Labels;

/// The tree of the counted simplices, without filtration values.
pub(super) fn write<L: Index>(
    graph: &Graph,
    parts: &Parts,
    last_vertices: fn(Vec<L>) -> LastVertices,
    progress: Option<Progress<'_>>,
) -> FrozenTree {
    let first = parts.first();
    let num_simplices = parts.counts.iter().sum::<u64>();
    let Some((&leaves, dim)) = parts.counts.last().zip(parts.counts.len().checked_sub(1)) else {
        return FrozenTree::default();
    };
    let num_simplices = index_of(num_simplices);
    let mut labels = vec![L::ZERO; num_simplices];
    let mut child_offsets = vec![0; num_simplices - index_of(leaves) + 1];
    let done = Stage::new(progress, Phase::Writing, graph.num_vertices());
    parts.writers(&first, &mut labels, &mut child_offsets).into_par_iter().for_each_init(
        || Walk::<L>::new(graph, dim),
        |walk, (part, mut writer)| {
            for vertex in part.vertices.clone() {
                walk.below_vertex(vertex, &mut writer);
            }
            done.add(part.vertices.len());
        },
    );
    child_offsets[first[dim]] = narrow(num_simplices);
    FrozenTree {
        first,
        num_simplices,
        child_offsets,
        last_vertices: last_vertices(labels),
        filtration: None,
        labels: Labels::Numbered(graph.num_vertices()),
        coordinates: None,
    }
}

/// A number of simplices as a `usize`; the budget has been checked, and memory holds more than that.
fn index_of(count: u64) -> usize {
    usize::try_from(count).unwrap_or(usize::MAX)
}

impl Parts {
    /// The first id of each dimension.
    pub(super) fn first(&self) -> Vec<usize> {
        let next = |next: &mut usize, &count: &u64| Some(std::mem::replace(next, *next + index_of(count)));
        self.counts.iter().scan(0, next).collect()
    }

    /// Calls `each` for every dimension of every part, in the order of the ids: dimension by dimension.
    pub(super) fn lengths(&self) -> impl Iterator<Item = (Dim, usize, usize)> {
        (0..self.counts.len()).flat_map(move |dim| {
            self.parts.iter().enumerate().map(move |(number, part)| (dim, number, index_of(part.counts[dim])))
        })
    }

    /// The parts of the arrays that each part fills.
    fn writers<'a, L>(
        &'a self,
        first: &[usize],
        mut labels: &'a mut [L],
        child_offsets: &'a mut [u32],
    ) -> Vec<(&'a Part, Writer<'a, L>)> {
        let mut child_offsets = &mut child_offsets[..first.last().copied().unwrap_or(0)];
        let arch = pulp::Arch::new();
        let writer = |part| (part, Writer { levels: Vec::with_capacity(first.len()), arch });
        let mut writers: Vec<_> = self.parts.iter().map(writer).collect();
        let mut start = 0;
        for (dim, part, len) in self.lengths() {
            writers[part].1.levels.push(Level {
                next: narrow(start),
                done: 0,
                labels: labels.split_off_mut(..len).unwrap_or_default(),
                child_offsets: if dim + 1 < first.len() {
                    child_offsets.split_off_mut(..len).unwrap_or_default()
                } else {
                    &mut []
                },
            });
            start += len;
        }
        writers
    }
}

/// What one part writes.
struct Writer<'a, L> {
    levels: Vec<Level<'a, L>>,
    /// Bits are counted and found by one instruction each where the processor has them.
    arch: pulp::Arch,
}

/// The simplices of one dimension that one part writes.
struct Level<'a, L> {
    /// The id of the next simplex.
    next: u32,
    /// How many are written.
    done: usize,
    labels: &'a mut [L],
    child_offsets: &'a mut [u32],
}

impl<L: Index> Level<'_, L> {
    /// Ends with `done` simplices written.
    fn advance(&mut self, done: usize) {
        self.next += narrow(done - self.done);
        self.done = done;
    }
}

impl<L: Index> Sink<L> for Writer<'_, L> {
    fn node(&mut self, dim: Dim, vertex: u32) {
        let first_child = self.levels.get(dim + 1).map_or(0, |below| below.next);
        let level = &mut self.levels[dim];
        level.labels[level.done] = index(vertex as usize);
        if let Some(offset) = level.child_offsets.get_mut(level.done) {
            *offset = first_child;
        }
        level.advance(level.done + 1);
    }

    fn list(&mut self, dim: Dim, candidates: &[u32]) {
        let level = &mut self.levels[dim];
        for (label, &vertex) in level.labels[level.done..].iter_mut().zip(candidates) {
            *label = index(vertex as usize);
        }
        level.advance(level.done + candidates.len());
    }

    fn start(&mut self, _: Dim, _: usize) {}

    fn grow(&mut self, dim: Dim, nodes: Nodes<'_>, letters: &Letters<L>, below: &mut Batch) {
        let mut first_child = self.levels[dim + 1].next;
        let level = &mut self.levels[dim];
        let (labels, child_offsets) = (&mut level.labels[level.done..], &mut level.child_offsets[level.done..]);
        let mut done = 0;
        nodes.for_each_child(letters, self.arch, |letter, mask| {
            labels[done] = letters.names[letter];
            child_offsets[done] = first_child;
            first_child += mask.count_ones();
            below.push(mask);
            done += 1;
        });
        level.advance(level.done + done);
    }

    fn leaves(&mut self, dim: Dim, nodes: Nodes<'_>, letters: &Letters<L>) {
        let level = &mut self.levels[dim];
        let labels = &mut level.labels[level.done..];
        let mut done = 0;
        nodes.for_each_child(letters, self.arch, |letter, _| {
            labels[done] = letters.names[letter];
            done += 1;
        });
        level.advance(level.done + done);
    }
}
