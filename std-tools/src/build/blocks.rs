//! The simplices by their first vertex: [`Blocks`].
//!
//! In canonical order the simplices of one dimension with the same first vertex v stand together, the *block* of v. A
//! coface of a simplex in the block has no vertex before v, and is in the block of its dimension; or one, and descends in
//! the simplex tree from an edge (u, v); or two, from a triangle (u, u', v); and so on. What is found from cofacets and
//! cofaces of codimension 2 is therefore found block by block, each on one thread, in arrays that fit its cache.

use std::ops::Range;

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::SigArrays;

/// Where the cofaces of the simplices in a block are. Simplices are given by their numbers within their dimension.
pub(super) struct Blocks {
    /// The edges, by their last vertex.
    pub(super) edges: ByLastVertex,
    /// The triangles, by their last vertex.
    pub(super) triangles: ByLastVertex,
    /// The edges with that vertex of each triangle, in the same order: without its first vertex, and without its second.
    edges_of_triangles: Vec<[usize; 2]>,
}

impl Blocks {
    pub(super) fn new<I: Index>(arrays: &SigArrays<I>) -> Self {
        let (edges, triangles) = (ByLastVertex::new(arrays, 1), ByLastVertex::new(arrays, 2));
        let rows = arrays.facets(2);
        let edge = |triangle: usize, i: usize| rows[triangle * 3 + i].to_usize() - arrays.first[1];
        let edges_of = |&triangle: &usize| [edge(triangle, 0), edge(triangle, 1)];
        let edges_of_triangles = triangles.numbers.par_iter().map(edges_of).collect();
        Self { edges, triangles, edges_of_triangles }
    }

    /// The edges of the triangles whose last vertex is `vertex`.
    pub(super) fn edges_of_triangles(&self, vertex: usize) -> &[[usize; 2]] {
        &self.edges_of_triangles[self.triangles.range(vertex)]
    }
}

/// The simplices of one dimension by their last vertex, those of each by increasing number.
pub(super) struct ByLastVertex {
    starts: Vec<usize>,
    numbers: Vec<usize>,
}

impl ByLastVertex {
    fn new<I: Index>(arrays: &SigArrays<I>, dim: Dim) -> Self {
        let last_vertices = &arrays.last_vertices[arrays.ids(dim)];
        let mut starts = vec![0; arrays.ids(0).len() + 2];
        for &vertex in last_vertices {
            starts[vertex as usize + 2] += 1;
        }
        for vertex in 2..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        // Shifted by one, so that filling in moves each start to where it belongs.
        let mut numbers = vec![0; last_vertices.len()];
        for (number, &vertex) in last_vertices.iter().enumerate() {
            let next = &mut starts[vertex as usize + 1];
            numbers[*next] = number;
            *next += 1;
        }
        starts.pop();
        Self { starts, numbers }
    }

    #[inline]
    pub(super) fn of(&self, vertex: usize) -> &[usize] {
        &self.numbers[self.range(vertex)]
    }

    /// Where those of a vertex stand.
    #[inline]
    pub(super) fn range(&self, vertex: usize) -> Range<usize> {
        self.starts[vertex]..self.starts[vertex + 1]
    }

    /// What lies between two of `starts`, such as [`descendants`], for each simplex in this order: looked up here once, as
    /// they are far apart there.
    pub(super) fn ranges(&self, starts: &[usize]) -> Vec<Range<usize>> {
        self.numbers.par_iter().map(|&number| starts[number]..starts[number + 1]).collect()
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
