//! The clusters of one dimension from those of the next, by union-find: for complexes in which many top simplices share
//! their faces, so that walking their stars would visit each face many times.
//!
//! A cluster of a (p+1)-simplex ρ lies in one cluster of each facet σ of ρ. So let an *item* be a triple (ρ, position of
//! the facet σ in ρ, cluster of ρ); the clusters of σ are the classes of its items under what joins them. Two facets ρ1
//! and ρ2 of a (p+2)-simplex η share one σ, and every cluster of η lies in a cluster of ρ1 and in one of ρ2, which are one
//! at σ. Nothing else joins, but that all top (p+2)-simplices that contain ρ share it: as these are clusters of their own
//! at ρ and one cluster at any σ below, they count as one item from the start. The classes are found by union-find over
//! arithmetic item numbers.

use std::cmp::Reverse;
use std::ops::Range;

use sig_core::{Dim, Index};

use crate::build::limits::Stage;
use crate::build::lists::Part;
use crate::build::{SigArrays, index};

/// The relations of the dimensions 0, 1, …, d − 1.
pub(super) fn find<I: Index>(arrays: &SigArrays<I>, stage: &Stage<'_>) -> Vec<Relations<I>> {
    let Some(dim) = arrays.dim() else { return Vec::new() };
    // From dimension d downwards.
    let mut levels = vec![Clusters::of_tops(arrays.ids(dim).len())];
    let mut up = Vec::new();
    for p in (0..dim).rev() {
        let level = Level { arrays, p, above: &levels, up: &up };
        let (relations, classes) =
            if u32::from_usize(level.num_items()).is_some() { level.find::<u32>() } else { level.find::<u64>() };
        up = classes;
        let first_above = arrays.ids(p + 2).start;
        levels.push(Clusters::new(relations, first_above));
        if let Some(done) = levels.len().checked_sub(3) {
            levels[done].starts = Vec::new();
        }
        stage.add(1);
    }
    levels.drain(1..).rev().map(|clusters| clusters.relations).collect()
}

/// The relations C\*(σ) of all simplices σ of one dimension.
pub(super) struct Relations<I> {
    /// Where the entries of each simplex start, and the end.
    starts: Vec<usize>,
    /// Representatives of clusters, by decreasing dimension, then increasing id.
    entries: Vec<I>,
}

impl<I> Relations<I> {
    /// The entries of simplex number `simplex` of the dimension.
    fn of(&self, simplex: usize) -> &[I] {
        &self.entries[self.starts[simplex]..self.starts[simplex + 1]]
    }
}

/// Writes the lists of a range of simplices below dimension d; `first` holds the first id of each dimension.
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
    /// Where the clusters of each simplex start, numbered through the dimension, and the end.
    starts: Vec<usize>,
}

impl<I: Index> Clusters<I> {
    /// `count` top simplices.
    fn of_tops(count: usize) -> Self {
        Self { relations: Relations { starts: vec![0; count + 1], entries: Vec::new() }, starts: (0..=count).collect() }
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
        Self { relations, starts }
    }

    fn of(&self, simplex: usize) -> Range<usize> {
        self.starts[simplex]..self.starts[simplex + 1]
    }
}

/// The number of entries of a list that are `first_above` or more; they stand first.
fn num_high<I: Index>(list: &[I], first_above: usize) -> usize {
    list.iter().take_while(|entry| entry.to_usize() >= first_above).count()
}

/// What the relations of dimension p are found from.
struct Level<'a, I> {
    arrays: &'a SigArrays<I>,
    p: Dim,
    /// The clusters from dimension d down to p + 1.
    above: &'a [Clusters<I>],
    /// For each item of dimension p + 1 the number of its class at the facet.
    up: &'a [I],
}

impl<I: Index> Level<'_, I> {
    /// The clusters of the simplices of dimension p + 1.
    fn clusters(&self) -> &Clusters<I> {
        &self.above[self.above.len() - 1]
    }

    fn num_items(&self) -> usize {
        self.clusters().starts.last().map_or(0, |count| count * (self.p + 2))
    }

    /// The relations, and for each item the number of its class at the facet. Items are numbered with `U`.
    fn find<U: Index>(&self) -> (Relations<I>, Vec<I>) {
        let mut sets = Sets::<U>::new(self.num_items());
        self.join(&mut sets);
        // The least top simplex of each class, at its root; then the number of the class.
        let mut classes = vec![I::STOP; self.num_items()];
        let mut starts = vec![0; self.arrays.ids(self.p).len() + 1];
        self.for_each_item(|item, facet, representative| {
            let root = sets.root(item);
            classes[root] = classes[root].min(representative);
            starts[facet + 1] += usize::from(root == item);
        });
        for facet in 1..starts.len() {
            starts[facet] += starts[facet - 1];
        }
        let mut roots = vec![(I::ZERO, U::ZERO); starts[starts.len() - 1]];
        let mut next = starts.clone();
        self.for_each_item(|item, facet, _| {
            if sets.root(item) == item {
                roots[next[facet]] = (classes[item], index(item));
                next[facet] += 1;
            }
        });
        drop(next);
        let first_above = self.arrays.ids(self.p + 2).start;
        for range in starts.windows(2) {
            let roots = &mut roots[range[0]..range[1]];
            roots.sort_unstable_by_key(|&(top, _)| (Reverse(self.dim_of(top)), top));
            let num_high = roots.iter().take_while(|(top, _)| top.to_usize() >= first_above).count();
            for (class, (_, root)) in roots.iter().enumerate() {
                classes[root.to_usize()] = index(class.min(num_high));
            }
        }
        for item in 0..classes.len() {
            classes[item] = classes[sets.root(item)];
        }
        (Relations { starts, entries: roots.into_iter().map(|(top, _)| top).collect() }, classes)
    }

    /// Joins the items that a (p+2)-simplex joins.
    fn join<U: Index>(&self, sets: &mut Sets<U>) {
        let q = self.p + 2;
        let Some(of_cofaces) = self.above.len().checked_sub(2).map(|above| &self.above[above]) else { return };
        let clusters = self.clusters();
        let first_facet = self.arrays.first[self.p + 1];
        for (coface, facets) in self.arrays.facets(q).chunks_exact(q + 1).enumerate() {
            let of_coface = of_cofaces.of(coface);
            let count = of_coface.len();
            for cluster in 0..count {
                // The item of facet `i` of the coface, at the facet of that in position `position`.
                let item = |i: usize, position: usize| {
                    let of_facet = clusters.of(facets[i].to_usize() - first_facet);
                    let up = self.up[of_coface.start * (q + 1) + i * count + cluster].to_usize();
                    of_facet.start * q + position * of_facet.len() + up
                };
                for j in 1..=q {
                    for i in 0..j {
                        sets.join(item(i, j - 1), item(j, i));
                    }
                }
            }
        }
    }

    /// Calls `visit` with every item, the number of its facet within dimension p, and a top simplex of its cluster.
    fn for_each_item(&self, mut visit: impl FnMut(usize, usize, I)) {
        let q = self.p + 1;
        let (clusters, facets) = (self.clusters(), self.arrays.facets(q));
        for (simplex, id) in self.arrays.ids(q).enumerate() {
            let of_simplex = clusters.of(simplex);
            let list = clusters.relations.of(simplex);
            let mut item = of_simplex.start * (q + 1);
            for position in 0..=q {
                let facet = facets[simplex * (q + 1) + position].to_usize() - self.arrays.first[self.p];
                for cluster in 0..of_simplex.len() {
                    visit(item, facet, list.get(cluster).copied().unwrap_or_else(|| index(id)));
                    item += 1;
                }
            }
        }
    }

    fn dim_of(&self, id: I) -> Dim {
        self.arrays.first.partition_point(|&first| first <= id.to_usize())
    }
}

/// Disjoint sets of items, by halving paths to the root; the root is the least item.
struct Sets<U> {
    parents: Vec<U>,
}

impl<U: Index> Sets<U> {
    fn new(count: usize) -> Self {
        Self { parents: (0..count).map(index).collect() }
    }

    fn root(&mut self, mut item: usize) -> usize {
        loop {
            let parent = self.parents[item].to_usize();
            if parent == item {
                return item;
            }
            self.parents[item] = self.parents[parent];
            item = parent;
        }
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b)] = index(a.min(b));
    }
}
