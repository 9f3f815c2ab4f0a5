//! A pyramid of 2-maps (mcc-2012, 3): each level comes from the one below by contracting the edges of one kernel and removing
//! those of another.

use sig_core::{Dim, SimplexId};

use super::kernels::Kernel;
use super::{CombinatorialMap, NONE, OperatorError, Walk, map_integers};

/// The levels of a pyramid of 2-maps, as the base and, for each of its cells, the level that lacks it: what any level can be
/// made of.
///
/// The paper's pyramid is the set of its maps; [`integers_of_levels`](Self::integers_of_levels) counts for that, and
/// [`num_integers`](Self::num_integers) for what is stored here.
#[derive(Clone, Debug)]
pub struct Pyramid {
    base: CombinatorialMap,
    /// The first level without each cell; [`NONE`] where the last one has it.
    lost: Vec<u32>,
    /// For each edge, whether it was removed, if it is lost; else it was contracted.
    is_removed: Vec<bool>,
    /// The darts of each level.
    num_darts: Vec<usize>,
}

impl Pyramid {
    /// The pyramid over a base, level upon level until a kernel changes nothing. `contraction` and `removal` choose the edges
    /// of the next level, `removal` after the contraction; the edges of one kernel go in the order in which they are given.
    /// An edge that is the last of its component stays, though it be in a kernel.
    ///
    /// Cost: that of the operators and of the kernels.
    ///
    /// # Errors
    /// [`OperatorError`] if the base is not a 2-map, or a kernel is none: its edges have to be a forest, of the graph for
    /// contraction and of the dual graph for removal, each with a cell that goes with it.
    pub fn new(
        base: CombinatorialMap,
        mut contraction: impl FnMut(&CombinatorialMap) -> Kernel,
        mut removal: impl FnMut(&CombinatorialMap) -> Kernel,
    ) -> Result<Self, OperatorError> {
        if base.dim != 2 {
            return Err(OperatorError::Dimension(base.dim));
        }
        let edges = base.first[2] - base.first[1];
        let mut top = base.clone();
        let mut pyramid = Self {
            lost: vec![NONE; base.dart_of.len()],
            is_removed: vec![false; edges],
            num_darts: vec![base.num_darts],
            base,
        };
        let mut walk = Walk::new();
        loop {
            for (edge, vertex) in contraction(&top) {
                pyramid.lose([edge, vertex], top.contract(edge, vertex, &mut walk))?;
            }
            for (edge, face) in removal(&top) {
                if pyramid.lose([edge, face], top.remove(edge, face, &mut walk))? {
                    pyramid.is_removed[edge.index() - pyramid.base.first[1]] = true;
                }
            }
            if top.num_darts == pyramid.num_darts[pyramid.num_darts.len() - 1] {
                return Ok(pyramid);
            }
            pyramid.num_darts.push(top.num_darts);
        }
    }

    /// Notes the cells that an operator has deleted, if it has.
    fn lose(&mut self, cells: [SimplexId; 2], done: Result<(), OperatorError>) -> Result<bool, OperatorError> {
        match done {
            Ok(()) => {
                for cell in cells {
                    // There is a dart for each level, at least, and darts have 32-bit numbers.
                    self.lost[cell.index()] = crate::build::narrow(self.num_darts.len());
                }
                Ok(true)
            }
            Err(OperatorError::LastEdge(_)) => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// The number of levels, the base among them.
    #[must_use]
    pub fn num_levels(&self) -> usize {
        self.num_darts.len()
    }

    /// The darts of each level.
    #[must_use]
    pub fn num_darts(&self) -> &[usize] {
        &self.num_darts
    }

    /// The base: level 0.
    #[must_use]
    pub const fn base(&self) -> &CombinatorialMap {
        &self.base
    }

    /// The integers that mcc-2012, section 8, counts for the maps of all levels: 5 for each dart of each.
    #[must_use]
    pub fn integers_of_levels(&self) -> usize {
        self.num_darts.iter().map(|&darts| map_integers(2, darts)).sum()
    }

    /// The integers of what is stored: the base, and a level for each of its cells. A bit for each edge comes to that.
    #[must_use]
    pub fn num_integers(&self) -> usize {
        self.base.num_integers() + self.lost.len()
    }

    /// The map of a level, with the numbers of the base; the last one past the end.
    ///
    /// Cost: linear in the base.
    #[must_use]
    pub fn level(&self, level: usize) -> CombinatorialMap {
        let mut map = self.base.clone();
        let is_lost = |cell: u32| self.lost[cell as usize] as usize <= level && self.lost[cell as usize] != NONE;
        let survivors = self.survivors(is_lost);
        let kept = |dart: &u32| !is_lost(self.base.c(1, *dart));
        for dart in self.base.dart_numbers() {
            let row = &mut map.darts[5 * dart as usize..][..5];
            if kept(&dart) {
                row[0] = self.next(dart, kept);
                row[2] = survivors[row[2] as usize];
                row[4] = survivors[row[4] as usize];
            } else {
                row[0] = NONE;
            }
        }
        map.dart_of.fill(NONE);
        for dart in self.base.dart_numbers().filter(kept) {
            for dim in 0..=2 {
                let cell = map.c(dim, dart) as usize;
                if map.dart_of[cell] == NONE {
                    map.dart_of[cell] = dart;
                }
            }
        }
        map.num_darts = self.num_darts[level.min(self.num_darts.len() - 1)];
        map.num_cells = (0..=2).map(|dim| map.cells(dim).count()).collect();
        map
    }

    /// β1 at a level, by a walk in the base: over a contracted edge to the end of the path, along a removed one to the other
    /// side.
    fn next(&self, dart: u32, kept: impl Fn(&u32) -> bool) -> u32 {
        let mut next = self.base.b(1, dart);
        while !kept(&next) {
            let edge = self.base.c(1, next) as usize - self.base.first[1];
            let through = if self.is_removed[edge] { self.base.b(2, next) } else { next };
            next = self.base.b(1, through);
        }
        next
    }

    /// The cell that stands for each vertex and face at a level: the one that is left of those that lost edges join.
    fn survivors(&self, is_lost: impl Fn(u32) -> bool) -> Vec<u32> {
        let mut survivors: Vec<u32> = (0..).take(self.lost.len()).collect();
        let lost_darts = self.base.dart_numbers().filter(|&dart| is_lost(self.base.c(1, dart)));
        for dart in lost_darts {
            let edge = self.base.c(1, dart) as usize - self.base.first[1];
            let dim: Dim = if self.is_removed[edge] { 2 } else { 0 };
            let [one, other] = [dart, self.base.b(2, dart)].map(|dart| root(&mut survivors, self.base.c(dim, dart)));
            // A cell that is lost gives way; of two, either.
            if is_lost(one) { survivors[one as usize] = other } else { survivors[other as usize] = one }
        }
        (0..).take(self.lost.len()).map(|cell| root(&mut survivors, cell)).collect()
    }
}

/// The last cell that the links from one lead to. Halves the path.
pub(super) fn root(links: &mut [u32], mut cell: u32) -> u32 {
    while links[cell as usize] != cell {
        let next = links[links[cell as usize] as usize];
        links[cell as usize] = next;
        cell = next;
    }
    cell
}
