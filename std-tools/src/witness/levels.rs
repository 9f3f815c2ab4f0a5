//! The tree under construction: one level of arrays a dimension, each made from sorted candidates and the level below.
//!
//! A *candidate* of dimension j is a simplex that some witness witnesses and whose prefix, the word without its last
//! vertex, is in the complex. It is named by the number of that prefix in its level and by the last vertex, in one
//! integer: candidates in the order of these integers stand in canonical order. What of them has all its facets in the
//! level below is the next level. Nothing is hashed and no word is stored.

use std::ops::Range;

use rayon::prelude::*;

use crate::build::narrow;
use crate::frozen::{FrozenTree, LastVertices};
use crate::soup::{Coordinates, Labels};

/// A candidate, with or without the least relaxation at which a witness witnesses it.
pub(super) trait Candidate: Copy + Ord + Send + Sync {
    /// Whether the relaxation is kept.
    const WITH_VALUE: bool;

    /// The candidate with this prefix and this last vertex; `value` is not negative.
    fn new(prefix: u32, last: u32, value: impl FnOnce() -> f64) -> Self;

    /// The prefix and the last vertex in one integer.
    fn key(self) -> u64;

    /// The relaxation; 0 if it is not kept.
    fn value(self) -> f64;

    fn prefix(self) -> u32 {
        narrow((self.key() >> 32) as usize)
    }

    fn last(self) -> u32 {
        u32::try_from(self.key() & u64::from(u32::MAX)).unwrap_or(u32::MAX)
    }
}

fn key(prefix: u32, last: u32) -> u64 {
    u64::from(prefix) << 32 | u64::from(last)
}

impl Candidate for u64 {
    const WITH_VALUE: bool = false;

    fn new(prefix: u32, last: u32, _: impl FnOnce() -> f64) -> Self {
        key(prefix, last)
    }

    fn key(self) -> u64 {
        self
    }

    fn value(self) -> f64 {
        0.0
    }
}

/// The bits of numbers that are not negative stand in the order of the numbers.
impl Candidate for (u64, u64) {
    const WITH_VALUE: bool = true;

    fn new(prefix: u32, last: u32, value: impl FnOnce() -> f64) -> Self {
        (key(prefix, last), value().to_bits())
    }

    fn key(self) -> u64 {
        self.0
    }

    fn value(self) -> f64 {
        f64::from_bits(self.1)
    }
}

/// Sorts, and of equal candidates keeps one, that of the least relaxation.
pub(super) fn sort_and_merge<C: Candidate>(candidates: &mut Vec<C>) {
    candidates.sort_unstable();
    candidates.dedup_by_key(|candidate| candidate.key());
}

/// The simplices of one dimension, numbered from 0.
#[derive(Clone, Debug, Default)]
pub(super) struct Level {
    /// The last vertex of each.
    pub(super) last: Vec<u32>,
    /// Where the children of each start in the next level, and the end; empty while there is no next level.
    pub(super) first_child: Vec<u32>,
    /// The least relaxation at which each is in the complex; empty if that is not asked for.
    pub(super) values: Vec<f64>,
}

/// The levels that are complete, from the vertices up.
#[derive(Clone, Debug, Default)]
pub(super) struct Levels {
    levels: Vec<Level>,
    /// Of every simplex of the last level, its facets; the i-th omits the i-th vertex. Empty for vertices.
    facets: Vec<u32>,
}

/// What a task finds of the next level.
#[derive(Default)]
struct Part {
    prefixes: Vec<u32>,
    last: Vec<u32>,
    facets: Vec<u32>,
    values: Vec<f64>,
}

impl Levels {
    /// The level of `num_vertices` vertices, with their relaxations or none.
    pub(super) fn new(num_vertices: usize, values: Vec<f64>) -> Self {
        let vertices = Level { last: (0..narrow(num_vertices)).collect(), first_child: Vec::new(), values };
        Self { levels: vec![vertices], facets: Vec::new() }
    }

    /// The number of levels: one more than the largest dimension so far.
    pub(super) fn len(&self) -> usize {
        self.levels.len()
    }

    /// The simplices of the last level.
    pub(super) fn num_last(&self) -> usize {
        self.levels.last().map_or(0, |level| level.last.len())
    }

    /// The simplices of all levels.
    pub(super) fn num_simplices(&self) -> u64 {
        self.levels.iter().map(|level| level.last.len() as u64).sum()
    }

    /// The last vertices of level `depth` + 1 that are children of `node` of level `depth`, and the number of the first.
    #[inline]
    pub(super) fn children(&self, depth: usize, node: u32) -> (u32, &[u32]) {
        let starts = &self.levels[depth].first_child;
        let (start, end) = (starts[node as usize], starts[node as usize + 1]);
        (start, &self.levels[depth + 1].last[start as usize..end as usize])
    }

    /// The simplex with the given vertices, increasing, in the level of its dimension; `None` if it is not there.
    pub(super) fn find(&self, word: &[u32]) -> Option<u32> {
        let (&first, rest) = word.split_first()?;
        rest.iter().enumerate().try_fold(first, |node, (depth, vertex)| {
            let (start, children) = self.children(depth, node);
            children.binary_search(vertex).ok().map(|position| start + narrow(position))
        })
    }

    /// Of the candidates for the next level, the prefixes of which are in `prefixes` and which stand in `parts`, each
    /// part sorted, those whose facets are all in the last level.
    fn complete<C: Candidate>(&self, parts: &[Vec<C>], prefixes: Range<u32>) -> Part {
        let bound = |part: &[C], prefix: u32| part.partition_point(|candidate| candidate.prefix() < prefix);
        let slices = parts.iter().map(|part| &part[bound(part, prefixes.start)..bound(part, prefixes.end)]);
        let mut candidates = slices.collect::<Vec<_>>().concat();
        // The stable sort is the one that merges what is sorted already.
        candidates.sort();
        candidates.dedup_by_key(|candidate| candidate.key());
        let mut part = Part::default();
        for run in candidates.chunk_by(|a, b| a.prefix() == b.prefix()) {
            self.complete_siblings(run, &mut part);
        }
        part
    }

    /// The same for candidates with one prefix.
    ///
    /// The facet of τv that omits the i-th vertex of τ is the child of that facet of τ with the last vertex v: all are
    /// looked up in ranges of children, in which the candidates advance side by side.
    fn complete_siblings<C: Candidate>(&self, siblings: &[C], part: &mut Part) {
        let Some(prefix) = siblings.first().map(|candidate| candidate.prefix()) else { return };
        let dim = self.levels.len();
        let level = &self.levels[dim - 1];
        let prefix_facets = self.facets.get(prefix as usize * dim..(prefix as usize + 1) * dim).unwrap_or(&[]);
        let mut ranges: [(u32, &[u32]); 32] = [(0, &[]); 32];
        for (range, &facet) in ranges.iter_mut().zip(prefix_facets) {
            *range = self.children(dim - 2, facet);
        }
        let ranges = &mut ranges[..prefix_facets.len()];
        'candidates: for candidate in siblings {
            let (last, start) = (candidate.last(), part.facets.len());
            let mut value = candidate.value();
            if dim == 1 {
                part.facets.push(last);
                value = level.values.get(last as usize).map_or(value, |facet| facet.max(value));
            }
            for (first, children) in ranges.iter_mut() {
                let skipped = position(children, last);
                (*first, *children) = (*first + narrow(skipped), &children[skipped..]);
                if children.first() != Some(&last) {
                    part.facets.truncate(start);
                    continue 'candidates;
                }
                part.facets.push(*first);
                value = level.values.get(*first as usize).map_or(value, |facet| facet.max(value));
            }
            part.facets.push(prefix);
            part.prefixes.push(prefix);
            part.last.push(last);
            if C::WITH_VALUE {
                part.values.push(level.values.get(prefix as usize).map_or(value, |facet| facet.max(value)));
            }
        }
    }

    /// Adds the next level: of the candidates in `parts`, each sorted, those whose facets are all in the last level. If
    /// there are none, no level is added. Returns how many there are.
    ///
    /// `room` is told how many a task has found, and may refuse.
    pub(super) fn grow<C: Candidate, E: Send>(
        &mut self,
        parts: &[Vec<C>],
        room: impl Fn(usize) -> Result<(), E> + Sync,
    ) -> Result<usize, E> {
        /// Tasks: many more than threads, as some prefixes have more candidates than others.
        const TASKS: u32 = 64;
        let parents = narrow(self.num_last());
        let step = parents.div_ceil(TASKS).max(1);
        let found = (0..parents.div_ceil(step)).into_par_iter().map(|task| {
            let part = self.complete(parts, task * step..parents.min((task + 1) * step));
            room(part.last.len()).map(|()| part)
        });
        let found = found.collect::<Result<Vec<Part>, E>>()?;
        let count = found.iter().map(|part| part.last.len()).sum();
        if count == 0 {
            return Ok(0);
        }
        let mut first_child = Vec::with_capacity(parents as usize + 1);
        let mut end = 0;
        for &prefix in found.iter().flat_map(|part| &part.prefixes) {
            first_child.resize(first_child.len().max(prefix as usize + 1), end);
            end += 1;
        }
        first_child.resize(parents as usize + 1, end);
        if let Some(level) = self.levels.last_mut() {
            level.first_child = first_child;
        }
        let (mut next, mut facets) = (Level::default(), Vec::new());
        next.last.reserve_exact(count);
        facets.reserve_exact(count * (self.levels.len() + 1));
        for mut part in found {
            next.last.append(&mut part.last);
            next.values.append(&mut part.values);
            facets.append(&mut part.facets);
        }
        self.levels.push(next);
        self.facets = facets;
        Ok(count)
    }

    /// Adds a level of which everything is known: the prefixes and the last vertices in canonical order.
    pub(super) fn push_known(&mut self, simplices: &[(u32, u32)]) {
        let parents = self.num_last();
        let starts = (0..=narrow(parents)).map(|node| simplices.partition_point(|&(prefix, _)| prefix < node));
        let first_child = starts.map(narrow).collect();
        if let Some(level) = self.levels.last_mut() {
            level.first_child = first_child;
        }
        self.levels.push(Level { last: simplices.iter().map(|&(_, last)| last).collect(), ..Level::default() });
        self.facets = Vec::new();
    }

    /// The tree in the arrays of a file.
    pub(super) fn freeze(self, labels: Labels, coordinates: Option<Coordinates>) -> FrozenTree {
        let Some(num_vertices) = self.levels.first().map(|level| level.last.len()).filter(|&count| count > 0) else {
            return FrozenTree::default();
        };
        let mut tree = FrozenTree { labels, coordinates, ..FrozenTree::default() };
        let with_values = self.levels.iter().all(|level| level.values.len() == level.last.len());
        for level in &self.levels {
            tree.first.push(tree.num_simplices);
            tree.num_simplices += level.last.len();
            let children = level.first_child.split_last().map_or(&[][..], |(_, starts)| starts);
            tree.child_offsets.extend(children.iter().map(|&start| start + narrow(tree.num_simplices)));
        }
        tree.child_offsets.push(narrow(tree.num_simplices));
        let last = self.levels.iter().flat_map(|level| &level.last);
        tree.last_vertices = if num_vertices <= LastVertices::MOST_BITS16 {
            // Vertex ids are below the number of vertices, which fits.
            LastVertices::Bits16(last.map(|&vertex| u16::try_from(vertex).unwrap_or(u16::MAX)).collect())
        } else {
            LastVertices::Bits32(last.copied().collect())
        };
        tree.filtration = with_values.then(|| self.levels.into_iter().flat_map(|level| level.values).collect());
        tree
    }
}

/// How many of `sorted` are below `bound`.
#[inline]
pub(super) fn position(sorted: &[u32], bound: u32) -> usize {
    // Most ranges are shorter than a binary search is worth.
    const SHORT: usize = 12;
    if sorted.len() > SHORT {
        return sorted.partition_point(|&vertex| vertex < bound);
    }
    sorted.iter().take_while(|&&vertex| vertex < bound).count()
}
