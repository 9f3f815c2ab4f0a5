//! Combinatorial maps: closed orientable quasi-manifolds by darts and permutations, the structure that mcc-2012 compares
//! incidence graphs with (sections 2, 4.3 and 8). A baseline to measure against, never on the main path.
//!
//! An n-map, n ≥ 2, is a set of *darts* with permutations β1, …, βn, of which β2, …, βn are involutions, and βi ∘ βj too for
//! i + 2 ≤ j. Its i-cells are orbits:
//!
//! | cell | the darts that are reached from one by |
//! |---|---|
//! | vertex | β1⁻¹, then βi, for i = 2, …, n |
//! | i-cell, i > 0 | all βj but βi |
//!
//! Read from left to right, as here, the vertex of a dart is the one that it leaves; read as functions, as mcc-2012 may mean
//! it, the one that it arrives at: the orbits differ by β1. In the 2-maps of images, to which section 2 alludes with σ and
//! α, the orbits of σ are vertices and the map is the dual of this one.
//!
//! One file a thing: `build` makes the map of a simplicial complex, or names the simplex that forbids it; `words` has the
//! tables for that; `orbits` walks the cells; `relations` answers for boundary, co-boundary and adjacency; `simplicial` goes
//! back to the complex; `structure` is the map as one of the structures that are compared; `operators` removes and contracts edges of 2-maps; `pyramid` stacks 2-maps that come from one another
//! by kernels of such edges, `kernels` chooses them.
//!
//! # Storage
//!
//! Section 8 of mcc-2012 counts for each dart its n permutations and a pointer for each of its n + 1 cells: B · (2n + 1)
//! items for B darts, and so does this container, in one flat array. The paper gives B = 4 n_1 for n = 2, one dart for each
//! path of the incidence graph from an n-node to a 0-node. That is the number of *flags* (the darts of a generalised map); an
//! n-map has one dart for every second flag, 2 n_1 for n = 2, for the flags of the other orientation are the same cells seen
//! from the back. So a simplex of dimension n gives (n + 1)!/2 darts, and a map takes half of what the paper says:
//! [`map_integers`] counts for either number. The index from cells to darts, one integer a cell, is counted apart.

mod build;
pub mod kernels;
mod operators;
mod orbits;
mod pyramid;
mod relations;
mod simplicial;
mod structure;
mod words;

use std::fmt;

use sig_core::{Dim, SimplexId};

pub use build::MapError;
pub use operators::OperatorError;
pub use orbits::Walk;
pub use pyramid::Pyramid;
pub use simplicial::NotSimplicial;
pub use structure::Darts;

/// The number of a dart in its map, from 0.
///
/// Darts keep their numbers when others are deleted.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
#[repr(transparent)]
pub struct DartId(u32);

impl DartId {
    /// The dart with number `index`.
    #[must_use]
    pub const fn new(index: u32) -> Self {
        Self(index)
    }

    /// The number of the dart.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

impl fmt::Display for DartId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}

/// No dart, no cell.
const NONE: u32 = u32::MAX;

/// An n-map, n ≥ 2, with the cells of every dart.
///
/// Cells are numbered as the simplices of the complex that the map was made from, and keep their numbers when others are
/// deleted.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct CombinatorialMap {
    dim: Dim,
    /// The first cell of each dimension, and the end: n + 2 numbers.
    first: Vec<usize>,
    /// 2n + 1 numbers a dart: β1, …, βn, then its cells of dimension 0, …, n. [`NONE`] where the dart is deleted.
    darts: Vec<u32>,
    /// One dart of each cell; [`NONE`] where the cell is deleted.
    dart_of: Vec<u32>,
    /// The darts that are not deleted.
    num_darts: usize,
    /// The cells of each dimension that are not deleted.
    num_cells: Vec<usize>,
}

impl CombinatorialMap {
    /// The dimension n.
    #[must_use]
    pub const fn dim(&self) -> Dim {
        self.dim
    }

    /// B: the number of darts.
    #[must_use]
    pub const fn num_darts(&self) -> usize {
        self.num_darts
    }

    /// The darts, increasing.
    pub fn darts(&self) -> impl Iterator<Item = DartId> + '_ {
        self.dart_numbers().map(DartId)
    }

    /// The number of cells of a dimension.
    #[must_use]
    pub fn num_cells(&self, dim: Dim) -> usize {
        self.num_cells.get(dim).copied().unwrap_or(0)
    }

    /// The cells of a dimension, increasing.
    pub fn cells(&self, dim: Dim) -> impl Iterator<Item = SimplexId> + '_ {
        let bound = |dim: Dim| self.first.get(dim).or(self.first.last()).copied().unwrap_or(0);
        (bound(dim)..bound(dim + 1)).filter(|&cell| self.dart_of[cell] != NONE).map(SimplexId::new)
    }

    /// The dimension of a cell; `None` past the end. Deleted cells keep theirs. Cost: O(n).
    #[must_use]
    pub fn dim_of(&self, cell: SimplexId) -> Option<Dim> {
        let index = cell.index();
        (index < self.dart_of.len()).then(|| self.first.iter().take_while(|&&first| first <= index).count() - 1)
    }

    /// βi of a dart, 1 ≤ i ≤ n; `None` for other i, and for a dart that is deleted or past the end. Cost: O(1).
    #[must_use]
    pub fn beta(&self, i: Dim, dart: DartId) -> Option<DartId> {
        let row = self.row(dart)?;
        (1..=self.dim).contains(&i).then(|| DartId(row[i - 1]))
    }

    /// The cell of dimension `dim` incident in a dart; `None` as for [`beta`](Self::beta). Cost: O(1).
    #[must_use]
    pub fn cell(&self, dart: DartId, dim: Dim) -> Option<SimplexId> {
        let row = self.row(dart)?;
        row.get(self.dim + dim).map(|&cell| SimplexId::new(cell as usize))
    }

    /// A dart of a cell; `None` if it is deleted or past the end. Cost: O(1).
    #[must_use]
    pub fn dart_of(&self, cell: SimplexId) -> Option<DartId> {
        self.dart_of.get(cell.index()).copied().filter(|&dart| dart != NONE).map(DartId)
    }

    /// The integers that mcc-2012, section 8, counts for a map: 2n + 1 for each of its darts. The number from each cell to a
    /// dart, which the paper does not count, is one more for each cell.
    #[must_use]
    pub fn num_integers(&self) -> usize {
        map_integers(self.dim, self.num_darts)
    }

    /// The bytes of the arrays: darts, and a dart for each cell; deleted ones too.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of::<u32>() * (self.darts.len() + self.dart_of.len())
    }

    /// The numbers of a dart that is there.
    fn row(&self, dart: DartId) -> Option<&[u32]> {
        let width = 2 * self.dim + 1;
        let start = dart.index().checked_mul(width)?;
        self.darts.get(start..start + width).filter(|row| row[0] != NONE)
    }

    /// The numbers of the darts that are there.
    fn dart_numbers(&self) -> impl Iterator<Item = u32> + '_ {
        (0..).zip(self.darts.chunks_exact(2 * self.dim + 1)).filter(|(_, row)| row[0] != NONE).map(|(dart, _)| dart)
    }

    /// βi of a dart that is there.
    #[inline]
    fn b(&self, i: Dim, dart: u32) -> u32 {
        self.darts[(2 * self.dim + 1) * dart as usize + i - 1]
    }

    /// The cell of a dimension of a dart that is there.
    #[inline]
    fn c(&self, dim: Dim, dart: u32) -> u32 {
        self.darts[(2 * self.dim + 1) * dart as usize + self.dim + dim]
    }
}

/// What mcc-2012, section 8, counts for an n-map of `num_darts` darts: B · (2n + 1) integers.
#[must_use]
pub const fn map_integers(dim: Dim, num_darts: usize) -> usize {
    num_darts * (2 * dim + 1)
}

/// The darts that a simplicial n-map has for each of its n-simplices: (n + 1)!/2, half of its flags. `None` where that is
/// more than a `usize` holds.
#[must_use]
pub fn darts_of_simplex(dim: Dim) -> Option<usize> {
    (3..=dim + 1).try_fold(1, usize::checked_mul)
}
