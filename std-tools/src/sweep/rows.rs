//! The boundary rows of a complex as plain slices, and the faces of a simplex by them.

use std::ops::Range;

use sig_core::format::{Column, SectionKind};
use sig_core::{Complex, Dim, Index};

use super::block::narrow;

/// The facets of the simplices of each dimension, where they lie.
pub(super) struct Rows<'a, I> {
    levels: Vec<Level<'a, I>>,
}

struct Level<'a, I> {
    ids: Range<usize>,
    /// `dim + 1` facets a simplex; none of vertices.
    facets: &'a [I],
}

/// The rows of the simplices of `W` vertices, whose length the compiler knows.
#[derive(Clone, Copy)]
struct RowsOf<'a, I, const W: usize> {
    /// The first of the simplices.
    first: usize,
    rows: &'a [[I; W]],
}

impl<'a, I: Index, const W: usize> RowsOf<'a, I, W> {
    /// The row of a simplex; `None` where the file does not hold what it must.
    #[inline]
    fn row(self, id: I) -> Option<&'a [I; W]> {
        self.rows.get(id.to_usize().wrapping_sub(self.first))
    }
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

    /// All rows of the simplices of `W` vertices.
    fn all_rows<const W: usize>(&self) -> RowsOf<'a, I, W> {
        let level = self.levels.get(W - 1);
        let first = level.map_or(0, |level| level.ids.start);
        RowsOf { first, rows: level.map_or(&[], |level| level.facets.as_chunks().0) }
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

    /// Calls `visit` with each face of dimension `dim` of consecutive simplices of dimension `above`, and the simplex:
    /// simplex by simplex, each face of it once.
    ///
    /// Vertices are deleted by decreasing position (B_{p,q} without marks): a row is read for all faces but the last
    /// step, none of them that of the facet without the first vertex, so all are near the simplex in the order of ids.
    #[inline]
    pub(super) fn each_face(&self, (dim, above): (Dim, Dim), ids: &Range<usize>, visit: impl FnMut(I, I)) {
        // Loops whose lengths are known to the compiler take a third of the time.
        match (above + 1, above - dim) {
            (2, 1) => self.each_facet::<2>(ids, visit),
            (3, 1) => self.each_facet::<3>(ids, visit),
            (4, 1) => self.each_facet::<4>(ids, visit),
            (5, 1) => self.each_facet::<5>(ids, visit),
            (6, 1) => self.each_facet::<6>(ids, visit),
            (3, 2) => self.each_second::<3, 2>(ids, visit),
            (4, 2) => self.each_second::<4, 3>(ids, visit),
            (5, 2) => self.each_second::<5, 4>(ids, visit),
            (6, 2) => self.each_second::<6, 5>(ids, visit),
            (4, 3) => self.each_third::<4, 3, 2>(ids, visit),
            (5, 3) => self.each_third::<5, 4, 3>(ids, visit),
            (6, 3) => self.each_third::<6, 5, 4>(ids, visit),
            (_, omitted) => self.each_other((above, omitted), ids, visit),
        }
    }

    /// Calls `visit` with the ends of consecutive edges.
    #[inline]
    pub(super) fn each_edge(&self, ids: &Range<usize>, mut visit: impl FnMut(I, I)) {
        self.each_row::<2>(ids).for_each(|(_, &[last, first])| visit(last, first));
    }

    /// The simplices of `W` vertices with their rows.
    #[inline]
    fn each_row<const W: usize>(
        &self,
        ids: &Range<usize>,
    ) -> impl Iterator<Item = (usize, &'a [I; W])> + use<'a, I, W> {
        (ids.start..).zip(self.of(W - 1, ids).as_chunks::<W>().0)
    }

    /// The facets of simplices of `W` vertices.
    #[inline(never)]
    fn each_facet<const W: usize>(&self, ids: &Range<usize>, mut visit: impl FnMut(I, I)) {
        for (id, row) in self.each_row::<W>(ids) {
            for &face in row {
                visit(face, narrow(id));
            }
        }
    }

    /// The faces of `V` − 1 vertices of simplices of `W` = `V` + 1.
    #[inline(never)]
    fn each_second<const W: usize, const V: usize>(&self, ids: &Range<usize>, mut visit: impl FnMut(I, I)) {
        let below = self.all_rows::<V>();
        for (id, row) in self.each_row::<W>(ids) {
            for position in 1..W {
                let Some(faces) = below.row(row[position]) else { continue };
                for &face in &faces[..position] {
                    visit(face, narrow(id));
                }
            }
        }
    }

    /// The faces of `U` − 1 vertices of simplices of `W` = `V` + 1 = `U` + 2.
    #[inline(never)]
    fn each_third<const W: usize, const V: usize, const U: usize>(
        &self,
        ids: &Range<usize>,
        mut visit: impl FnMut(I, I),
    ) {
        let (below, far) = (self.all_rows::<V>(), self.all_rows::<U>());
        for (id, row) in self.each_row::<W>(ids) {
            for (position, &facet) in row.iter().enumerate().skip(2) {
                let Some(facets) = below.row(facet) else { continue };
                for second in 1..position {
                    let Some(faces) = far.row(facets[second]) else { continue };
                    for &face in &faces[..second] {
                        visit(face, narrow(id));
                    }
                }
            }
        }
    }

    /// Faces of simplices of any dimension.
    fn each_other(&self, (above, omitted): (Dim, usize), ids: &Range<usize>, mut visit: impl FnMut(I, I)) {
        for (id, row) in ids.clone().map(narrow).zip(self.of(above, ids).chunks_exact(above + 1)) {
            self.faces_of(above, row, omitted, &mut |face| visit(face, id));
        }
    }

    /// The faces that lack `omitted` of the first vertices of a simplex, as many as `row` has facets, and none of the
    /// others.
    fn faces_of<F: FnMut(I)>(&self, dim: Dim, row: &'a [I], omitted: usize, visit: &mut F) {
        if omitted == 1 {
            return row.iter().for_each(|&face| visit(face));
        }
        for (position, facet) in row.iter().enumerate().skip(omitted - 1) {
            let facets = self.row(dim - 1, facet.to_usize());
            self.faces_of(dim - 1, facets.get(..position).unwrap_or(facets), omitted - 1, visit);
        }
    }
}
