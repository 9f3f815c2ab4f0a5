//! The top simplices among the cofacets of each simplex, clusters of their own: [`Cofacets`].
//!
//! Those of the (d − 1)-simplices are the facets of the d-simplices transposed, and nearly all that the lists of a mesh or
//! of a flag complex hold; so they are counted and written where they belong, block by block ([`Blocks`]).

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::blocks::{Blocks, descendant, descendants, tasks};
use crate::build::clusters::Cell;
use crate::build::{SigArrays, index, widen};

/// Top simplices that one task handles, about.
const TASK: usize = 1 << 14;

/// The top simplices of dimension g among the cofacets of each (g − 1)-simplex.
pub(super) struct Cofacets<I> {
    /// Where the list of each starts.
    pub(super) pointers: Vec<I>,
    /// The lists, increasing, each ended by the stop code.
    pub(super) lists: Vec<I>,
}

/// Of no simplices.
impl<I> Default for Cofacets<I> {
    fn default() -> Self {
        Self { pointers: Vec::new(), lists: Vec::new() }
    }
}

impl<I: Index> Cofacets<I> {
    /// The cofacets of simplex number `facet` of its dimension.
    #[inline]
    pub(super) fn of(&self, facet: usize) -> &[I] {
        let list = &self.lists[self.pointers[facet].to_usize()..];
        &list[..list.iter().position(|&entry| entry == I::STOP).unwrap_or(0)]
    }

    /// The first of them, or the stop code.
    #[inline]
    pub(super) fn first(&self, facet: usize) -> I {
        self.lists[self.pointers[facet].to_usize()]
    }

    /// The same with wider indices.
    pub(super) fn widen(self) -> Cofacets<u64> {
        Cofacets { pointers: widen(self.pointers), lists: widen(self.lists) }
    }
}

/// The entries of all the lists with their stop codes, if all simplices of dimension `dim` > 0 are top.
pub(super) fn len<I: Index>(arrays: &SigArrays<I>, dim: Dim) -> usize {
    arrays.ids(dim).len() * (dim + 1) + arrays.ids(dim - 1).len()
}

/// The cofacets of the simplices of dimension `dim` − 1, where `dim` > 0: those that are top, or all if `is_top` is not
/// given. Their number must fit the index type.
pub(super) fn find<I: Cell>(
    arrays: &SigArrays<I>,
    blocks: &Blocks<I>,
    dim: Dim,
    is_top: Option<&[bool]>,
) -> Cofacets<I> {
    let columns = Columns::new(arrays, blocks, dim);
    let facet_blocks = descendants(arrays, 0, dim - 1);
    let tasks = tasks(&columns.blocks, TASK);
    let is_top = |top: usize| is_top.is_none_or(|is_top| is_top[top]);
    let num_facets = |vertices: &Range<usize>| facet_blocks[vertices.end] - facet_blocks[vertices.start];
    let lens = columns.lens(&tasks, &is_top, num_facets);
    let mut all =
        Cofacets { pointers: vec![I::ZERO; arrays.ids(dim - 1).len()], lists: vec![I::ZERO; lens.iter().sum()] };
    let (mut pointers, mut lists, mut offset) = (all.pointers.as_mut_slice(), all.lists.as_mut_slice(), 0);
    let mut jobs = Vec::with_capacity(tasks.len());
    for (vertices, len) in tasks.into_iter().zip(lens) {
        let pointers = pointers.split_off_mut(..num_facets(&vertices)).unwrap_or_default();
        let lists = lists.split_off_mut(..len).unwrap_or_default();
        jobs.push((vertices, pointers, lists, offset));
        offset += len;
    }
    let first_top = arrays.first[dim];
    let room = || (Vec::new(), Vec::new());
    jobs.into_par_iter().for_each_init(room, |(next, pairs), (vertices, mut pointers, lists, offset)| {
        let mut start = 0;
        for vertex in vertices {
            let facets = facet_blocks[vertex]..facet_blocks[vertex + 1];
            // Counts at first, then where the next entry of each list goes.
            next.clear();
            next.resize(facets.len(), 0_usize);
            pairs.clear();
            columns.for_each(vertex, &is_top, |facet, top| {
                next[facet - facets.start] += 1;
                pairs.push((facet - facets.start, top));
            });
            for (next, pointer) in next.iter_mut().zip(&mut *pointers) {
                let count = *next;
                *next = start;
                *pointer = index(offset + start);
                start += count + 1;
            }
            for &(facet, top) in &*pairs {
                let next = &mut next[facet];
                lists[*next] = index(first_top + top);
                *next += 1;
            }
            for &end in &*next {
                lists[end] = I::STOP;
            }
            pointers = &mut pointers[facets.len()..];
        }
    });
    all
}

/// The first cofacet of each simplex of dimension `dim` − 1, where `dim` is d > 0; its own id if it has none.
pub(super) fn least<I: Cell>(arrays: &SigArrays<I>, blocks: &Blocks<I>, dim: Dim) -> Vec<I> {
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
            columns.for_each(vertex, &|_| true, |facet, top| {
                let least = &mut least[facet - start];
                if least.to_usize() < first_top {
                    *least = index(first_top + top);
                }
            });
        }
    });
    least
}

/// The simplices of dimension `dim` that have facets in a block.
struct Columns<'a, I> {
    arrays: &'a SigArrays<I>,
    of_vertices: &'a Blocks<I>,
    dim: Dim,
    blocks: Vec<usize>,
}

impl<'a, I: Cell> Columns<'a, I> {
    fn new(arrays: &'a SigArrays<I>, of_vertices: &'a Blocks<I>, dim: Dim) -> Self {
        Self { arrays, of_vertices, dim, blocks: descendants(arrays, 0, dim) }
    }

    /// The simplices that begin with an edge.
    #[inline]
    fn beginning_with(&self, edge: I) -> Range<usize> {
        let id = self.arrays.first[1] + edge.to_usize();
        descendant(self.arrays, id, 1, self.dim)..descendant(self.arrays, id + 1, 1, self.dim)
    }

    /// The entries and stop codes of the lists that each task writes: a stop code for each of its facets, and an entry
    /// whenever one is a facet of those that are wanted.
    fn lens(
        &self,
        tasks: &[Range<usize>],
        is_wanted: &(impl Fn(usize) -> bool + Sync),
        num_facets: impl Fn(&Range<usize>) -> usize,
    ) -> Vec<usize> {
        let lens: Vec<AtomicUsize> = tasks.iter().map(|vertices| AtomicUsize::new(num_facets(vertices))).collect();
        let task_of: Vec<usize> =
            tasks.iter().enumerate().flat_map(|(task, vertices)| std::iter::repeat_n(task, vertices.len())).collect();
        tasks.par_iter().enumerate().for_each(|(task, vertices)| {
            let mut own = 0;
            // Neighbours are often of the same task as the one before.
            let (mut other, mut len) = (task, 0);
            let offsets = &self.arrays.child_offsets;
            let edges = offsets[vertices.start].to_usize()..offsets[vertices.end].to_usize();
            let mut start = descendant(self.arrays, edges.start, 1, self.dim);
            for edge in edges {
                let end = descendant(self.arrays, edge + 1, 1, self.dim);
                let count = (start..end).filter(|&top| is_wanted(top)).count();
                start = end;
                own += count * self.dim;
                let of_end = task_of[self.arrays.last_vertices[edge] as usize];
                if of_end != other {
                    lens[other].fetch_add(std::mem::take(&mut len), Ordering::Relaxed);
                    other = of_end;
                }
                len += count;
            }
            lens[other].fetch_add(len, Ordering::Relaxed);
            lens[task].fetch_add(own, Ordering::Relaxed);
        });
        lens.into_iter().map(AtomicUsize::into_inner).collect()
    }

    /// Calls `visit` with each facet in the block of `vertex` and each of its cofacets that are wanted, the cofacets of one
    /// facet by increasing number.
    #[inline]
    fn for_each(&self, vertex: usize, is_wanted: &impl Fn(usize) -> bool, mut visit: impl FnMut(usize, usize)) {
        let rows = self.arrays.facets(self.dim);
        let first_facet = self.arrays.first[self.dim - 1];
        for &edge in self.of_vertices.edges(vertex) {
            for top in self.beginning_with(edge).filter(|&top| is_wanted(top)) {
                visit(rows[top * (self.dim + 1)].to_usize() - first_facet, top);
            }
        }
        let block = self.blocks[vertex]..self.blocks[vertex + 1];
        let rows = &rows[block.start * (self.dim + 1)..block.end * (self.dim + 1)];
        for (top, row) in block.zip(rows.chunks_exact(self.dim + 1)).filter(|&(top, _)| is_wanted(top)) {
            for facet in &row[1..] {
                visit(facet.to_usize() - first_facet, top);
            }
        }
    }
}
