//! Cell complexes that change, as incidence graphs (mcc-2012, 2): a multigraph of the cells, in which an arc joins an i-cell
//! and an (i+1)-cell and says how often the one appears on the boundary of the other, and with which sign.
//!
//! A [`CellComplex`] comes from the arrays of any simplicial complex (`simplices`) or from [text](read_cells), and changes by
//! Euler operators (`operators`): [`CellComplex::kill`], KiC(i+1)C, takes a pair of cells away without changing the homology, and
//! [`CellComplex::make`], MiC(i+1)C, puts it back. [`check`](CellComplex::check) tests the invariants.
//!
//! One file each: `arena` has the memory, `lists` the two lists of a cell, `gaps` those that are long.

mod arena;
mod check;
mod cycles;
mod gaps;
mod lists;
mod operators;
mod refine;
mod simplices;
mod text;

use hashbrown::HashMap;
use sig_core::{Arc, CellId, Dim, Incidence, MAX_DIM, PackedArc};

use crate::build::narrow;
use arena::Arena;
use lists::{Header, Side};

pub use check::BrokenInvariant;
pub use cycles::CellWithCycle;
pub use operators::{Infeasible, Instance, OperatorKind, OperatorType, Refinement};
pub use simplices::TooManyCells;
pub use text::{read_cells, write_cells};

/// A cell complex of any dimension up to [`MAX_DIM`], regular or not, as an incidence graph.
///
/// Cells are numbered when the complex is made and keep their numbers; numbers of cells that are gone are vacant, and
/// taken again when the cell is made again. Of each cell the boundary and the co-boundary are listed by increasing number.
///
/// Memory: 12 bytes a cell and 4 bytes for each end of an arc, and what growing lists leave unused; incidences other than
/// the most common ones take some 40 bytes besides. A triangulated surface takes 28 bytes a cell, a tetrahedral mesh about 36.
#[derive(Clone, Debug, Default)]
pub struct CellComplex {
    cells: Vec<Header>,
    arena: Arena,
    /// Incidences that have no code, by i-cell and (i+1)-cell.
    elsewhere: HashMap<(CellId, CellId), Incidence>,
    /// The cells of each dimension.
    counts: Vec<usize>,
    scratch: operators::Scratch,
}

impl CellComplex {
    /// The dimension of the complex; `None` if it is empty.
    #[must_use]
    pub fn dim(&self) -> Option<Dim> {
        self.counts.iter().rposition(|&count| count > 0)
    }

    /// The number of cells of each dimension up to that of the complex.
    #[must_use]
    pub fn counts(&self) -> &[usize] {
        &self.counts[..self.dim().map_or(0, |dim| dim + 1)]
    }

    /// The number of cells.
    #[must_use]
    pub fn num_cells(&self) -> usize {
        self.counts.iter().sum()
    }

    /// The number of cell numbers, those of vacant cells included: all cells are below it.
    #[must_use]
    pub fn num_ids(&self) -> usize {
        self.cells.len()
    }

    /// χ = Σ (−1)^i n_i.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        let signed = |(dim, &count): (Dim, &usize)| if dim % 2 == 0 { count as i64 } else { -(count as i64) };
        self.counts.iter().enumerate().map(signed).sum()
    }

    /// The cells, by number.
    pub fn cells(&self) -> impl DoubleEndedIterator<Item = CellId> + Clone + use<'_> {
        let alive = |(_, header): &(u32, &Header)| !header.is_vacant();
        (0..narrow(self.cells.len())).zip(&self.cells).filter(alive).map(|(number, _)| CellId::new(number))
    }

    /// The dimension of a cell; `None` if there is none of that number.
    #[must_use]
    #[inline]
    pub fn dim_of(&self, cell: CellId) -> Option<Dim> {
        self.header(cell).map(Header::dim)
    }

    /// Whether there is a cell of that number.
    #[must_use]
    #[inline]
    pub fn contains(&self, cell: CellId) -> bool {
        self.header(cell).is_some()
    }

    /// The (i−1)-cells on the boundary of an i-cell, by number.
    pub fn boundary(&self, cell: CellId) -> impl ExactSizeIterator<Item = Arc> + DoubleEndedIterator + Clone + use<'_> {
        self.arcs(cell, Side::Boundary)
    }

    /// The (i+1)-cells that have an i-cell on their boundary, by number.
    pub fn coboundary(
        &self,
        cell: CellId,
    ) -> impl ExactSizeIterator<Item = Arc> + DoubleEndedIterator + Clone + use<'_> {
        self.arcs(cell, Side::Coboundary)
    }

    /// The number of different cells on the boundary of a cell. Cost: O(1), as [`num_coboundary`](Self::num_coboundary).
    #[must_use]
    #[inline]
    pub fn num_boundary(&self, cell: CellId) -> usize {
        self.header(cell).map_or(0, |header| header.len(Side::Boundary, &self.arena))
    }

    /// The number of different cells that have a cell on their boundary.
    #[must_use]
    #[inline]
    pub fn num_coboundary(&self, cell: CellId) -> usize {
        self.header(cell).map_or(0, |header| header.len(Side::Coboundary, &self.arena))
    }

    /// How an i-cell appears on the boundary of an (i+1)-cell; [`Incidence::NONE`] if it does not. Cost: a search in the
    /// boundary of `high`.
    #[must_use]
    pub fn incidence(&self, low: CellId, high: CellId) -> Incidence {
        let list = self.list(high, Side::Boundary);
        lists::find(list, low).map_or(Incidence::NONE, |at| self.incidence_of(low, high, list[at]))
    }

    /// Bytes that the complex takes in memory: those of cells and arcs, with what lists leave unused.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let elsewhere = self.elsewhere.allocation_size();
        self.cells.capacity() * size_of::<Header>() + self.arena.bytes().0 + elsewhere
    }

    /// Makes room for numbers of cells below a bound.
    pub(crate) fn reserve_ids(&mut self, num_ids: usize) {
        if self.cells.len() < num_ids {
            self.cells.resize(num_ids, Header::VACANT);
        }
    }

    #[inline]
    fn header(&self, cell: CellId) -> Option<Header> {
        self.cells.get(cell.index()).copied().filter(|header| !header.is_vacant())
    }

    #[inline]
    fn list(&self, cell: CellId, side: Side) -> &[PackedArc] {
        self.header(cell).map_or(&[], |header| header.list(side, &self.arena))
    }

    #[inline]
    fn incidence_of(&self, low: CellId, high: CellId, arc: PackedArc) -> Incidence {
        let elsewhere = || self.elsewhere.get(&(low, high)).copied().unwrap_or(Incidence::NONE);
        arc.incidence().unwrap_or_else(elsewhere)
    }

    #[inline]
    fn arcs(&self, cell: CellId, side: Side) -> Arcs<'_> {
        let header = self.header(cell).unwrap_or(Header::VACANT);
        let num_arcs = header.len(side, &self.arena);
        let slots = if num_arcs == 0 { &[] } else { header.list(side, &self.arena) };
        Arcs { complex: self, cell, side, slots, num_arcs, before: None }
    }

    /// The neighbours of a cell on one side if they are one or two, and how they are incident.
    #[inline]
    pub(crate) fn one_or_two(&self, cell: CellId, instance: Instance) -> Option<(Arc, Option<Arc>)> {
        let side = if instance == Instance::First { Side::Boundary } else { Side::Coboundary };
        let header = self.cells.get(cell.index()).filter(|header| matches!(header.slots(side), 1 | 2))?;
        let list = header.list(side, &self.arena);
        let arc = |packed: PackedArc| {
            let other = packed.cell();
            let (low, high) = if side == Side::Boundary { (other, cell) } else { (cell, other) };
            Arc { cell: other, incidence: self.incidence_of(low, high, packed) }
        };
        Some((arc(list[0]), list.get(1).copied().map(arc)))
    }

    /// A complex of cells by increasing number, each with its boundary by increasing number; the cells on a boundary come
    /// before.
    ///
    /// `boundary(number, visit)` calls `visit` with the arcs; it is called twice for each cell.
    pub(crate) fn lay_out(
        dims: impl Iterator<Item = Dim> + Clone,
        boundary: impl Fn(u32, &mut dyn FnMut(Arc)),
    ) -> Self {
        let mut lengths: Vec<u32> = Vec::new();
        let mut counts = vec![0; MAX_DIM + 1];
        for (number, dim) in (0..).zip(dims.clone()) {
            counts[dim] += 1;
            let mut length = 0;
            boundary(number, &mut |arc| {
                length += 1;
                lengths[arc.cell.index()] += 1;
            });
            lengths.push(length);
        }
        counts.truncate(counts.iter().rposition(|&count| count > 0).map_or(0, |dim| dim + 1));
        let words = lengths.iter().map(|&arcs| Header::words_of(arcs as usize)).sum();
        let mut complex = Self { arena: Arena::with_capacity(words), counts, ..Self::default() };
        complex.cells.reserve_exact(lengths.len());
        for (arcs, dim) in lengths.into_iter().zip(dims) {
            complex.cells.push(Header::new(dim, arcs as usize, &mut complex.arena));
        }
        let Self { cells, arena, elsewhere, .. } = &mut complex;
        for number in 0..narrow(cells.len()) {
            boundary(number, &mut |arc| {
                let cell = CellId::new(number);
                let packed = PackedArc::new(arc);
                cells[cell.index()].lay(Side::Boundary, packed, arena);
                let back = PackedArc::new(Arc { cell, ..arc });
                cells[arc.cell.index()].lay(Side::Coboundary, back, arena);
                if packed.is_elsewhere() {
                    elsewhere.insert((arc.cell, cell), arc.incidence);
                }
            });
        }
        cells.iter().for_each(|header| header.settle(arena));
        complex
    }
}

/// The arcs of a cell on one side, by increasing cell.
#[derive(Clone)]
struct Arcs<'a> {
    complex: &'a CellComplex,
    cell: CellId,
    side: Side,
    slots: &'a [PackedArc],
    num_arcs: usize,
    /// The cell of the slot before.
    before: Option<CellId>,
}

impl Arcs<'_> {
    #[inline]
    fn arc(&self, packed: PackedArc) -> Arc {
        let other = packed.cell();
        let (low, high) = if self.side == Side::Boundary { (other, self.cell) } else { (self.cell, other) };
        Arc { cell: other, incidence: self.complex.incidence_of(low, high, packed) }
    }
}

impl Iterator for Arcs<'_> {
    type Item = Arc;

    #[inline]
    fn next(&mut self) -> Option<Arc> {
        loop {
            let (&packed, rest) = self.slots.split_first()?;
            self.slots = rest;
            // The others of a run are gaps.
            if self.before.replace(packed.cell()) != Some(packed.cell()) {
                self.num_arcs -= 1;
                return Some(self.arc(packed));
            }
        }
    }

    #[inline]
    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.num_arcs, Some(self.num_arcs))
    }
}

impl DoubleEndedIterator for Arcs<'_> {
    #[inline]
    fn next_back(&mut self) -> Option<Arc> {
        if self.num_arcs == 0 {
            return None;
        }
        let (&(mut packed), mut rest) = self.slots.split_last()?;
        while let Some((&before, further)) = rest.split_last().filter(|(before, _)| before.cell() == packed.cell()) {
            (packed, rest) = (before, further);
        }
        self.slots = rest;
        self.num_arcs -= 1;
        Some(self.arc(packed))
    }
}

impl ExactSizeIterator for Arcs<'_> {}

/// The same cells with the same numbers, dimensions and incidences, whatever the memory they lie in.
impl PartialEq for CellComplex {
    fn eq(&self, other: &Self) -> bool {
        let same_cell = |cell| {
            self.dim_of(cell) == other.dim_of(cell)
                && self.boundary(cell).eq(other.boundary(cell))
                && self.coboundary(cell).eq(other.coboundary(cell))
        };
        let ids = narrow(self.num_ids().max(other.num_ids()));
        self.counts() == other.counts() && (0..ids).all(|number| same_cell(CellId::new(number)))
    }
}

impl Eq for CellComplex {}
