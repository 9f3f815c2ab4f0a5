//! The simplices by their first vertex: [`Blocks`].
//!
//! In canonical order the simplices of one dimension with the same first vertex v stand together, the *block* of v. A
//! cofacet of a simplex in the block is in the block of its own dimension, or has one vertex u before v, and then descends
//! in the simplex tree from the edge (u, v). So the facets are transposed block by block, each on one thread, in arrays
//! that fit its cache.

use std::ops::Range;

use sig_core::{Dim, Index};

use crate::build::SigArrays;

/// The edges by their last vertex, those of each by increasing number: where the cofacets of the simplices in a block are
/// that have a vertex before it. Edges are given by their numbers.
pub(super) struct Blocks {
    starts: Vec<usize>,
    edges: Vec<usize>,
}

impl Blocks {
    pub(super) fn new<I: Index>(arrays: &SigArrays<I>) -> Self {
        let last_vertices = &arrays.last_vertices[arrays.ids(1)];
        let mut starts = vec![0; arrays.ids(0).len() + 2];
        for &vertex in last_vertices {
            starts[vertex as usize + 2] += 1;
        }
        for vertex in 2..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        // Shifted by one, so that filling in moves each start to where it belongs.
        let mut edges = vec![0; last_vertices.len()];
        for (edge, &vertex) in last_vertices.iter().enumerate() {
            let next = &mut starts[vertex as usize + 1];
            edges[*next] = edge;
            *next += 1;
        }
        starts.pop();
        Self { starts, edges }
    }

    /// The edges with the last vertex `vertex`.
    #[inline]
    pub(super) fn edges(&self, vertex: usize) -> &[usize] {
        &self.edges[self.starts[vertex]..self.starts[vertex + 1]]
    }
}

/// For each simplex of dimension `from`, and for one past the last, the first simplex of dimension `to` that begins with
/// it: those between two of these begin with the first. Of `to` = `from`, all numbers.
pub(super) fn descendants<I: Index>(arrays: &SigArrays<I>, from: Dim, to: Dim) -> Vec<usize> {
    let ids = arrays.ids(from);
    let descend = |id: usize| (from..to).fold(id, |id, _| arrays.child_offsets[id].to_usize()) - arrays.first[to];
    (ids.start..=ids.end).map(descend).collect()
}

/// The vertices in ranges of about `size` simplices each, or more in one block; `starts` are the
/// [`descendants`] of the vertices.
pub(super) fn tasks(starts: &[usize], size: usize) -> Vec<Range<usize>> {
    let mut tasks = Vec::new();
    let mut first = 0;
    for end in 1..starts.len() {
        // A vertex counts as a simplex: isolated ones are work too.
        if starts[end] - starts[first] + (end - first) >= size || end + 1 == starts.len() {
            tasks.push(first..end);
            first = end;
        }
    }
    tasks
}
