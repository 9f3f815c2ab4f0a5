//! The top simplices among the cofacets of each simplex, clusters of their own: the facets of the top simplices of one
//! dimension, transposed.
//!
//! Those of the (d − 1)-simplices are nearly all that the lists of a mesh or of a flag complex hold; so they are counted
//! and written where they belong, [`Cofacets`]. Of the other dimensions few simplices are top, as a rule, and most facets
//! have no cofacet: [`FewCofacets`].

mod columns;

use std::ops::Range;

use rayon::prelude::*;
use sig_core::{Dim, Index};

use columns::{Columns, inboxes, task_size};

use crate::build::clusters::Cell;
use crate::build::{SigArrays, index, widen};

/// Simplices that are looked through at a time.
const CHUNK: usize = 1 << 14;
/// Facets that are looked through for one in [`FewCofacets`], as a power of two.
const PAGE_BITS: u32 = 6;

/// The simplices of dimension d among the cofacets of each (d − 1)-simplex.
pub(super) struct Cofacets<I> {
    /// Where the list of each starts, by id; nothing of those of lower dimensions.
    pub(super) pointers: Vec<I>,
    /// The first (d − 1)-simplex.
    pub(super) first: usize,
    /// The lists, increasing, each ended by the stop code.
    pub(super) lists: Vec<I>,
}

/// Of no simplices.
impl<I> Default for Cofacets<I> {
    fn default() -> Self {
        Self { pointers: Vec::new(), first: 0, lists: Vec::new() }
    }
}

impl<I: Index> Cofacets<I> {
    /// The cofacets of simplex number `facet` of its dimension.
    #[inline]
    pub(super) fn of(&self, facet: usize) -> &[I] {
        let list = &self.lists[self.pointers[self.first + facet].to_usize()..];
        &list[..list.iter().position(|&entry| entry == I::STOP).unwrap_or(0)]
    }

    /// The same with wider indices.
    pub(super) fn widen(self) -> Cofacets<u64> {
        Cofacets { pointers: widen(self.pointers), first: self.first, lists: widen(self.lists) }
    }
}

/// The top simplices of a dimension g < d among the cofacets of the (g − 1)-simplices that have some.
pub(super) struct FewCofacets<I> {
    /// Pairs of a facet and a cofacet, increasing: the numbers of the facets in their dimension,
    facets: Vec<I>,
    /// and the cofacets.
    tops: Vec<I>,
    /// Where the pairs of every so many facets start.
    pages: Vec<I>,
}

/// Of no simplices.
impl<I> Default for FewCofacets<I> {
    fn default() -> Self {
        Self { facets: Vec::new(), tops: Vec::new(), pages: Vec::new() }
    }
}

impl<I: Index> FewCofacets<I> {
    /// From increasing pairs.
    fn new(pairs: &[Vec<(I, I)>], num_facets: usize) -> Self {
        let pairs = || pairs.iter().flatten();
        let mut pages = vec![0; (num_facets >> PAGE_BITS) + 2];
        pairs().for_each(|(facet, _)| pages[(facet.to_usize() >> PAGE_BITS) + 1] += 1);
        let mut start = 0;
        let pages = pages.into_iter().map(|count| {
            start += count;
            index(start)
        });
        Self {
            pages: pages.collect(),
            facets: pairs().map(|&(facet, _)| facet).collect(),
            tops: pairs().map(|&(_, top)| top).collect(),
        }
    }

    /// The cofacets of simplex number `facet` of its dimension.
    pub(super) fn of(&self, facet: usize) -> &[I] {
        let page = facet >> PAGE_BITS;
        let Some(&[start, end]) = self.pages.get(page..page + 2) else { return &[] };
        let (start, end) = (start.to_usize(), end.to_usize());
        let before = start + self.facets[start..end].partition_point(|other| other.to_usize() < facet);
        let len = self.facets[before..end].iter().take_while(|other| other.to_usize() == facet).count();
        &self.tops[before..before + len]
    }

    /// The facets that have cofacets from number `from` on, each with one of these.
    pub(super) fn pairs_from(&self, from: usize) -> impl Iterator<Item = (usize, I)> {
        let start = self.facets.partition_point(|facet| facet.to_usize() < from);
        self.facets[start..].iter().map(|facet| facet.to_usize()).zip(self.tops[start..].iter().copied())
    }
}

/// The entries of all the lists with their stop codes, if all simplices of dimension `dim` > 0 are top.
pub(super) fn len<I: Index>(arrays: &SigArrays<I>, dim: Dim) -> usize {
    arrays.ids(dim).len() * (dim + 1) + arrays.ids(dim - 1).len()
}

/// The cofacets of the simplices of dimension `dim` − 1, where `dim` is d > 0. Their number must fit the index type. Each
/// simplex of dimension `dim` is told once to a visitor: its number, and the positions in it of the vertices that those of
/// its facets leave out which one before it has too.
pub(super) fn find<I: Index, V: Send>(
    arrays: &SigArrays<I>,
    dim: Dim,
    new_visitor: impl Fn() -> V + Sync,
    visit: impl Fn(&mut V, usize, u32) + Sync,
) -> (Cofacets<I>, Vec<V>) {
    find_all(&Columns::new(arrays, dim, task_size(arrays, dim), |tops| tops), new_visitor, visit)
}

fn find_all<I: Index, V: Send>(
    columns: &Columns<'_, I, impl Fn(Range<usize>) -> Range<usize> + Sync>,
    new_visitor: impl Fn() -> V + Sync,
    visit: impl Fn(&mut V, usize, u32) + Sync,
) -> (Cofacets<I>, Vec<V>) {
    let outboxes = columns.deal();
    let inboxes = inboxes(&columns.tasks, &outboxes);
    let lens: Vec<usize> = columns
        .tasks
        .iter()
        .zip(&inboxes)
        .zip(&outboxes)
        .map(|((task, inbox), outbox)| {
            let sent: usize = outbox.values().map(Vec::len).sum();
            let received: usize = inbox.iter().map(|pairs| pairs.len()).sum();
            task.facets.len() + task.tops.len() * (columns.dim + 1) + received - sent
        })
        .collect();
    let mut all = Cofacets {
        pointers: vec![I::ZERO; columns.first_top],
        first: columns.first_facet,
        lists: vec![I::ZERO; lens.iter().sum()],
    };
    let (mut pointers, mut lists, mut offset) = (&mut all.pointers[all.first..], all.lists.as_mut_slice(), 0);
    let mut jobs = Vec::with_capacity(lens.len());
    for ((task, inbox), len) in columns.tasks.iter().zip(&inboxes).zip(lens) {
        let pointers = pointers.split_off_mut(..task.facets.len()).unwrap_or_default();
        let lists = lists.split_off_mut(..len).unwrap_or_default();
        jobs.push((task, inbox, pointers, lists, offset));
        offset += len;
    }
    let transposed = jobs.into_par_iter().map(|(task, inbox, pointers, lists, offset)| {
        let mut visitor = new_visitor();
        let tell = |top, shared| visit(&mut visitor, top, shared);
        let others = columns.transpose(task, inbox, pointers, lists, offset, tell);
        (visitor, others)
    });
    let (mut visitors, others): (Vec<V>, Vec<_>) = transposed.unzip();
    visitors.extend(columns.visit_others(&others, |facet| all.of(facet), &new_visitor, &visit));
    (all, visitors)
}

/// The same of a dimension below d, for the `tops` alone, by increasing number.
pub(super) fn find_few<I: Index, V: Send>(
    arrays: &SigArrays<I>,
    dim: Dim,
    tops: &[I],
    new_visitor: impl Fn() -> V + Sync,
    visit: impl Fn(&mut V, usize, u32) + Sync,
) -> (FewCofacets<I>, Vec<V>) {
    let place = |number: usize| tops.partition_point(|top| top.to_usize() < number);
    let wanted = |range: Range<usize>| tops[place(range.start)..place(range.end)].iter().map(|top| top.to_usize());
    find_wanted(&Columns::new(arrays, dim, task_size(arrays, dim), wanted), new_visitor, visit)
}

fn find_wanted<I: Index, V: Send, R: Iterator<Item = usize>>(
    columns: &Columns<'_, I, impl Fn(Range<usize>) -> R + Sync>,
    new_visitor: impl Fn() -> V + Sync,
    visit: impl Fn(&mut V, usize, u32) + Sync,
) -> (FewCofacets<I>, Vec<V>) {
    let outboxes = columns.deal();
    let inboxes = inboxes(&columns.tasks, &outboxes);
    let room = || (Vec::new(), Vec::new());
    let transposed = columns.tasks.par_iter().zip(&inboxes).map_init(room, |(pointers, lists), (task, inbox)| {
        let (mut visitor, mut others, mut pairs) = (new_visitor(), Vec::new(), Vec::new());
        let most = (columns.wanted)(task.tops.clone()).count() * (columns.dim + 1)
            + inbox.iter().map(|pairs| pairs.len()).sum::<usize>();
        if most > 0 {
            pointers.resize(task.facets.len().max(pointers.len()), I::ZERO);
            let pointers = &mut pointers[..task.facets.len()];
            lists.clear();
            lists.resize(task.facets.len() + most, I::STOP);
            let tell = |top, shared| visit(&mut visitor, top, shared);
            others = columns.transpose(task, inbox, pointers, lists, 0, tell);
            for (facet, pointer) in task.facets.clone().zip(pointers) {
                let list = lists[pointer.to_usize()..].iter().take_while(|&&top| top != I::STOP);
                pairs.extend(list.map(|&top| (index(facet), top)));
            }
        }
        (pairs, (visitor, others))
    });
    let (pairs, told): (Vec<_>, Vec<_>) = transposed.unzip();
    let (mut visitors, others): (Vec<V>, Vec<_>) = told.into_iter().unzip();
    let all = FewCofacets::new(&pairs, columns.num_facets());
    visitors.extend(columns.visit_others(&others, |facet| all.of(facet), &new_visitor, &visit));
    (all, visitors)
}

/// The first cofacet of each simplex of dimension `dim` − 1, where `dim` is d > 0; its own id if it has none.
pub(super) fn least<I: Cell>(arrays: &SigArrays<I>, dim: Dim) -> Vec<I> {
    let facets = arrays.ids(dim - 1);
    let least: Vec<I::Shared> = facets.clone().into_par_iter().map(|_| I::STOP.share()).collect();
    let rows = arrays.facets(dim).par_chunks_exact(dim + 1).with_min_len(CHUNK);
    rows.enumerate().for_each(|(top, row)| {
        let top: I = index(arrays.first[dim] + top);
        for facet in row {
            let least = &least[facet.to_usize() - facets.start];
            if I::load(least) > top {
                I::lower(least, top);
            }
        }
    });
    let found = least.into_par_iter().map(I::into_inner).zip(facets);
    found.map(|(least, facet)| if least == I::STOP { index(facet) } else { least }).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::build::{Arrays, BuildOptions, build};
    use crate::soup::{Labels, Soup};

    proptest! {
        /// Of all simplices of a dimension and of some, in tasks of any size.
        #[test]
        fn cofacets_are_the_facets_transposed(
            simplices in prop::collection::vec(prop::collection::btree_set(0_u32..14, 2..6), 1..30),
            size in prop::sample::select(vec![1_usize, 3, 10, 1000]),
            every in 1_usize..4,
        ) {
            let mut soup = Soup::new(Labels::Numbered(14), true);
            simplices.into_iter().for_each(|simplex| soup.push(&simplex.into_iter().collect::<Vec<_>>()));
            let Ok(Arrays::Narrow(arrays)) = build(soup, &BuildOptions::default()).map(|built| built.arrays) else {
                panic!("a small complex");
            };
            for dim in 1..arrays.first.len() {
                let (ids, facets) = (arrays.ids(dim), arrays.ids(dim - 1));
                let tops: Vec<usize> = (0..ids.len()).step_by(every).collect();
                let row = |top: usize| &arrays.facets(dim)[top * (dim + 1)..][..dim + 1];
                let list = |facet: usize| -> Vec<u32> {
                    let tops = tops.iter().filter(|&&top| row(top).contains(&u32::try_from(facet).unwrap()));
                    tops.map(|&top| u32::try_from(ids.start + top).unwrap()).collect()
                };
                let lists: Vec<Vec<u32>> = facets.clone().map(list).collect();
                let is_shared = |top: usize, facet: u32| {
                    lists[facet as usize - facets.start][0] as usize != ids.start + top
                };
                let shared: Vec<(usize, u32)> = tops.iter().map(|&top| {
                    let shared = (0..).zip(row(top)).map(|(i, &facet)| u32::from(is_shared(top, facet)) << i);
                    (top, shared.sum())
                }).collect();
                let wanted = |range: Range<usize>| {
                    tops[range.start.div_ceil(every)..range.end.div_ceil(every)].iter().copied()
                };
                let columns = Columns::new(&arrays, dim, size, wanted);
                let (few, told) = find_wanted(&columns, Vec::new, |told, top, shared| told.push((top, shared)));
                let mut told = told.concat();
                told.sort_unstable();
                prop_assert_eq!(&told, &shared);
                for (facet, list) in lists.iter().enumerate() {
                    prop_assert_eq!(few.of(facet), list);
                    let from = few.pairs_from(facet).take_while(|&(other, _)| other == facet);
                    prop_assert_eq!(&from.map(|(_, top)| top).collect::<Vec<_>>(), list);
                }
                if every == 1 {
                    let columns = Columns::new(&arrays, dim, size, |tops| tops);
                    let (all, told) = find_all(&columns, Vec::new, |told, top, shared| told.push((top, shared)));
                    let mut told = told.concat();
                    told.sort_unstable();
                    prop_assert_eq!(told, shared);
                    for (facet, list) in lists.iter().enumerate() {
                        prop_assert_eq!(all.of(facet), list);
                    }
                    prop_assert_eq!(all.lists.len(), len(&arrays, dim));
                    let first = lists.iter().zip(facets).map(|(list, id)| list.first().map_or(id, |&top| top as usize));
                    let least: Vec<usize> = least(&arrays, dim).into_iter().map(|id| id as usize).collect();
                    prop_assert_eq!(least, first.collect::<Vec<_>>());
                }
            }
        }
    }
}
