//! Filtration values: the largest weight in each clique, found by a second walk in the same order.
//!
//! Every candidate z of a node σ carries the largest weight of an edge from z to σ, so that a child takes one comparison
//! with its parent's value, and its candidates one with an edge.

use rayon::prelude::*;
use sig_core::Dim;

use crate::build::Stage;
use crate::flag::count::Parts;
use crate::flag::walk::{ABSENT, LETTERS, Letters, for_each_common};
use crate::flag::{Phase, Progress};
use crate::frozen::FrozenTree;
use crate::graph::Graph;

/// The filtration values of the simplices of the tree, which is that of the graph and the parts.
pub(super) fn find(graph: &Graph, tree: &FrozenTree, parts: &Parts, progress: Option<Progress<'_>>) -> Vec<f64> {
    let mut values = vec![0.0; tree.num_simplices];
    let Some(dim) = tree.dim() else { return values };
    let mut jobs: Vec<(_, Vec<Values<'_>>)> =
        parts.parts.iter().map(|part| (part.vertices.clone(), Vec::with_capacity(dim + 1))).collect();
    let mut rest = values.as_mut_slice();
    for (_, part, len) in parts.lengths() {
        jobs[part].1.push(Values { values: rest.split_off_mut(..len).unwrap_or_default(), done: 0 });
    }
    let done = Stage::new(progress, Phase::Values, graph.num_vertices());
    jobs.into_par_iter().for_each_init(
        || Carrier::new(graph, dim),
        |carrier, (vertices, mut levels)| {
            done.add(vertices.len());
            for vertex in vertices {
                carrier.below_vertex(vertex as usize, &mut levels);
            }
        },
    );
    values
}

/// The values of the simplices of one dimension that one part writes.
struct Values<'a> {
    values: &'a mut [f64],
    done: usize,
}

impl Values<'_> {
    #[inline]
    fn push(&mut self, value: f64) {
        self.values[self.done] = value;
        self.done += 1;
    }
}

/// Working memory of the walk, reused from vertex to vertex.
struct Carrier<'a> {
    graph: &'a Graph,
    max_dim: Dim,
    places: Vec<u8>,
    letters: Letters<u32>,
    /// The weights of the edges between letters, the lesser letter first.
    weights: Vec<[f64; LETTERS]>,
    /// For the children of each dimension of the node at hand, by letter, the largest weight of an edge to the node.
    carried: Vec<[f64; LETTERS]>,
    /// Candidates that are too many for letters, and what they carry, by dimension.
    lists: Vec<(Vec<u32>, Vec<f64>)>,
}

impl<'a> Carrier<'a> {
    fn new(graph: &'a Graph, max_dim: Dim) -> Self {
        Self {
            graph,
            max_dim,
            places: vec![ABSENT; graph.num_vertices()],
            letters: Letters::new(),
            weights: vec![[0.0; LETTERS]; LETTERS],
            carried: vec![[0.0; LETTERS]; max_dim + 1],
            lists: vec![(Vec::new(), Vec::new()); max_dim + 1],
        }
    }

    fn below_vertex(&mut self, vertex: usize, levels: &mut [Values<'_>]) {
        let value = self.graph.vertex_weight(vertex);
        levels[0].push(value);
        if self.max_dim > 0 {
            let edges = self.graph.edges_of(vertex);
            let weights = self.graph.weights().and_then(|weights| weights.get(edges)).unwrap_or(&[]);
            self.below(1, self.graph.upper_neighbours(vertex), weights, value, levels);
        }
    }

    /// Writes what is below a node of dimension `dim` − 1 that has the value `value`.
    fn below(&mut self, dim: Dim, candidates: &[u32], carried: &[f64], value: f64, levels: &mut [Values<'_>]) {
        if candidates.is_empty() {
            return;
        }
        if dim == self.max_dim {
            carried.iter().for_each(|&weight| levels[dim].push(value.max(weight)));
        } else if candidates.len() <= LETTERS {
            let (graph, weights) = (self.graph, &mut self.weights);
            self.letters.set(graph, candidates, &mut self.places, |a, b, edge| weights[a][b] = graph.weight(edge));
            self.carried[dim][..carried.len()].copy_from_slice(carried);
            self.grow(dim, u64::MAX >> (LETTERS - candidates.len()), value, levels);
        } else {
            let (mut list, mut list_carried) = std::mem::take(&mut self.lists[dim]);
            for (position, (&vertex, &weight)) in candidates.iter().zip(carried).enumerate() {
                let value = value.max(weight);
                levels[dim].push(value);
                let first_edge = self.graph.edges_of(vertex as usize).start;
                list.clear();
                list_carried.clear();
                let later = position + 1;
                for_each_common(&candidates[later..], self.graph.upper_neighbours(vertex as usize), |place, edge| {
                    list.push(candidates[later + place]);
                    list_carried.push(carried[later + place].max(self.graph.weight(first_edge + edge)));
                });
                self.below(dim + 1, &list, &list_carried, value, levels);
            }
            self.lists[dim] = (list, list_carried);
        }
    }

    /// Writes the children, of dimension `dim`, of a node with candidates `mask`, and what is below them.
    fn grow(&mut self, dim: Dim, mask: u64, value: f64, levels: &mut [Values<'_>]) {
        for letter in bits(mask) {
            let value = value.max(self.carried[dim][letter]);
            levels[dim].push(value);
            let below = self.letters.below(mask, letter);
            let weights = &self.weights[letter];
            if dim + 1 == self.max_dim {
                let carried = &self.carried[dim];
                bits(below).for_each(|other| levels[dim + 1].push(value.max(carried[other].max(weights[other]))));
            } else if below != 0 {
                let [.., here, next] = &mut self.carried[..dim + 2] else { unreachable!("two levels") };
                bits(below).for_each(|other| next[other] = here[other].max(weights[other]));
                self.grow(dim + 1, below, value, levels);
            }
        }
    }
}

/// The positions of the bits that are set.
fn bits(mut mask: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let position = mask.trailing_zeros() as usize;
        mask &= mask.wrapping_sub(1);
        (position < LETTERS).then_some(position)
    })
}
