//! Sets of cells as bits.

use std::ops::Range;

/// A set of numbers below a bound.
#[derive(Clone, Debug, Default)]
pub(super) struct Bits {
    words: Vec<u64>,
}

impl Bits {
    /// The empty set, with room for the numbers below `len`.
    pub(super) fn new(len: usize) -> Self {
        Self { words: vec![0; len.div_ceil(64)] }
    }

    /// The numbers whose marks are set.
    pub(super) fn of(marks: &[bool]) -> Self {
        let word = |marks: &[bool]| marks.iter().rev().fold(0, |word, &mark| word << 1 | u64::from(mark));
        Self { words: marks.chunks(64).map(word).collect() }
    }

    #[inline]
    pub(super) fn contains(&self, number: usize) -> bool {
        self.words[number / 64] >> (number % 64) & 1 == 1
    }

    #[inline]
    pub(super) fn insert(&mut self, number: usize) {
        self.words[number / 64] |= 1 << (number % 64);
    }

    /// The bytes that it takes.
    pub(super) fn bytes(len: usize) -> u64 {
        len as u64 / 8
    }

    pub(super) fn count(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// The numbers of a range that are not in the set, increasing.
    pub(super) fn absent(&self, range: Range<usize>) -> impl Iterator<Item = usize> + '_ {
        let words = range.start / 64..range.end.div_ceil(64);
        let numbers = words.flat_map(|at| {
            let mut absent = !self.words[at];
            std::iter::from_fn(move || {
                let number = at * 64 + absent.trailing_zeros() as usize;
                let is_one = absent != 0;
                absent &= absent.wrapping_sub(1);
                is_one.then_some(number)
            })
        });
        numbers.skip_while(move |&number| number < range.start).take_while(move |&number| number < range.end)
    }
}

/// A set that gives back its numbers in sweeps from the least to the greatest.
#[derive(Debug)]
pub(super) struct Sweep {
    /// A set, then for each set those of its words that are not zero.
    layers: Vec<Vec<u64>>,
    at: usize,
}

impl Sweep {
    /// The empty set, with room for the numbers below `len`.
    pub(super) fn new(len: usize) -> Self {
        let mut layers = vec![vec![0; len.div_ceil(64).max(1)]];
        while let Some(last) = layers.last().map(Vec::len).filter(|&last| last > 1) {
            layers.push(vec![0; last.div_ceil(64)]);
        }
        Self { layers, at: 0 }
    }

    #[inline]
    pub(super) fn insert(&mut self, number: usize) {
        let mut number = number;
        for layer in &mut self.layers {
            let word = &mut layer[number / 64];
            let is_known = *word != 0;
            *word |= 1 << (number % 64);
            if is_known {
                break;
            }
            number /= 64;
        }
    }

    /// Takes out the least number that is not less than the one before, or the least of all if there is none.
    #[inline]
    pub(super) fn next(&mut self) -> Option<usize> {
        let number = self.find(self.at).or_else(|| self.find(0))?;
        self.at = number;
        let mut at = number;
        for layer in &mut self.layers {
            let word = &mut layer[at / 64];
            *word &= !(1 << (at % 64));
            if *word != 0 {
                break;
            }
            at /= 64;
        }
        Some(number)
    }

    /// The least number that is not less than another one.
    #[inline]
    fn find(&self, from: usize) -> Option<usize> {
        let mut at = from;
        for (height, layer) in self.layers.iter().enumerate() {
            let word = *layer.get(at / 64)? & (u64::MAX << (at % 64));
            if word != 0 {
                let mut number = at / 64 * 64 + word.trailing_zeros() as usize;
                for layer in self.layers[..height].iter().rev() {
                    number = number * 64 + layer[number].trailing_zeros() as usize;
                }
                return Some(number);
            }
            at = at / 64 + 1;
        }
        None
    }
}
