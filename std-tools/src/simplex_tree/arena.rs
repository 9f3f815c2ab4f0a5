//! Where the sibling sets of a simplex tree lie: blocks of rows in a few arrays, without an allocation of their own.
//!
//! A set of `len` siblings with room for `capacity` is a block of rows, the first of which gives the set its handle; the
//! others are its siblings. Each column is an array:
//!
//! ```text
//! row          nodes             beside (with filtration values)   slots (with label lists)
//! set          len, capacity     parent set, parent label          -
//! set + 1 + i  label, child set  value                             place in the list of the label
//! ```
//!
//! So the way down the tree reads the nodes alone, half of the memory, and what else there is of a sibling is where its
//! node is. Without values the parent takes a row of nodes, between the first one and the siblings.
//!
//! Capacities are those of [`capacity`]: exact up to eight siblings, at most a quarter more above, so that the many sets
//! of two or three carry no slack. A set that loses siblings keeps its block until less than a quarter of it is in use.
//! Freed blocks wait in one list for each capacity.
//!
//! A block moves when its capacity changes; its parent and its children are told, which know it by its handle.

use super::SizeError;

/// The handle of no set. As a parent set it stands for the top nodes.
pub(super) const NONE: u32 = 0;

/// The slot of a sibling that is in no list yet.
pub(super) const UNLISTED: u32 = u32::MAX;

/// The least capacity for `len` siblings.
#[inline]
pub(super) const fn capacity(len: usize) -> usize {
    if len <= 8 { len } else { len.next_multiple_of(1 << (usize::BITS - (len - 1).leading_zeros() - 3)) }
}

/// The number of the list of free blocks of a capacity.
fn class_of(capacity: usize) -> usize {
    if capacity <= 8 {
        return capacity;
    }
    let bits = (usize::BITS - (capacity - 1).leading_zeros()) as usize;
    8 + 4 * (bits - 4) + (capacity >> (bits - 3)) - 4
}

/// The label of a sibling, and the set of its children. In the first row of a block: the length and the capacity; of one
/// that is free: the next one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) label: u32,
    pub(super) child: u32,
}

/// Sibling sets in blocks.
#[derive(Clone, Debug)]
pub(super) struct Arena {
    nodes: Vec<Node>,
    /// The bits of values, and parents: the set, and the label in the high half.
    beside: Vec<u64>,
    slots: Vec<u32>,
    /// The first free block of each class.
    free: Vec<u32>,
    filtered: bool,
    listed: bool,
}

impl Arena {
    pub(super) fn new(filtered: bool, listed: bool) -> Self {
        let (nodes, beside, slots) = (Vec::new(), Vec::new(), Vec::new());
        let mut arena = Self { nodes, beside, slots, free: Vec::new(), filtered, listed };
        // An empty set that is never written, so that NONE is a handle without siblings.
        arena.lengthen(arena.header());
        arena
    }

    pub(super) const fn is_filtered(&self) -> bool {
        self.filtered
    }

    /// Bytes of the blocks, free ones among them.
    pub(super) fn bytes(&self) -> usize {
        let columns = size_of_val(self.nodes.as_slice()) + size_of_val(self.beside.as_slice());
        columns + size_of_val(self.slots.as_slice()) + size_of_val(self.free.as_slice())
    }

    /// Rows before the siblings of a set.
    #[inline]
    const fn header(&self) -> usize {
        if self.filtered { 1 } else { 2 }
    }

    /// The row of a sibling.
    #[inline]
    const fn row(&self, set: u32, index: usize) -> usize {
        set as usize + self.header() + index
    }

    fn lengthen(&mut self, rows: usize) {
        let end = self.nodes.len() + rows;
        self.nodes.resize(end, Node { label: 0, child: 0 });
        if self.filtered {
            self.beside.resize(end, 0);
        }
        if self.listed {
            self.slots.resize(end, UNLISTED);
        }
    }

    /// Makes a block for `len` siblings, which are not yet written.
    #[inline]
    pub(super) fn allocate(&mut self, parent: u32, parent_label: u32, len: usize) -> Result<u32, SizeError> {
        let room = capacity(len);
        let set = match self.free.get_mut(class_of(room)) {
            Some(head) if *head != NONE => {
                let set = *head;
                *head = self.nodes[set as usize].label;
                set
            }
            _ => {
                let set = u32::try_from(self.nodes.len()).map_err(|_| SizeError)?;
                self.lengthen(self.header() + room);
                set
            }
        };
        let (Ok(label), Ok(child)) = (u32::try_from(len), u32::try_from(room)) else { return Err(SizeError) };
        self.nodes[set as usize] = Node { label, child };
        self.set_parent(set, (parent, parent_label));
        Ok(set)
    }

    /// Gives the block of a set back.
    pub(super) fn release(&mut self, set: u32) {
        let class = class_of(self.capacity(set));
        if self.free.len() <= class {
            self.free.resize(class + 1, NONE);
        }
        self.nodes[set as usize].label = self.free[class];
        self.free[class] = set;
    }

    /// The number of siblings; 0 for [`NONE`].
    #[inline]
    pub(super) fn len(&self, set: u32) -> usize {
        self.nodes[set as usize].label as usize
    }

    #[inline]
    fn capacity(&self, set: u32) -> usize {
        self.nodes[set as usize].child as usize
    }

    /// The set in which the parent of the siblings is, and the label of the parent.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "the two halves")]
    pub(super) fn parent(&self, set: u32) -> (u32, u32) {
        if self.filtered {
            let both = self.beside[set as usize];
            (both as u32, (both >> 32) as u32)
        } else {
            let Node { label, child } = self.nodes[set as usize + 1];
            (child, label)
        }
    }

    #[inline]
    fn set_parent(&mut self, set: u32, (parent, label): (u32, u32)) {
        if self.filtered {
            self.beside[set as usize] = u64::from(parent) | u64::from(label) << 32;
        } else {
            self.nodes[set as usize + 1] = Node { label, child: parent };
        }
    }

    /// The siblings, labels increasing; none for [`NONE`].
    #[inline]
    pub(super) fn nodes(&self, set: u32) -> &[Node] {
        let start = self.row(set, 0);
        &self.nodes[start..start + self.len(set)]
    }

    /// The labels, increasing; none for [`NONE`].
    #[inline]
    pub(super) fn labels(&self, set: u32) -> impl ExactSizeIterator<Item = u32> + Clone {
        self.nodes(set).iter().map(|node| node.label)
    }

    /// Where a label is among the siblings, or would be.
    #[inline]
    pub(super) fn search(&self, set: u32, label: u32) -> Result<usize, usize> {
        let nodes = self.nodes(set);
        // Short runs are a cache line or two, which are faster read through than halved.
        let index = if nodes.len() <= 16 {
            nodes.iter().take_while(|other| other.label < label).count()
        } else {
            nodes.partition_point(|other| other.label < label)
        };
        if nodes.get(index).is_some_and(|other| other.label == label) { Ok(index) } else { Err(index) }
    }

    /// Where labels, increasing, will be in a set when those that it lacks are inserted; how many it lacks.
    #[inline]
    pub(super) fn find_all(&self, set: u32, labels: &[u32], indices: &mut [usize]) -> usize {
        let siblings = self.nodes(set);
        let (mut from, mut missing) = (0, 0);
        for (index, &label) in indices.iter_mut().zip(labels) {
            from += siblings[from..].iter().take_while(|other| other.label < label).count();
            *index = from + missing;
            missing += usize::from(siblings.get(from).is_none_or(|other| other.label != label));
        }
        missing
    }

    /// Some function of what is kept of a set: for whoever wants it to be near soon. See `insert_with_faces`.
    #[inline]
    pub(super) fn touch(&self, set: u32) -> u64 {
        // The first row, and one that is most often in the next line, of both columns; none depends on another.
        let line = |ahead: usize| {
            let row = set as usize + ahead;
            let node = self.nodes.get(row).map_or(0, |node| node.child);
            self.beside.get(row).copied().unwrap_or(0) ^ u64::from(node)
        };
        line(0) ^ line(8)
    }

    /// The set of the children of a sibling.
    #[inline]
    pub(super) fn child(&self, set: u32, index: usize) -> u32 {
        self.nodes[self.row(set, index)].child
    }

    #[inline]
    pub(super) fn set_child(&mut self, set: u32, index: usize, child: u32) {
        let row = self.row(set, index);
        self.nodes[row].child = child;
    }

    /// The filtration value of a sibling, 0 in trees without.
    #[inline]
    pub(super) fn value(&self, set: u32, index: usize) -> f64 {
        if self.filtered { f64::from_bits(self.beside[self.row(set, index)]) } else { 0.0 }
    }

    #[inline]
    pub(super) fn set_value(&mut self, set: u32, index: usize, value: f64) {
        if self.filtered {
            let row = self.row(set, index);
            self.beside[row] = value.to_bits();
        }
    }

    /// The place of a sibling in the list of its label.
    #[inline]
    pub(super) fn slot(&self, set: u32, index: usize) -> u32 {
        self.slots[self.row(set, index)]
    }

    #[inline]
    pub(super) fn set_slot(&mut self, set: u32, index: usize, slot: u32) {
        let row = self.row(set, index);
        self.slots[row] = slot;
    }

    /// Writes the label of a sibling that has no children yet, and is in no list.
    #[inline]
    pub(super) fn write(&mut self, set: u32, index: usize, label: u32, value: f64) {
        let row = self.row(set, index);
        self.nodes[row] = Node { label, child: NONE };
        self.set_value(set, index, value);
        if self.listed {
            self.slots[row] = UNLISTED;
        }
    }

    /// Copies a run of rows.
    #[inline]
    fn copy(&mut self, from: usize, to: usize, count: usize) {
        copy(&mut self.nodes, from, to, count);
        if self.filtered {
            copy(&mut self.beside, from, to, count);
        }
        if self.listed {
            copy(&mut self.slots, from, to, count);
        }
    }

    /// Gives a set more siblings; whoever asks writes them at the end. Returns the handle, which is another if there was
    /// no room; then the children have been told, the parent has not.
    pub(super) fn extend(&mut self, set: u32, len: usize) -> Result<u32, SizeError> {
        let kept = self.len(set);
        self.rearrange(set, len, [(0, 0, kept), (kept, kept, 0)])
    }

    /// Makes room for one sibling more before that at `index`; whoever asks writes it. Returns the handle as
    /// [`extend`](Self::extend) does.
    #[inline]
    pub(super) fn open(&mut self, set: u32, index: usize) -> Result<u32, SizeError> {
        let len = self.len(set);
        self.rearrange(set, len + 1, [(0, 0, index), (index, index + 1, len - index)])
    }

    /// Takes one sibling out; the others close up. The set keeps at least one. Returns the handle as
    /// [`extend`](Self::extend) does.
    #[inline]
    pub(super) fn take(&mut self, set: u32, index: usize) -> Result<u32, SizeError> {
        let len = self.len(set);
        self.rearrange(set, len - 1, [(0, 0, index), (index + 1, index, len - 1 - index)])
    }

    /// Gives a set another length and moves two runs of siblings, (from, to, count), the first of which starts the set.
    #[inline]
    fn rearrange(&mut self, set: u32, len: usize, runs: [(usize, usize, usize); 2]) -> Result<u32, SizeError> {
        let (room, first) = (self.capacity(set), self.row(set, 0));
        if len <= room && room <= 4 * len {
            self.nodes[set as usize].label = u32::try_from(len).map_err(|_| SizeError)?;
            let [_, (from, to, count)] = runs;
            self.copy(first + from, first + to, count);
            return Ok(set);
        }
        let (parent, label) = self.parent(set);
        let moved = self.allocate(parent, label, len)?;
        let start = self.row(moved, 0);
        for (from, to, count) in runs {
            self.copy(first + from, start + to, count);
        }
        for (_, to, count) in runs {
            for row in start + to..start + to + count {
                let Node { label, child } = self.nodes[row];
                if child != NONE {
                    self.set_parent(child, (moved, label));
                }
            }
        }
        self.release(set);
        Ok(moved)
    }

    /// Merges labels, increasing, into a set that already has room for the `missing` ones of them that it lacks (their
    /// room is the end of the set); those that it has get the lower one of the two values.
    pub(super) fn merge(&mut self, set: u32, labels: &[u32], missing: usize, value: f64) {
        let mut to = self.len(set);
        let mut from = to - missing;
        let mut pending = labels.len();
        // From the back, so that each sibling moves once.
        while pending > 0 {
            let label = labels[pending - 1];
            let last = from.checked_sub(1).map(|index| self.nodes[self.row(set, index)].label);
            to -= 1;
            if last.is_none_or(|last| last < label) {
                self.write(set, to, label, value);
                pending -= 1;
                continue;
            }
            from -= 1;
            if from != to {
                self.copy(self.row(set, from), self.row(set, to), 1);
            }
            if last == Some(label) {
                if value < self.value(set, to) {
                    self.set_value(set, to, value);
                }
                pending -= 1;
            }
        }
    }
}

/// Copies a run within a column. Most runs are shorter than a call to move them takes.
#[inline]
fn copy<T: Copy>(column: &mut [T], from: usize, to: usize, count: usize) {
    match count {
        0 => {}
        1 => column[to] = column[from],
        _ => column.copy_within(from..from + count, to),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn capacities_are_exact_for_small_sets_and_at_most_a_quarter_more_for_others() {
        for len in 1..5000 {
            let capacity = capacity(len);
            assert!(capacity >= len && 4 * capacity <= 5 * len, "{len}: {capacity}");
            assert!(len > 8 || capacity == len);
            // A full set is its own capacity, and capacities have classes of their own.
            assert_eq!(super::capacity(capacity), capacity);
            if super::capacity(len + 1) != capacity {
                assert_eq!(class_of(super::capacity(len + 1)), class_of(capacity) + 1);
            }
        }
    }
}
