//! Lays the faces that the tasks found end to end: last vertices, child offsets, boundary.
//!
//! Only the facets without the least vertex are not known yet; they follow from the child offsets ([`facets`]).

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::levels::Chunks;
use crate::build::local::Level;
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
