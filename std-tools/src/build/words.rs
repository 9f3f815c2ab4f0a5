//! Listed simplices as sorted words of vertex ids, with the parity that sorting takes away, dealt out to *buckets*: ranges
//! of consecutive vertices whose faces one task finds ([`super::levels`]).

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;
use sig_core::{Dim, MAX_DIM};

use crate::build::facets::mark;
use crate::build::local::{EVEN, ODD};
use crate::build::order::Order;
use crate::build::{BuildError, Meter, Phase, narrow};

/// Vertex numbers that are checked or dealt out at a time, at least and at most.
const CHUNK: Range<usize> = 1 << 16..1 << 25;
/// Chunks of an input of any size, at most (but for very large ones).
const MOST_CHUNKS: usize = 1 << 10;
/// Tails in a bucket, about, at least and at most: what is known of it then fits a core's cache.
pub(super) const BUCKET: Range<usize> = 1 << 13..1 << 15;
/// Buckets, about, where these are not too small or too large; and at most.
const BUCKETS: usize = 1 << 5;
const MOST_BUCKETS: usize = 1 << 14;

/// The listed simplices as words, by bucket. In each bucket is every *tail* whose first vertex is in it: what is left of
/// a word from one of its vertices on, but the last. A tail that goes on from a vertex of the same bucket is not there
/// apart.
pub(super) struct Words {
    /// Vertices in a bucket, as a power of two.
    bits: u32,
    num_vertices: usize,
    parts: Vec<Part>,
}

/// The words of some rows of the input.
#[derive(Default)]
struct Part {
    /// The first bucket that has any.
    first: usize,
    /// Where those of each bucket from there on start, and the end.
    starts: Vec<u32>,
    /// Records: a head, then the vertices.
    flat: Vec<u32>,
}

/// A word of `len` vertices, which is a listed one if it has a `mark`, as one number in front of them.
#[expect(clippy::cast_possible_truncation, reason = "at most 32 vertices")]
fn head(len: usize, mark: u8) -> u32 {
    (len as u32) << 2 | u32::from(mark)
}

/// The words in records: how each is listed, 0 of the tail of one that starts in another bucket, and its vertices.
pub(super) fn records(flat: &[u32]) -> impl Iterator<Item = (u8, &[u32])> {
    let mut rest = flat;
    std::iter::from_fn(move || {
        let (&head, after) = rest.split_first()?;
        let (word, others) = after.split_at_checked((head >> 2) as usize)?;
        rest = others;
        Some(((head & 3) as u8, word))
    })
}

impl Words {
    /// The words that are listed.
    pub(super) fn iter(&self) -> impl Iterator<Item = &[u32]> {
        let all = self.parts.iter().flat_map(|part| records(&part.flat));
        all.filter(|&(mark, _)| mark != 0).map(|(_, word)| word)
    }

    pub(super) fn num_vertices(&self) -> usize {
        self.num_vertices
    }

    pub(super) fn num_buckets(&self) -> usize {
        self.num_vertices.div_ceil(1 << self.bits)
    }

    /// The vertices of a bucket.
    pub(super) fn vertices(&self, bucket: usize) -> Range<u32> {
        narrow(bucket << self.bits)..narrow(self.num_vertices.min((bucket + 1) << self.bits))
    }

    /// The records of a bucket; where they are in several parts, in `room`.
    pub(super) fn gather<'a>(&'a self, bucket: usize, room: &'a mut Vec<u32>) -> &'a [u32] {
        let mut runs = self.parts.iter().filter_map(|part| {
            let place = bucket.checked_sub(part.first)?;
            let &[start, end] = part.starts.get(place..place + 2)? else { return None };
            Some(&part.flat[start as usize..end as usize]).filter(|run| !run.is_empty())
        });
        let first = runs.next().unwrap_or(&[]);
        let Some(second) = runs.next() else { return first };
        room.clear();
        [first, second].into_iter().chain(runs).for_each(|run| room.extend_from_slice(run));
        room
    }
}

/// Checks the shape of the soup and the range of its vertex numbers; tells which of `count` vertices are used.
pub(super) fn check(simplices: &[Vec<u32>], count: usize) -> Result<Vec<bool>, BuildError> {
    if u32::try_from(count).map_or(true, |count| count > u32::MAX - 1) {
        return Err(BuildError::TooManyVertices(count));
    }
    let used: Vec<AtomicBool> = (0..count).map(|_| AtomicBool::new(false)).collect();
    for (dim, flat) in simplices.iter().enumerate() {
        if !flat.is_empty() && (dim > MAX_DIM || !flat.len().is_multiple_of(dim + 1)) {
            return Err(BuildError::MalformedSoup { dim, len: flat.len() });
        }
        let chunks = flat.par_chunks(CHUNK.start).map(|chunk| {
            chunk.iter().position(|&vertex| match used.get(vertex as usize) {
                Some(used) => {
                    mark(used);
                    false
                }
                None => true,
            })
        });
        let wrong = chunks.enumerate().find_map_first(|(chunk, place)| Some(chunk * CHUNK.start + place?));
        if let Some(position) = wrong {
            return Err(BuildError::VertexOutOfRange {
                dim,
                index: position / (dim + 1),
                vertex: flat[position],
                count,
            });
        }
    }
    Ok(used.into_iter().map(AtomicBool::into_inner).collect())
}

/// Rewrites every listed simplex as its word, and deals the words out to buckets of so many tails, about.
pub(super) fn sort(
    simplices: Vec<Vec<u32>>,
    order: &Order,
    bucket: Range<usize>,
    meter: &Meter<'_>,
) -> Result<Words, BuildError> {
    let num_listed = simplices.iter().enumerate().map(|(dim, flat)| flat.len() / (dim + 1)).sum();
    let stage = meter.stage(Phase::Words, num_listed);
    let num_tails: usize = simplices.iter().enumerate().map(|(dim, flat)| flat.len() / (dim + 1) * dim).sum();
    let num_vertices = order.num_vertices();
    // Vertices count as tails: isolated ones are work too.
    let num_tails = num_tails + num_vertices;
    let bucket = (num_tails / BUCKETS).clamp(bucket.start, bucket.end);
    let size = (num_vertices as u128 * bucket as u128 / num_tails.max(1) as u128).max(1);
    let size = usize::try_from(size).unwrap_or(1).max(num_vertices / MOST_BUCKETS);
    let bits = size.next_power_of_two().trailing_zeros();
    let mut parts = Vec::new();
    for (dim, simplices) in simplices.into_iter().enumerate() {
        let rows = (simplices.len() / MOST_CHUNKS).clamp(CHUNK.start, CHUNK.end) / (dim + 1);
        let chunks = simplices.par_chunks(rows * (dim + 1)).map_init(Vec::new, |words, rows| {
            let part = deal(rows, dim, order, bits, words);
            stage.add(rows.len() / (dim + 1));
            part
        });
        for (chunk, part) in chunks.collect::<Vec<_>>().into_iter().enumerate() {
            let repeated = |(row, vertex)| BuildError::RepeatedVertex { dim, index: chunk * rows + row, vertex };
            parts.push(part.map_err(repeated)?);
        }
    }
    Ok(Words { bits, num_vertices, parts })
}

/// The words of some rows by bucket; `words` is room for them.
///
/// # Errors
/// The first row that repeats a vertex, and that vertex as the input numbers it.
fn deal(rows: &[u32], dim: Dim, order: &Order, bits: u32, words: &mut Vec<u32>) -> Result<Part, (usize, u32)> {
    words.clear();
    words.resize(rows.len() / (dim + 1) * (dim + 2), 0);
    let is_good = match dim {
        1 => sort_rows::<2>(rows, order, words),
        2 => sort_rows::<3>(rows, order, words),
        3 => sort_rows::<4>(rows, order, words),
        _ => sort_long_rows(rows, dim, order, words),
    };
    if !is_good {
        let mut all = rows.chunks_exact(dim + 1).enumerate();
        return Err(all.find_map(|(row, vertices)| Some((row, repeated(vertices)?))).unwrap_or_default());
    }
    let bucket = |vertex: u32| (vertex >> bits) as usize;
    // Nothing follows the last vertex, unless it is the first.
    let last = dim.max(1);
    let (mut least, mut most) = (u32::MAX, 0);
    for word in words.chunks_exact(dim + 2) {
        least = least.min(word[1]);
        most = most.max(word[last]);
    }
    let first = bucket(least);
    // Shifted by one, so that filling in moves each start to where it belongs.
    let mut starts = vec![0_u32; bucket(most) + 3 - first];
    for_each_tail(words, dim, bits, |tail, _| starts[bucket(tail[0]) - first + 2] += narrow(tail.len() + 1));
    for bucket in 2..starts.len() {
        starts[bucket] += starts[bucket - 1];
    }
    let mut flat = vec![0; starts[starts.len() - 1] as usize];
    for_each_tail(words, dim, bits, |tail, mark| {
        let next = &mut starts[bucket(tail[0]) - first + 1];
        let record = &mut flat[*next as usize..][..tail.len() + 1];
        record[0] = head(tail.len(), mark);
        // Cheaper than a call to copy a few.
        record[1..].iter_mut().zip(tail).for_each(|(to, from)| *to = *from);
        *next += narrow(tail.len() + 1);
    });
    starts.pop();
    Ok(Part { first, starts, flat })
}

/// Calls `visit` with every tail that goes to a bucket: each word with its mark, and what is left of it from a vertex on
/// that is of another bucket than the one before.
#[inline]
fn for_each_tail(words: &[u32], dim: Dim, bits: u32, mut visit: impl FnMut(&[u32], u8)) {
    for record in words.chunks_exact(dim + 2) {
        let (mark, word) = ((record[0] & 3) as u8, &record[1..]);
        visit(word, mark);
        for place in 1..dim {
            if word[place] >> bits != word[place - 1] >> bits {
                visit(&word[place..], 0);
            }
        }
    }
}

/// Sorts rows of `N` vertex numbers of the input into records, by a network without branches; false if a vertex is
/// repeated.
fn sort_rows<const N: usize>(rows: &[u32], order: &Order, records: &mut [u32]) -> bool {
    let mut is_good = true;
    for (row, record) in rows.as_chunks::<N>().0.iter().zip(records.chunks_exact_mut(N + 1)) {
        let mut word = row.map(|vertex| order.id(vertex));
        let mut is_odd = false;
        for end in 1..N {
            for place in (1..=end).rev() {
                let (a, b) = (word[place - 1], word[place]);
                is_odd ^= a > b;
                (word[place - 1], word[place]) = (a.min(b), a.max(b));
            }
        }
        is_good &= word.is_sorted_by(|a, b| a < b);
        record[0] = head(N, if is_odd { ODD } else { EVEN });
        record[1..].copy_from_slice(&word);
    }
    is_good
}

/// As [`sort_rows`], of any length.
fn sort_long_rows(rows: &[u32], dim: Dim, order: &Order, records: &mut [u32]) -> bool {
    let mut is_good = true;
    for (row, record) in rows.chunks_exact(dim + 1).zip(records.chunks_exact_mut(dim + 2)) {
        let (head_of_record, word) = record.split_at_mut(1);
        let mut swaps = 0;
        for (end, &vertex) in row.iter().enumerate() {
            let id = order.id(vertex);
            let mut place = end;
            while place > 0 && word[place - 1] > id {
                word[place] = word[place - 1];
                place -= 1;
            }
            word[place] = id;
            swaps += end - place;
        }
        is_good &= word.is_sorted_by(|a, b| a < b);
        head_of_record[0] = head(dim + 1, if swaps % 2 == 0 { EVEN } else { ODD });
    }
    is_good
}

/// The first vertex of a row that is there before.
fn repeated(row: &[u32]) -> Option<u32> {
    let mut ends = row.iter().enumerate();
    ends.find_map(|(end, vertex)| row[..end].contains(vertex).then_some(*vertex))
}
