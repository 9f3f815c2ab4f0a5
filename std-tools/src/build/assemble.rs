//! Lays the faces that the tasks found end to end: last vertices, child offsets, boundary.
//!
//! Only the facets without the least vertex are not known yet. Facet 0 of a child with last vertex y is the child y of
//! facet 0 of its parent, so they follow level by level from the child offsets.

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::levels::Chunks;
use crate::build::local::Level;
use crate::build::{Meter, Phase, SigArrays, index};

/// Parents whose children one task handles.
const PARENTS: usize = 1 << 13;

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
    for p in 2..=dim {
        find_first_facets(&mut arrays, p);
        stage.add(1);
    }
    (arrays, listed)
}

/// Copies the chunks, level by level, to where they belong, and frees them.
fn lay_out<I: Index>(chunks: Chunks, counts: &[usize], arrays: &mut SigArrays<I>) -> Vec<Vec<u8>> {
    let Chunks { num_vertices, listed_vertices, mut tasks } = chunks;
    let dim = counts.len() - 1;
    // Where the simplices of each dimension of each task go.
    let starts: Vec<Vec<usize>> = (0..=dim).map(|p| starts(&tasks, p, arrays.first[p])).collect();
    let (vertices, mut last_vertices) = arrays.last_vertices.split_at_mut(num_vertices);
    for (last, vertex) in vertices.iter_mut().zip(0..) {
        *last = vertex;
    }
    let (mut child_offsets, end) = arrays.child_offsets.split_at_mut(arrays.first[dim]);
    end[0] = index(arrays.num_simplices);
    let mut boundary = arrays.boundary.as_mut_slice();
    let mut listed = vec![listed_vertices];
    for p in 0..=dim {
        let levels: Vec<Level> =
            tasks.iter_mut().map(|levels| levels.get_mut(p).map(std::mem::take).unwrap_or_default()).collect();
        if p > 0 {
            listed.push(concatenate_marks(&levels, counts[p]));
        }
        let mut parts = Vec::with_capacity(levels.len());
        for (task, level) in levels.into_iter().enumerate() {
            parts.push(Part {
                last_vertices: last_vertices.split_off_mut(..level.labels.len()).unwrap_or_default(),
                boundary: boundary.split_off_mut(..level.labels.len() * (p + 1)).unwrap_or_default(),
                child_offsets: if p < dim {
                    child_offsets.split_off_mut(..level.first_child.len()).unwrap_or_default()
                } else {
                    &mut []
                },
                facet_start: if p > 0 { starts[p - 1][task] } else { 0 },
                child_start: if p < dim { starts[p + 1][task] } else { 0 },
                level,
            });
        }
        parts.into_par_iter().for_each(|part| part.write(p));
    }
    listed
}

/// Where the simplices of dimension `dim` of each task start, if those of the first start at `first`.
fn starts(tasks: &[Vec<Level>], dim: Dim, first: usize) -> Vec<usize> {
    tasks
        .iter()
        .scan(first, |next, levels| {
            let start = *next;
            *next += levels.get(dim).map_or(0, |level| level.first_child.len());
            Some(start)
        })
        .collect()
}

/// The marks of all tasks; nothing if there are none.
fn concatenate_marks(levels: &[Level], count: usize) -> Vec<u8> {
    if levels.iter().all(|level| level.listed.is_empty()) {
        return Vec::new();
    }
    let mut marks = Vec::with_capacity(count);
    for level in levels {
        marks.extend_from_slice(&level.listed);
        if level.listed.is_empty() {
            marks.resize(marks.len() + level.labels.len(), 0);
        }
    }
    marks
}

/// One level of one task, and the parts of the arrays that it fills.
struct Part<'a, I> {
    level: Level,
    last_vertices: &'a mut [u32],
    boundary: &'a mut [I],
    child_offsets: &'a mut [I],
    /// The id of the first simplex of the level below, and of the level above, of the task.
    facet_start: usize,
    child_start: usize,
}

impl<I: Index> Part<'_, I> {
    fn write(self, dim: Dim) {
        self.last_vertices.copy_from_slice(&self.level.labels);
        for (offset, &child) in self.child_offsets.iter_mut().zip(&self.level.first_child) {
            *offset = index(self.child_start + child as usize);
        }
        if dim > 0 {
            let rows = self.boundary.chunks_exact_mut(dim + 1);
            for ((row, facets), &label) in rows.zip(self.level.facets.chunks_exact(dim)).zip(&self.level.labels) {
                // Right for edges; the others wait for the level below.
                row[0] = index(label as usize);
                for (entry, &facet) in row[1..].iter_mut().zip(facets) {
                    *entry = index(self.facet_start + facet as usize);
                }
            }
        }
    }
}

/// Fills in facet 0 of the simplices of dimension `dim` > 1.
fn find_first_facets<I: Index>(arrays: &mut SigArrays<I>, dim: Dim) {
    let (parents, children) = (arrays.ids(dim - 1), arrays.ids(dim));
    let below: usize = (1..dim - 1).map(|p| arrays.ids(p).len() * (p + 1)).sum();
    let (lower, boundary) = arrays.boundary.split_at_mut(below + parents.len() * dim);
    let parent_rows = &lower[below..];
    let mut boundary = &mut boundary[..children.len() * (dim + 1)];
    let mut parts = Vec::new();
    for start in parents.clone().step_by(PARENTS) {
        let family = start..parents.end.min(start + PARENTS);
        let count = arrays.child_offsets[family.end].to_usize() - arrays.child_offsets[family.start].to_usize();
        parts.push((family, boundary.split_off_mut(..count * (dim + 1)).unwrap_or_default()));
    }
    let children_of = |id: usize| arrays.child_offsets[id].to_usize()..arrays.child_offsets[id + 1].to_usize();
    let last_vertices = &arrays.last_vertices;
    parts.into_par_iter().for_each(|(family, rows)| {
        let mut rows = rows.chunks_exact_mut(dim + 1);
        for parent in family {
            let labels = &last_vertices[children_of(parent)];
            if labels.is_empty() {
                continue;
            }
            let facet = parent_rows[(parent - parents.start) * dim].to_usize();
            let mut candidates = children_of(facet);
            // All labels are among the candidates' labels, and both increase.
            for (&label, row) in labels.iter().zip(&mut rows) {
                candidates.start += seek(&last_vertices[candidates.clone()], label);
                row[0] = index(candidates.start);
            }
        }
    });
}

/// The position of `label` in increasing `labels`, by doubling steps: usually it is near the start.
fn seek(labels: &[u32], label: u32) -> usize {
    let mut step = 1;
    let mut start = 0;
    while labels.get(start + step - 1).is_some_and(|&candidate| candidate < label) {
        start += step;
        step *= 2;
    }
    let end = labels.len().min(start + step - 1);
    start + labels[start..end].partition_point(|&candidate| candidate < label)
}
