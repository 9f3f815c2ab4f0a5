//! The clusters of one dimension from those of the next, by union-find: for complexes in which many top simplices share
//! their faces, so that walking their stars would visit each face many times.
//!
//! A cluster of a (p+1)-simplex ρ lies in one cluster of each facet σ of ρ. So let an *item* be a triple (ρ, position of
//! the facet σ in ρ, cluster of ρ); the clusters of σ are the classes of its items under what joins them. Two facets ρ1
//! and ρ2 of a (p+2)-simplex η share one σ, and every cluster of η lies in a cluster of ρ1 and in one of ρ2, which are one
//! at σ. Nothing else joins, but that all top (p+2)-simplices that contain ρ share it: as these are clusters of their own
//! at ρ and one cluster at any σ below, they count as one item from the start. The classes are found by union-find over
//! arithmetic item numbers, on all threads ([`Sets`]).
//!
//! The least item of a class names its representative: let T be the least top simplex of the class, ρ its least face of
//! dimension p + 1 that contains σ, and ρ' the least such face of all top simplices of the class. If ρ' came before ρ, a
//! top simplex with the face ρ' would come before T in lexicographic order; so they are the same, and T is the
//! representative of the first cluster at ρ that is in the class.

use std::cmp::Reverse;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::clusters::sets::{Cell, Sets};
use crate::build::limits::Stage;
use crate::build::lists::Part;
use crate::build::{SigArrays, cofaces, index};

/// Simplices that one task handles.
const TASK: usize = 1 << 13;

/// The relations of the dimensions 0, 1, …, d − 2. In dimension d − 1 they are the cofacets.
pub(super) fn find<I: Cell>(arrays: &SigArrays<I>, stage: &Stage<'_>) -> Vec<Relations<I>> {
    let Some(dim) = arrays.dim().filter(|&dim| dim > 0) else { return Vec::new() };
    // From dimension d downwards. The cofacets of a (d − 1)-simplex are of dimension d, and count as one cluster.
    let mut levels = vec![Clusters::one_each(Vec::new()), Clusters::one_each(cofaces::least(arrays, dim))];
    stage.add(1);
    let mut up = Up::Zero;
    for p in (0..dim - 1).rev() {
        let level = Level { arrays, p, above: &levels, up: &up };
        let (relations, classes) =
            if level.num_items() <= Sets::<u32>::MOST_ITEMS { level.find::<u32>() } else { level.find::<u64>() };
        up = classes;
        let first_above = arrays.ids(p + 2).start;
        levels.push(Clusters::new(relations, first_above));
        let done = levels.len() - 3;
        levels[done].starts = Vec::new();
        stage.add(1);
    }
    levels.drain(2..).rev().map(|clusters| clusters.relations).collect()
}

/// The relations C\*(σ) of all simplices σ of one dimension.
pub(super) struct Relations<I> {
    /// Where the entries of each simplex start, and the end; empty if every simplex has one.
    starts: Vec<usize>,
    /// Representatives of clusters, by decreasing dimension, then increasing id.
    entries: Vec<I>,
}

impl<I> Relations<I> {
    /// The entries of simplex number `simplex` of the dimension.
    fn of(&self, simplex: usize) -> &[I] {
        let range = match self.starts.get(simplex..simplex + 2) {
            Some(&[start, end]) => start..end,
            _ => simplex..simplex + 1,
        };
        // Of dimension d nothing is stored.
        self.entries.get(range).unwrap_or(&[])
    }
}

/// Writes the lists of a range of simplices below dimension d − 1; `first` holds the first id of each dimension.
pub(super) fn write<I: Index>(relations: &[Relations<I>], first: &[usize], ids: Range<usize>, part: &mut Part<I>) {
    for (relations, range) in relations.iter().zip(first.windows(2)) {
        for id in ids.start.max(range[0])..ids.end.min(range[1]) {
            part.push(relations.of(id - range[0]));
        }
    }
}

/// The clusters of the simplices of one dimension q. They are the entries of the relation, except that those of
/// dimension q + 1 count as one, and that a top simplex is a cluster of its own.
struct Clusters<I> {
    relations: Relations<I>,
    /// Where the clusters of each simplex start, numbered through the dimension, and the end; empty if every simplex has
    /// one.
    starts: Vec<usize>,
}

impl<I: Index> Clusters<I> {
    /// One for each simplex, with the given representatives, or with the simplices themselves as such.
    fn one_each(entries: Vec<I>) -> Self {
        Self { relations: Relations { starts: Vec::new(), entries }, starts: Vec::new() }
    }

    /// The clusters for `relations` between dimension q and others, if the dimension q + 2 starts at `first_above`.
    fn new(relations: Relations<I>, first_above: usize) -> Self {
        let mut starts = Vec::with_capacity(relations.starts.len());
        starts.push(0);
        let mut next = 0;
        for range in relations.starts.windows(2) {
            let list = &relations.entries[range[0]..range[1]];
            next += (num_high(list, first_above) + 1).min(list.len().max(1));
            starts.push(next);
        }
        if next + 1 == starts.len() {
            starts = Vec::new();
        }
        Self { relations, starts }
    }

    #[inline]
    fn of(&self, simplex: usize) -> Range<usize> {
        match self.starts.get(simplex..simplex + 2) {
            Some(&[start, end]) => start..end,
            _ => simplex..simplex + 1,
        }
    }
}

/// The number of entries of a list that are `first_above` or more; they stand first.
fn num_high<I: Index>(list: &[I], first_above: usize) -> usize {
    list.iter().take_while(|entry| entry.to_usize() >= first_above).count()
}

/// For each item the number of its class at the facet, where the classes of dimension p + 1 count as one.
enum Up {
    /// All 0.
    Zero,
    Narrow(Sets<u32>),
    Wide(Sets<u64>),
}

impl Up {
    #[inline]
    fn class(&self, item: usize) -> usize {
        match self {
            Self::Zero => 0,
            Self::Narrow(sets) => sets.class(item),
            Self::Wide(sets) => sets.class(item),
        }
    }
}

impl From<Sets<u32>> for Up {
    fn from(sets: Sets<u32>) -> Self {
        Self::Narrow(sets)
    }
}

impl From<Sets<u64>> for Up {
    fn from(sets: Sets<u64>) -> Self {
        Self::Wide(sets)
    }
}

/// What the relations of dimension p are found from.
struct Level<'a, I> {
    arrays: &'a SigArrays<I>,
    p: Dim,
    /// The clusters from dimension d down to p + 1.
    above: &'a [Clusters<I>],
    /// The classes of the items of dimension p + 1.
    up: &'a Up,
}

impl<I: Cell> Level<'_, I> {
    /// The clusters of the simplices of dimension p + 1.
    fn clusters(&self) -> &Clusters<I> {
        &self.above[self.above.len() - 1]
    }

    fn num_items(&self) -> usize {
        let count = self.arrays.ids(self.p + 1).len();
        self.clusters().starts.last().copied().unwrap_or(count) * (self.p + 2)
    }

    /// The relations, and the classes of the items. Items are numbered with `U`.
    fn find<U: Cell>(&self) -> (Relations<I>, Up)
    where
        Up: From<Sets<U>>,
    {
        let sets = Sets::<U>::new(self.num_items());
        self.join(&sets);
        let counts = self.count_roots(&sets);
        let (starts, entries) = self.gather(&sets, counts);
        if self.p > 0 {
            tasks(0..self.num_items()).for_each(|items| items.for_each(|item| sets.resolve(item)));
            (Relations { starts, entries }, sets.into())
        } else {
            (Relations { starts, entries }, Up::Zero)
        }
    }

    /// Joins the items that a (p+2)-simplex joins.
    fn join<U: Cell>(&self, sets: &Sets<U>) {
        let of_cofaces = &self.above[self.above.len() - 2];
        let q = self.p + 2;
        let clusters = self.clusters();
        let first_facet = self.arrays.first[self.p + 1];
        let rows = self.arrays.facets(q);
        tasks(0..self.arrays.ids(q).len()).for_each(|cofaces| {
            // For each facet the number of its first item, and how many there are for a position.
            let mut facet_items = vec![(0, 0); q + 1];
            let mut first_items = vec![0; q + 1];
            for coface in cofaces {
                let facets = &rows[coface * (q + 1)..][..q + 1];
                for (items, facet) in facet_items.iter_mut().zip(facets) {
                    let of_facet = clusters.of(facet.to_usize() - first_facet);
                    *items = (of_facet.start * q, of_facet.len());
                }
                let of_coface = of_cofaces.of(coface);
                let count = of_coface.len();
                for cluster in 0..count {
                    for (i, (first, items)) in first_items.iter_mut().zip(&facet_items).enumerate() {
                        *first = items.0 + self.up.class(of_coface.start * (q + 1) + i * count + cluster);
                    }
                    for j in 1..=q {
                        for i in 0..j {
                            let (a, b) =
                                (first_items[i] + (j - 1) * facet_items[i].1, first_items[j] + i * facet_items[j].1);
                            sets.join(a, b);
                        }
                    }
                }
            }
        });
    }

    /// The number of classes of each simplex of dimension p, at its number plus two.
    fn count_roots<U: Cell>(&self, sets: &Sets<U>) -> Vec<AtomicUsize> {
        let count = self.arrays.ids(self.p).len();
        let counts: Vec<AtomicUsize> = (0..count + 2).map(|_| AtomicUsize::new(0)).collect();
        self.for_each_item(|item, facet, _| {
            if sets.settle(item) {
                counts[facet + 2].fetch_add(1, Ordering::Relaxed);
            }
        });
        counts
    }

    /// The representatives of the classes: where those of each simplex start, and all of them. Numbers the classes.
    fn gather<U: Cell>(&self, sets: &Sets<U>, counts: Vec<AtomicUsize>) -> (Vec<usize>, Vec<I>) {
        let mut starts = counts;
        let mut end = 0;
        for start in &mut starts {
            end += *start.get_mut();
            *start.get_mut() = end;
        }
        let entries: Vec<I::Shared> = (0..end).map(|_| I::ZERO.share()).collect();
        let roots: Vec<U::Shared> = (0..end).map(|_| U::ZERO.share()).collect();
        self.for_each_item(|item, facet, representative| {
            if sets.is_root(item) {
                // What starts at the next simplex, when all is filled in.
                let place = starts[facet + 1].fetch_add(1, Ordering::Relaxed);
                I::store(&entries[place], representative());
                U::store(&roots[place], index(item));
            }
        });
        let mut starts: Vec<usize> = starts.into_iter().map(AtomicUsize::into_inner).collect();
        starts.pop();
        tasks(0..starts.len() - 1).for_each(|simplices| {
            let mut list = Vec::new();
            for simplex in simplices {
                let range = starts[simplex]..starts[simplex + 1];
                self.order(&entries[range.clone()], &roots[range], sets, &mut list);
            }
        });
        (starts, entries.into_iter().map(I::into_inner).collect())
    }

    /// Orders the entries of one simplex, and numbers its classes.
    fn order<U: Cell>(&self, entries: &[I::Shared], roots: &[U::Shared], sets: &Sets<U>, list: &mut Vec<(I, U)>) {
        if entries.len() > 1 {
            list.clear();
            list.extend(entries.iter().zip(roots).map(|(entry, root)| (I::load(entry), U::load(root))));
            let (mut least, mut most) = (list[0].0, list[0].0);
            for &(top, _) in &*list {
                (least, most) = (least.min(top), most.max(top));
            }
            if self.dim_of(least) == self.dim_of(most) {
                list.sort_unstable();
            } else {
                list.sort_unstable_by_key(|&(top, _)| (Reverse(self.dim_of(top)), top));
            }
            for (entry, &(top, _)) in entries.iter().zip(&*list) {
                I::store(entry, top);
            }
            let first_above = self.arrays.ids(self.p + 2).start;
            let num_high = list.iter().take_while(|(top, _)| top.to_usize() >= first_above).count();
            for (class, &(_, root)) in list.iter().enumerate() {
                sets.name(root.to_usize(), class.min(num_high));
            }
        } else if let [root] = roots {
            sets.name(U::load(root).to_usize(), 0);
        }
    }

    /// Calls `visit` with every item, the number of its facet within dimension p, and a function that finds the least top
    /// simplex of its cluster; on all threads.
    fn for_each_item(&self, visit: impl Fn(usize, usize, &dyn Fn() -> I) + Sync) {
        let q = self.p + 1;
        let (clusters, rows) = (self.clusters(), self.arrays.facets(q));
        let (first, first_facet) = (self.arrays.first[q], self.arrays.first[self.p]);
        tasks(0..self.arrays.ids(q).len()).for_each(|simplices| {
            for simplex in simplices {
                let of_simplex = clusters.of(simplex);
                let mut item = of_simplex.start * (q + 1);
                for facet in &rows[simplex * (q + 1)..][..q + 1] {
                    for cluster in 0..of_simplex.len() {
                        let representative = || {
                            let list = clusters.relations.of(simplex);
                            list.get(cluster).copied().unwrap_or_else(|| index(first + simplex))
                        };
                        visit(item, facet.to_usize() - first_facet, &representative);
                        item += 1;
                    }
                }
            }
        });
    }

    fn dim_of(&self, id: I) -> Dim {
        self.arrays.first.partition_point(|&first| first <= id.to_usize())
    }
}

/// The range in pieces, on all threads.
fn tasks(range: Range<usize>) -> impl ParallelIterator<Item = Range<usize>> {
    let end = range.end;
    (0..range.len().div_ceil(TASK)).into_par_iter().map(move |task| {
        let start = range.start + task * TASK;
        start..end.min(start + TASK)
    })
}
