//! The two lists of a cell: its boundary and its co-boundary, each by increasing cell, in one block.
//!
//! The boundary stands at the start of the block, the co-boundary at its end, and what is free between them: either may
//! grow without moving the other. A list of more than [`LONG`] slots may have gaps among them (`gaps`), and the number of its
//! arcs stands in a word of its own at that end of the block.

use sig_core::{CellId, Dim, PackedArc};

use super::arena::{Arena, capacity, class_for};
use super::gaps;

/// Where the lists of a cell lie: twelve bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Header {
    start: u32,
    /// The slots of the boundary, and the class of the block above them.
    down: u32,
    /// The slots of the co-boundary, and the dimension of the cell above them.
    up: u32,
}

const DOWN_BITS: u32 = 25;
const UP_BITS: u32 = 27;

/// The longest list that has no gaps.
const LONG: usize = 256;

/// The words for so many arcs, with those that count them.
#[inline]
const fn words_for(arcs: usize) -> usize {
    if arcs <= LONG { arcs } else { arcs + 2 }
}

/// Which list.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Side {
    Boundary,
    Coboundary,
}

impl Side {
    /// The longest list that is kept.
    pub(super) const fn longest(self) -> usize {
        match self {
            Self::Boundary => (1 << DOWN_BITS) - 1,
            Self::Coboundary => (1 << UP_BITS) - 1,
        }
    }
}

impl Header {
    /// No cell.
    pub(super) const VACANT: Self = Self { start: u32::MAX, down: 0, up: 0 };

    /// The words of the block of a cell with so many arcs.
    pub(super) const fn words_of(arcs: usize) -> usize {
        capacity(class_for(words_for(arcs)))
    }

    /// A cell with a block for so many arcs, and none in it.
    pub(super) fn new(dim: Dim, arcs: usize, arena: &mut Arena) -> Self {
        let class = class_for(words_for(arcs));
        let start = arena.allocate(class);
        Self { start, down: bits(class) << DOWN_BITS, up: bits(dim) << UP_BITS }
    }

    #[inline]
    pub(super) const fn is_vacant(self) -> bool {
        self.start == u32::MAX
    }

    #[inline]
    pub(super) const fn dim(self) -> Dim {
        (self.up >> UP_BITS) as usize
    }

    #[inline]
    pub(super) const fn slots(self, side: Side) -> usize {
        match side {
            Side::Boundary => (self.down & ((1 << DOWN_BITS) - 1)) as usize,
            Side::Coboundary => (self.up & ((1 << UP_BITS) - 1)) as usize,
        }
    }

    /// The number of arcs in a list.
    #[inline]
    pub(super) fn len(self, side: Side, arena: &Arena) -> usize {
        let slots = self.slots(side);
        if slots <= LONG { slots } else { arena.words()[self.place_of_len(side)].word() as usize }
    }

    /// The word that counts the arcs of a long list.
    const fn place_of_len(self, side: Side) -> usize {
        let start = self.start as usize;
        match side {
            Side::Boundary => start,
            Side::Coboundary => start + capacity(self.class()) - 1,
        }
    }

    fn set_len(self, side: Side, len: usize, arena: &mut Arena) {
        arena.words_mut()[self.place_of_len(side)] = PackedArc::from_word(bits(len));
    }

    const fn set_slots(&mut self, side: Side, slots: u32) {
        let (field, width) = match side {
            Side::Boundary => (&mut self.down, DOWN_BITS),
            Side::Coboundary => (&mut self.up, UP_BITS),
        };
        *field = *field >> width << width | slots;
    }

    #[inline]
    const fn class(self) -> usize {
        (self.down >> DOWN_BITS) as usize
    }

    #[inline]
    const fn range(self, side: Side) -> core::ops::Range<usize> {
        let (start, slots) = (self.start as usize, self.slots(side));
        let count = (slots > LONG) as usize;
        match side {
            Side::Boundary => start + count..start + count + slots,
            Side::Coboundary => {
                let end = start + capacity(self.class()) - count;
                end - slots..end
            }
        }
    }

    /// The slots of a list: the arcs, and gaps if it is long.
    #[inline]
    pub(super) fn list(self, side: Side, arena: &Arena) -> &[PackedArc] {
        &arena.words()[self.range(side)]
    }

    /// The same, to change an incidence.
    #[inline]
    pub(super) fn list_mut(self, side: Side, arena: &mut Arena) -> &mut [PackedArc] {
        &mut arena.words_mut()[self.range(side)]
    }

    /// Gives the block back.
    pub(super) fn release(self, arena: &mut Arena) {
        arena.release(self.start, self.class());
    }

    /// The words that [`reserve`](Self::reserve) allocates for so many more arcs.
    #[inline]
    pub(super) const fn words_to_reserve(self, more: usize) -> usize {
        let arcs = self.slots(Side::Boundary) + self.slots(Side::Coboundary) + more;
        if words_for(arcs) <= capacity(self.class()) { 0 } else { Self::words_of(arcs + arcs / 8) }
    }

    /// Makes room for so many more arcs.
    #[inline]
    pub(super) fn reserve(&mut self, more: usize, arena: &mut Arena) {
        let words = self.words_to_reserve(more);
        if words > 0 {
            self.move_to(class_for(words), arena);
        }
    }

    /// Moves the lists to a larger block.
    fn move_to(&mut self, class: usize, arena: &mut Arena) {
        let start = arena.allocate(class);
        let old = *self;
        self.start = start;
        self.down = self.down & ((1 << DOWN_BITS) - 1) | bits(class) << DOWN_BITS;
        for side in [Side::Boundary, Side::Coboundary] {
            arena.words_mut().copy_within(old.range(side), self.range(side).start);
            if old.slots(side) > LONG {
                let len = old.len(side, arena);
                self.set_len(side, len, arena);
            }
        }
        old.release(arena);
    }

    /// While a complex is laid out: adds the last arc of a list, right after what is in the block. Boundaries come first;
    /// at the end, [`settle`](Self::settle) moves the co-boundary to its place.
    #[inline]
    pub(super) fn lay(&mut self, side: Side, arc: PackedArc, arena: &mut Arena) {
        let at = self.start as usize + self.slots(Side::Boundary) + self.slots(Side::Coboundary);
        arena.words_mut()[at] = arc;
        match side {
            Side::Boundary => self.down += 1,
            Side::Coboundary => self.up += 1,
        }
    }

    /// Ends the laying out.
    #[inline]
    pub(super) fn settle(self, arena: &mut Arena) {
        let laid = self.start as usize;
        let middle = laid + self.slots(Side::Boundary);
        for (side, from) in [(Side::Coboundary, middle), (Side::Boundary, laid)] {
            let (slots, to) = (self.slots(side), self.range(side).start);
            if from != to {
                arena.words_mut().copy_within(from..from + slots, to);
            }
            if slots > LONG {
                self.set_len(side, slots, arena);
            }
        }
    }

    /// Lays a list out anew, over as many slots as there is room for.
    fn rebuild(&mut self, side: Side, arcs: &[PackedArc], arena: &mut Arena) {
        let other = if side == Side::Boundary { Side::Coboundary } else { Side::Boundary };
        let other = self.slots(other) + usize::from(self.slots(other) > LONG);
        let slots = match arcs.len() {
            few @ ..=LONG => few,
            many => gaps::slots_for(many).min(capacity(self.class()) - other - 1).min(side.longest()),
        };
        self.set_slots(side, bits(slots));
        gaps::spread(arcs, self.list_mut(side, arena));
        if slots > LONG {
            self.set_len(side, arcs.len(), arena);
        }
    }

    /// Adds arcs to a list that is long or becomes so.
    #[cold]
    fn insert_long(&mut self, side: Side, new: &[PackedArc], arena: &mut Arena) {
        let mut placed = 0;
        if self.slots(side) > LONG {
            let slots = self.list_mut(side, arena);
            placed = new.iter().take_while(|&&arc| gaps::insert(slots, arc)).count();
            let len = self.len(side, arena) + placed;
            self.set_len(side, len, arena);
        }
        if placed < new.len() {
            let mut arcs: Vec<PackedArc> = gaps::arcs(self.list(side, arena)).collect();
            arcs.extend(&new[placed..]);
            // Two runs: a merge.
            arcs.sort();
            // Room for gaps, if there is any.
            let other = self.slots(Side::Boundary) + self.slots(Side::Coboundary) - self.slots(side);
            let words = Self::words_of(gaps::slots_for(gaps::slots_for(arcs.len())) + other);
            if gaps::slots_for(arcs.len()) + other + 2 > capacity(self.class()) && arena.has_room(words) {
                self.move_to(class_for(words), arena);
            }
            self.rebuild(side, &arcs, arena);
        }
    }

    /// Removes an arc from a long list.
    #[cold]
    fn remove_long(&mut self, side: Side, cell: CellId, arena: &mut Arena) {
        gaps::remove(self.list_mut(side, arena), cell);
        let len = self.len(side, arena) - 1;
        self.set_len(side, len, arena);
        if 2 * len < self.slots(side) {
            let arcs: Vec<PackedArc> = gaps::arcs(self.list(side, arena)).collect();
            self.rebuild(side, &arcs, arena);
        }
    }

    /// Adds arcs, by increasing cell, to cells that are not in the list; there is room for them.
    #[inline]
    pub(super) fn insert(&mut self, side: Side, new: &[PackedArc], arena: &mut Arena) {
        if self.slots(side) + new.len() > LONG {
            return self.insert_long(side, new, arena);
        }
        let range = self.range(side);
        let words = arena.words_mut();
        match side {
            Side::Boundary => {
                // From the end: what comes after a new arc moves up to make room for it and those before it.
                let mut read = range.end;
                for (before, &arc) in new.iter().enumerate().rev() {
                    let at = range.start + lower_bound(&words[range.start..read], arc.cell());
                    words.copy_within(at..read, at + before + 1);
                    words[at + before] = arc;
                    read = at;
                }
                self.down += bits(new.len());
            }
            Side::Coboundary => {
                let mut read = range.start;
                for (placed, &arc) in new.iter().enumerate() {
                    let at = read + lower_bound(&words[read..range.end], arc.cell());
                    let shift = new.len() - placed;
                    words.copy_within(read..at, read - shift);
                    words[at - shift] = arc;
                    read = at;
                }
                self.up += bits(new.len());
            }
        }
    }

    /// Removes the arc to a cell that is in the list.
    #[inline]
    pub(super) fn remove(&mut self, side: Side, cell: CellId, arena: &mut Arena) {
        if self.slots(side) > LONG {
            return self.remove_long(side, cell, arena);
        }
        let range = self.range(side);
        let words = arena.words_mut();
        let at = range.start + lower_bound(&words[range.clone()], cell);
        debug_assert!(at < range.end && words[at].cell() == cell);
        match side {
            Side::Boundary => {
                words.copy_within(at + 1..range.end, at);
                self.down -= 1;
            }
            Side::Coboundary => {
                words.copy_within(range.start..at, range.start + 1);
                self.up -= 1;
            }
        }
    }

    /// Removes the arc to a cell that is in the list, and adds others, as [`insert`](Self::insert).
    #[inline]
    pub(super) fn exchange(&mut self, side: Side, cell: CellId, new: &[PackedArc], arena: &mut Arena) {
        let &[arc] = new else {
            self.remove(side, cell, arena);
            return self.insert(side, new, arena);
        };
        if self.slots(side) > LONG {
            self.remove_long(side, cell, arena);
            return self.insert(side, new, arena);
        }
        // One for another: what is between the two moves by one.
        let list = self.list_mut(side, arena);
        let (gone, place) = (lower_bound(list, cell), lower_bound(list, arc.cell()));
        debug_assert!(list[gone].cell() == cell);
        if place > gone {
            list[gone..place].rotate_left(1);
            list[place - 1] = arc;
        } else {
            list[place..=gone].rotate_right(1);
            list[place] = arc;
        }
    }

    /// Removes the arcs to cells, increasing, that are in the list.
    #[inline]
    pub(super) fn remove_all(&mut self, side: Side, cells: &[CellId], arena: &mut Arena) {
        if self.slots(side) > LONG {
            return cells.iter().for_each(|&cell| self.remove(side, cell, arena));
        }
        let range = self.range(side);
        let words = arena.words_mut();
        match side {
            Side::Boundary => {
                let mut read = range.start;
                for (gone, &cell) in cells.iter().enumerate() {
                    let at = read + lower_bound(&words[read..range.end], cell);
                    words.copy_within(read..at, read - gone);
                    read = at + 1;
                }
                words.copy_within(read..range.end, read - cells.len());
                self.down -= bits(cells.len());
            }
            Side::Coboundary => {
                let mut read = range.end;
                for (gone, &cell) in cells.iter().rev().enumerate() {
                    let at = range.start + lower_bound(&words[range.start..read], cell);
                    words.copy_within(at + 1..read, at + 1 + gone);
                    read = at;
                }
                words.copy_within(range.start..read, range.start + cells.len());
                self.up -= bits(cells.len());
            }
        }
    }
}

/// A number that fits the field for which it is meant: the callers check lengths, and classes are few.
#[inline]
fn bits(value: usize) -> u32 {
    crate::build::narrow(value)
}

/// The first place in a list with that cell or a later one.
#[inline]
pub(super) fn lower_bound(list: &[PackedArc], cell: CellId) -> usize {
    if list.len() <= 16 {
        return list.iter().position(|arc| arc.cell() >= cell).unwrap_or(list.len());
    }
    list.partition_point(|arc| arc.cell() < cell)
}

/// Where in a list a cell is.
#[inline]
pub(super) fn find(list: &[PackedArc], cell: CellId) -> Option<usize> {
    let at = lower_bound(list, cell);
    list.get(at).is_some_and(|arc| arc.cell() == cell).then_some(at)
}

#[cfg(test)]
mod tests {
    use super::{Arena, Header, Side, gaps};
    use proptest::prelude::*;
    use proptest::test_runner::TestCaseError;
    use sig_core::{Arc, CellId, Incidence, PackedArc};
    use std::collections::BTreeSet;

    fn arc(number: u32) -> PackedArc {
        PackedArc::new(Arc { cell: CellId::new(number), incidence: Incidence::once(1) })
    }

    proptest! {
        /// Both lists of a cell behave as two sets.
        #[test]
        fn lists_are_sets(steps in proptest::collection::vec((any::<bool>(), any::<bool>(), proptest::collection::btree_set(0_u32..60, 0..8)), 0..40)) {
            behave_as_sets(steps)?;
        }

        /// Long ones too.
        #[test]
        fn long_lists_are_sets(steps in proptest::collection::vec((any::<bool>(), 0_u8..3, 0_u32..3000, 1_u32..9, 0_u32..700), 0..30)) {
            behave_as_sets(steps.into_iter().map(|(up, add, first, step, many)| {
                (up, add > 0, (0..many).map(|number| first + step * number).collect())
            }))?;
        }
    }

    /// The steps: to which list, whether to add or to remove, which cells.
    fn behave_as_sets(steps: impl IntoIterator<Item = (bool, bool, BTreeSet<u32>)>) -> Result<(), TestCaseError> {
        {
            let mut arena = Arena::default();
            let mut header = Header::new(5, 0, &mut arena);
            let mut model = [BTreeSet::new(), BTreeSet::new()];
            for (up, add, cells) in steps {
                let (side, set) = if up { (Side::Coboundary, &mut model[1]) } else { (Side::Boundary, &mut model[0]) };
                let cells: Vec<u32> = cells.into_iter().filter(|cell| set.contains(cell) != add).collect();
                if add {
                    let new: Vec<_> = cells.iter().map(|&cell| arc(cell)).collect();
                    header.reserve(new.len(), &mut arena);
                    header.insert(side, &new, &mut arena);
                    set.extend(cells);
                } else if let [cell] = cells[..] {
                    header.remove(side, CellId::new(cell), &mut arena);
                    set.remove(&cell);
                } else {
                    let gone: Vec<_> = cells.iter().map(|&cell| CellId::new(cell)).collect();
                    header.remove_all(side, &gone, &mut arena);
                    set.retain(|cell| !cells.contains(cell));
                }
                prop_assert_eq!(header.dim(), 5);
                for (side, set) in [Side::Boundary, Side::Coboundary].into_iter().zip(&model) {
                    let list: Vec<u32> = gaps::arcs(header.list(side, &arena)).map(|arc| arc.cell().number()).collect();
                    prop_assert_eq!(header.len(side, &arena), set.len());
                    prop_assert_eq!(list, set.iter().copied().collect::<Vec<_>>());
                }
            }
        }
        Ok(())
    }
}
