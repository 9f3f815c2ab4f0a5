//! Where the sibling sets of a simplex tree lie: blocks of words in one array, without an allocation of their own.
//!
//! A set of `len` siblings of capacity `c` is the block
//!
//! ```text
//! parent set, parent label, len | c labels | c child sets | 2 c words of values | c slots
//! ```
//!
//! that its handle, the number of its first word, names. Values and slots are there only in trees that have filtration
//! values and label lists. The capacity follows from `len` ([`capacity`]): exact up to eight siblings, at most a quarter
//! more above, so that the many sets of two or three carry no slack. Freed blocks wait in one list for each capacity.
//!
//! A block moves when its capacity changes; its parent and its children are told, which know it by its handle.

use super::SizeError;

/// The handle of no set. As a parent set it stands for the top nodes.
pub(super) const NONE: u32 = 0;

/// The slot of a sibling that is in no list yet.
pub(super) const UNLISTED: u32 = u32::MAX;

/// Words before the labels of a set.
const HEADER: usize = 3;

/// The capacity of a set of `len` siblings.
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

/// Sibling sets in blocks.
#[derive(Clone, Debug)]
pub(super) struct Arena {
    words: Vec<u32>,
    /// The first free block of each class; a free block's first word is the next one.
    free: Vec<u32>,
    filtered: bool,
    listed: bool,
}

impl Arena {
    pub(super) fn new(filtered: bool, listed: bool) -> Self {
        // The first word makes the handle 0 free for NONE.
        Self { words: vec![0], free: Vec::new(), filtered, listed }
    }

    pub(super) const fn is_filtered(&self) -> bool {
        self.filtered
    }

    /// Bytes of the blocks, free ones among them.
    pub(super) fn bytes(&self) -> usize {
        size_of_val(self.words.as_slice()) + size_of_val(self.free.as_slice())
    }

    const fn words_of(&self, capacity: usize) -> usize {
        HEADER + capacity * (2 + 2 * self.filtered as usize + self.listed as usize)
    }

    /// Makes a block for `len` siblings, whose labels and children are not yet written.
    #[inline]
    pub(super) fn allocate(&mut self, parent: u32, parent_label: u32, len: usize) -> Result<u32, SizeError> {
        let capacity = capacity(len);
        let class = class_of(capacity);
        let (Ok(at), Ok(len)) = (u32::try_from(self.words.len()), u32::try_from(len)) else { return Err(SizeError) };
        let set = match self.free.get_mut(class) {
            Some(head) if *head != NONE => {
                let set = *head;
                *head = self.words[set as usize];
                set
            }
            _ => {
                let end = self.words.len() + self.words_of(capacity);
                self.words.resize(end, 0);
                at
            }
        };
        self.words[set as usize..set as usize + HEADER].copy_from_slice(&[parent, parent_label, len]);
        Ok(set)
    }

    /// Gives the block of a set back.
    pub(super) fn release(&mut self, set: u32) {
        let class = class_of(capacity(self.len(set)));
        if self.free.len() <= class {
            self.free.resize(class + 1, NONE);
        }
        self.words[set as usize] = self.free[class];
        self.free[class] = set;
    }

    /// The number of siblings.
    #[inline]
    pub(super) fn len(&self, set: u32) -> usize {
        self.words[set as usize + 2] as usize
    }

    /// The set in which the parent of the siblings is, and the label of the parent.
    #[inline]
    pub(super) fn parent(&self, set: u32) -> (u32, u32) {
        (self.words[set as usize], self.words[set as usize + 1])
    }

    pub(super) fn set_parent(&mut self, set: u32, parent: u32) {
        self.words[set as usize] = parent;
    }

    /// The labels, increasing; none for [`NONE`].
    #[inline]
    pub(super) fn labels(&self, set: u32) -> &[u32] {
        if set == NONE {
            return &[];
        }
        let start = set as usize + HEADER;
        &self.words[start..start + self.len(set)]
    }

    /// Where a label is among the siblings, or would be.
    #[inline]
    pub(super) fn search(&self, set: u32, label: u32) -> Result<usize, usize> {
        let labels = self.labels(set);
        // Short runs of labels are one cache line, which is faster read through than halved.
        let index = if labels.len() <= 16 {
            labels.iter().take_while(|&&other| other < label).count()
        } else {
            labels.partition_point(|&other| other < label)
        };
        if labels.get(index) == Some(&label) { Ok(index) } else { Err(index) }
    }

    /// Where labels, increasing, will be in a set when those that it lacks are inserted; how many it lacks.
    #[inline]
    pub(super) fn find_all(&self, set: u32, labels: &[u32], indices: &mut [usize]) -> usize {
        let siblings = self.labels(set);
        let (mut from, mut missing) = (0, 0);
        for (index, &label) in indices.iter_mut().zip(labels) {
            from += siblings[from..].iter().take_while(|&&other| other < label).count();
            *index = from + missing;
            missing += usize::from(siblings.get(from) != Some(&label));
        }
        missing
    }

    /// Some function of words of a set: for whoever wants it to be near soon. See `insert_with_faces`.
    #[inline]
    pub(super) fn touch(&self, set: u32) -> u32 {
        // The first word that is not in the header, and one that is most often in the next line.
        let word = |ahead: usize| self.words.get(set as usize + ahead).copied().unwrap_or(0);
        word(HEADER) ^ word(HEADER + 16)
    }

    #[inline]
    fn child_at(&self, set: u32, index: usize) -> usize {
        set as usize + HEADER + capacity(self.len(set)) + index
    }

    #[inline]
    fn value_at(&self, set: u32, index: usize) -> usize {
        set as usize + HEADER + 2 * capacity(self.len(set)) + 2 * index
    }

    #[inline]
    fn slot_at(&self, set: u32, index: usize) -> usize {
        let capacity = capacity(self.len(set));
        set as usize + HEADER + capacity * (2 + 2 * usize::from(self.filtered)) + index
    }

    /// The set of the children of a sibling.
    #[inline]
    pub(super) fn child(&self, set: u32, index: usize) -> u32 {
        self.words[self.child_at(set, index)]
    }

    #[inline]
    pub(super) fn set_child(&mut self, set: u32, index: usize, child: u32) {
        let at = self.child_at(set, index);
        self.words[at] = child;
    }

    /// The filtration value of a sibling, 0 in trees without.
    #[inline]
    pub(super) fn value(&self, set: u32, index: usize) -> f64 {
        if !self.filtered {
            return 0.0;
        }
        let at = self.value_at(set, index);
        f64::from_bits(u64::from(self.words[at]) | u64::from(self.words[at + 1]) << 32)
    }

    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "the two halves of the bits")]
    pub(super) fn set_value(&mut self, set: u32, index: usize, value: f64) {
        if self.filtered {
            let (at, bits) = (self.value_at(set, index), value.to_bits());
            self.words[at..at + 2].copy_from_slice(&[bits as u32, (bits >> 32) as u32]);
        }
    }

    /// The place of a sibling in the list of its label.
    #[inline]
    pub(super) fn slot(&self, set: u32, index: usize) -> u32 {
        self.words[self.slot_at(set, index)]
    }

    #[inline]
    pub(super) fn set_slot(&mut self, set: u32, index: usize, slot: u32) {
        let at = self.slot_at(set, index);
        self.words[at] = slot;
    }

    /// Writes the label of a sibling that has no children yet, and is in no list.
    #[inline]
    pub(super) fn write(&mut self, set: u32, index: usize, label: u32, value: f64) {
        self.words[set as usize + HEADER + index] = label;
        self.set_child(set, index, NONE);
        self.set_value(set, index, value);
        if self.listed {
            self.set_slot(set, index, UNLISTED);
        }
    }

    /// Moves a sibling within its set.
    fn shift(&mut self, set: u32, from: usize, to: usize) {
        let labels = set as usize + HEADER;
        self.words[labels + to] = self.words[labels + from];
        let children = self.child_at(set, 0);
        self.words[children + to] = self.words[children + from];
        if self.filtered {
            let values = self.value_at(set, 0);
            self.words.copy_within(values + 2 * from..values + 2 * from + 2, values + 2 * to);
        }
        if self.listed {
            let slots = self.slot_at(set, 0);
            self.words[slots + to] = self.words[slots + from];
        }
    }

    /// The columns of a block: where each starts, in capacities, and how many words of it a sibling has.
    fn columns(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (values, slots) = (2 * usize::from(self.filtered), usize::from(self.listed));
        [(0, 1), (1, 1), (2, values), (2 + values, slots)].into_iter().filter(|&(_, width)| width > 0)
    }

    /// Gives a set another length, more or less; whoever asks for more writes the new siblings at the end, whoever asks
    /// for less has moved those that stay to the front. Returns the handle, which is another if the capacity changes;
    /// then the children have been told, the parent has not.
    pub(super) fn resize(&mut self, set: u32, len: usize) -> Result<u32, SizeError> {
        let kept = self.len(set).min(len);
        self.rearrange(set, len, [(0, 0, kept), (kept, kept, 0)])
    }

    /// Makes room for one sibling more before that at `index`; whoever asks writes it. Returns the handle as
    /// [`resize`](Self::resize) does.
    #[inline]
    pub(super) fn open(&mut self, set: u32, index: usize) -> Result<u32, SizeError> {
        let len = self.len(set);
        self.rearrange(set, len + 1, [(0, 0, index), (index, index + 1, len - index)])
    }

    /// Takes one sibling out; the others close up. The set keeps at least one. Returns the handle as
    /// [`resize`](Self::resize) does.
    #[inline]
    pub(super) fn take(&mut self, set: u32, index: usize) -> Result<u32, SizeError> {
        let len = self.len(set);
        self.rearrange(set, len - 1, [(0, 0, index), (index + 1, index, len - 1 - index)])
    }

    /// Gives a set another length and moves two runs of siblings, (from, to, count), the first of which starts the set.
    fn rearrange(&mut self, set: u32, len: usize, runs: [(usize, usize, usize); 2]) -> Result<u32, SizeError> {
        let (old, new) = (capacity(self.len(set)), capacity(len));
        let (parent, label) = self.parent(set);
        if old == new {
            self.words[set as usize + 2] = u32::try_from(len).map_err(|_| SizeError)?;
            let [_, (from, to, count)] = runs;
            for (column, width) in self.columns() {
                let start = set as usize + HEADER + column * old;
                self.words.copy_within(start + width * from..start + width * (from + count), start + width * to);
            }
            return Ok(set);
        }
        let moved = self.allocate(parent, label, len)?;
        let columns = self.columns();
        let block = |set: u32, capacity: usize| set as usize..set as usize + self.words_of(capacity);
        let blocks = [block(set, old), block(moved, new)];
        let Ok([source, target]) = self.words.get_disjoint_mut(blocks) else { return Err(SizeError) };
        for (column, width) in columns {
            let (source, target) = (&source[HEADER + column * old..], &mut target[HEADER + column * new..]);
            for (from, to, count) in runs {
                let source = &source[width * from..width * (from + count)];
                // Most runs are shorter than a call to copy them takes.
                target[width * to..].iter_mut().zip(source).for_each(|(target, &word)| *target = word);
            }
        }
        for (_, to, count) in runs {
            for index in to..to + count {
                let child = self.child(moved, index);
                if child != NONE {
                    self.set_parent(child, moved);
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
            let last = from.checked_sub(1).map(|index| self.words[set as usize + HEADER + index]);
            to -= 1;
            if last.is_none_or(|last| last < label) {
                self.write(set, to, label, value);
                pending -= 1;
                continue;
            }
            from -= 1;
            if from != to {
                self.shift(set, from, to);
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
