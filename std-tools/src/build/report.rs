//! What the input held: repeated, non-maximal and conflicting simplices, unused vertices; and the parity of top
//! simplices.

use std::fmt;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sig_core::{Dim, Index};

use crate::build::SigArrays;
use crate::build::facets::mark;
use crate::build::local::{EVEN, ODD};

/// Facets that are looked at by one task.
const CHUNK: usize = 1 << 16;

/// What the input held beyond its maximal simplices.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct BuildReport {
    /// Simplices that the input lists.
    pub listed: usize,
    /// Of these, repetitions of one listed before; merged.
    pub repeated: usize,
    /// Of the repetitions, those with other attributes than the first, whose attributes stay.
    pub differing: usize,
    /// Different simplices that the input lists along with a coface.
    pub non_maximal: usize,
    /// Top simplices that the input lists in both orientations; their parity is 0.
    pub conflicting: usize,
    /// Declared vertices that no listed simplex uses, kept as 0-simplices.
    pub unused_kept: usize,
    /// Declared vertices that no listed simplex uses, dropped.
    pub unused_dropped: usize,
    /// The labels of the first of the unused vertices.
    pub first_unused: Vec<String>,
    /// Top simplices, of each dimension.
    pub top_simplices: Vec<usize>,
}

impl fmt::Display for BuildReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} simplices listed", self.listed)?;
        let counts = [
            (self.repeated, "repeated (merged)"),
            (self.differing, "repeated with other attributes (the first stay)"),
            (self.non_maximal, "given along with a coface (merged)"),
            (self.conflicting, "given in both orientations (parity 0)"),
            (self.unused_kept, "unused vertices kept"),
            (self.unused_dropped, "unused vertices dropped"),
        ];
        counts.into_iter().filter(|&(count, _)| count > 0).try_for_each(|(count, what)| write!(f, ", {count} {what}"))
    }
}

/// What the arrays and the marks of the listed simplices tell for the report.
#[derive(Clone, Default, Serialize, Deserialize)]
pub(super) struct Counts {
    pub(super) distinct_listed: usize,
    pub(super) non_maximal: usize,
    pub(super) conflicting: usize,
    pub(super) top_simplices: Vec<usize>,
}

impl Counts {
    /// Of a complex of so many dimensions, nothing yet.
    pub(super) fn new(dims: usize) -> Self {
        Self { top_simplices: vec![0; dims], ..Self::default() }
    }

    /// Adds those of a part.
    pub(super) fn merge(&mut self, part: &Self) {
        self.distinct_listed += part.distinct_listed;
        self.non_maximal += part.non_maximal;
        self.conflicting += part.conflicting;
        self.top_simplices.iter_mut().zip(&part.top_simplices).for_each(|(all, more)| *all += more);
    }

    /// What they say of so many listed simplices.
    pub(super) fn report(self, listed: usize) -> BuildReport {
        BuildReport {
            listed,
            repeated: listed - self.distinct_listed,
            non_maximal: self.non_maximal,
            conflicting: self.conflicting,
            top_simplices: self.top_simplices,
            ..BuildReport::default()
        }
    }

    /// Takes in simplices of one dimension, how they are listed and which of them are top, and calls `parity` with the
    /// orientation of each that is: whether it is odd.
    pub(super) fn add(&mut self, dim: Dim, marks: &[u8], is_top: &[bool], mut parity: impl FnMut(bool)) {
        for (&mark, &is_top) in marks.iter().zip(is_top) {
            self.distinct_listed += usize::from(mark & (EVEN | ODD) != 0);
            if is_top {
                parity(mark == ODD);
                self.conflicting += usize::from(mark == EVEN | ODD);
                self.top_simplices[dim] += 1;
            } else {
                self.non_maximal += usize::from(mark & (EVEN | ODD) != 0);
            }
        }
    }
}

/// Which simplices of each dimension are top, all of them listed (or unused vertices, which are marked as listed); nothing
/// for a dimension of which none is listed. `listed[p]` holds one byte for every p-simplex, or nothing if none is.
pub(super) fn is_top<I: Index>(arrays: &SigArrays<I>, listed: &[Vec<u8>]) -> Vec<Vec<bool>> {
    let mut tops = vec![Vec::new(); arrays.first.len()];
    for (dim, marks) in listed.iter().enumerate().filter(|(_, marks)| !marks.is_empty()) {
        let facets = arrays.facets(dim + 1);
        if facets.is_empty() {
            tops[dim] = vec![true; marks.len()];
            continue;
        }
        let has_coface: Vec<AtomicBool> = marks.par_iter().map(|_| AtomicBool::new(false)).collect();
        let first = arrays.first[dim];
        facets.par_chunks(CHUNK).for_each(|facets| {
            facets.iter().for_each(|facet| mark(&has_coface[facet.to_usize() - first]));
        });
        // In place: faster on one thread than to new memory on all.
        tops[dim] = has_coface.into_iter().map(|mark| !mark.into_inner()).collect();
    }
    tops
}

/// The parity bits of the top simplices in id order, and the counts for the report.
pub(super) fn tally(listed: &[Vec<u8>], is_top: &[Vec<bool>]) -> (Vec<u8>, Counts) {
    let mut parity = Bits::default();
    let mut counts = Counts::new(is_top.len());
    for (dim, (marks, is_top)) in listed.iter().zip(is_top).enumerate() {
        let chunks = marks.par_chunks(CHUNK).zip(is_top.par_chunks(CHUNK)).map(|(marks, is_top)| {
            let (mut parity, mut counts) = (Bits::default(), Counts::new(dim + 1));
            counts.add(dim, marks, is_top, |is_odd| parity.push(is_odd));
            (parity, counts)
        });
        for (bits, of_chunk) in chunks.collect::<Vec<_>>() {
            parity.append(&bits);
            counts.merge(&of_chunk);
        }
    }
    (parity.bytes, counts)
}

/// Bits in bytes, least significant first.
#[derive(Default)]
struct Bits {
    bytes: Vec<u8>,
    len: usize,
}

impl Bits {
    #[inline]
    fn push(&mut self, bit: bool) {
        if self.len.is_multiple_of(8) {
            self.bytes.push(0);
        }
        if let Some(byte) = self.bytes.last_mut() {
            *byte |= u8::from(bit) << (self.len % 8);
        }
        self.len += 1;
    }

    fn append(&mut self, others: &Self) {
        let shift = self.len % 8;
        for &byte in &others.bytes {
            if let Some(last) = self.bytes.last_mut().filter(|_| shift > 0) {
                *last |= byte << shift;
            }
            self.bytes.push(if shift > 0 { byte >> (8 - shift) } else { byte });
        }
        self.len += others.len;
        self.bytes.truncate(self.len.div_ceil(8));
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn bits_appended_are_bits_pushed(runs in prop::collection::vec(prop::collection::vec(any::<bool>(), 0..40), 0..8)) {
            let (mut appended, mut pushed) = (Bits::default(), Bits::default());
            for run in runs {
                let mut bits = Bits::default();
                for bit in run {
                    bits.push(bit);
                    pushed.push(bit);
                }
                appended.append(&bits);
            }
            prop_assert_eq!((appended.bytes, appended.len), (pushed.bytes, pushed.len));
        }
    }
}
