//! Lays the faces that the tasks found end to end: last vertices, child offsets, boundary.
//!
//! Only the facets without the least vertex are not known yet; they follow from the child offsets ([`facets`]).

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::levels::Chunks;
use crate::build::trie::{Bucket, Slices};
use crate::build::{Meter, Phase, SigArrays, facets, index};

/// The arrays of the faces, without co-boundary relations, and how the simplices of each dimension are listed (one byte
/// each; nothing for a dimension of which none is).
pub(super) fn assemble<I: Index>(chunks: Chunks, meter: &Meter<'_>) -> (SigArrays<I>, Vec<Vec<u8>>) {
    let counts = chunks.counts();
    let num_simplices: usize = counts.iter().sum();
    let first: Vec<usize> = counts
        .iter()
        .scan(0, |next, &count| {
            *next += count;
            Some(*next - count)
        })
        .collect();
    let Some(dim) = counts.len().checked_sub(1) else { return (SigArrays::default(), Vec::new()) };
    let mut arrays = SigArrays::<I> {
        boundary: vec![I::ZERO; counts.iter().enumerate().skip(1).map(|(p, count)| (p + 1) * count).sum()],
        child_offsets: vec![I::ZERO; first[dim] + 1],
        last_vertices: vec![0; num_simplices],
        first,
        num_simplices,
        ..SigArrays::default()
    };
    let listed = lay_out(chunks, &counts, &mut arrays);
    let stage = meter.stage(Phase::Boundary, dim.saturating_sub(1));
    let last_vertices = std::mem::take(&mut arrays.last_vertices);
    for p in 2..=dim {
        // The tasks found all faces, so that nothing is missing.
        let _ = facets::fill(&mut arrays, &last_vertices, p, 1, &[]);
        stage.add(1);
    }
    arrays.last_vertices = last_vertices;
    (arrays, listed)
}

/// Writes the buckets to where they belong, and frees them.
fn lay_out<I: Index>(chunks: Chunks, counts: &[usize], arrays: &mut SigArrays<I>) -> Vec<Vec<u8>> {
    let dim = counts.len() - 1;
    let (child_offsets, end) = arrays.child_offsets.split_at_mut(arrays.first[dim]);
    end[0] = index(arrays.num_simplices);
    let is_listed = |p: Dim| {
        chunks.buckets.iter().any(|bucket: &Bucket| bucket.listed.get(p).is_some_and(|marks| !marks.is_empty()))
    };
    let mut listed: Vec<Vec<u8>> =
        counts.iter().enumerate().map(|(p, &count)| vec![0; if is_listed(p) { count } else { 0 }]).collect();
    // What is left of the arrays of each dimension.
    let mut starts = arrays.first.clone();
    let mut last_vertices = split(&mut arrays.last_vertices, counts.iter().copied());
    let mut boundary = split(
        &mut arrays.boundary,
        counts.iter().enumerate().map(|(p, count)| if p > 0 { (p + 1) * count } else { 0 }),
    );
    let mut child_offsets = split(child_offsets, counts[..dim].iter().copied());
    let mut marks: Vec<&mut [u8]> = listed.iter_mut().map(Vec::as_mut_slice).collect();
    let jobs: Vec<_> = chunks
        .buckets
        .into_iter()
        .map(|bucket| {
            let count = |p: Dim| bucket.counts.get(p).copied().unwrap_or(0);
            let slices = Slices {
                starts: starts.clone(),
                last_vertices: take(&mut last_vertices, count),
                boundary: take(&mut boundary, |p| if p > 0 { (p + 1) * count(p) } else { 0 }),
                child_offsets: take(&mut child_offsets, count),
            };
            let marks = take(&mut marks, count);
            (0..=dim).for_each(|p| starts[p] += count(p));
            (bucket, slices, marks)
        })
        .collect();
    let arch = pulp::Arch::new();
    jobs.into_par_iter().for_each(|(bucket, mut slices, mut marks)| {
        // With the instructions for bits that the processor has.
        arch.dispatch(
            #[inline(always)]
            || bucket.write(&mut slices),
        );
        for (to, from) in marks.iter_mut().zip(&bucket.listed).filter(|(_, from)| !from.is_empty()) {
            to.copy_from_slice(from);
        }
    });
    listed
}

/// An array in parts of the given lengths.
fn split<T>(array: &mut [T], lens: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    let mut rest = array;
    lens.map(|len| rest.split_off_mut(..len).unwrap_or_default()).collect()
}

/// Takes as much as `count` tells, by dimension, off the start of each array; what is shorter is left as it is.
fn take<'a, T>(arrays: &mut [&'a mut [T]], count: impl Fn(Dim) -> usize) -> Vec<&'a mut [T]> {
    arrays.iter_mut().enumerate().map(|(p, rest)| rest.split_off_mut(..count(p)).unwrap_or_default()).collect()
}
