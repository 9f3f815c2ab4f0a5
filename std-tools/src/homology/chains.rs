//! Where boundaries come from: simplices and cells by dimension and number in their dimension.

use sig_core::{CellId, Dim, Relations, SimplexId};

use crate::build::narrow;
use crate::cells::CellComplex;

/// A complex as a chain complex: cells of each dimension, numbered from 0, with their boundaries.
pub trait Chains: Sync {
    /// How many cells there are of each dimension.
    fn counts(&self) -> Vec<usize>;

    /// The boundaries of the cells of a dimension. Cost: a pass over them.
    fn level(&self, dim: Dim) -> Level;
}

/// The boundaries of all cells of one dimension: for each its faces with their incidence numbers, which are not zero.
#[derive(Clone, Debug)]
pub struct Level {
    rows: Rows,
    /// Numbers in the dimension below.
    faces: Vec<u32>,
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

impl Level {
    /// How many cells there are.
    #[must_use]
    pub fn num_cells(&self) -> usize {
        match &self.rows {
            Rows::Even(cells, _) => *cells,
            Rows::From(starts) => starts.len() - 1,
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
    pub fn faces(&self, cell: usize) -> &[u32] {
        &self.faces[self.range(cell)]
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
        let faces = self.faces(cell).iter().enumerate();
        faces.map(move |(k, &face)| (face, self.coefficient(cell, k)))
    }

    /// All faces of all cells, one after the other.
    pub(super) fn all_faces(&self) -> &[u32] {
        &self.faces
    }
}

/// The simplices of a complex in a file of either kind, oriented by the order of their vertices.
#[derive(Debug)]
pub struct Simplices<'a, C>(pub &'a C);

impl<C: Relations + Sync> Chains for Simplices<'_, C> {
    fn counts(&self) -> Vec<usize> {
        let dims = self.0.dim().map_or(0, |dim| dim + 1);
        (0..dims).map(|dim| self.0.num_simplices_of_dim(dim)).collect()
    }

    fn level(&self, dim: Dim) -> Level {
        let first = |dim: Dim| self.0.simplices_of_dim(dim).bounds().0.index();
        let faces = match dim.checked_sub(1) {
            None => Vec::new(),
            Some(below) => {
                let below = first(below);
                let mut faces = Vec::with_capacity(self.0.num_simplices_of_dim(dim) * (dim + 1));
                for simplex in self.0.simplices_of_dim(dim) {
                    faces.extend(self.0.facets(simplex).map(|facet: SimplexId| narrow(facet.index() - below)));
                }
                faces
            }
        };
        let width = if dim == 0 { 0 } else { dim + 1 };
        Level { rows: Rows::Even(self.0.num_simplices_of_dim(dim), width), faces, coefficients: None }
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

impl Chains for Cells<'_> {
    fn counts(&self) -> Vec<usize> {
        self.complex.counts().to_vec()
    }

    fn level(&self, dim: Dim) -> Level {
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
        Level { rows: Rows::From(starts), faces, coefficients: Some(coefficients) }
    }
}
