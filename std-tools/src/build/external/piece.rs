//! One piece: the complex of all listed simplices around a range of vertices, of which it *owns* the simplices whose least
//! vertex is in the range.
//!
//! Whatever contains an owned simplex contains a vertex of the range, so all of it is in the piece: which simplices are
//! top, C\*, and the facets but for their numbers are what they are in the whole complex. Vertices keep their order, hence
//! simplices theirs, and the owned ones of each dimension are consecutive in the piece and in the whole.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use sig_core::{Dim, Index};

use super::plan::Ranges;
use crate::build::blocks::descendants;
use crate::build::report::{self, Counts};
use crate::build::{Arrays, BuildError, BuildOptions, Meter, SigArrays, Unused, VertexOrder};
use crate::build::{assemble, clusters, find_faces, narrow};
use crate::soup::{Labels, Soup};

/// A piece, built.
pub(super) struct Piece {
    pub(super) arrays: SigArrays<u32>,
    /// The vertices in the whole complex, increasing.
    pub(super) vertices: Vec<u32>,
    /// The owned simplices of each dimension.
    pub(super) owned: Vec<Range<usize>>,
    /// Which simplices of each dimension are top; nothing where none is listed.
    pub(super) is_top: Vec<Vec<bool>>,
    /// How they are listed.
    pub(super) listed: Vec<Vec<u8>>,
}

impl Piece {
    /// Builds the piece of the vertices in `range`, around which the simplices `words` are listed, by dimension.
    pub(super) fn build(range: &Range<u32>, mut words: Vec<Vec<u32>>, limit: u64) -> Result<Self, BuildError> {
        let numbers = Numbers::new(range, &words);
        words.iter_mut().flatten().for_each(|vertex| *vertex = numbers.of(*vertex));
        let vertices = numbers.into_vertices();
        let start = vertices.partition_point(|&vertex| vertex < range.start);
        // Declared, so that a vertex without simplices is there too.
        let soup = Soup { simplices: words, ..Soup::new(Labels::Numbered(vertices.len()), true) };
        let options = BuildOptions {
            order: VertexOrder::Input,
            unused: Unused::Keep,
            max_simplices: Some(limit),
            max_bytes: Some(u64::MAX),
            progress: None,
        };
        let meter = Meter::new(None);
        let (chunks, ..) = find_faces(soup, &options, &meter)?;
        let too_large = BuildError::TooLarge { at_least: chunks.num_simplices() as u64, limit };
        if u32::from_usize(chunks.num_simplices()).is_none() {
            return Err(too_large);
        }
        let (arrays, listed) = assemble::assemble::<u32>(chunks, &meter);
        let is_top = report::is_top(&arrays, &listed);
        let Arrays::Narrow(arrays) = clusters::add(arrays, &is_top, &meter) else { return Err(too_large) };
        let descend = |vertex: usize, dim: Dim| (0..dim).fold(vertex, |id, _| arrays.child_offsets[id] as usize);
        let owned = (0..arrays.first.len()).map(|dim| descend(start, dim)..descend(start + range.len(), dim)).collect();
        Ok(Self { arrays, vertices, owned, is_top, listed })
    }

    /// The dimension of the piece; it has a vertex.
    pub(super) fn dim(&self) -> Dim {
        self.owned.len() - 1
    }

    pub(super) fn is_owned(&self, dim: Dim, id: usize) -> bool {
        self.owned[dim].contains(&id)
    }

    /// Whether a simplex is top.
    pub(super) fn is_top(&self, dim: Dim, id: usize) -> bool {
        self.is_top[dim].get(id - self.arrays.first[dim]).copied().unwrap_or(false)
    }

    /// Calls `visit` with the marks and tops of the owned simplices of each dimension of which any is listed.
    pub(super) fn for_each_listed(&self, mut visit: impl FnMut(Dim, &[u8], &[bool])) {
        for (dim, owned) in self.owned.iter().enumerate() {
            let start = self.arrays.first[dim];
            if let (Some(marks), Some(is_top)) = (self.listed.get(dim), self.is_top.get(dim))
                && !marks.is_empty()
            {
                let range = owned.start - start..owned.end - start;
                visit(dim, &marks[range.clone()], &is_top[range]);
            }
        }
    }

    /// C\*(σ) of a simplex that is below the dimension of the piece.
    pub(super) fn relation(&self, id: usize) -> &[u32] {
        let pointer = &self.arrays.pointers[id];
        if self.is_flagged(id) {
            return std::slice::from_ref(pointer);
        }
        let list = &self.arrays.lists[*pointer as usize..];
        &list[..list.iter().position(|&entry| entry == u32::STOP).unwrap_or(0)]
    }

    fn is_flagged(&self, id: usize) -> bool {
        self.arrays.flags[id / 8] >> (id % 8) & 1 == 1
    }

    /// The first simplex of dimension `dim` of each vertex of the piece, and the end.
    pub(super) fn blocks(&self, dim: Dim) -> Vec<usize> {
        let mut starts = descendants(&self.arrays, 0, dim);
        starts.iter_mut().for_each(|start| *start += self.arrays.first[dim]);
        starts
    }

    /// The lower neighbours of the owned vertices: where those of each start, and all of them as vertices of the whole.
    pub(super) fn lower_neighbours(&self) -> (Vec<usize>, Vec<u32>) {
        let owned = &self.owned[0];
        let mut starts = vec![0; owned.len() + 2];
        let mut edges = Vec::new();
        if self.dim() > 0 {
            for (vertex, range) in self.blocks(1).windows(2).enumerate() {
                for &end in &self.arrays.last_vertices[range[0]..range[1]] {
                    if owned.contains(&(end as usize)) {
                        edges.push((end as usize - owned.start, self.vertices[vertex]));
                        starts[end as usize - owned.start + 2] += 1;
                    }
                }
            }
        }
        for vertex in 2..starts.len() {
            starts[vertex] += starts[vertex - 1];
        }
        // Shifted by one, so that filling in moves each start to where it belongs.
        let mut neighbours = vec![0; edges.len()];
        for (end, vertex) in edges {
            neighbours[starts[end + 1]] = vertex;
            starts[end + 1] += 1;
        }
        starts.pop();
        (starts, neighbours)
    }

    /// What the whole has to know of the piece before anything is written.
    pub(super) fn count(&self) -> Counted {
        let mut report = Counts::new(self.owned.len());
        self.for_each_listed(|dim, marks, is_top| report.add(dim, marks, is_top, |_| {}));
        let below = &self.owned[..self.dim()];
        let flagged = |owned: &Range<usize>| owned.clone().filter(|&id| self.is_flagged(id)).count();
        let entries = |owned: &Range<usize>| self.list_start(owned.end) - self.list_start(owned.start);
        let last = below.last().filter(|owned| !owned.is_empty());
        Counted {
            simplices: self.owned.iter().map(Range::len).collect(),
            flagged: below.iter().map(flagged).collect(),
            entries: below.iter().map(entries).collect(),
            last_entries: last.map_or(0, |owned| self.relation(owned.end - 1).len() + 1),
            lower: self.num_lower(),
            report,
        }
    }

    /// The number of lower neighbours of the owned vertices.
    fn num_lower(&self) -> usize {
        if self.dim() == 0 {
            return 0;
        }
        let ends = &self.arrays.last_vertices[self.arrays.ids(1)];
        ends.iter().filter(|&&end| self.is_owned(0, end as usize)).count()
    }

    /// Where the lists of the simplices from `id` on start.
    fn list_start(&self, id: usize) -> usize {
        let next = (id..self.arrays.pointers.len()).find(|&id| !self.is_flagged(id));
        next.map_or(self.arrays.lists.len(), |id| self.arrays.pointers[id] as usize)
    }

    /// The owned simplices whose numbers other pieces need, each as (piece, dimension, number among those owned), packed
    /// by [`pack`] and increasing: the facets without the least vertex of what others own, and the top simplices that are
    /// around vertices of others.
    pub(super) fn shared(&self, me: usize, ranges: &Ranges) -> Vec<u64> {
        let mut shared = Vec::new();
        for dim in 2..=self.dim() {
            let (rows, first, facets) = (self.arrays.facets(dim), self.arrays.first[dim], &self.owned[dim - 1]);
            for (vertex, block) in self.blocks(dim).windows(2).take(self.owned[0].start).enumerate() {
                let mut user = None;
                for id in block[0]..block[1] {
                    let facet = rows[(id - first) * (dim + 1)] as usize;
                    if facets.contains(&facet) {
                        let user = *user.get_or_insert_with(|| ranges.of(self.vertices[vertex]));
                        shared.push(pack(user, dim - 1, facet - facets.start));
                    }
                }
            }
        }
        let end = self.owned[0].end;
        for dim in 1..=self.dim() {
            for id in self.owned[dim].clone().filter(|&id| self.is_top(dim, id)) {
                let (mut face, mut p) = (id, dim);
                // The vertices from the last on, as long as they are not owned.
                while self.arrays.last_vertices[face] as usize >= end {
                    let user = ranges.of(self.vertices[self.arrays.last_vertices[face] as usize]);
                    shared.push(pack(user, dim, id - self.owned[dim].start));
                    face = self.arrays.facets(p)[(face - self.arrays.first[p]) * (p + 1) + p] as usize;
                    p -= 1;
                }
            }
        }
        debug_assert!(shared.iter().all(|&key| unpack(key).0 != me));
        shared.sort_unstable();
        shared.dedup();
        shared
    }
}

/// Piece, dimension and number in one.
fn pack(piece: usize, dim: Dim, number: usize) -> u64 {
    (piece as u64) << 37 | (dim as u64) << 32 | u64::from(narrow(number))
}

/// What [`pack`] took.
#[expect(clippy::cast_possible_truncation, reason = "they were put in")]
pub(super) fn unpack(key: u64) -> (usize, Dim, u32) {
    ((key >> 37) as usize, (key >> 32 & 31) as Dim, key as u32)
}

/// What the whole has to know of a piece.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Counted {
    /// Owned simplices of each dimension.
    pub(super) simplices: Vec<usize>,
    /// Of those below the dimension of the piece, how many are flagged in it, and the entries and stop codes of the others.
    flagged: Vec<usize>,
    entries: Vec<usize>,
    /// The same of the last simplex one dimension below that of the piece alone.
    last_entries: usize,
    /// Lower neighbours of the owned vertices.
    pub(super) lower: usize,
    pub(super) report: Counts,
}

impl Counted {
    /// The owned simplices of dimension `dim`.
    pub(super) fn num(&self, dim: Dim) -> usize {
        self.simplices.get(dim).copied().unwrap_or(0)
    }

    /// The entries and stop codes in the lists of those in a complex of dimension `whole`: only there its d-simplices have
    /// their largest dimension, so that what a smaller piece flags is listed.
    pub(super) fn entries(&self, dim: Dim, whole: Dim) -> usize {
        match self.entries.get(dim) {
            Some(entries) if self.simplices.len() == whole + 1 => *entries,
            Some(entries) => entries + 2 * self.flagged[dim],
            // All of them top.
            None => self.num(dim),
        }
    }

    /// The entries and the stop code of the last list of dimension `whole` − 1, the dimension of the complex being
    /// `whole` > 0; there is one.
    pub(super) fn last_entries(&self, whole: Dim) -> usize {
        if self.simplices.len() == whole + 1 { self.last_entries } else { 1 }
    }
}

/// The vertices of a piece, numbered in order: a bit for each vertex of the whole, from the first of the piece.
struct Numbers {
    first: u32,
    bits: Vec<u64>,
    /// The vertices before each word of bits.
    before: Vec<u32>,
}

impl Numbers {
    fn new(range: &Range<u32>, words: &[Vec<u32>]) -> Self {
        let (mut first, mut last) = (range.start, range.end - 1);
        for &vertex in words.iter().flatten() {
            first = first.min(vertex);
            last = last.max(vertex);
        }
        let mut bits = vec![0_u64; ((last - first) / 64 + 1) as usize];
        for vertex in words.iter().flatten().copied().chain(range.clone()) {
            bits[((vertex - first) / 64) as usize] |= 1 << ((vertex - first) % 64);
        }
        let before = bits
            .iter()
            .scan(0, |before, word| {
                *before += word.count_ones();
                Some(*before - word.count_ones())
            })
            .collect();
        Self { first, bits, before }
    }

    #[inline]
    fn of(&self, vertex: u32) -> u32 {
        let place = vertex - self.first;
        let word = (place / 64) as usize;
        self.before[word] + (self.bits[word] & ((1 << (place % 64)) - 1)).count_ones()
    }

    fn into_vertices(self) -> Vec<u32> {
        let first = self.first;
        let of_word = |(mut word, start): (u64, u32)| {
            std::iter::from_fn(move || {
                let bit = (word != 0).then(|| word.trailing_zeros())?;
                word &= word - 1;
                Some(start + bit)
            })
        };
        self.bits.into_iter().zip((first..).step_by(64)).flat_map(of_word).collect()
    }
}
