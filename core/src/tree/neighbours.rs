//! The common neighbours of the vertices of a simplex: where its cofaces can be.

use core::ops::Range;

use super::{Path, Tree};
use crate::format::Column;
use crate::id::Index;
use crate::scratch::{Queue, ScratchError};

impl<I: Index> Tree<'_, I> {
    /// Queues the vertices before σ's last one that are neighbours of all of σ's vertices, and perhaps a few that are not
    /// of one, increasing, each with the number of σ's vertices before it in place of the mask.
    ///
    /// A filter is made of a short list of neighbours, a long one is searched for each vertex that is left.
    pub(super) fn common_neighbours(&self, path: &Path, queue: &mut Queue<'_, I>) -> Result<(), ScratchError> {
        let rarest = self.rarest(path);
        let others = || path.iter().enumerate().filter_map(|(place, node)| (place != rarest).then_some(node.label));
        let mut filter = Filter::ALL;
        for vertex in others().filter(|&vertex| self.is_short(vertex)) {
            let mut own = Filter::NONE;
            let upper = [(&self.last_vertices, self.child_range(0, vertex))];
            let lower = self.lower.iter().map(|lower| (&lower.vertices, self.lower_rows(vertex).unwrap_or(0..0)));
            lower.chain(upper).for_each(|(column, rows)| own.insert_rows(column, rows));
            filter.intersect(&own);
        }
        self.neighbours(path, rarest, |vertex, _| {
            let Some(id) = I::from_usize(vertex).filter(|_| filter.may_have(vertex)) else { return Ok(()) };
            let before = path.iter().filter(|node| node.label < vertex).count();
            queue.push(id, u32::try_from(before).unwrap_or(0))
        })?;
        for vertex in others().filter(|&vertex| !self.is_short(vertex)) {
            let (mut lower, mut upper) = (self.lower_rows(vertex), self.child_range(0, vertex));
            queue.retain(|other, before| {
                let adjacent = match (&self.lower, &mut lower) {
                    _ if other > vertex => advance(&self.last_vertices, &mut upper, other),
                    (Some(lower), Some(rows)) => advance(&lower.vertices, rows, other),
                    _ => self.child(1, other, vertex).is_some(),
                };
                adjacent.then_some(before)
            });
        }
        Ok(())
    }

    /// Whether a vertex has so few neighbours, all of them listed, that a filter is made of them.
    fn is_short(&self, vertex: usize) -> bool {
        let degree =
            self.child_range(0, vertex).len().saturating_add(self.lower_rows(vertex).map_or(MANY, |rows| rows.len()));
        degree < MANY
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
        Some(start..bound(vertex.saturating_add(1)).clamp(start, len))
    }
}

/// From how many vertices on a list is searched, not walked.
pub(super) const MANY: usize = 128;

/// Which vertices may be in a set, by their last bits: of one that it has not, it is sure.
pub(super) struct Filter {
    words: [u64; 16],
}

impl Filter {
    const ALL: Self = Self { words: [u64::MAX; 16] };
    pub(super) const NONE: Self = Self { words: [0; 16] };

    #[inline]
    pub(super) fn insert(&mut self, vertex: usize) {
        if let Some(word) = self.words.get_mut(vertex / 64 % 16) {
            *word |= 1 << (vertex % 64);
        }
    }

    #[inline]
    fn insert_rows(&mut self, column: &Column<'_>, rows: Range<usize>) {
        match column {
            Column::U16(vertices) => self.insert_all(vertices.get(rows)),
            Column::U32(vertices) => self.insert_all(vertices.get(rows)),
            Column::U64(vertices) => self.insert_all(vertices.get(rows)),
            _ => {}
        }
    }

    #[inline]
    fn insert_all<L: Index>(&mut self, vertices: Option<&[L]>) {
        vertices.unwrap_or_default().iter().for_each(|vertex| self.insert(vertex.to_usize()));
    }

    fn intersect(&mut self, other: &Self) {
        self.words.iter_mut().zip(&other.words).for_each(|(word, other)| *word &= other);
    }

    #[inline]
    pub(super) fn may_have(&self, vertex: usize) -> bool {
        self.words.get(vertex / 64 % 16).is_some_and(|word| word >> (vertex % 64) & 1 == 1)
    }
}

/// Moves the start of `rows`, in which `column` increases, to the first that holds `value` or more; whether it holds
/// `value`.
#[inline]
fn advance(column: &Column<'_>, rows: &mut Range<usize>, value: usize) -> bool {
    rows.start = column.lower_bound(rows.clone(), value);
    rows.start < rows.end && column.index_at(rows.start) == Some(value)
}
