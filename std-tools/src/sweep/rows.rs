//! The boundary rows of a complex as plain slices, and the faces of a simplex by them.

use std::ops::Range;

use sig_core::format::{Column, SectionKind};
use sig_core::{Complex, Dim, Index};

/// The facets of the simplices of each dimension, where they lie.
pub(super) struct Rows<'a, I> {
    levels: Vec<Level<'a, I>>,
}

struct Level<'a, I> {
    ids: Range<usize>,
    /// `dim + 1` facets a simplex; none of vertices.
    facets: &'a [I],
}

impl<'a, I: Index> Rows<'a, I> {
    pub(super) fn new(complex: &Complex<'a, I>) -> Self {
        let section = complex.container().section(SectionKind::Boundary);
        let column = section.map_or(Column::U8(&[]), |section| section.column);
        // Opening has checked the type.
        let mut rest: &[I] = bytemuck::try_cast_slice(column.as_bytes()).unwrap_or_default();
        let level = |dim: Dim| {
            let (start, end) = complex.simplices_of_dim(dim).bounds();
            let ids = start.index()..end.index();
            let len = if dim == 0 { 0 } else { ids.len() * (dim + 1) };
            let (facets, behind) = rest.split_at_checked(len).unwrap_or_default();
            rest = behind;
            Level { ids, facets }
        };
        Self { levels: (0..complex.dim().map_or(0, |dim| dim + 1)).map(level).collect() }
    }

    /// One more than the dimension of the complex.
    pub(super) fn dims(&self) -> usize {
        self.levels.len()
    }

    /// The ids of a dimension; none of one that there is not.
    pub(super) fn ids(&self, dim: Dim) -> Range<usize> {
        self.levels.get(dim).map_or(0..0, |level| level.ids.clone())
    }

    /// The facets of consecutive simplices of one dimension.
    pub(super) fn of(&self, dim: Dim, ids: &Range<usize>) -> &'a [I] {
        let Some(level) = self.levels.get(dim) else { return &[] };
        let entry = |id: usize| id.saturating_sub(level.ids.start).saturating_mul(dim + 1);
        level.facets.get(entry(ids.start)..entry(ids.end)).unwrap_or_default()
    }

    /// The facets of a simplex; none of a vertex, or where the file does not hold what it must.
    #[inline]
    pub(super) fn row(&self, dim: Dim, id: usize) -> &'a [I] {
        let Some(level) = self.levels.get(dim) else { return &[] };
        let start = id.wrapping_sub(level.ids.start).wrapping_mul(dim + 1);
        level.facets.get(start..start.wrapping_add(dim + 1)).unwrap_or_default()
    }

    /// The first vertex of a simplex: what is left when the last one is dropped again and again.
    pub(super) fn first_vertex(&self, dim: Dim, id: usize) -> usize {
        (1..=dim).rev().fold(id, |id, dim| self.row(dim, id).last().map_or(0, |parent| parent.to_usize()))
    }

    /// Calls `visit` with the faces that lack `omitted` of the first vertices of a simplex, as many as `row` has
    /// facets, and none of the others: each once.
    ///
    /// Vertices are deleted by decreasing position (B_{p,q} without marks): a row is read for all faces but the last
    /// step, none of them that of the facet without the first vertex, so all are near the simplex in the order of ids.
    #[inline]
    pub(super) fn faces<F: FnMut(I)>(&self, dim: Dim, row: &'a [I], omitted: usize, visit: &mut F) {
        // The last two steps are loops, for calls would take as long.
        match omitted {
            1 => row.iter().for_each(|&face| visit(face)),
            2 => {
                for (position, facet) in row.iter().enumerate().skip(1) {
                    self.row(dim - 1, facet.to_usize()).iter().take(position).for_each(|&face| visit(face));
                }
            }
            _ => self.far_faces(dim, row, omitted, visit),
        }
    }

    fn far_faces<F: FnMut(I)>(&self, dim: Dim, row: &'a [I], omitted: usize, visit: &mut F) {
        for (position, facet) in row.iter().enumerate().skip(omitted - 1) {
            let facets = self.row(dim - 1, facet.to_usize());
            self.faces(dim - 1, facets.get(..position).unwrap_or(facets), omitted - 1, visit);
        }
    }
}
