//! The partial co-boundary relations as the paper stores them: pointers, lists with stop codes, and one flag a simplex
//! (sig-2004, 4.2).

use sig_core::Index;

use crate::build::{Arrays, SigArrays, index};

/// Completes `arrays` with the relations, at the width that the list offsets need. `for_each_list` hands over C\*(σ),
/// by decreasing dimension, then increasing id, for every simplex σ below dimension d in id order; it is asked twice if
/// the width proves too small.
pub(crate) fn pack<I: Index>(mut arrays: SigArrays<I>, for_each_list: impl Fn(&mut dyn FnMut(&[I]))) -> Arrays
where
    Arrays: From<SigArrays<I>>,
{
    let Some(lists) = Lists::<I>::write(&arrays.first, &for_each_list) else {
        let mut arrays = arrays.widen();
        // 64 bits are never too small.
        if let Some(lists) = Lists::write(&arrays.first, &for_each_list) {
            lists.put_into(&mut arrays);
        }
        return arrays.into();
    };
    lists.put_into(&mut arrays);
    arrays.into()
}

/// The pointers, lists and flags of the simplices so far.
struct Lists<I> {
    pointers: Vec<I>,
    lists: Vec<I>,
    flags: Vec<u8>,
}

impl<I: Index> Lists<I> {
    /// Writes all lists, if the offsets fit.
    fn write<J: Index>(first: &[usize], for_each_list: impl Fn(&mut dyn FnMut(&[J]))) -> Option<Self> {
        let top_start = first.last().copied().unwrap_or(0);
        // Only simplices two dimensions below the tops are flagged.
        let flaggable = first.len().checked_sub(2).map_or(0, |facets| first[facets]);
        let mut written =
            Self { pointers: Vec::with_capacity(top_start), lists: Vec::new(), flags: vec![0; top_start.div_ceil(8)] };
        for_each_list(&mut |list| written.push(list, flaggable, top_start));
        I::from_usize(written.lists.len()).map(|_| written)
    }

    fn push<J: Index>(&mut self, list: &[J], flaggable: usize, top_start: usize) {
        let id = self.pointers.len();
        match list {
            [top] if id < flaggable && top.to_usize() >= top_start => {
                self.flags[id / 8] |= 1 << (id % 8);
                self.pointers.push(index(top.to_usize()));
            }
            _ => {
                // An offset that does not fit is found out at the end.
                self.pointers.push(I::from_usize(self.lists.len()).unwrap_or(I::STOP));
                self.lists.extend(list.iter().map(|top| index::<I>(top.to_usize())));
                self.lists.push(I::STOP);
            }
        }
    }

    fn put_into(self, arrays: &mut SigArrays<I>) {
        arrays.pointers = self.pointers;
        arrays.lists = self.lists;
        arrays.flags = self.flags;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_that_do_not_fit_are_noticed() {
        let lists = |count: usize| move |write: &mut dyn FnMut(&[u32])| (0..count).for_each(|_| write(&[7]));
        // Edges on two vertices: each list is an entry and a stop code.
        assert!(Lists::<u16>::write(&[0, 40_000], lists(32_767)).is_some());
        assert!(Lists::<u16>::write(&[0, 40_000], lists(32_768)).is_none());
    }
}
