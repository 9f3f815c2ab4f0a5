//! What the input held: repeated, non-maximal and conflicting simplices, unused vertices; and the parity of top
//! simplices.

use std::fmt;

use sig_core::Index;

use crate::build::SigArrays;
use crate::build::local::{EVEN, ODD};

/// What the input held beyond its maximal simplices.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct BuildReport {
    /// Simplices that the input lists.
    pub listed: usize,
    /// Of these, repetitions of one listed before; merged.
    pub repeated: usize,
    /// Different simplices that the input lists along with a coface.
    pub non_maximal: usize,
    /// Top simplices that the input lists in both orientations; their parity is 0.
    pub conflicting: usize,
    /// Declared vertices that no listed simplex uses, kept as 0-simplices.
    pub unused_kept: usize,
    /// Declared vertices that no listed simplex uses, dropped.
    pub unused_dropped: usize,
    /// Top simplices, of each dimension.
    pub top_simplices: Vec<usize>,
}

impl fmt::Display for BuildReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} simplices listed", self.listed)?;
        let counts = [
            (self.repeated, "repeated (merged)"),
            (self.non_maximal, "given along with a coface (merged)"),
            (self.conflicting, "given in both orientations (parity 0)"),
            (self.unused_kept, "unused vertices kept"),
            (self.unused_dropped, "unused vertices dropped"),
        ];
        counts.into_iter().filter(|&(count, _)| count > 0).try_for_each(|(count, what)| write!(f, ", {count} {what}"))
    }
}

/// What the arrays and the marks of the listed simplices tell for the report.
pub(super) struct Counts {
    pub(super) distinct_listed: usize,
    pub(super) non_maximal: usize,
    pub(super) conflicting: usize,
    pub(super) top_simplices: Vec<usize>,
}

/// Finds the top simplices, all of them listed (or unused vertices, which are marked as listed); their parity bits in
/// id order, the counts for the report, and which simplices of each dimension are top (nothing for a dimension of which
/// none is). `listed[p]` holds one byte for every p-simplex, or nothing if none is
/// listed.
pub(super) fn top_simplices<I: Index>(arrays: &SigArrays<I>, listed: &[Vec<u8>]) -> (Vec<u8>, Counts, Vec<Vec<bool>>) {
    let mut parity = Vec::new();
    let mut num_tops = 0;
    let mut counts =
        Counts { distinct_listed: 0, non_maximal: 0, conflicting: 0, top_simplices: vec![0; arrays.first.len()] };
    let mut tops = vec![Vec::new(); arrays.first.len()];
    for (dim, marks) in listed.iter().enumerate().filter(|(_, marks)| !marks.is_empty()) {
        let mut is_top = vec![true; marks.len()];
        for facet in arrays.facets(dim + 1) {
            is_top[facet.to_usize() - arrays.first[dim]] = false;
        }
        for (&mark, &is_top) in marks.iter().zip(&is_top) {
            counts.distinct_listed += usize::from(mark & (EVEN | ODD) != 0);
            if !is_top {
                counts.non_maximal += usize::from(mark & (EVEN | ODD) != 0);
                continue;
            }
            if num_tops % 8 == 0 {
                parity.push(0);
            }
            if let Some(byte) = parity.last_mut() {
                *byte |= u8::from(mark == ODD) << (num_tops % 8);
            }
            num_tops += 1;
            counts.conflicting += usize::from(mark == EVEN | ODD);
            counts.top_simplices[dim] += 1;
        }
        if counts.top_simplices[dim] > 0 {
            tops[dim] = is_top;
        }
    }
    (parity, counts, tops)
}
