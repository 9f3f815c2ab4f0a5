//! In canonical order the simplices of one dimension with the same first vertex v stand together, the *block* of v. Blocks
//! are what tasks share a dimension by.

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::SigArrays;

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

/// The first vertices of consecutive ranges of blocks, and the end: ranges with about `size` simplices of the dimensions
/// `dims` each, or more in one block.
pub(super) fn bounds<I: Index>(arrays: &SigArrays<I>, dims: &[Dim], size: usize) -> Vec<usize> {
    // A vertex counts as a simplex: isolated ones are work too.
    let before = |vertex: usize| vertex + dims.iter().map(|&dim| descendant(arrays, vertex, 0, dim)).sum::<usize>();
    let count = arrays.ids(0).len();
    let mut bounds: Vec<usize> = (0..=before(count) / size)
        .map(|task| {
            let (mut start, mut end) = (0, count);
            while start < end {
                let middle = start.midpoint(end);
                if before(middle) < task * size { start = middle + 1 } else { end = middle }
            }
            start
        })
        .collect();
    bounds.push(count);
    bounds.dedup();
    bounds
}
