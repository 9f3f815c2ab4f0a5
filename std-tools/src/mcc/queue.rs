//! The queue of a simplification: a radix heap (Ahuja, Mehlhorn, Orlin and Tarjan, *Faster algorithms for the shortest path
//! problem*, 1990) that takes entries below the least one too.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use sig_core::CellId;

use super::simplify::Precision;
use crate::cells::Instance;

/// A pivot, and when it comes up, as one number: the bits of its cost, which is not negative, so that they compare as it does,
/// as far as the precision tells them apart; a rank among those of the same cost; the cell, and the instance in the lowest bit.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) struct Entry(u64);

/// Where the rank begins: above the 29 bits of a cell and the instance.
const RANK: u32 = 30;

impl Entry {
    /// The greatest rank.
    pub(super) const LAST: u32 = 3;

    #[inline]
    pub(super) fn new(cost: f32, precision: Precision, rank: u32, pivot: CellId, instance: Instance) -> Self {
        // −0 is 0.
        let dropped = precision.dropped_bits();
        let cost = u64::from((cost + 0.0).to_bits() >> dropped << dropped);
        Self(cost << 32 | u64::from(rank << RANK | pivot.number() << 1 | u32::from(instance == Instance::Second)))
    }

    /// What decides before the cell.
    #[inline]
    pub(super) const fn class(self) -> u64 {
        self.0 >> RANK
    }

    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "the lower half")]
    pub(super) const fn pivot(self) -> (CellId, Instance) {
        let word = self.0 as u32 & ((1 << RANK) - 1);
        (CellId::new(word >> 1), if word & 1 == 1 { Instance::Second } else { Instance::First })
    }
}

/// So many entries are sorted rather than parted further.
const FEW: usize = 1 << 12;

/// Entries, the least first; equal ones come as often as they were pushed.
pub(super) struct Queue {
    /// Entries up to `limit`, the least at the end, and those that came since.
    sorted: Vec<Entry>,
    late: BinaryHeap<Reverse<Entry>>,
    limit: u64,
    /// Those beyond, by the highest bit in which they differ from `limit`.
    parts: [Vec<Entry>; 64],
    len: usize,
}

impl Queue {
    pub(super) const fn new() -> Self {
        let parts = [const { Vec::new() }; 64];
        Self { sorted: Vec::new(), late: BinaryHeap::new(), limit: 0, parts, len: 0 }
    }

    /// The number of entries.
    pub(super) const fn len(&self) -> usize {
        self.len
    }

    #[inline]
    pub(super) fn push(&mut self, entry: Entry) {
        self.len += 1;
        if entry.0 <= self.limit {
            self.late.push(Reverse(entry));
        } else {
            self.part(entry);
        }
    }

    #[inline]
    fn part(&mut self, entry: Entry) {
        self.parts[(entry.0 ^ self.limit).ilog2() as usize].push(entry);
    }

    #[inline]
    pub(super) fn pop(&mut self) -> Option<Entry> {
        loop {
            let late = self.late.peek().map(|&Reverse(entry)| entry);
            let next = match (self.sorted.last().copied(), late) {
                (Some(first), Some(late)) if late < first => self.late.pop().map(|Reverse(entry)| entry),
                (Some(_), _) => self.sorted.pop(),
                (None, Some(_)) => self.late.pop().map(|Reverse(entry)| entry),
                (None, None) => {
                    if !self.refill() {
                        return None;
                    }
                    continue;
                }
            };
            self.len -= 1;
            return next;
        }
    }

    /// Sorts the next entries, the others being few; false if there are none.
    fn refill(&mut self) -> bool {
        let Some(least) = self.parts.iter().position(|part| !part.is_empty()) else { return false };
        if self.parts[least].len() <= FEW {
            std::mem::swap(&mut self.sorted, &mut self.parts[least]);
            self.sorted.sort_unstable_by(|a, b| b.cmp(a));
            // The greatest that would have been in this part.
            self.limit = (self.limit >> least | 1) << least | ((1 << least) - 1);
            return true;
        }
        let part = std::mem::take(&mut self.parts[least]);
        self.limit = part.iter().min().map_or(self.limit, |entry| entry.0);
        for entry in part {
            if entry.0 == self.limit {
                self.sorted.push(entry);
            } else {
                self.part(entry);
            }
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::super::simplify::Precision;
    use super::{Entry, FEW, Queue};
    use crate::cells::Instance;
    use proptest::prelude::*;
    use sig_core::CellId;
    use std::cmp::Reverse;
    use std::collections::BinaryHeap;

    proptest! {
        /// As a heap, whatever comes when.
        #[test]
        fn the_least_first(steps in prop::collection::vec((0_u32..40, any::<u16>(), 0_u8..4), 1..200), at_once in 0_usize..3) {
            let (mut queue, mut model) = (Queue::new(), BinaryHeap::new());
            let mut number = 0;
            for (cost, pivot, what) in steps {
                for _ in 0..if what == 0 { at_once * FEW } else { usize::from(what > 1) } {
                    number = (number + 7919) % 65_536;
                    let pivot = CellId::new(u32::from(pivot) ^ number);
                    let entry = Entry::new(cost as f32 / 3.0, Precision::Exact, 0, pivot, Instance::Second);
                    queue.push(entry);
                    model.push(Reverse(entry));
                }
                for _ in 0..if what == 1 { 1 + 3 * usize::from(pivot) / 8 } else { 1 } {
                    prop_assert_eq!(queue.pop(), model.pop().map(|Reverse(entry)| entry));
                    prop_assert_eq!(queue.len(), model.len());
                }
            }
            while let Some(Reverse(entry)) = model.pop() {
                prop_assert_eq!(queue.pop(), Some(entry));
            }
            prop_assert_eq!(queue.pop(), None);
        }
    }
}
