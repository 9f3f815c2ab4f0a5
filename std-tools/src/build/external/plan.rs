//! Into which pieces a complex is cut: ranges of vertices whose stars fit the memory.

use std::ops::Range;

use sig_core::Dim;

use super::piece::Piece;
use super::{Error, Listed};
use crate::build::{BuildError, SigArrays};

/// Parts of the complex that are built to see how large it is.
const SAMPLES: usize = 8;
/// Listed simplices of a sample, about.
const SAMPLE: usize = 1 << 14;
/// Bytes of a simplex, roughly, where they are not known.
const BYTES_PER_SIMPLEX: usize = 64;
/// Vertices that share an entry of [`Ranges::hints`], as a power of two.
const HINT_BITS: u32 = 8;

/// Consecutive ranges of vertices.
pub(super) struct Ranges {
    /// Where each range starts, and the end.
    starts: Vec<u32>,
    /// For every so many vertices the range of the first.
    hints: Vec<u32>,
}

impl Ranges {
    /// The ranges between `starts`, which increase.
    pub(super) fn new(starts: Vec<u32>) -> Self {
        let mut range = 0;
        let end = starts.last().copied().unwrap_or(0);
        let hints = (0..=end >> HINT_BITS)
            .map(|hint| {
                while starts.get(range as usize + 1).is_some_and(|&next| next <= hint << HINT_BITS) {
                    range += 1;
                }
                range
            })
            .collect();
        Self { starts, hints }
    }

    /// Where each starts, and the end.
    pub(super) fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    pub(super) fn get(&self, range: usize) -> Range<u32> {
        self.starts[range]..self.starts[range + 1]
    }

    /// The range that has a vertex.
    #[inline]
    pub(super) fn of(&self, vertex: u32) -> usize {
        let mut range = self.hints[(vertex >> HINT_BITS) as usize] as usize;
        while self.starts[range + 1] <= vertex {
            range += 1;
        }
        range
    }
}

/// What is known of a complex before it is cut.
pub(super) struct Survey {
    /// In how many listed simplices each vertex is.
    weights: Vec<u32>,
    /// Bytes of the result for each (listed simplex, vertex), and for each simplex.
    bytes_per_weight: f64,
    bytes_per_simplex: f64,
}

/// The listed simplices around a range of vertices.
struct Sample {
    range: Range<u32>,
    words: Vec<Vec<u32>>,
    listed: usize,
    /// Pairs of one of them and a vertex in the range.
    weight: usize,
}

impl Survey {
    /// One pass over the listed simplices; samples are built in memory for a result of `bytes`.
    pub(super) fn new(listed: &Listed<'_>, bytes: u64) -> Result<Self, Error> {
        let num_vertices = listed.order.num_vertices();
        let mut weights = vec![0_u32; num_vertices];
        let total: usize = listed.spill.counts().iter().enumerate().map(|(dim, count)| (dim + 1) * count).sum();
        let len = (SAMPLE * num_vertices / total.max(1)).clamp(1, num_vertices.div_ceil(SAMPLES).max(1));
        let at = |vertex: usize| u32::try_from(vertex.min(num_vertices)).unwrap_or(u32::MAX);
        let mut samples: Vec<Sample> = (0..SAMPLES)
            .map(|number| number * num_vertices / SAMPLES)
            .map(|start| Sample { range: at(start)..at(start + len), words: Vec::new(), listed: 0, weight: 0 })
            .collect();
        listed.try_for_each(|dim, word| {
            for &vertex in word {
                let weight = &mut weights[vertex as usize];
                *weight = weight.saturating_add(1);
            }
            for sample in &mut samples {
                let weight = word.iter().filter(|vertex| sample.range.contains(vertex)).count();
                if weight > 0 && sample.listed < 4 * SAMPLE {
                    sample.add(dim, word, weight);
                }
            }
            Ok(())
        })?;
        let (mut bytes_per_weight, mut all_bytes, mut simplices) = (0_f64, 0, 0);
        for sample in samples.into_iter().filter(|sample| sample.weight > 0) {
            let weight = sample.weight;
            let (sample_bytes, sample_simplices) = sample.size(bytes / BYTES_PER_SIMPLEX as u64)?;
            bytes_per_weight = bytes_per_weight.max(ratio(sample_bytes, weight));
            all_bytes = sample_bytes.saturating_add(all_bytes);
            simplices = sample_simplices.saturating_add(simplices);
        }
        Ok(Self { weights, bytes_per_weight, bytes_per_simplex: ratio(all_bytes, simplices.max(1)).max(16.0) })
    }

    /// Assume that so many times more memory is needed than it seemed.
    pub(super) fn be_careful(&mut self, factor: f64) {
        self.bytes_per_weight *= factor;
    }

    /// Ranges of vertices whose pieces result in about `bytes` each, and are no larger if a range has more than one vertex.
    #[expect(clippy::cast_precision_loss, reason = "an estimate")]
    pub(super) fn cut(&self, bytes: u64) -> Ranges {
        let most = bytes as f64;
        let mut starts = vec![0];
        let mut taken = 0.0;
        for (vertex, &weight) in (0_u32..).zip(&self.weights) {
            // A vertex is a simplex even if nothing is around it.
            let more = f64::from(weight) * self.bytes_per_weight + 16.0;
            if taken + more > most && taken > 0.0 {
                starts.push(vertex);
                taken = 0.0;
            }
            taken += more;
        }
        if !self.weights.is_empty() {
            starts.push(u32::try_from(self.weights.len()).unwrap_or(u32::MAX));
        }
        Ranges::new(starts)
    }

    /// How many simplices take so many bytes.
    #[expect(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    pub(super) fn simplices(&self, bytes: u64) -> u64 {
        (bytes as f64 / self.bytes_per_simplex) as u64
    }
}

#[expect(clippy::cast_precision_loss, reason = "an estimate")]
fn ratio(a: usize, b: usize) -> f64 {
    a as f64 / b as f64
}

impl Sample {
    fn add(&mut self, dim: Dim, word: &[u32], weight: usize) {
        if self.words.len() <= dim {
            self.words.resize_with(dim + 1, Vec::new);
        }
        self.words[dim].extend_from_slice(word);
        self.listed += 1;
        self.weight += weight;
    }

    /// The bytes of the complex of the sample, and its simplices.
    fn size(self, limit: u64) -> Result<(usize, usize), Error> {
        match Piece::build(&self.range, self.words, limit) {
            Ok(piece) => Ok((bytes(&piece.arrays), piece.arrays.num_simplices)),
            Err(BuildError::TooLarge { at_least, .. }) => {
                let simplices = usize::try_from(at_least).unwrap_or(usize::MAX);
                Ok((simplices.saturating_mul(BYTES_PER_SIMPLEX), simplices))
            }
            Err(error) => Err(error.into()),
        }
    }
}

/// The bytes of the arrays at 32 bits.
fn bytes(arrays: &SigArrays<u32>) -> usize {
    let indices = arrays.boundary.len() + arrays.pointers.len() + arrays.lists.len() + arrays.child_offsets.len();
    4 * (indices + arrays.last_vertices.len())
}
