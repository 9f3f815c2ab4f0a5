//! The vertices in parts, and which parts are joined by edges: where the cofaces of a block of simplices are looked
//! for.
//!
//! In canonical order the simplices of one dimension that begin with a vertex of a part are consecutive. A simplex that
//! begins in part A has a face that begins in part B only if there is an edge from a vertex of A to one of B, or A is
//! B. So the cofaces of simplices that begin in B begin in the parts that have an edge into B, none of them after B.

use std::ops::Range;

use rayon::prelude::*;
use sig_core::{Dim, Index};

use super::rows::Rows;

/// Parts of the vertices, by number.
pub(super) struct Parts {
    /// For each dimension the first simplex of each part, and the end of the last one's.
    starts: Vec<Vec<usize>>,
    /// Where the parts that have an edge into each part start in `into`.
    into_starts: Vec<usize>,
    /// These parts, increasing, itself the last.
    into: Vec<u32>,
}

impl Parts {
    /// Parts of about `size` simplices of the dimension that has the most of them, or of one vertex that has more.
    ///
    /// Cost: one pass over the edges, on all threads; two numbers for each part and each two that are joined, and one
    /// for each vertex while it runs.
    pub(super) fn new<I: Index>(rows: &Rows<'_, I>, size: usize) -> Self {
        let largest = (0..rows.dims()).max_by_key(|&dim| rows.ids(dim).len()).unwrap_or(0);
        let sampled = rows.ids(largest).step_by(size.max(1)).map(|id| rows.first_vertex(largest, id));
        let end = rows.ids(0).end;
        let mut first: Vec<usize> = std::iter::once(0).chain(sampled).collect();
        // On a buffer that is no complex they need not increase.
        first.retain(|&vertex| vertex < end);
        first.sort_unstable();
        first.dedup();
        first.push(end);
        let starts: Vec<Vec<usize>> = (0..rows.dims()).map(|dim| starts(rows, dim, &first)).collect();
        let mut parts = Self { starts, into_starts: Vec::new(), into: Vec::new() };
        parts.join(rows, &first);
        parts
    }

    /// How many there are.
    fn len(&self) -> usize {
        self.starts.first().map_or(0, |starts| starts.len() - 1)
    }

    /// Finds which parts are joined.
    fn join<I: Index>(&mut self, rows: &Rows<'_, I>, first: &[usize]) {
        let mut part_of = vec![0_u32; rows.ids(0).len()];
        for (part, bounds) in (0..).zip(first.windows(2)) {
            part_of[bounds[0]..bounds[1]].fill(part);
        }
        let ends_of = |part: usize| rows.of(1, &self.ids(1, part)).chunks_exact(2).map(|ends| ends[0].to_usize());
        // For each part the ones that its edges lead into.
        let out: Vec<Vec<u32>> = (0..self.len())
            .into_par_iter()
            .with_min_len(16)
            .map_init(
                || vec![usize::MAX; self.len()],
                |seen, part| {
                    // Each is in the list of itself, and no edge leads to a part before.
                    seen[part] = part;
                    let mut found = Vec::new();
                    for &other in ends_of(part).filter_map(|end| part_of.get(end)) {
                        if seen[other as usize] != part {
                            seen[other as usize] = part;
                            found.push(other);
                        }
                    }
                    found
                },
            )
            .collect();
        let mut next = vec![0; self.len() + 1];
        out.iter().flatten().for_each(|&part| next[part as usize + 1] += 1);
        for part in 1..next.len() {
            // One more, for itself.
            next[part] += next[part - 1] + 1;
        }
        self.into_starts = next.clone();
        self.into = vec![0; self.into_starts.last().copied().unwrap_or(0)];
        for (part, found) in (0..).zip(&out) {
            // Parts before it have all come: it is the last of its own list.
            for &other in [part].iter().chain(found) {
                let next = &mut next[other as usize];
                if let Some(slot) = self.into.get_mut(*next) {
                    *slot = part;
                }
                *next += 1;
            }
        }
    }

    /// The simplices of a dimension that begin in a part.
    pub(super) fn ids(&self, dim: Dim, part: usize) -> Range<usize> {
        self.starts.get(dim).map_or(0..0, |starts| starts[part]..starts[part + 1])
    }

    /// The parts in which cofaces of consecutive simplices of a dimension begin, increasing.
    pub(super) fn around(&self, dim: Dim, ids: &Range<usize>) -> Vec<usize> {
        let Some(starts) = self.starts.get(dim).filter(|_| !ids.is_empty()) else { return Vec::new() };
        let part_of = |id: usize| starts.partition_point(|&start| start <= id).saturating_sub(1);
        let own = part_of(ids.start)..(part_of(ids.end - 1) + 1).min(self.len());
        let joined = self.into_starts[own.start]..self.into_starts[own.end];
        let mut parts: Vec<usize> = self.into[joined].iter().map(|&part| part as usize).collect();
        parts.sort_unstable();
        parts.dedup();
        parts
    }
}

/// For each first vertex of a part the first simplex of a dimension that begins with it or with a later one.
fn starts<I: Index>(rows: &Rows<'_, I>, dim: Dim, first: &[usize]) -> Vec<usize> {
    let ids = rows.ids(dim);
    let mut start = ids.start;
    let start_of = |&vertex: &usize| {
        // Each from where the one before stands: on a buffer that is no complex, too, they do not decrease.
        let (mut low, mut high) = (start, ids.end);
        while low < high {
            let middle = low + (high - low) / 2;
            if rows.first_vertex(dim, middle) < vertex { low = middle + 1 } else { high = middle }
        }
        start = low;
        low
    };
    let mut starts: Vec<usize> = first.iter().map(start_of).collect();
    if let Some(end) = starts.last_mut() {
        *end = ids.end;
    }
    starts
}
