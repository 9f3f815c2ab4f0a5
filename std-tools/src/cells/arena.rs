//! Room for the arcs of cells: blocks of a few sizes in one array, those that are given back used again.

use sig_core::PackedArc;

use crate::build::narrow;

/// Blocks of arcs.
#[derive(Clone, Debug, Default)]
pub(super) struct Arena {
    words: Vec<PackedArc>,
    /// The first free block of each class, [`NONE`] if there is none; the first word of a free block is the next one.
    free: Vec<u32>,
    /// Words in free blocks.
    free_words: usize,
}

/// No block.
const NONE: u32 = u32::MAX;

/// The least class of blocks that have room for so many arcs: every number up to 8, then four to each doubling.
#[inline]
pub(super) const fn class_for(arcs: usize) -> usize {
    if arcs <= 8 {
        return arcs;
    }
    let largest = arcs - 1;
    let exponent = largest.ilog2() as usize;
    8 + (exponent - 3) * 4 + (largest >> (exponent - 2)) - 3
}

/// The arcs for which a block of a class has room.
#[inline]
pub(super) const fn capacity(class: usize) -> usize {
    if class <= 8 {
        return class;
    }
    let step = class - 9;
    (step % 4 + 5) << (step / 4 + 1)
}

impl Arena {
    pub(super) fn with_capacity(words: usize) -> Self {
        Self { words: Vec::with_capacity(words), ..Self::default() }
    }

    /// Whether blocks of so many words in all can be allocated, whatever is free.
    pub(super) fn has_room(&self, words: usize) -> bool {
        self.words.len().saturating_add(words) < NONE as usize
    }

    /// A block of a class, its words unspecified. There must be room.
    pub(super) fn allocate(&mut self, class: usize) -> u32 {
        if class == 0 {
            return 0;
        }
        if let Some(first) = self.free.get_mut(class)
            && *first != NONE
        {
            let start = *first;
            *first = self.words[start as usize].word();
            self.free_words -= capacity(class);
            return start;
        }
        let start = narrow(self.words.len());
        self.words.resize(self.words.len() + capacity(class), PackedArc::from_word(0));
        start
    }

    /// Takes a block back.
    pub(super) fn release(&mut self, start: u32, class: usize) {
        if class == 0 {
            return;
        }
        if self.free.len() <= class {
            self.free.resize(class + 1, NONE);
        }
        self.words[start as usize] = PackedArc::from_word(self.free[class]);
        self.free[class] = start;
        self.free_words += capacity(class);
    }

    #[inline]
    pub(super) fn words(&self) -> &[PackedArc] {
        &self.words
    }

    #[inline]
    pub(super) fn words_mut(&mut self) -> &mut [PackedArc] {
        &mut self.words
    }

    /// Bytes that the arena takes, and how many of them are in free blocks.
    pub(super) fn bytes(&self) -> (usize, usize) {
        let word = size_of::<PackedArc>();
        (self.words.capacity() * word + self.free.capacity() * size_of::<u32>(), self.free_words * word)
    }
}

#[cfg(test)]
mod tests {
    use super::{capacity, class_for};

    #[test]
    fn classes_have_room_and_waste_little() {
        for arcs in (0..5000).chain([1 << 20, (1 << 20) + 1, (1 << 26) + 12345]) {
            let class = class_for(arcs);
            assert!(capacity(class) >= arcs, "{arcs}");
            assert!(class == 0 || capacity(class - 1) < arcs, "{arcs}");
            assert!(capacity(class) * 4 <= arcs * 5 || arcs <= 8, "{arcs}");
            assert!(class < 128);
        }
    }
}
