//! The clusters of one dimension from those of the next, by union-find: for complexes in which many top simplices share
//! their faces, so that walking their stars would visit each face many times.
//!
//! A cluster of a (p+1)-simplex ρ lies in one cluster of each facet σ of ρ. So let an *item* be a triple (ρ, position of
//! the facet σ in ρ, cluster of ρ); the clusters of σ are the classes of its items under what joins them. Two facets ρ1
//! and ρ2 of a (p+2)-simplex η share one σ, and every cluster of η lies in a cluster of ρ1 and in one of ρ2, which are one
//! at σ. Nothing else joins, but that all top (p+2)-simplices that contain ρ share it: as these are clusters of their own
//! at ρ and one cluster at any σ below, they count as one item from the start. The classes are found by union-find over
//! arithmetic item numbers, for the simplices σ of one first vertex at a time ([`Blocks`]).
//!
//! The least item of a class names its representative: let T be the least top simplex of the class, ρ its least face of
//! dimension p + 1 that contains σ, and ρ' the least such face of all top simplices of the class. If ρ' came before ρ, a
//! top simplex with the face ρ' would come before T in lexicographic order; so they are the same, and T is the
//! representative of the first cluster at ρ that is in the class.

use std::cmp::Reverse;
use std::ops::Range;

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::blocks::{Blocks, descendants, tasks};
use crate::build::clusters::sets::Sets;
use crate::build::limits::Stage;
use crate::build::lists::Part;
use crate::build::{SigArrays, cofaces, index, narrow};

/// Simplices of dimension p + 1 that one task handles, about.
const TASK: usize = 1 << 14;

/// The relations of the dimensions 0, 1, …, d − 2. In dimension d − 1 they are the cofacets.
pub(super) fn find<I: Index>(arrays: &SigArrays<I>, blocks: &Blocks, stage: &Stage<'_>) -> Vec<Relations<I>> {
    let Some(dim) = arrays.dim().filter(|&dim| dim > 0) else { return Vec::new() };
    // From dimension d downwards.
    let mut levels = vec![Clusters::one_each(Vec::new()), Clusters::one_each(cofaces::least(arrays, blocks, dim))];
    stage.add(1);
    let mut up = Up::none();
    for p in (0..dim - 1).rev() {
        let (relations, classes) = Level::new(arrays, blocks, p, &levels, &up).find();
        up = classes;
        levels.push(Clusters::new(relations, arrays.ids(p + 2).start));
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
    #[inline]
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
            next += count(list, num_high(list, first_above));
            starts.push(next);
        }
        if next + 1 == starts.len() {
            starts = Vec::new();
        }
        Self { relations, starts }
    }

    /// Where the clusters of a simplex start.
    #[inline]
    fn start(&self, simplex: usize) -> usize {
        self.starts.get(simplex).copied().unwrap_or(simplex)
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
#[inline]
fn num_high<I: Index>(list: &[I], first_above: usize) -> usize {
    list.iter().take_while(|entry| entry.to_usize() >= first_above).count()
}

/// The number of clusters for a list, as [`Clusters`] counts them.
#[inline]
fn count<I>(list: &[I], num_high: usize) -> usize {
    (num_high + 1).min(list.len().max(1))
}

/// For the clusters of the cofacets of a simplex of dimension q, in which cluster of that they lie. Nothing is stored of
/// simplices that have one.
struct Up<I> {
    /// Where those of each simplex start: as often as it has clusters beyond one; and the end.
    starts: Vec<usize>,
    /// The numbers of the cofacets, increasing, as often as they have clusters.
    cofacets: Vec<I>,
    /// The clusters, as [`Clusters`] counts them.
    classes: Vec<u32>,
}

impl<I: Index> Up<I> {
    fn none() -> Self {
        Self { starts: Vec::new(), cofacets: Vec::new(), classes: Vec::new() }
    }

    /// In which of the clusters `of_simplex` of a simplex that has several the given one of a cofacet lies.
    #[inline(never)]
    fn class(&self, simplex: usize, of_simplex: Range<usize>, (cofacet, cluster): (usize, usize)) -> usize {
        let before = of_simplex.start - simplex;
        let range = self.starts[before]..self.starts[before + of_simplex.len() - 1];
        let first = self.cofacets[range.clone()].partition_point(|other| other.to_usize() < cofacet);
        self.classes[range.start + first + cluster] as usize
    }
}

/// What the relations of dimension p < d − 1 are found from.
struct Level<'a, I> {
    arrays: &'a SigArrays<I>,
    blocks: &'a Blocks,
    p: Dim,
    /// The facets of the simplices of dimension p + 2.
    coface_rows: &'a [I],
    /// The clusters of the simplices of dimension p + 1, and in which of them those of dimension p + 2 lie.
    clusters: &'a Clusters<I>,
    up: &'a Up<I>,
    of_cofaces: &'a Clusters<I>,
    /// Where in the dimensions p, p + 1 and p + 2 the blocks start, and the descendants of the edges and triangles.
    simplex_blocks: Vec<usize>,
    cofacet_blocks: Vec<usize>,
    coface_blocks: Vec<usize>,
    cofacets_of_edges: Vec<usize>,
    cofaces_of_edges: Vec<usize>,
    /// By last vertex.
    cofaces_of_triangles: Vec<Range<usize>>,
    /// What is added (wrapping) to the number of a cluster of a descendant of an edge to make it an item of the block of
    /// the last vertex.
    of_edges: Vec<usize>,
    /// The items below those of the cofacets in the block itself.
    num_below: Vec<usize>,
}

/// The items of one block. First those of the cofacets with a vertex before it, in position 0; then those of the cofacets
/// in the block, which have no item in position 0.
struct Block {
    vertex: usize,
    /// What is added (wrapping) to p + 1 times the number of the first cluster of a cofacet to make it its first item.
    shift: usize,
    num_items: usize,
}

/// What one task found.
struct Found<I> {
    /// The number of entries for each simplex.
    counts: Vec<u32>,
    entries: Vec<I>,
    up: Up<I>,
}

/// Memory that a task reuses.
struct Scratch<I> {
    sets: Sets,
    /// For each simplex the first root and its representative, the stop code if none.
    roots: Vec<(I, usize)>,
    /// The others, with their simplices.
    more: Vec<(usize, I, usize)>,
    list: Vec<(I, usize)>,
    /// The classes of the roots at simplices with more than one.
    classes: Vec<u32>,
    /// The items at these simplices: simplex, cofacet, class.
    items: Vec<(usize, I, u32)>,
}

impl<I> Scratch<I> {
    fn new() -> Self {
        Self {
            sets: Sets::default(),
            roots: Vec::new(),
            more: Vec::new(),
            list: Vec::new(),
            classes: Vec::new(),
            items: Vec::new(),
        }
    }
}

impl<'a, I: Index> Level<'a, I> {
    /// `levels` are the clusters from dimension d down to p + 1.
    fn new(arrays: &'a SigArrays<I>, blocks: &'a Blocks, p: Dim, levels: &'a [Clusters<I>], up: &'a Up<I>) -> Self {
        let (of_cofaces, clusters) = (&levels[levels.len() - 2], &levels[levels.len() - 1]);
        let cofacets_of_edges = descendants(arrays, 1, p + 1);
        let mut of_edges = vec![0; arrays.ids(1).len()];
        let num_below = (0..arrays.ids(0).len()).map(|vertex| {
            let mut next = 0;
            for &edge in blocks.edges.of(vertex) {
                let start = clusters.start(cofacets_of_edges[edge]);
                of_edges[edge] = usize::wrapping_sub(next, start);
                next += clusters.start(cofacets_of_edges[edge + 1]) - start;
            }
            next
        });
        Self {
            num_below: num_below.collect(),
            of_edges,
            arrays,
            blocks,
            p,
            coface_rows: arrays.facets(p + 2),
            clusters,
            up,
            of_cofaces,
            simplex_blocks: descendants(arrays, 0, p),
            cofacet_blocks: descendants(arrays, 0, p + 1),
            coface_blocks: descendants(arrays, 0, p + 2),
            cofacets_of_edges,
            cofaces_of_edges: descendants(arrays, 1, p + 2),
            cofaces_of_triangles: blocks.triangles.ranges(&descendants(arrays, 2, p + 2)),
        }
    }

    /// The relations, and in which clusters those of the cofacets lie.
    fn find(&self) -> (Relations<I>, Up<I>) {
        let found: Vec<Found<I>> = tasks(&self.cofacet_blocks, TASK)
            .into_par_iter()
            .map_init(Scratch::new, |scratch, vertices| {
                let mut found = Found { counts: Vec::new(), entries: Vec::new(), up: Up::none() };
                for vertex in vertices {
                    let block = self.block(vertex);
                    scratch.sets.reset(block.num_items);
                    self.join_in_block(&block, &mut scratch.sets);
                    self.join_from_edges(&block, &mut scratch.sets);
                    self.join_from_triangles(&block, &mut scratch.sets);
                    self.gather(&block, scratch, &mut found);
                }
                found
            })
            .collect();
        let mut starts = Vec::with_capacity(self.arrays.ids(self.p).len() + 1);
        starts.push(0);
        let mut entries = Vec::with_capacity(found.iter().map(|found| found.entries.len()).sum());
        let mut up = Up::none();
        let mut end = 0;
        for found in found {
            for count in found.counts {
                end += count as usize;
                starts.push(end);
            }
            entries.extend_from_slice(&found.entries);
            up.starts.extend(found.up.starts.iter().map(|start| up.cofacets.len() + start));
            up.cofacets.extend_from_slice(&found.up.cofacets);
            up.classes.extend_from_slice(&found.up.classes);
        }
        up.starts.push(up.cofacets.len());
        (Relations { starts, entries }, up)
    }

    fn block(&self, vertex: usize) -> Block {
        let start = self.clusters.start(self.cofacet_blocks[vertex]);
        let end = self.clusters.start(self.cofacet_blocks[vertex + 1]);
        let below = self.num_below[vertex];
        Block {
            vertex,
            shift: below.wrapping_sub(start * (self.p + 1)),
            num_items: below + (end - start) * (self.p + 1),
        }
    }

    /// The number in the dimension of the first cluster of a cofacet, the number of its clusters, and in which of them the
    /// given one of a coface lies.
    #[inline(always)]
    fn up(&self, cofacet: I, coface: (usize, usize)) -> (usize, usize, usize) {
        let cofacet = cofacet.to_usize() - self.arrays.first[self.p + 1];
        let Range { start, end } = self.clusters.of(cofacet);
        let class = if end - start > 1 { self.up.class(cofacet, start..end, coface) } else { 0 };
        (start, end - start, class)
    }

    /// The item in position 1 of a cofacet in the block for a cluster of a coface, and the distance to that in the next
    /// position.
    #[inline(always)]
    fn item_in_block(&self, block: &Block, cofacet: I, coface: (usize, usize)) -> (usize, usize) {
        let (start, count, class) = self.up(cofacet, coface);
        (block.shift.wrapping_add(start * (self.p + 1) + class), count)
    }

    /// The item in position 0 of a cofacet that descends from `edge`, for a cluster of a coface.
    #[inline(always)]
    fn item_of_edge(&self, edge: usize, cofacet: I, coface: (usize, usize)) -> usize {
        let (start, _, class) = self.up(cofacet, coface);
        self.of_edges[edge].wrapping_add(start + class)
    }

    /// Calls `visit` with the facets of each coface in a range, and with the coface and each of its clusters.
    #[inline(always)]
    fn for_each_cluster(&self, cofaces: Range<usize>, mut visit: impl FnMut(&[I], (usize, usize))) {
        let len = self.p + 3;
        let rows = &self.coface_rows[cofaces.start * len..cofaces.end * len];
        for (coface, facets) in cofaces.zip(rows.chunks_exact(len)) {
            for cluster in 0..self.of_cofaces.of(coface).len() {
                visit(facets, (coface, cluster));
            }
        }
    }

    /// Joins what the cofaces in the block join.
    fn join_in_block(&self, block: &Block, sets: &mut Sets) {
        let cofaces = self.coface_blocks[block.vertex]..self.coface_blocks[block.vertex + 1];
        let mut items = Vec::with_capacity(self.p + 2);
        self.for_each_cluster(cofaces, |facets, coface| {
            items.clear();
            // Facets 1, 2, …
            for (j, &facet) in facets[1..].iter().enumerate() {
                let (item_j, step_j) = self.item_in_block(block, facet, coface);
                for (i, &(item_i, step_i)) in items.iter().enumerate() {
                    sets.join(item_i + (j - 1) * step_i, item_j + i * step_j);
                }
                items.push((item_j, step_j));
            }
        });
    }

    /// Joins what the cofaces with one vertex before the block join.
    fn join_from_edges(&self, block: &Block, sets: &mut Sets) {
        for &edge in self.blocks.edges.of(block.vertex) {
            let cofaces = self.cofaces_of_edges[edge]..self.cofaces_of_edges[edge + 1];
            self.for_each_cluster(cofaces, |facets, coface| {
                let (mut item, step) = self.item_in_block(block, facets[0], coface);
                for &facet in &facets[2..] {
                    sets.join(item, self.item_of_edge(edge, facet, coface));
                    item += step;
                }
            });
        }
    }

    /// Joins what the cofaces with two vertices before the block join.
    fn join_from_triangles(&self, block: &Block, sets: &mut Sets) {
        let cofaces = &self.cofaces_of_triangles[self.blocks.triangles.range(block.vertex)];
        for (cofaces, edges) in cofaces.iter().zip(self.blocks.edges_of_triangles(block.vertex)) {
            self.for_each_cluster(cofaces.clone(), |facets, coface| {
                let [a, b] = [0, 1].map(|i| self.item_of_edge(edges[i], facets[i], coface));
                sets.join(a, b);
            });
        }
    }

    /// Calls `visit` with every item of the block, in order, with the number of its simplex in the block, its cofacet, and
    /// the cluster of that.
    #[inline]
    fn for_each_item(&self, block: &Block, mut visit: impl FnMut(usize, usize, usize, usize)) {
        let (vertex, len) = (block.vertex, self.p + 2);
        let rows = self.arrays.facets(self.p + 1);
        let first = self.arrays.first[self.p] + self.simplex_blocks[vertex];
        let mut item = 0;
        let mut visit_position = |cofacet: usize, position: usize| {
            let simplex = rows[cofacet * len + position].to_usize() - first;
            for cluster in 0..self.clusters.of(cofacet).len() {
                visit(item, simplex, cofacet, cluster);
                item += 1;
            }
        };
        for &edge in self.blocks.edges.of(vertex) {
            for cofacet in self.cofacets_of_edges[edge]..self.cofacets_of_edges[edge + 1] {
                visit_position(cofacet, 0);
            }
        }
        for cofacet in self.cofacet_blocks[vertex]..self.cofacet_blocks[vertex + 1] {
            for position in 1..len {
                visit_position(cofacet, position);
            }
        }
    }

    /// The representatives of the classes of the block, in order; and the classes of the items, if there is a dimension
    /// below.
    fn gather(&self, block: &Block, scratch: &mut Scratch<I>, found: &mut Found<I>) {
        let Scratch { sets, roots, more, .. } = scratch;
        roots.clear();
        roots.resize(self.simplex_blocks[block.vertex + 1] - self.simplex_blocks[block.vertex], (I::STOP, 0));
        more.clear();
        let first_cofacet = self.arrays.first[self.p + 1];
        self.for_each_item(block, |item, simplex, cofacet, cluster| {
            if sets.settle(item) {
                let entries = self.clusters.relations.of(cofacet);
                let representative = entries.get(cluster).copied().unwrap_or_else(|| index(first_cofacet + cofacet));
                if roots[simplex].0 == I::STOP {
                    roots[simplex] = (representative, item);
                } else {
                    more.push((simplex, representative, item));
                }
            }
        });
        more.sort_unstable();
        let several = self.list(block, scratch, found);
        if several && self.p > 0 {
            self.list_items(block, scratch, found);
        }
    }

    /// Lists the representatives, and names the classes of simplices that have several; whether any has. These are marked
    /// in `roots` by the stop code.
    fn list(&self, block: &Block, scratch: &mut Scratch<I>, found: &mut Found<I>) -> bool {
        let Scratch { roots, more, list, classes, .. } = scratch;
        let first_above = self.arrays.ids(self.p + 2).start;
        let mut more = more.iter().peekable();
        let mut several = false;
        for (simplex, root) in roots.iter_mut().enumerate() {
            if more.peek().is_none_or(|other| other.0 != simplex) {
                found.counts.push(u32::from(root.0 != I::STOP));
                found.entries.extend((root.0 != I::STOP).then_some(root.0));
                continue;
            }
            list.clear();
            list.push(*root);
            while let Some(&(_, representative, item)) = more.next_if(|other| other.0 == simplex) {
                list.push((representative, item));
            }
            list.sort_unstable_by_key(|&(top, _)| (Reverse(self.dim_of(top)), top));
            let start = found.entries.len();
            found.entries.extend(list.iter().map(|&(top, _)| top));
            found.counts.push(narrow(list.len()));
            let list_of_tops = &found.entries[start..];
            let num_high = num_high(list_of_tops, first_above);
            if count(list_of_tops, num_high) > 1 {
                several = true;
                root.0 = I::STOP;
                classes.resize(classes.len().max(block.num_items), 0);
                for (class, &(_, root)) in list.iter().enumerate() {
                    classes[root] = narrow(class.min(num_high));
                }
            }
        }
        several
    }

    /// Lists the classes of the items of simplices that have several.
    fn list_items(&self, block: &Block, scratch: &mut Scratch<I>, found: &mut Found<I>) {
        let Scratch { sets, roots, classes, items, .. } = scratch;
        items.clear();
        self.for_each_item(block, |item, simplex, cofacet, _| {
            if roots[simplex].0 == I::STOP {
                items.push((simplex, index(cofacet), classes[sets.root_of_settled(item)]));
            }
        });
        // Stable, so that the cofacets and their clusters stay in order.
        items.sort_by_key(|&(simplex, ..)| simplex);
        let up = &mut found.up;
        for of_simplex in items.chunk_by(|a, b| a.0 == b.0) {
            let beyond_one = of_simplex.iter().map(|&(.., class)| class as usize).max().unwrap_or(0);
            up.starts.extend(std::iter::repeat_n(up.cofacets.len(), beyond_one));
            up.cofacets.extend(of_simplex.iter().map(|&(_, cofacet, _)| cofacet));
            up.classes.extend(of_simplex.iter().map(|&(.., class)| class));
        }
    }

    fn dim_of(&self, id: I) -> Dim {
        self.arrays.first.partition_point(|&first| first <= id.to_usize())
    }
}
