//! The simplices by their first vertex: [`Blocks`].
//!
//! In canonical order the simplices of one dimension with the same first vertex v stand together, the *block* of v. A
//! cofacet of a simplex in the block is in the block of its own dimension, or has one vertex u before v, and then descends
//! in the simplex tree from the edge (u, v). So the facets are transposed block by block, each on one thread, in arrays
//! that fit its cache.

use std::ops::Range;

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::clusters::Cell;
use crate::build::{SigArrays, index};

/// Parts of the edges that are sorted at a time, at most: each takes a number for every vertex.
const MOST_PARTS: usize = 16;

/// The edges by their last vertex, those of each by increasing number: where the cofacets of the simplices in a block are
/// that have a vertex before it. Edges are given by their numbers.
pub(super) struct Blocks<I> {
    starts: Vec<usize>,
    edges: Vec<I>,
}

impl<I: Cell> Blocks<I> {
    pub(super) fn new(arrays: &SigArrays<I>) -> Self {
        let last_vertices = &arrays.last_vertices[arrays.ids(1)];
        let size = last_vertices.len().div_ceil(rayon::current_num_threads().min(MOST_PARTS)).max(1);
        // How often each vertex is the last in each part.
        let count = |part: &[u32]| {
            let mut counts = vec![0_u32; arrays.ids(0).len()];
            part.iter().for_each(|&vertex| counts[vertex as usize] += 1);
            counts
        };
        let mut next: Vec<Vec<u32>> = last_vertices.par_chunks(size).map(count).collect();
        // Then where in the list of the vertex the part starts.
        let mut starts = Vec::with_capacity(arrays.ids(0).len() + 1);
        let mut start = 0;
        starts.push(start);
        for vertex in arrays.ids(0) {
            let mut len = 0;
            for next in &mut next {
                len += std::mem::replace(&mut next[vertex], len);
            }
            start += len as usize;
            starts.push(start);
        }
        let edges: Vec<I::Shared> = last_vertices.par_iter().map(|_| I::ZERO.share()).collect();
        last_vertices.par_chunks(size).zip(&mut next).enumerate().for_each(|(part, (last_vertices, next))| {
            for (place, &vertex) in last_vertices.iter().enumerate() {
                let next = &mut next[vertex as usize];
                I::store(&edges[starts[vertex as usize] + *next as usize], index(part * size + place));
                *next += 1;
            }
        });
        Self { starts, edges: edges.into_par_iter().map(I::into_inner).collect() }
    }

    /// The edges with the last vertex `vertex`.
    #[inline]
    pub(super) fn edges(&self, vertex: usize) -> &[I] {
        &self.edges[self.starts[vertex]..self.starts[vertex + 1]]
    }
}

/// For each simplex of dimension `from`, and for one past the last, the first simplex of dimension `to` that begins with
/// it: those between two of these begin with the first. Of `to` = `from`, all numbers.
pub(super) fn descendants<I: Index>(arrays: &SigArrays<I>, from: Dim, to: Dim) -> Vec<usize> {
    let ids = arrays.ids(from);
    (ids.start..ids.end + 1).into_par_iter().map(|id| descendant(arrays, id, from, to)).collect()
}

/// The first simplex of dimension `to` that begins with `id`, of dimension `from`, or with one after it.
#[inline]
pub(super) fn descendant<I: Index>(arrays: &SigArrays<I>, id: usize, from: Dim, to: Dim) -> usize {
    (from..to).fold(id, |id, _| arrays.child_offsets[id].to_usize()) - arrays.first[to]
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
