//! Where boundaries come from: simplices and cells by dimension and number in their dimension.

use std::borrow::Cow;

use sig_core::format::{Column, SectionKind};
use sig_core::{CellId, Dim, Index, Relations, SimplexId};

use crate::build::{Families, narrow};
use crate::cells::CellComplex;

/// A complex as a chain complex: cells of each dimension, numbered from 0, with their boundaries.
pub trait Chains: Sync {
    /// How many cells there are of each dimension.
    fn counts(&self) -> Vec<usize>;

    /// The boundaries of the cells of a dimension; `below` are those of the dimension below, if the caller has them.
    ///
    /// Cost: nothing where the boundaries lie somewhere already, else a pass over them, in rayon's current pool; without
    /// `below` over those of all dimensions below.
    fn level(&self, dim: Dim, below: Option<&Level<'_>>) -> Level<'_>;
}

/// The boundaries of all cells of one dimension: for each its faces with their incidence numbers, which are not zero.
#[derive(Clone, Debug)]
pub struct Level<'a> {
    rows: Rows,
    /// Numbers in the dimension below, plus `first`.
    faces: Cow<'a, [u32]>,
    first: u32,
    /// One for each face; if there are none, they alternate, from 1.
    coefficients: Option<Vec<i32>>,
}

#[derive(Clone, Debug)]
enum Rows {
    /// So many cells of so many faces.
    Even(usize, usize),
    /// Where each begins, and the end.
    From(Vec<usize>),
}

impl Level<'_> {
    /// How many cells there are.
    #[must_use]
    pub fn num_cells(&self) -> usize {
        match &self.rows {
            Rows::Even(cells, _) => *cells,
            Rows::From(starts) => starts.len() - 1,
        }
    }

    /// How many faces all cells have.
    #[must_use]
    pub fn num_faces(&self) -> usize {
        self.faces.len()
    }

    /// The number of faces of every cell, if it is the same for all.
    pub(super) fn width(&self) -> Option<usize> {
        match self.rows {
            Rows::Even(_, width) => Some(width),
            Rows::From(_) => None,
        }
    }

    #[inline]
    fn range(&self, cell: usize) -> std::ops::Range<usize> {
        match &self.rows {
            Rows::Even(_, faces) => cell * faces..(cell + 1) * faces,
            Rows::From(starts) => starts[cell]..starts[cell + 1],
        }
    }

    /// The faces of a cell, each once.
    #[must_use]
    #[inline]
    pub fn faces(&self, cell: usize) -> impl ExactSizeIterator<Item = u32> + Clone + '_ {
        let first = self.first;
        self.faces[self.range(cell)].iter().map(move |&face| face - first)
    }

    /// The incidence number of the k-th face of a cell.
    #[must_use]
    #[inline]
    pub fn coefficient(&self, cell: usize, k: usize) -> i64 {
        match &self.coefficients {
            None => 1 - 2 * (k as i64 & 1),
            Some(coefficients) => coefficients[self.range(cell).start + k].into(),
        }
    }

    /// The faces of a cell with their incidence numbers.
    #[inline]
    pub fn boundary(&self, cell: usize) -> impl ExactSizeIterator<Item = (u32, i64)> + '_ {
        self.faces(cell).enumerate().map(move |(k, face)| (face, self.coefficient(cell, k)))
    }
}

/// The simplices of a complex in a file of either kind, oriented by the order of their vertices.
///
/// The boundaries of a file that has them are read where they lie, if its indices have 32 bits; those of a simplex tree
/// follow from those of the dimension below. The complex must be a right one, as its `validate` says: else the answers are
/// wrong, or there is a panic.
#[derive(Debug)]
pub struct Simplices<'a, C>(pub &'a C);

impl<C: Relations + Sync> Simplices<'_, C> {
    fn ids(&self, dim: Dim) -> std::ops::Range<usize> {
        let (start, end) = self.0.simplices_of_dim(dim).bounds();
        start.index()..end.index()
    }

    /// The section of the boundaries, if it has 32 bits.
    fn stored(&self, dim: Dim) -> Option<Level<'_>> {
        let Column::U32(boundary) = self.0.container().section(SectionKind::Boundary)?.column else { return None };
        let before: usize = (1..dim).map(|dim| self.ids(dim).len() * (dim + 1)).sum();
        let cells = self.ids(dim).len();
        let faces = Cow::Borrowed(&boundary[before..before + cells * (dim + 1)]);
        Some(Level {
            rows: Rows::Even(cells, dim + 1),
            faces,
            first: narrow(self.ids(dim - 1).start),
            coefficients: None,
        })
    }

    /// By the children of the simplices in the dimension below, if the file has these in 32 bits.
    fn of_tree(&self, dim: Dim, below: Option<&Level<'_>>) -> Option<Level<'_>> {
        let section = |kind| self.0.container().section(kind).map(|section| section.column);
        let Column::U32(child_offsets) = section(SectionKind::ChildOffsets)? else { return None };
        match section(SectionKind::LastVertices)? {
            Column::U16(last_vertices) => self.of_families(dim, below, child_offsets, last_vertices),
            Column::U32(last_vertices) => self.of_families(dim, below, child_offsets, last_vertices),
            _ => None,
        }
    }

    fn of_families<L: Index>(
        &self,
        dim: Dim,
        below: Option<&Level<'_>>,
        child_offsets: &[u32],
        last_vertices: &[L],
    ) -> Option<Level<'_>> {
        let (parents, cells) = (self.ids(dim - 1), self.ids(dim));
        let mut rows = vec![0; cells.len() * (dim + 1)];
        let mut boundaries = rows.chunks_exact_mut(dim + 1);
        for parent in parents.clone() {
            let children = child_offsets[parent] as usize..child_offsets[parent + 1] as usize;
            for (child, row) in children.zip(&mut boundaries) {
                row[dim] = narrow(parent);
                if dim == 1 {
                    row[0] = narrow(last_vertices[child].to_usize());
                }
            }
        }
        if dim > 1 {
            let computed =
                if below.is_none() { self.of_families(dim - 1, None, child_offsets, last_vertices) } else { None };
            let below = below.or(computed.as_ref())?;
            let families =
                Families { child_offsets, last_vertices, parents: parents.clone(), parent_rows: &below.faces };
            families.fill(dim, dim, &mut rows, &|_| ()).ok()?;
        }
        let first = narrow(parents.start);
        Some(Level { rows: Rows::Even(cells.len(), dim + 1), faces: Cow::Owned(rows), first, coefficients: None })
    }

    /// Simplex by simplex.
    fn by_facets(&self, dim: Dim) -> Level<'_> {
        let below = self.ids(dim - 1).start;
        let mut faces = Vec::with_capacity(self.ids(dim).len() * (dim + 1));
        for simplex in self.0.simplices_of_dim(dim) {
            faces.extend(self.0.facets(simplex).map(|facet: SimplexId| narrow(facet.index() - below)));
        }
        let rows = Rows::Even(self.ids(dim).len(), dim + 1);
        Level { rows, faces: Cow::Owned(faces), first: 0, coefficients: None }
    }
}

impl<C: Relations + Sync> Chains for Simplices<'_, C> {
    fn counts(&self) -> Vec<usize> {
        let dims = self.0.dim().map_or(0, |dim| dim + 1);
        (0..dims).map(|dim| self.0.num_simplices_of_dim(dim)).collect()
    }

    fn level(&self, dim: Dim, below: Option<&Level<'_>>) -> Level<'_> {
        if dim == 0 {
            let rows = Rows::Even(self.0.num_vertices(), 0);
            return Level { rows, faces: Cow::default(), first: 0, coefficients: None };
        }
        self.stored(dim).or_else(|| self.of_tree(dim, below)).unwrap_or_else(|| self.by_facets(dim))
    }
}

/// The cells of a cell complex, by increasing number.
#[derive(Debug)]
pub struct Cells<'a> {
    complex: &'a CellComplex,
    /// Of each cell, its number in its dimension.
    numbers: Vec<u32>,
}

impl<'a> Cells<'a> {
    /// Of a complex. Cost: a pass over the cells.
    #[must_use]
    pub fn new(complex: &'a CellComplex) -> Self {
        let mut numbers = vec![0_u32; complex.num_ids()];
        let mut next = vec![0; complex.counts().len()];
        for cell in complex.cells() {
            let next = &mut next[complex.dim_of(cell).unwrap_or(0)];
            numbers[cell.index()] = *next;
            *next += 1;
        }
        Self { complex, numbers }
    }
}

impl Cells<'_> {
    /// The cells of a dimension, by number.
    #[must_use]
    pub fn of_dim(&self, dim: Dim) -> Vec<CellId> {
        self.complex.cells().filter(|&cell| self.complex.dim_of(cell) == Some(dim)).collect()
    }
}

impl Chains for Cells<'_> {
    fn counts(&self) -> Vec<usize> {
        self.complex.counts().to_vec()
    }

    fn level(&self, dim: Dim, _: Option<&Level<'_>>) -> Level<'_> {
        let (mut starts, mut faces, mut coefficients) = (vec![0], Vec::new(), Vec::new());
        let cells = self.complex.cells().filter(|&cell: &CellId| self.complex.dim_of(cell) == Some(dim));
        for cell in cells {
            // A face that appears as often with either sign is none of the chain.
            for arc in self.complex.boundary(cell).filter(|arc| arc.incidence.sign != 0) {
                faces.push(self.numbers[arc.cell.index()]);
                coefficients.push(arc.incidence.sign);
            }
            starts.push(faces.len());
        }
        Level { rows: Rows::From(starts), faces: Cow::Owned(faces), first: 0, coefficients: Some(coefficients) }
    }
}
