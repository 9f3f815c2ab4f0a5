//! The lookup table: which ids belong to which dimension, and where their rows lie.

use core::ops::Range;

use crate::id::{Dim, Index, MAX_DIM};
use crate::relations::binomial;

/// First ids and row offsets of the dimensions, unpacked once so that a query finds them without a search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Levels {
    dims: usize,
    total: usize,
    /// `first[p]` is the first id of dimension p, and the number of simplices from p = d + 1 on.
    first: [usize; MAX_DIM + 2],
    /// The row of p-simplex σ starts at `row_shift[p] + (p + 1)·σ`, modulo the word size.
    row_shift: [usize; MAX_DIM + 1],
}

impl Levels {
    /// Reads a lookup table; `Err(p)` if the first id of dimension p is not after the one before, not 0 for p = 0, or
    /// not below the number of simplices, or if there are fewer p-simplices than a d-simplex has: so no simplex has more
    /// faces than there are simplices, whatever the arrays say. Also `Err` if the boundary would have more entries than a
    /// `usize` counts.
    pub(crate) fn new<I: Index>(lookup: &[I], total: usize) -> Result<Self, usize> {
        let mut levels = Self { dims: lookup.len(), total, first: [total; MAX_DIM + 2], row_shift: [0; MAX_DIM + 1] };
        for (dim, (slot, first)) in levels.first.iter_mut().zip(lookup).enumerate() {
            *slot = first.to_usize();
            if (dim == 0) != (*slot == 0) || *slot >= total {
                return Err(dim);
            }
        }
        let mut rows: usize = 0;
        for dim in 1..levels.dims {
            let (Some(&start), Some(&end)) = (levels.first.get(dim), levels.first.get(dim + 1)) else { break };
            let before = levels.first.get(dim - 1).copied().unwrap_or(0);
            let count = end.checked_sub(start).filter(|&count| count > 0 && before < start).ok_or(dim)?;
            if let Some(shift) = levels.row_shift.get_mut(dim) {
                *shift = rows.wrapping_sub(start.wrapping_mul(dim + 1));
            }
            rows = count.checked_mul(dim + 1).and_then(|entries| rows.checked_add(entries)).ok_or(dim)?;
        }
        if levels.dims == 0 && total != 0 {
            return Err(0);
        }
        let too_few = |&dim: &Dim| levels.ids(dim).len() < binomial(levels.dims, dim + 1);
        (0..levels.dims).find(too_few).map_or(Ok(levels), Err)
    }

    pub(crate) const fn dims(&self) -> usize {
        self.dims
    }

    pub(crate) const fn total(&self) -> usize {
        self.total
    }

    /// The first id of dimension `dim`; the number of simplices past the last dimension.
    #[inline]
    pub(crate) fn start(&self, dim: Dim) -> usize {
        self.first.get(dim).copied().unwrap_or(self.total)
    }

    /// The ids of dimension `dim`.
    #[inline]
    pub(crate) fn ids(&self, dim: Dim) -> Range<usize> {
        self.start(dim)..self.start(dim.saturating_add(1))
    }

    /// The number of simplices below the highest dimension: of pointers and of flags.
    pub(crate) fn num_pointers(&self) -> usize {
        self.dims.checked_sub(1).map_or(0, |top| self.start(top))
    }

    /// The id from which on no simplex is flagged: the first of dimension d − 1.
    #[inline]
    pub(crate) fn flags_end(&self) -> usize {
        self.dims.checked_sub(2).map_or(0, |dim| self.start(dim))
    }

    /// Twice the number of simplices of dimension d − 1: of indices in pairs.
    pub(crate) fn num_pairs(&self) -> usize {
        // No lookup table has more than half of the ids of an address space: they are elements of slices, or of none.
        self.num_pointers().saturating_sub(self.flags_end()).saturating_mul(2)
    }

    /// The number of boundary entries: Σ (p+1) n_p for p > 0.
    pub(crate) fn num_boundary(&self) -> usize {
        (1..self.dims).map(|dim| self.ids(dim).len() * (dim + 1)).sum()
    }

    #[inline]
    pub(crate) fn dim_of(&self, simplex: usize) -> Option<Dim> {
        let (_, ends) = self.first.split_first()?;
        ends.iter().position(|&end| simplex < end)
    }

    /// Where the row of a simplex of dimension `dim` lies among the boundary entries. Of an id of another dimension the
    /// range is of something else.
    #[inline]
    pub(crate) fn row(&self, dim: Dim, simplex: usize) -> Option<Range<usize>> {
        let start = self.row_shift.get(dim)?.wrapping_add(simplex.wrapping_mul(dim + 1));
        (dim > 0).then(|| start..start.wrapping_add(dim + 1))
    }
}
