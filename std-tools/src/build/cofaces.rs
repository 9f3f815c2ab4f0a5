//! The lists of dimension d − 1: the cofacets of each simplex, all of them top simplices, hence clusters of their own.
//!
//! They are the facets of the d-simplices transposed, and nearly all that the lists of a flag complex hold; so they are
//! counted and written where they belong, block by block ([`Blocks`]).

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::blocks::{Blocks, descendants, tasks};
use crate::build::{SigArrays, index};

/// Top simplices that one task handles, about.
const TASK: usize = 1 << 14;

/// The entries of all the lists with their stop codes; `dim` is d > 0.
pub(super) fn len<I: Index>(arrays: &SigArrays<I>, dim: Dim) -> usize {
    arrays.ids(dim).len() * (dim + 1) + arrays.ids(dim - 1).len()
}

/// Writes the lists and pointers of the simplices of dimension `dim` − 1, where `dim` is d > 0. Their lists start at
/// `offset` in all the lists.
pub(super) fn write<I: Index>(
    arrays: &SigArrays<I>,
    blocks: &Blocks,
    dim: Dim,
    (pointers, lists): (&mut [I], &mut [I]),
    offset: usize,
) {
    let columns = Columns::new(arrays, blocks, dim);
    let facet_blocks = descendants(arrays, 0, dim - 1);
    let (mut pointers, mut lists, mut offset) = (pointers, lists, offset);
    let mut jobs = Vec::new();
    for vertices in tasks(&columns.blocks, TASK) {
        let num_facets = facet_blocks[vertices.end] - facet_blocks[vertices.start];
        let len = num_facets + vertices.clone().map(|vertex| columns.len(vertex)).sum::<usize>();
        let pointers = pointers.split_off_mut(..num_facets).unwrap_or_default();
        let lists = lists.split_off_mut(..len).unwrap_or_default();
        jobs.push((vertices, pointers, lists, offset));
        offset += len;
    }
    let first_top = arrays.first[dim];
    jobs.into_par_iter().for_each_init(Vec::new, |next, (vertices, mut pointers, mut lists, mut offset)| {
        for vertex in vertices {
            let facets = facet_blocks[vertex]..facet_blocks[vertex + 1];
            // Counts at first, then where the next entry of each list goes.
            next.clear();
            next.resize(facets.len(), 0);
            columns.for_each(vertex, |facet, _| next[facet - facets.start] += 1);
            let mut len = 0;
            for (next, pointer) in next.iter_mut().zip(&mut *pointers) {
                let count = *next;
                *next = len;
                *pointer = index(offset + len);
                len += count + 1;
            }
            columns.for_each(vertex, |facet, top| {
                let next = &mut next[facet - facets.start];
                lists[*next] = index(first_top + top);
                *next += 1;
            });
            for &end in &*next {
                lists[end] = I::STOP;
            }
            offset += len;
            pointers = &mut pointers[facets.len()..];
            lists = &mut lists[len..];
        }
    });
}

/// The first cofacet of each simplex of dimension `dim` − 1, where `dim` is d > 0; its own id if it has none.
pub(super) fn least<I: Index>(arrays: &SigArrays<I>, blocks: &Blocks, dim: Dim) -> Vec<I> {
    let columns = Columns::new(arrays, blocks, dim);
    let facet_blocks = descendants(arrays, 0, dim - 1);
    let mut least: Vec<I> = arrays.ids(dim - 1).map(index).collect();
    let mut rest = least.as_mut_slice();
    let mut jobs = Vec::new();
    for vertices in tasks(&columns.blocks, TASK) {
        let facets = facet_blocks[vertices.start]..facet_blocks[vertices.end];
        jobs.push((vertices, facets.start, rest.split_off_mut(..facets.len()).unwrap_or_default()));
    }
    let first_top = arrays.first[dim];
    jobs.into_par_iter().for_each(|(vertices, start, least)| {
        for vertex in vertices {
            columns.for_each(vertex, |facet, top| {
                let least = &mut least[facet - start];
                if least.to_usize() < first_top {
                    *least = index(first_top + top);
                }
            });
        }
    });
    least
}

/// The d-simplices that have facets in a block.
struct Columns<'a, I> {
    arrays: &'a SigArrays<I>,
    of_vertices: &'a Blocks,
    dim: Dim,
    blocks: Vec<usize>,
    from_edges: Vec<usize>,
}

impl<'a, I: Index> Columns<'a, I> {
    fn new(arrays: &'a SigArrays<I>, of_vertices: &'a Blocks, dim: Dim) -> Self {
        let (blocks, from_edges) = (descendants(arrays, 0, dim), descendants(arrays, 1, dim));
        Self { arrays, of_vertices, dim, blocks, from_edges }
    }

    /// How often simplices of the block of `vertex` are facets.
    fn len(&self, vertex: usize) -> usize {
        let below = self.of_vertices.edges(vertex).iter();
        let below: usize = below.map(|&edge| self.from_edges[edge + 1] - self.from_edges[edge]).sum();
        below + (self.blocks[vertex + 1] - self.blocks[vertex]) * self.dim
    }

    /// Calls `visit` with each facet in the block of `vertex` and each of its cofacets, the cofacets of one facet by
    /// increasing number.
    #[inline]
    fn for_each(&self, vertex: usize, mut visit: impl FnMut(usize, usize)) {
        let rows = self.arrays.facets(self.dim);
        let first_facet = self.arrays.first[self.dim - 1];
        for &edge in self.of_vertices.edges(vertex) {
            for top in self.from_edges[edge]..self.from_edges[edge + 1] {
                visit(rows[top * (self.dim + 1)].to_usize() - first_facet, top);
            }
        }
        let block = self.blocks[vertex]..self.blocks[vertex + 1];
        let rows = &rows[block.start * (self.dim + 1)..block.end * (self.dim + 1)];
        for (top, row) in block.zip(rows.chunks_exact(self.dim + 1)) {
            for facet in &row[1..] {
                visit(facet.to_usize() - first_facet, top);
            }
        }
    }
}
