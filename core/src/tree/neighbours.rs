//! The common neighbours of the vertices of a simplex: where its cofaces can be.

use core::ops::Range;

use super::{Path, Tree};
use crate::format::Column;
use crate::id::Index;
use crate::scratch::{Queue, ScratchError};

impl<I: Index> Tree<'_, I> {
    /// Queues the vertices before σ's last one that are neighbours of all of σ's vertices, increasing, each with the number
    /// of σ's vertices before it in place of the mask.
    pub(super) fn common_neighbours(&self, path: &Path, queue: &mut Queue<'_, I>) -> Result<(), ScratchError> {
        let rarest = self.rarest(path);
        self.neighbours(path, rarest, |vertex, before| {
            I::from_usize(vertex).map_or(Ok(()), |vertex| queue.push(vertex, before))
        })?;
        for node in path.iter().enumerate().filter_map(|(place, node)| (place != rarest).then_some(node)) {
            if queue.len() == 0 {
                break;
            }
            let vertex = node.label;
            let (mut lower, mut upper) = (self.lower_rows(vertex), self.child_range(0, vertex));
            queue.retain(|other, before| {
                if other > vertex {
                    return advance(&self.last_vertices, &mut upper, other).then_some(before + 1);
                }
                let adjacent = match (&self.lower, &mut lower) {
                    (Some(lower), Some(rows)) => advance(&lower.vertices, rows, other),
                    _ => self.child(1, other, vertex).is_some(),
                };
                adjacent.then_some(before)
            });
        }
        Ok(())
    }

    /// The place in the word of the vertex that has the fewest neighbours, as far as they have to be looked through.
    pub(super) fn rarest(&self, path: &Path) -> usize {
        let degree = |vertex: usize| {
            let lower = self.lower_rows(vertex).map_or(vertex, |rows| rows.len());
            lower.saturating_add(self.child_range(0, vertex).len())
        };
        let degrees = path.iter().enumerate().map(|(place, node)| (degree(node.label), place));
        degrees.min().map_or(0, |(_, place)| place)
    }

    /// Hands the neighbours of one of σ's vertices that come before σ's last vertex to `each`, increasing, with 0 before
    /// that vertex and 1 after it.
    pub(super) fn neighbours<E>(
        &self,
        path: &Path,
        place: usize,
        mut each: impl FnMut(usize, u32) -> Result<(), E>,
    ) -> Result<(), E> {
        let (Some(vertex), Some(last)) = (path.get(place), path.last()) else { return Ok(()) };
        match (&self.lower, self.lower_rows(vertex.label)) {
            (Some(lower), Some(mut rows)) => {
                rows.try_for_each(|row| lower.vertices.index_at(row).map_or(Ok(()), |other| each(other, 0)))?;
            }
            _ => {
                let is_lower = |&other: &usize| self.child(1, other, vertex.label).is_some();
                (0..vertex.label.min(self.num_vertices())).filter(is_lower).try_for_each(|other| each(other, 0))?;
            }
        }
        let upper = self.child_range(0, vertex.label).map_while(|edge| self.last_vertices.index_at(edge));
        upper.take_while(|&other| other < last.label).try_for_each(|other| each(other, 1))
    }

    /// Where the lower neighbours of a vertex stand, if the file has them; nothing past the end.
    #[inline]
    pub(super) fn lower_rows(&self, vertex: usize) -> Option<Range<usize>> {
        let lower = self.lower.as_ref()?;
        let len = lower.vertices.len();
        let bound = |vertex: usize| lower.offsets.get(vertex).map_or(len, |offset| offset.to_usize());
        // Clamped, for in a buffer that is not a tree an offset may be anything.
        let start = bound(vertex).min(len);
        Some(start..bound(vertex.saturating_add(1)).max(start).min(len))
    }
}
/// Moves the start of `rows`, in which `column` increases, to the first that holds `value` or more; whether it holds
/// `value`.
#[inline]
fn advance(column: &Column<'_>, rows: &mut Range<usize>, value: usize) -> bool {
    rows.start = column.lower_bound(rows.clone(), value);
    rows.start < rows.end && column.index_at(rows.start) == Some(value)
}
