//! The two lists of a cell: its boundary and its co-boundary, each by increasing cell, in one block.
//!
//! The boundary stands at the start of the block, the co-boundary at its end, and what is free between them: either may
//! grow without moving the other.

use sig_core::{CellId, Dim, PackedArc};

use super::arena::{Arena, capacity, class_for};

/// Where the lists of a cell lie: twelve bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Header {
    start: u32,
    /// The length of the boundary, and the class of the block above it.
    down: u32,
    /// The length of the co-boundary, and the dimension of the cell above it.
    up: u32,
}

const DOWN_BITS: u32 = 25;
const UP_BITS: u32 = 27;

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

    /// A cell with a block for so many arcs, and none in it.
    pub(super) fn new(dim: Dim, arcs: usize, arena: &mut Arena) -> Self {
        let class = class_for(arcs);
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
    pub(super) const fn len(self, side: Side) -> usize {
        match side {
            Side::Boundary => (self.down & ((1 << DOWN_BITS) - 1)) as usize,
            Side::Coboundary => (self.up & ((1 << UP_BITS) - 1)) as usize,
        }
    }

    #[inline]
    const fn class(self) -> usize {
        (self.down >> DOWN_BITS) as usize
    }

    #[inline]
    const fn range(self, side: Side) -> core::ops::Range<usize> {
        let start = self.start as usize;
        match side {
            Side::Boundary => start..start + self.len(side),
            Side::Coboundary => {
                let end = start + capacity(self.class());
                end - self.len(side)..end
            }
        }
    }

    #[inline]
    pub(super) fn list(self, side: Side, arena: &Arena) -> &[PackedArc] {
        &arena.words()[self.range(side)]
    }

    #[inline]
    pub(super) fn list_mut(self, side: Side, arena: &mut Arena) -> &mut [PackedArc] {
        &mut arena.words_mut()[self.range(side)]
    }

    /// Gives the block back.
    pub(super) fn release(self, arena: &mut Arena) {
        arena.release(self.start, self.class());
    }

    /// The words that [`reserve`](Self::reserve) allocates for so many more arcs.
    pub(super) fn words_to_reserve(self, more: usize) -> usize {
        let arcs = self.len(Side::Boundary) + self.len(Side::Coboundary) + more;
        if arcs <= capacity(self.class()) { 0 } else { capacity(class_for(arcs + arcs / 8)) }
    }

    /// Makes room for so many more arcs.
    pub(super) fn reserve(&mut self, more: usize, arena: &mut Arena) {
        let words = self.words_to_reserve(more);
        if words == 0 {
            return;
        }
        let class = class_for(words);
        let start = arena.allocate(class);
        let down = self.range(Side::Boundary);
        let up = self.range(Side::Coboundary);
        let end = start as usize + capacity(class);
        arena.words_mut().copy_within(down, start as usize);
        let up_len = up.len();
        arena.words_mut().copy_within(up, end - up_len);
        self.release(arena);
        self.start = start;
        self.down = self.down & ((1 << DOWN_BITS) - 1) | bits(class) << DOWN_BITS;
    }

    /// While a complex is laid out: adds the last arc of a list, right after what is in the block. Boundaries come first;
    /// at the end, [`settle`](Self::settle) moves the co-boundary to its place.
    #[inline]
    pub(super) fn lay(&mut self, side: Side, arc: PackedArc, arena: &mut Arena) {
        let at = self.start as usize + self.len(Side::Boundary) + self.len(Side::Coboundary);
        arena.words_mut()[at] = arc;
        match side {
            Side::Boundary => self.down += 1,
            Side::Coboundary => self.up += 1,
        }
    }

    /// Ends the laying out.
    #[inline]
    pub(super) fn settle(self, arena: &mut Arena) {
        let (laid, at) = (self.range(Side::Boundary).end, self.range(Side::Coboundary));
        if at.start > laid {
            arena.words_mut().copy_within(laid..laid + at.len(), at.start);
        }
    }

    /// Adds arcs, by increasing cell, to cells that are not in the list; there is room for them.
    #[inline]
    pub(super) fn insert(&mut self, side: Side, new: &[PackedArc], arena: &mut Arena) {
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

    /// Removes the arcs to cells, increasing, that are in the list.
    #[inline]
    pub(super) fn remove_all(&mut self, side: Side, cells: &[CellId], arena: &mut Arena) {
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
fn lower_bound(list: &[PackedArc], cell: CellId) -> usize {
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
    use super::{Arena, Header, Side};
    use proptest::prelude::*;
    use sig_core::{Arc, CellId, Incidence, PackedArc};
    use std::collections::BTreeSet;

    fn arc(number: u32) -> PackedArc {
        PackedArc::new(Arc { cell: CellId::new(number), incidence: Incidence::once(1) })
    }

    proptest! {
        /// Both lists of a cell behave as two sets.
        #[test]
        fn lists_are_sets(steps in proptest::collection::vec((any::<bool>(), any::<bool>(), proptest::collection::btree_set(0_u32..60, 0..8)), 0..40)) {
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
                    let list: Vec<u32> = header.list(side, &arena).iter().map(|arc| arc.cell().number()).collect();
                    prop_assert_eq!(list, set.iter().copied().collect::<Vec<_>>());
                }
            }
        }
    }
}
