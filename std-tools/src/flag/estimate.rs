//! How large a flag complex will be, without building it: [`estimate`].

use std::ops::Range;

use rayon::prelude::*;
use sig_core::{Dim, MAX_DIM};

use crate::build::narrow;
use crate::flag::count::{Counter, Total};
use crate::flag::walk::Walk;
use crate::generate::SplitMix64;
use crate::graph::Graph;

/// Simplices up to which all are counted: a second of work.
const COUNTED: u64 = 1 << 28;

/// Simplices that are looked at, at most, before the answer is only a lower bound: a minute of work.
const LOOKED_AT: u64 = 1 << 34;

/// Vertices in the sample.
const SAMPLE: usize = 1 << 10;

/// How well an [`Estimate`] is known.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Accuracy {
    /// All simplices were counted.
    Exact,
    /// The simplices below a sample of the vertices were counted.
    Sampled {
        /// Vertices in the sample.
        vertices: usize,
        /// The standard error of the number of simplices.
        standard_error: f64,
    },
    /// There are more simplices than could be counted in a minute or so.
    AtLeast,
}

/// The size of a flag complex.
#[derive(Clone, PartialEq, Debug)]
pub struct Estimate {
    /// The number of simplices of each dimension.
    pub counts: Vec<u64>,
    /// Bytes of the file of the tree, but for its header and labels, coordinates and checksums.
    pub file_bytes: u64,
    /// How well that is known.
    pub accuracy: Accuracy,
}

impl Estimate {
    /// The number of simplices.
    #[must_use]
    pub fn num_simplices(&self) -> u64 {
        self.counts.iter().fold(0, |sum, &count| sum.saturating_add(count))
    }

    fn new(graph: &Graph, mut counts: Vec<u64>, accuracy: Accuracy) -> Self {
        while counts.pop_if(|count| *count == 0).is_some() {}
        let all = counts.iter().fold(0_u64, |sum, &count| sum.saturating_add(count));
        let width = |largest: u64| sig_core::IndexWidth::least_for(largest).map_or(8, |width| width.bytes() as u64);
        let label = width(graph.num_vertices() as u64);
        let value = if graph.is_weighted() { 8 } else { 0 };
        let inner = all - counts.last().copied().unwrap_or(0);
        let offsets = inner.saturating_add(1).saturating_mul(width(all));
        Self { counts, file_bytes: all.saturating_mul(label + value).saturating_add(offsets), accuracy }
    }
}

/// The number of cliques of up to `max_dim` + 1 vertices, and the bytes of their [tree](crate::frozen::FrozenTree) as a
/// file: counted if a sample says that this takes about a second, else from that sample. It is two vertices drawn with
/// `seed` from each of 512 ranges of vertices; what is counted are the simplices of which they are the least vertices.
///
/// The standard error is that of such a stratified sample: it says how far off the estimate usually is, unless very few
/// vertices are in very many simplices.
#[must_use]
pub fn estimate(graph: &Graph, max_dim: Dim, seed: u64) -> Estimate {
    let max_dim = max_dim.min(MAX_DIM);
    let strata = strata(graph.num_vertices());
    if graph.num_vertices() > SAMPLE {
        let sampled = sample(graph, max_dim, &strata, seed);
        if sampled.accuracy == Accuracy::AtLeast || sampled.num_simplices() > COUNTED {
            return sampled;
        }
    }
    let total = Total::new(LOOKED_AT);
    let counts = strata
        .into_par_iter()
        .map_init(
            || Walk::<u32>::new(graph, max_dim),
            |walk, range| {
                let mut counter = Counter::new(max_dim, &total);
                range.for_each(|vertex| walk.below_vertex(narrow(vertex), &mut counter));
                counter.settle();
                counter.counts
            },
        )
        .reduce(|| vec![0; max_dim + 1], |a, b| a.iter().zip(b).map(|(a, b)| a + b).collect());
    let accuracy = if total.is_exceeded() { Accuracy::AtLeast } else { Accuracy::Exact };
    Estimate::new(graph, counts, accuracy)
}

/// Up to [`SAMPLE`] / 2 ranges of vertices, of at least two each if there are as many.
fn strata(num_vertices: usize) -> Vec<Range<usize>> {
    let count = (SAMPLE / 2).min(num_vertices / 2).max(1);
    (0..count).map(|stratum| stratum * num_vertices / count..(stratum + 1) * num_vertices / count).collect()
}

/// The estimate from two vertices of each range.
#[expect(clippy::cast_precision_loss, reason = "an estimate")]
fn sample(graph: &Graph, max_dim: Dim, strata: &[Range<usize>], seed: u64) -> Estimate {
    let mut random = SplitMix64::new(seed);
    let mut drawn = Vec::with_capacity(strata.len());
    for range in strata {
        let a = random.next_below(range.len());
        let b = (a + 1 + random.next_below(range.len() - 1)) % range.len();
        drawn.push((range.len() as f64, [range.start + a, range.start + b]));
    }
    let total = Total::new(LOOKED_AT);
    let counted: Vec<_> = drawn
        .into_par_iter()
        .map_init(
            || Walk::<u32>::new(graph, max_dim),
            |walk, (weight, pair)| {
                let counts = pair.map(|vertex| {
                    let mut counter = Counter::new(max_dim, &total);
                    walk.below_vertex(narrow(vertex), &mut counter);
                    counter.settle();
                    counter.counts
                });
                (weight, counts)
            },
        )
        .collect();
    let mut counts = vec![0.0; max_dim + 1];
    let mut variance = 0.0;
    for (weight, [a, b]) in counted {
        let (all_a, all_b) = (a.iter().sum::<u64>() as f64, b.iter().sum::<u64>() as f64);
        for (count, (a, b)) in counts.iter_mut().zip(a.into_iter().zip(b)) {
            // What was drawn counts for itself alone once that is all that is known.
            *count += (a + b) as f64 * if total.is_exceeded() { 1.0 } else { weight / 2.0 };
        }
        variance += weight * (weight - 2.0) * ((all_a - all_b) / 2.0).powi(2);
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let counts = counts.into_iter().map(|count: f64| count.round() as u64).collect();
    let accuracy = if total.is_exceeded() {
        Accuracy::AtLeast
    } else {
        Accuracy::Sampled { vertices: 2 * strata.len(), standard_error: variance.sqrt() }
    };
    Estimate::new(graph, counts, accuracy)
}
