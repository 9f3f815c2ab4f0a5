//! Homology-preserving Euler operators on an incidence graph (mcc-2012, 4).
//!
//! KiC(i+1)C takes an i-cell, here *low*, and an (i+1)-cell, *high*, off the complex, of which low appears once on the boundary
//! of high. Every other cell s on the boundary of high and every other cell r with low on its boundary come to meet where
//! low and high were: ϕ(s,r) grows by ϕ(s,high)·ϕ(low,r), and the signed number changes so that the boundary of every
//! boundary stays zero ([`Incidence::joined`]). The paper has four cases, which differ only in how many s and r there are:
//!
//! | | first instance | second instance |
//! |---|---|---|
//! | first type | one s: low is merged with it | one r: high is merged with it |
//! | second type | no s: high is bounded by low only | no r: low bounds high only |
//!
//! Where there is no s, or no r, the type is the second whatever stands on the other side: a pendant edge is of the second
//! type in the paper's Figure 1, though it is bounded by two vertices. This reading of 4.1 is also the one by which spheres
//! end with the four cells that Table 1 implies.
//!
//! So one procedure does them all, and one undoes them all; the rules of 4.1 and 4.2 say which pairs it may be asked for.
//! [`CellComplex::cancel`] asks for no rule but the single appearance: then it is the algebraic cancellation of a pair, which
//! preserves homology too, and whose result need not be a complex of cells.

use sig_core::{Arc, CellId, Dim, Incidence, MAX_DIM, PackedArc};

use super::CellComplex;
use super::lists::{Header, Side, find};

/// The type of an operator (mcc-2012, 4.1).
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum OperatorType {
    /// A cell is merged with another one.
    First,
    /// Two cells vanish together.
    Second,
}

/// The instance of an operator (mcc-2012, 4.1): the second is the dual of the first.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Instance {
    /// What counts is the boundary of the (i+1)-cell.
    First,
    /// What counts is the co-boundary of the i-cell.
    Second,
}

/// Which of the four rules allows an operator.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct OperatorKind {
    /// The type.
    pub operator_type: OperatorType,
    /// The instance.
    pub instance: Instance,
}

/// Why an operator is not feasible; the complex is as it was.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Infeasible {
    /// There is no cell of that number.
    #[error("there is no cell {0}")]
    NoSuchCell(CellId),
    /// The one is not on the boundary of the other.
    #[error("cell {low} is not on the boundary of cell {high}")]
    NotIncident {
        /// The cell that should be the i-cell.
        low: CellId,
        /// The cell that should be the (i+1)-cell.
        high: CellId,
    },
    /// The i-cell appears several times on the boundary of the (i+1)-cell.
    #[error("cell {low} appears {multiplicity} times on the boundary of cell {high}, not once")]
    Multiplicity {
        /// The i-cell.
        low: CellId,
        /// The (i+1)-cell.
        high: CellId,
        /// ϕ.
        multiplicity: u32,
    },
    /// Neither has the (i+1)-cell at most one other cell on its boundary, nor does the i-cell bound at most one other.
    #[error(
        "cell {high} is bounded by {below} other cells, and cell {low} bounds {above} others; one of these must be 0 or 1"
    )]
    Neighbours {
        /// The i-cell.
        low: CellId,
        /// The (i+1)-cell.
        high: CellId,
        /// Other i-cells on the boundary of the (i+1)-cell.
        below: usize,
        /// Other (i+1)-cells that the i-cell bounds.
        above: usize,
    },
    /// A multiplicity, or the memory, would be larger than its numbers are.
    #[error("the multiplicities or lists around cells {low} and {high} would be too large")]
    TooLarge {
        /// The i-cell.
        low: CellId,
        /// The (i+1)-cell.
        high: CellId,
    },
    /// A cell that would be made is there, or its number or dimension is out of range.
    #[error("cell {0} cannot be made: there is one of that number, or the number or dimension is out of range")]
    CannotMake(CellId),
    /// A cell to which a new one would be joined is not there, has another dimension, or is out of order in its list; or the
    /// incidence is none.
    #[error("a new cell cannot be joined to cell {0}: wrong cell, dimension, order or incidence")]
    CannotJoin(CellId),
    /// The incidence of a pair is less than the part of it that would move to the new cells: ϕ(p',r) ≥ ϕ'(p',q)·ϕ'(p,r).
    #[error("cell {low} appears less often on the boundary of cell {high} than the new cells take away")]
    TooFew {
        /// The i-cell that stays.
        low: CellId,
        /// The (i+1)-cell that stays.
        high: CellId,
    },
    /// A cell that would be killed with a cycle bounds another one.
    #[error("cell {cell} is on the boundary of cell {high}")]
    Bounds {
        /// The cell.
        cell: CellId,
        /// The other.
        high: CellId,
    },
    /// A chain of i-cells has a cell that is none.
    #[error("cell {cell} is no cell of dimension {dim}")]
    NotInCycle {
        /// The cell.
        cell: CellId,
        /// i.
        dim: Dim,
    },
    /// A cycle does not have the cell once, in either orientation.
    #[error("the coefficient of cell {cell} in the cycle is {coefficient}, not 1 or -1")]
    NotOnCycle {
        /// The cell.
        cell: CellId,
        /// Its coefficient.
        coefficient: i128,
    },
    /// The boundary of a chain is not zero.
    #[error("the chain is no cycle: its boundary has cell {face} {coefficient} times")]
    NoCycle {
        /// A cell of the boundary.
        face: CellId,
        /// Its coefficient.
        coefficient: i128,
    },
}

/// A pair of cells that was killed, with all that makes it again: the inverse operator MiC(i+1)C.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Refinement {
    /// The i-cell.
    pub low: CellId,
    /// The (i+1)-cell.
    pub high: CellId,
    /// i.
    pub dim: Dim,
    /// \[high:low\], 1 or −1.
    pub sign: i32,
    arcs: Vec<Arc>,
    ends: [usize; 3],
}

impl Refinement {
    /// A refinement that makes `low` of dimension `dim` and `high`, which it bounds once with the given sign. The lists are by
    /// increasing cell: what bounds `low`, what else bounds `high`, what else `low` bounds, and what `high` bounds.
    #[must_use]
    pub fn new(low: CellId, high: CellId, dim: Dim, sign: i32, lists: [&[Arc]; 4]) -> Self {
        let mut refinement = Self::default();
        refinement.reset(low, high, dim, sign);
        lists.into_iter().enumerate().for_each(|(part, list)| refinement.extend(part, list.iter().copied()));
        refinement
    }

    /// Begins anew, keeping the memory.
    pub(crate) fn reset(&mut self, low: CellId, high: CellId, dim: Dim, sign: i32) {
        self.arcs.clear();
        (self.low, self.high, self.dim, self.sign, self.ends) = (low, high, dim, sign, [0; 3]);
    }

    /// Adds the arcs of one of the four lists; they come in order.
    #[inline]
    pub(crate) fn extend(&mut self, part: usize, arcs: impl Iterator<Item = Arc>) {
        self.arcs.extend(arcs);
        if let Some(end) = self.ends.get_mut(part) {
            *end = self.arcs.len();
        }
    }

    /// The (i−1)-cells on the boundary of the i-cell.
    #[must_use]
    pub fn below_low(&self) -> &[Arc] {
        &self.arcs[..self.ends[0]]
    }

    /// The other i-cells on the boundary of the (i+1)-cell.
    #[must_use]
    pub fn below_high(&self) -> &[Arc] {
        &self.arcs[self.ends[0]..self.ends[1]]
    }

    /// The other (i+1)-cells that the i-cell bounds.
    #[must_use]
    pub fn above_low(&self) -> &[Arc] {
        &self.arcs[self.ends[1]..self.ends[2]]
    }

    /// The (i+2)-cells that the (i+1)-cell bounds.
    #[must_use]
    pub fn above_high(&self) -> &[Arc] {
        &self.arcs[self.ends[2]..]
    }

    /// The four lists one after the other: all cells that the new ones are joined to.
    #[must_use]
    pub fn arcs(&self) -> &[Arc] {
        &self.arcs
    }

    /// The rules that allow the inverse: one for each of the instances at most.
    pub fn kinds(&self) -> impl Iterator<Item = OperatorKind> + use<> {
        kinds(self.below_high().len(), self.above_low().len())
    }
}

/// The rules that allow killing a pair with so many others on either side.
fn kinds(below: usize, above: usize) -> impl Iterator<Item = OperatorKind> {
    let (operator_type, most) =
        if below.min(above) == 0 { (OperatorType::Second, 0) } else { (OperatorType::First, 1) };
    let kind = move |others, instance| (others <= most).then_some(OperatorKind { operator_type, instance });
    [kind(below, Instance::First), kind(above, Instance::Second)].into_iter().flatten()
}

/// Memory that operators use again.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    /// For each r and each s: what becomes of their incidence, and whether they are incident before, or after.
    plan: Vec<(Incidence, bool)>,
    packed: Vec<PackedArc>,
    cells: Vec<CellId>,
}

impl CellComplex {
    /// The rules that allow to kill a pair of cells.
    ///
    /// # Errors
    /// [`Infeasible`], as [`kill`](Self::kill).
    pub fn kinds(&self, low: CellId, high: CellId) -> Result<impl Iterator<Item = OperatorKind> + use<>, Infeasible> {
        self.pair(low, high)?;
        Ok(kinds(self.num_boundary(high) - 1, self.num_coboundary(low) - 1))
    }

    /// KiC(i+1)C: kills an i-cell and an (i+1)-cell where one of the rules of mcc-2012, 4.1 and 4.2, allows it, and returns what
    /// makes them again. The homology of the complex stays what it is.
    ///
    /// Cost: a search, and a move of what follows, in the list of every neighbour of the two cells.
    ///
    /// # Errors
    /// [`Infeasible`], which says what rule is broken; nothing is changed then.
    pub fn kill(&mut self, low: CellId, high: CellId) -> Result<Refinement, Infeasible> {
        let mut refinement = Refinement::default();
        self.kill_into(low, high, &mut refinement)?;
        Ok(refinement)
    }

    /// [`kill`](Self::kill), into the memory of another refinement.
    ///
    /// # Errors
    /// As there; `refinement` is then unspecified.
    pub fn kill_into(&mut self, low: CellId, high: CellId, refinement: &mut Refinement) -> Result<(), Infeasible> {
        if self.kinds(low, high)?.next().is_none() {
            let (below, above) = (self.num_boundary(high) - 1, self.num_coboundary(low) - 1);
            return Err(Infeasible::Neighbours { low, high, below, above });
        }
        self.cancel_into(low, high, refinement)
    }

    /// Cancels a pair as [`kill`](Self::kill) does, however many others there are on both sides.
    ///
    /// # Errors
    /// [`Infeasible`], but for [`Infeasible::Neighbours`]; nothing is changed then.
    pub fn cancel(&mut self, low: CellId, high: CellId) -> Result<Refinement, Infeasible> {
        let mut refinement = Refinement::default();
        self.cancel_into(low, high, &mut refinement)?;
        Ok(refinement)
    }

    /// The dimension of the lower cell of a pair, and the sign, if it appears once.
    fn pair(&self, low: CellId, high: CellId) -> Result<(Dim, i32), Infeasible> {
        let dim = self.dim_of(low).ok_or(Infeasible::NoSuchCell(low))?;
        let high_dim = self.dim_of(high).ok_or(Infeasible::NoSuchCell(high))?;
        let Incidence { multiplicity, sign } = self.incidence(low, high);
        match multiplicity {
            _ if high_dim != dim + 1 => Err(Infeasible::NotIncident { low, high }),
            0 => Err(Infeasible::NotIncident { low, high }),
            1 => Ok((dim, sign)),
            _ => Err(Infeasible::Multiplicity { low, high, multiplicity }),
        }
    }

    fn cancel_into(&mut self, low: CellId, high: CellId, refinement: &mut Refinement) -> Result<(), Infeasible> {
        let (dim, sign) = self.pair(low, high)?;
        refinement.reset(low, high, dim, sign);
        refinement.extend(0, self.arcs(low, Side::Boundary));
        refinement.extend(1, self.arcs(high, Side::Boundary).filter(|arc| arc.cell != low));
        refinement.extend(2, self.arcs(low, Side::Coboundary).filter(|arc| arc.cell != high));
        refinement.extend(3, self.arcs(high, Side::Coboundary));
        let mut scratch = std::mem::take(&mut self.scratch);
        let planned = self.plan_kill(refinement, &mut scratch.plan);
        if planned.is_ok() {
            self.join(refinement, &mut scratch);
            self.counts[dim] -= 1;
            self.counts[dim + 1] -= 1;
        }
        self.scratch = scratch;
        planned
    }

    /// Finds the new incidences, and makes room for them.
    fn plan_kill(&mut self, pair: &Refinement, plan: &mut Vec<(Incidence, bool)>) -> Result<(), Infeasible> {
        let too_large = Infeasible::TooLarge { low: pair.low, high: pair.high };
        plan.clear();
        for r in pair.above_low() {
            let boundary = self.list(r.cell, Side::Boundary);
            for s in pair.below_high() {
                let at = find(boundary, s.cell);
                let before = at.map_or(Incidence::NONE, |at| self.incidence_of(s.cell, r.cell, boundary[at]));
                let after = before.joined(r.incidence, s.incidence, pair.sign).ok_or(too_large)?;
                plan.push((after, at.is_some()));
            }
        }
        // Each neighbour loses an arc before it gets new ones.
        let width = pair.below_high().len();
        if width <= 1 && pair.above_low().len() <= 1 {
            return Ok(());
        }
        let num_new = |entries: &mut dyn Iterator<Item = &(Incidence, bool)>| entries.filter(|entry| !entry.1).count();
        let of_r = |row: usize, _: &Arc| num_new(&mut plan[row * width..][..width].iter()).saturating_sub(1);
        let of_s = |column: usize, _: &Arc| num_new(&mut column_of(plan, column, width)).saturating_sub(1);
        let rows = if width > 1 { pair.above_low() } else { &[] };
        let columns = if pair.above_low().len() > 1 { pair.below_high() } else { &[] };
        let wanted = [(rows, Side::Boundary, &of_r as &dyn Fn(usize, &Arc) -> usize)];
        let wanted = wanted.into_iter().chain([(columns, Side::Coboundary, &of_s as _)]);
        self.reserve_all(wanted).then_some(()).ok_or(too_large)
    }

    /// Makes room in lists of cells for as many more arcs as the functions say; whether there is room.
    pub(super) fn reserve_all<'w>(
        &mut self,
        wanted: impl Iterator<Item = (&'w [Arc], Side, &'w dyn Fn(usize, &Arc) -> usize)> + Clone,
    ) -> bool {
        let mut words = 0;
        for (arcs, side, more) in wanted.clone() {
            for (number, arc) in arcs.iter().enumerate() {
                let header = self.cells[arc.cell.index()];
                let more = more(number, arc);
                if header.slots(side) + more > side.longest() {
                    return false;
                }
                words += header.words_to_reserve(more);
            }
        }
        if words == 0 {
            return true;
        }
        if !self.arena.has_room(words) {
            return false;
        }
        for (arcs, _, more) in wanted {
            for (number, arc) in arcs.iter().enumerate() {
                self.cells[arc.cell.index()].reserve(more(number, arc), &mut self.arena);
            }
        }
        true
    }

    /// Takes the pair away, and gives its neighbours their new incidences, by the plan.
    fn join(&mut self, pair: &Refinement, scratch: &mut Scratch) {
        let (low, high) = (pair.low, pair.high);
        let (below, above) = (pair.below_high(), pair.above_low());
        let Scratch { plan, packed, .. } = scratch;
        for (number, r) in above.iter().enumerate() {
            packed.clear();
            for (s, &(incidence, existed)) in below.iter().zip(&plan[number * below.len()..]) {
                let arc = PackedArc::new(Arc { cell: s.cell, incidence });
                if existed {
                    self.set_incidence(s.cell, r.cell, incidence);
                } else {
                    packed.push(arc);
                    if arc.is_elsewhere() {
                        self.elsewhere.insert((s.cell, r.cell), incidence);
                    }
                }
            }
            self.cells[r.cell.index()].exchange(Side::Boundary, low, packed, &mut self.arena);
        }
        for (column, s) in below.iter().enumerate() {
            packed.clear();
            let entries = column_of(plan, column, below.len());
            let new = above.iter().zip(entries).filter(|(_, entry)| !entry.1);
            packed.extend(new.map(|(r, &(incidence, _))| PackedArc::new(Arc { cell: r.cell, incidence })));
            self.cells[s.cell.index()].exchange(Side::Coboundary, high, packed, &mut self.arena);
        }
        let Self { cells, arena, .. } = self;
        pair.below_low().iter().for_each(|arc| cells[arc.cell.index()].remove(Side::Coboundary, low, arena));
        pair.above_high().iter().for_each(|arc| cells[arc.cell.index()].remove(Side::Boundary, high, arena));
        for cell in [low, high] {
            cells[cell.index()].release(arena);
            cells[cell.index()] = Header::VACANT;
        }
        if !self.elsewhere.is_empty() {
            for (arcs, key) in pair.keys() {
                arcs.iter().for_each(|arc| _ = self.elsewhere.remove(&key(arc.cell)));
            }
        }
    }

    /// Changes the incidence of two cells that are incident.
    pub(super) fn set_incidence(&mut self, low: CellId, high: CellId, incidence: Incidence) {
        let mut was_elsewhere = false;
        for (cell, side, other) in [(high, Side::Boundary, low), (low, Side::Coboundary, high)] {
            let list = self.cells[cell.index()].list_mut(side, &mut self.arena);
            if let Some(at) = find(list, other) {
                was_elsewhere = list[at].is_elsewhere();
                list[at] = PackedArc::new(Arc { cell: other, incidence });
            }
        }
        if PackedArc::new(Arc { cell: low, incidence }).is_elsewhere() {
            self.elsewhere.insert((low, high), incidence);
        } else if was_elsewhere {
            self.elsewhere.remove(&(low, high));
        }
    }
}

/// The entries for one s in a plan.
fn column_of(plan: &[(Incidence, bool)], column: usize, width: usize) -> impl Iterator<Item = &(Incidence, bool)> {
    plan.get(column..).unwrap_or_default().iter().step_by(width)
}

/// What stands in the table of incidences for a cell beside another one.
type Key = (CellId, CellId);

impl Refinement {
    /// The four lists, each with the key of an arc in the table of incidences.
    fn keys(&self) -> [(&[Arc], impl Fn(CellId) -> Key + use<>); 4] {
        let key = |cell: CellId, is_low: bool| move |other: CellId| if is_low { (cell, other) } else { (other, cell) };
        [
            (self.below_low(), key(self.low, false)),
            (self.below_high(), key(self.high, false)),
            (self.above_low(), key(self.low, true)),
            (self.above_high(), key(self.high, true)),
        ]
    }
}

impl CellComplex {
    /// MiC(i+1)C: makes a pair of cells, the exact inverse of the operator that killed it. Lists, numbers and incidences are as
    /// they would be if that had not been done.
    ///
    /// A pair that never was there can be made too: as a refinement with the numbers of vacant cells, or of the next ones.
    ///
    /// Cost: as [`kill`](Self::kill).
    ///
    /// # Errors
    /// [`Infeasible`]; nothing is changed then.
    pub fn make(&mut self, refinement: &Refinement) -> Result<(), Infeasible> {
        let mut scratch = std::mem::take(&mut self.scratch);
        let planned = self.plan_make(refinement, &mut scratch.plan);
        if planned.is_ok() {
            self.unjoin(refinement, &mut scratch);
            self.unpart(refinement, &mut scratch);
            let dim = refinement.dim;
            if self.counts.len() < dim + 2 {
                self.counts.resize(dim + 2, 0);
            }
            self.counts[dim] += 1;
            self.counts[dim + 1] += 1;
        }
        self.scratch = scratch;
        planned
    }

    /// Checks a refinement, finds what is left of the incidences, and makes room.
    fn plan_make(&mut self, pair: &Refinement, plan: &mut Vec<(Incidence, bool)>) -> Result<(), Infeasible> {
        let (low, high) = (pair.low, pair.high);
        for cell in [low, high] {
            let next = self.num_ids() + usize::from(cell == low.max(high));
            if self.contains(cell) || cell.index() > next || low == high || pair.dim >= MAX_DIM || pair.sign.abs() != 1
            {
                return Err(Infeasible::CannotMake(cell));
            }
        }
        let lists = [pair.below_low(), pair.below_high(), pair.above_low(), pair.above_high()];
        for (place, arcs) in lists.into_iter().enumerate() {
            self.check_joined((pair.dim + place).checked_sub(1), arcs)?;
        }
        plan.clear();
        for r in pair.above_low() {
            for s in pair.below_high() {
                let before = self.incidence(s.cell, r.cell);
                let too_few = Infeasible::TooFew { low: s.cell, high: r.cell };
                let after = before.parted(r.incidence, s.incidence, pair.sign).ok_or(too_few)?;
                plan.push((after, after.multiplicity > 0));
            }
        }
        let one = &|_: usize, _: &Arc| 1_usize;
        let wanted = lists.into_iter().zip([Side::Coboundary, Side::Coboundary, Side::Boundary, Side::Boundary]);
        let own = 4 * (pair.arcs.len() + 4);
        let fits = self.arena.has_room(own)
            && self.reserve_all(wanted.map(|(arcs, side)| (arcs, side, one as &dyn Fn(usize, &Arc) -> usize)))
            && self.arena.has_room(own);
        fits.then_some(()).ok_or(Infeasible::TooLarge { low, high })
    }

    /// Whether a new cell can be joined to these, which should be of a dimension and in order.
    pub(super) fn check_joined(&self, dim: Option<Dim>, arcs: &[Arc]) -> Result<(), Infeasible> {
        let mut before = None;
        for &Arc { cell, incidence } in arcs {
            let is_joined = incidence.multiplicity > 0 && incidence.is_consistent();
            if dim.is_none() || self.dim_of(cell) != dim || before.replace(cell) >= Some(cell) || !is_joined {
                return Err(Infeasible::CannotJoin(cell));
            }
        }
        Ok(())
    }

    /// Takes the incidences that come from the pair from its neighbours, by the plan.
    fn unjoin(&mut self, pair: &Refinement, scratch: &mut Scratch) {
        let (below, above) = (pair.below_high(), pair.above_low());
        let Scratch { plan, cells, .. } = scratch;
        for (r, row) in above.iter().zip(plan.chunks(below.len().max(1))) {
            cells.clear();
            for (s, &(incidence, remains)) in below.iter().zip(row) {
                if remains {
                    self.set_incidence(s.cell, r.cell, incidence);
                } else {
                    cells.push(s.cell);
                    if !self.elsewhere.is_empty() {
                        self.elsewhere.remove(&(s.cell, r.cell));
                    }
                }
            }
            self.cells[r.cell.index()].remove_all(Side::Boundary, cells, &mut self.arena);
        }
        for (column, s) in below.iter().enumerate() {
            cells.clear();
            let entries = column_of(plan, column, below.len());
            cells.extend(above.iter().zip(entries).filter(|(_, entry)| !entry.1).map(|(r, _)| r.cell));
            self.cells[s.cell.index()].remove_all(Side::Coboundary, cells, &mut self.arena);
        }
    }

    /// Puts the pair there, and on the lists of its neighbours.
    fn unpart(&mut self, pair: &Refinement, scratch: &mut Scratch) {
        let (low, high) = (pair.low, pair.high);
        let needed = low.max(high).index() + 1;
        if self.cells.len() < needed {
            self.cells.resize(needed, Header::VACANT);
        }
        let own = Incidence::once(pair.sign);
        let lists = [
            (low, pair.dim, pair.below_low(), None, pair.above_low(), Some(high)),
            (high, pair.dim + 1, pair.below_high(), Some(low), pair.above_high(), None),
        ];
        let Self { cells, arena, elsewhere, .. } = self;
        for (cell, dim, below, own_below, above, own_above) in lists {
            let mut header = Header::new(dim, below.len() + above.len() + 1, arena);
            for (side, arcs, own_cell) in [(Side::Boundary, below, own_below), (Side::Coboundary, above, own_above)] {
                let packed = &mut scratch.packed;
                packed.clear();
                packed.extend(arcs.iter().copied().map(PackedArc::new));
                if let Some(own_cell) = own_cell {
                    let arc = PackedArc::new(Arc { cell: own_cell, incidence: own });
                    packed.insert(packed.partition_point(|other| other.cell() < own_cell), arc);
                }
                header.reserve(packed.len(), arena);
                header.insert(side, packed, arena);
            }
            cells[cell.index()] = header;
        }
        for ((arcs, key), is_low) in pair.keys().into_iter().zip([true, false, true, false]) {
            let cell = if is_low { low } else { high };
            for &Arc { cell: neighbour, incidence } in arcs {
                let back = PackedArc::new(Arc { cell, incidence });
                if back.is_elsewhere() {
                    elsewhere.insert(key(neighbour), incidence);
                }
                let side = if key(neighbour).0 == neighbour { Side::Coboundary } else { Side::Boundary };
                cells[neighbour.index()].insert(side, &[back], arena);
            }
        }
    }
}
