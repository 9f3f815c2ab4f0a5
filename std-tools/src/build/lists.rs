//! The partial co-boundary relations as the paper stores them: pointers, lists with stop codes, and one flag a simplex
//! (sig-2004, 4.2).

use sig_core::{Dim, Index};

use crate::build::{Arrays, SigArrays, index};

/// The relations C\*(σ) of all simplices σ of one dimension.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(crate) struct Relations<I> {
    /// Where the entries of each simplex start, and the end.
    pub(crate) starts: Vec<usize>,
    /// Representatives of clusters, by decreasing dimension, then increasing id.
    pub(crate) entries: Vec<I>,
}

impl<I> Relations<I> {
    /// The entries of simplex number `simplex` of the dimension.
    pub(crate) fn of(&self, simplex: usize) -> &[I] {
        &self.entries[self.starts[simplex]..self.starts[simplex + 1]]
    }
}

/// Completes `arrays` with the relations of the dimensions 0, 1, …, d − 1, at the width that the list offsets need.
pub(crate) fn pack<I: Index>(arrays: SigArrays<I>, relations: Vec<Relations<I>>) -> Arrays
where
    Arrays: From<SigArrays<I>>,
{
    let mut len = 0;
    for (p, relations) in relations.iter().enumerate() {
        for simplex in 0..arrays.ids(p).len() {
            let list = relations.of(simplex);
            len += if is_flagged(&arrays.first, p, list) { 0 } else { list.len() + 1 };
        }
    }
    if I::from_usize(len).is_some() {
        write(arrays, relations, len).into()
    } else {
        write(arrays.widen(), relations, len).into()
    }
}

/// Whether `list`, of a p-simplex, is written as a pointer: one entry, of dimension d, and not of the next dimension.
fn is_flagged<I: Index>(first: &[usize], p: Dim, list: &[I]) -> bool {
    let dim = first.len() - 1;
    p + 1 < dim && matches!(list, [top] if top.to_usize() >= first[dim])
}

/// Completes `arrays`; the lists take `len` entries, stop codes included.
fn write<I: Index, J: Index>(mut arrays: SigArrays<I>, relations: Vec<Relations<J>>, len: usize) -> SigArrays<I> {
    let Some(&num_pointers) = arrays.first.last() else { return arrays };
    arrays.lists = Vec::with_capacity(len);
    arrays.pointers = Vec::with_capacity(num_pointers);
    arrays.flags = vec![0; num_pointers.div_ceil(8)];
    for (p, relations) in relations.into_iter().enumerate() {
        for simplex in 0..arrays.ids(p).len() {
            let list = relations.of(simplex);
            if is_flagged(&arrays.first, p, list) {
                let id = arrays.pointers.len();
                arrays.flags[id / 8] |= 1 << (id % 8);
                arrays.pointers.push(index(list[0].to_usize()));
            } else {
                arrays.pointers.push(index(arrays.lists.len()));
                arrays.lists.extend(list.iter().map(|entry| index::<I>(entry.to_usize())));
                arrays.lists.push(I::STOP);
            }
        }
    }
    arrays
}
