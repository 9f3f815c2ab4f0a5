//! Facets from the simplex tree: facet i of a child with last vertex y is the child y of facet i of its parent, so they
//! follow level by level from the child offsets, without a table of faces.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::{SigArrays, index};

/// Parents whose children one task handles.
const PARENTS: usize = 1 << 13;

/// Finds the facets of the simplices of dimension `dim` > 1 that leave out one of the vertices `0..count`; the rows of
/// the parents are complete. Marks them in `found`, by number within their dimension, if it is not empty.
///
/// # Errors
/// The least simplex that lacks a facet, within a task; then rows are left as they are.
pub(super) fn fill<I: Index, L: Index>(
    arrays: &mut SigArrays<I>,
    last_vertices: &[L],
    dim: Dim,
    count: usize,
    found: &[AtomicBool],
) -> Result<(), usize> {
    let (parents, children) = (arrays.ids(dim - 1), arrays.ids(dim));
    let below: usize = (1..dim - 1).map(|p| arrays.ids(p).len() * (p + 1)).sum();
    let (lower, boundary) = arrays.boundary.split_at_mut(below + parents.len() * dim);
    let parent_rows = &lower[below..];
    let mut boundary = &mut boundary[..children.len() * (dim + 1)];
    let child_offsets = &arrays.child_offsets;
    let mut tasks = Vec::new();
    for start in parents.clone().step_by(PARENTS) {
        let family = start..parents.end.min(start + PARENTS);
        let count = child_offsets[family.end].to_usize() - child_offsets[family.start].to_usize();
        tasks.push((family, boundary.split_off_mut(..count * (dim + 1)).unwrap_or_default()));
    }
    let children_of = |id: usize| child_offsets[id].to_usize()..child_offsets[id + 1].to_usize();
    tasks.into_par_iter().try_for_each(|(family, rows)| {
        let mut rows = rows;
        for parent in family {
            let siblings = children_of(parent);
            if siblings.is_empty() {
                continue;
            }
            let labels = &last_vertices[siblings.clone()];
            let rows = rows.split_off_mut(..labels.len() * (dim + 1)).unwrap_or_default();
            let facets = &parent_rows[(parent - parents.start) * dim..][..count];
            for (i, facet) in facets.iter().enumerate() {
                // All labels are among the candidates' labels, and both increase.
                let mut candidates = children_of(facet.to_usize());
                for (number, (label, row)) in labels.iter().zip(rows.chunks_exact_mut(dim + 1)).enumerate() {
                    candidates.start += seek(&last_vertices[candidates.clone()], label);
                    if candidates.is_empty() || last_vertices[candidates.start] != *label {
                        return Err(siblings.start + number);
                    }
                    row[i] = index(candidates.start);
                    if let Some(found) = found.get(candidates.start.wrapping_sub(parents.start)) {
                        mark(found);
                    }
                }
            }
        }
        Ok(())
    })
}

/// Sets a mark, without a write if it is set already.
#[inline]
pub(super) fn mark(mark: &AtomicBool) {
    if !mark.load(Ordering::Relaxed) {
        mark.store(true, Ordering::Relaxed);
    }
}

/// The position of the first entry of increasing `sorted` that is not less than `value`, by doubling steps: usually it is
/// near the start.
#[inline]
pub(crate) fn seek<T: Ord>(sorted: &[T], value: &T) -> usize {
    let mut step = 1;
    let mut start = 0;
    while sorted.get(start + step - 1).is_some_and(|candidate| candidate < value) {
        start += step;
        step *= 2;
    }
    let end = sorted.len().min(start + step - 1);
    start + sorted[start..end].partition_point(|candidate| candidate < value)
}
