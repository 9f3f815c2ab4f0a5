//! Cells as orbits of darts.

use sig_core::{Dim, SimplexId};

use super::{CombinatorialMap, DartId};

/// Memory to walk orbits with: a bit for each dart and each cell, and the last answer. One serves for any number of walks on
/// maps of any size.
#[derive(Clone, Debug, Default)]
pub struct Walk {
    /// Darts that were seen, and cells; all clear between walks.
    darts: Marks,
    cells: Marks,
    /// The darts of the orbit.
    pub(super) orbit: Vec<u32>,
    /// The cells of the answer.
    pub(super) found: Vec<SimplexId>,
    /// Cells that are to be kept out of it.
    passed_over: Vec<u32>,
    /// Darts to walk from later, and vertices to tell from others.
    pub(super) starts: Vec<u32>,
    pub(super) own: Vec<u32>,
}

impl Walk {
    /// Memory that grows with the first walk.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Starts an answer of cells.
    pub(super) fn start(&mut self) {
        self.found.clear();
    }

    /// Adds a cell to the answer, if it is new in it and not passed over.
    pub(super) fn add(&mut self, cell: u32) {
        if self.cells.set(cell) {
            self.found.push(SimplexId::new(cell as usize));
        }
    }

    /// Keeps a cell out of the answer.
    pub(super) fn pass_over(&mut self, cell: u32) {
        if self.cells.set(cell) {
            self.passed_over.push(cell);
        }
    }

    /// Ends an answer: clears its marks.
    pub(super) fn finish(&mut self) -> &[SimplexId] {
        for cell in &self.found {
            self.cells.clear(cell.index());
        }
        for cell in self.passed_over.drain(..) {
            self.cells.clear(cell as usize);
        }
        &self.found
    }

    /// The orbit of a dart under `generators`, which take a dart to others, into `orbit`.
    pub(super) fn orbit_of(&mut self, dart: u32, generators: impl Fn(u32, &mut dyn FnMut(u32))) {
        let Self { darts, orbit, .. } = self;
        orbit.clear();
        orbit.push(dart);
        darts.set(dart);
        let mut next = 0;
        while let Some(&dart) = orbit.get(next) {
            next += 1;
            generators(dart, &mut |image| {
                if darts.set(image) {
                    orbit.push(image);
                }
            });
        }
        for &dart in &*orbit {
            darts.clear(dart as usize);
        }
    }
}

/// A bit for each number.
#[derive(Clone, Debug, Default)]
struct Marks(Vec<u64>);

impl Marks {
    /// Sets a bit; whether it was clear.
    #[inline]
    fn set(&mut self, number: u32) -> bool {
        let (word, bit) = (number as usize / 64, 1 << (number % 64));
        if self.0.len() <= word {
            self.0.resize(word + 1 + word / 2, 0);
        }
        let is_new = self.0[word] & bit == 0;
        self.0[word] |= bit;
        is_new
    }

    #[inline]
    fn clear(&mut self, number: usize) {
        self.0[number / 64] &= !(1 << (number % 64));
    }
}

impl CombinatorialMap {
    /// The darts of a cell, in no particular order: its orbit. Empty for a cell that is deleted or past the end.
    ///
    /// Cost: O(n) for each dart of the orbit.
    pub fn darts_of<'w>(&self, cell: SimplexId, walk: &'w mut Walk) -> impl ExactSizeIterator<Item = DartId> + use<'w> {
        walk.orbit.clear();
        if let (Some(dart), Some(dim)) = (self.dart_of(cell), self.dim_of(cell)) {
            self.walk_cell(dart.0, dim, walk);
        }
        walk.orbit.iter().copied().map(DartId)
    }

    /// The orbit of the cell of dimension `dim` incident in a dart.
    ///
    /// An orbit is the same under the inverses: for vertices βi, then β1, which needs no inverse of β1.
    pub(super) fn walk_cell(&self, dart: u32, dim: Dim, walk: &mut Walk) {
        let n = self.dim;
        if dim == 0 {
            walk.orbit_of(dart, |dart, reach| (2..=n).for_each(|i| reach(self.b(1, self.b(i, dart)))));
        } else {
            let others = (1..dim).chain(dim + 1..=n);
            walk.orbit_of(dart, |dart, reach| others.clone().for_each(|i| reach(self.b(i, dart))));
        }
    }

    /// The darts reached from one by β1, …, β(dim − 1): flags of the boundary of its cell of dimension `dim`, with the same
    /// cells above it.
    pub(super) fn walk_boundary(&self, dart: u32, dim: Dim, walk: &mut Walk) {
        walk.orbit_of(dart, |dart, reach| (1..dim).for_each(|i| reach(self.b(i, dart))));
    }
}
