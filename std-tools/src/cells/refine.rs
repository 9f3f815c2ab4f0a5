//! Refinements as they stand in a file, applied where they lie: [`CellComplex::make`] without a copy.

use sig_core::mcc::RefinementView;
use sig_core::{Arc, Dim, Incidence, MAX_DIM, PackedArc};

use super::lists::{Header, Side, find};
use super::{CellComplex, Infeasible};

/// The sides of the neighbours on which the cells of a pair come to stand, in the order of the four lists.
const SIDES: [Side; 4] = [Side::Coboundary, Side::Coboundary, Side::Boundary, Side::Boundary];

impl CellComplex {
    /// Makes the pair of a refinement, whose numbers are reserved. `room` is memory that is used again.
    ///
    /// Cost: as [`make`](Self::make), of which it takes two thirds of the time, for it reads the arcs where they lie and has no
    /// plan: on errors it does not leave the complex as it was.
    ///
    /// # Errors
    /// As [`make`](Self::make), but the complex may be changed then, and is of no use.
    pub(crate) fn refine(
        &mut self,
        refinement: &RefinementView<'_>,
        room: &mut Vec<PackedArc>,
    ) -> Result<(), Infeasible> {
        let &RefinementView { low, high, dim, .. } = refinement;
        for cell in [low, high] {
            if self.contains(cell) || cell.index() >= self.cells.len() || dim >= MAX_DIM {
                return Err(Infeasible::CannotMake(cell));
            }
        }
        self.check_neighbours(refinement)?;
        self.part_neighbours(refinement)?;
        self.join_pair(refinement, room);
        if self.counts.len() < dim + 2 {
            self.counts.resize(dim + 2, 0);
        }
        self.counts[dim] += 1;
        self.counts[dim + 1] += 1;
        Ok(())
    }

    /// Checks that the neighbours are there, in order, and may be joined, and that there is room.
    fn check_neighbours(&self, refinement: &RefinementView<'_>) -> Result<(), Infeasible> {
        let mut words = 4 * (refinement.lists.iter().map(ExactSizeIterator::len).sum::<usize>() + 4);
        for ((place, list), side) in refinement.lists.iter().enumerate().zip(SIDES) {
            let dim: Option<Dim> = (refinement.dim + place).checked_sub(1);
            let mut before = None;
            for packed in list.packed() {
                let cell = packed.cell();
                let Some(header) = self.header(cell).filter(|header| Some(header.dim()) == dim) else {
                    return Err(Infeasible::CannotJoin(cell));
                };
                let length = if side == Side::Boundary { self.num_boundary(cell) } else { self.num_coboundary(cell) };
                if before.replace(cell) >= Some(cell) || length >= side.longest() {
                    return Err(Infeasible::CannotJoin(cell));
                }
                words += header.words_to_reserve(1);
            }
            // What has a code can be an incidence.
            if list.packed().any(PackedArc::is_elsewhere) {
                let is_none = |arc: &Arc| arc.incidence.multiplicity == 0 || !arc.incidence.is_consistent();
                if let Some(arc) = list.clone().find(is_none) {
                    return Err(Infeasible::CannotJoin(arc.cell));
                }
            }
        }
        let too_large = Infeasible::TooLarge { low: refinement.low, high: refinement.high };
        self.arena.has_room(words).then_some(()).ok_or(too_large)
    }

    /// Takes from the incidences of the neighbours on either side what goes by way of the pair.
    fn part_neighbours(&mut self, refinement: &RefinementView<'_>) -> Result<(), Infeasible> {
        let [_, below, above, _] = &refinement.lists;
        for r in above.clone() {
            for s in below.clone() {
                let list = self.cells[r.cell.index()].list(Side::Boundary, &self.arena);
                let too_few = Infeasible::TooFew { low: s.cell, high: r.cell };
                let old = find(list, s.cell).map(|at| list[at]).ok_or(too_few)?;
                let rest = self.incidence_of(s.cell, r.cell, old).parted(r.incidence, s.incidence, refinement.sign);
                let rest = rest.ok_or(too_few)?;
                if rest.multiplicity > 0 {
                    self.set_incidence(s.cell, r.cell, rest);
                    continue;
                }
                self.cells[r.cell.index()].remove(Side::Boundary, s.cell, &mut self.arena);
                self.cells[s.cell.index()].remove(Side::Coboundary, r.cell, &mut self.arena);
                if old.is_elsewhere() {
                    self.elsewhere.remove(&(s.cell, r.cell));
                }
            }
        }
        Ok(())
    }

    /// Puts the pair there, and on the lists of its neighbours.
    fn join_pair(&mut self, refinement: &RefinementView<'_>, room: &mut Vec<PackedArc>) {
        let &RefinementView { low, high, dim, sign, .. } = refinement;
        let [below_low, below_high, above_low, above_high] = &refinement.lists;
        let own = |cell| PackedArc::new(Arc { cell, incidence: Incidence::once(sign) });
        let Self { cells, arena, elsewhere, .. } = self;
        for (cell, dim, below, above) in [(low, dim, below_low, above_low), (high, dim + 1, below_high, above_high)] {
            let mut header = Header::new(dim, below.len() + above.len() + 1, arena);
            // Made after its neighbours as a rule, so the other cell of the pair is the last one on its list.
            for (side, list, other) in [(Side::Boundary, below, low), (Side::Coboundary, above, high)] {
                room.clear();
                room.extend(list.packed());
                if other != cell {
                    let place = room.iter().rposition(|arc| arc.cell() < other).map_or(0, |place| place + 1);
                    room.insert(place, own(other));
                }
                header.reserve(room.len(), arena);
                header.insert(side, room, arena);
            }
            cells[cell.index()] = header;
        }
        for (place, (list, side)) in refinement.lists.iter().zip(SIDES).enumerate() {
            let cell = if place % 2 == 0 { low } else { high };
            for neighbour in list.packed() {
                let header = &mut cells[neighbour.cell().index()];
                header.reserve(1, arena);
                header.insert(side, &[neighbour.towards(cell)], arena);
            }
            if list.packed().any(PackedArc::is_elsewhere) {
                for arc in list.clone().filter(|&arc| PackedArc::new(arc).is_elsewhere()) {
                    let key = if place < 2 { (arc.cell, cell) } else { (cell, arc.cell) };
                    elsewhere.insert(key, arc.incidence);
                }
            }
        }
    }
}
