//! Facets from the simplex tree: facet i of a child with last vertex y is the child y of facet i of its parent, so they
//! follow level by level from the child offsets, without a table of faces.

use std::ops::Range;
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
    let rows = &mut boundary[..children.len() * (dim + 1)];
    let first = parents.start;
    let families =
        Families { child_offsets: &arrays.child_offsets, last_vertices, parents, parent_rows: &lower[below..] };
    families.fill(dim, count, rows, &|facet| {
        if let Some(found) = found.get(facet.wrapping_sub(first)) {
            mark(found);
        }
    })
}

/// The simplices of one dimension, with their children in the simplex tree.
pub(crate) struct Families<'a, I, L> {
    /// Of each simplex by id, its first child, and the end.
    pub(crate) child_offsets: &'a [I],
    /// By id.
    pub(crate) last_vertices: &'a [L],
    /// The ids of the dimension.
    pub(crate) parents: Range<usize>,
    /// Their facets.
    pub(crate) parent_rows: &'a [I],
}

impl<I: Index, L: Index> Families<'_, I, L> {
    /// Finds the facets of the children, of dimension `dim` > 1, that leave out one of the vertices `0..count`, and tells
    /// of each from any thread.
    ///
    /// # Errors
    /// As [`fill`].
    pub(crate) fn fill(
        &self,
        dim: Dim,
        count: usize,
        rows: &mut [I],
        found: &(impl Fn(usize) + Sync),
    ) -> Result<(), usize> {
        let mut boundary = rows;
        let mut tasks = Vec::new();
        for start in self.parents.clone().step_by(PARENTS) {
            let family = start..self.parents.end.min(start + PARENTS);
            let count = self.children(family.clone()).len();
            tasks.push((family, boundary.split_off_mut(..count * (dim + 1)).unwrap_or_default()));
        }
        tasks.into_par_iter().try_for_each(|(family, rows)| {
            let mut rows = rows;
            for parent in family {
                let siblings = self.children(parent..parent + 1);
                if !siblings.is_empty() {
                    let rows = rows.split_off_mut(..siblings.len() * (dim + 1)).unwrap_or_default();
                    let facets = &self.parent_rows[(parent - self.parents.start) * dim..][..count];
                    self.fill_family(siblings, dim, facets, rows, found)?;
                }
            }
            Ok(())
        })
    }

    fn fill_family(
        &self,
        siblings: Range<usize>,
        dim: Dim,
        facets: &[I],
        rows: &mut [I],
        found: &impl Fn(usize),
    ) -> Result<(), usize> {
        let labels = &self.last_vertices[siblings.clone()];
        for (i, facet) in facets.iter().enumerate() {
            // All labels are among the candidates' labels, and both increase.
            let facet = facet.to_usize();
            let candidates = self.children(facet..facet + 1);
            let mut child = candidates.start;
            let mut candidates = &self.last_vertices[candidates];
            for (number, (label, row)) in labels.iter().zip(rows.chunks_exact_mut(dim + 1)).enumerate() {
                let skipped = seek(candidates, label);
                candidates = &candidates[skipped..];
                if candidates.first() != Some(label) {
                    return Err(siblings.start + number);
                }
                child += skipped;
                row[i] = index(child);
                found(child);
            }
        }
        Ok(())
    }

    /// The children of consecutive simplices.
    fn children(&self, parents: Range<usize>) -> Range<usize> {
        self.child_offsets[parents.start].to_usize()..self.child_offsets[parents.end].to_usize()
    }
}

/// Sets a mark, without a write if it is set already.
#[inline]
pub(super) fn mark(mark: &AtomicBool) {
    if !mark.load(Ordering::Relaxed) {
        mark.store(true, Ordering::Relaxed);
    }
}

/// The position of the first entry of increasing `sorted` that is not less than `value`. Usually it is near the start: a
/// few entries are looked at in turn, then steps are doubled.
#[inline]
pub(crate) fn seek<T: Ord>(sorted: &[T], value: &T) -> usize {
    const NEAR: usize = 4;
    let near = sorted.iter().take(NEAR).take_while(|&candidate| candidate < value).count();
    if near < NEAR { near } else { near + seek_far(&sorted[NEAR..], value) }
}

fn seek_far<T: Ord>(sorted: &[T], value: &T) -> usize {
    let mut step = 1;
    let mut start = 0;
    while sorted.get(start + step - 1).is_some_and(|candidate| candidate < value) {
        start += step;
        step *= 2;
    }
    let end = sorted.len().min(start + step - 1);
    start + sorted[start..end].partition_point(|candidate| candidate < value)
}
