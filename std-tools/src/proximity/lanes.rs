//! Distances of one point to many at a time, each to the last bit what [`Metric::distance`] gives.
//!
//! Points stand in blocks of [`LANES`], a block coordinate by coordinate. The sums of a block run side by side in vector
//! registers, each of them left to right over the coordinates, so the rule of the sum holds and nothing is checked
//! again. The searches of this module and the greedy permutation of [`crate::subsample`] are made of it.

use crate::points::{Metric, Points};

/// Points a block.
pub(crate) const LANES: usize = 8;

/// Coordinates between two looks at whether a block is already too far.
const STRIDE: usize = 8;

/// Points in blocks, for one metric.
///
/// It computes *ranks*: the square of a Euclidean distance, of other metrics the distance. Ranks order pairs as
/// distances do.
pub(crate) struct Lanes {
    metric: Metric,
    dim: usize,
    /// The coordinates of a block's points, axis by axis; zero past the last point.
    values: Vec<[f64; LANES]>,
    /// √p·p of every point, for the cosine.
    norms: Vec<[f64; LANES]>,
}

impl Lanes {
    pub(crate) fn new(points: &Points, metric: Metric) -> Self {
        let (dim, blocks) = (points.dim(), points.len().div_ceil(LANES));
        let mut values = vec![[0.0; LANES]; dim * blocks];
        let mut norms = vec![[0.0; LANES]; if metric == Metric::Cosine { blocks } else { 0 }];
        for index in 0..points.len() {
            let (block, lane) = (index / LANES, index % LANES);
            let point = points.point(index);
            for (row, &value) in values[block * dim..].iter_mut().zip(point) {
                row[lane] = value;
            }
            if let Some(norms) = norms.get_mut(block) {
                norms[lane] = norm(point);
            }
        }
        Self { metric, dim, values, norms }
    }

    /// The ranks of a point and the points of a block.
    pub(crate) fn ranks(&self, point: &[f64], block: usize) -> [f64; LANES] {
        self.ranks_within(point, block, f64::INFINITY).unwrap_or([f64::INFINITY; LANES])
    }

    /// The ranks of a point and the points of a block, unless it shows halfway that all of them are above `bound`.
    #[inline]
    pub(crate) fn ranks_within(&self, point: &[f64], block: usize, bound: f64) -> Option<[f64; LANES]> {
        let rows = &self.values[block * self.dim..(block + 1) * self.dim];
        match self.metric {
            Metric::Euclidean => accumulate(point, rows, bound, |sum, a, b| sum + (a - b) * (a - b)),
            Metric::Manhattan => accumulate(point, rows, bound, |sum, a, b| sum + (a - b).abs()),
            Metric::Maximum => accumulate(point, rows, bound, |most, a, b| {
                let distance = (a - b).abs();
                if distance > most { distance } else { most }
            }),
            Metric::Cosine => {
                // The terms may be negative: no sum shows anything before its end.
                let mut ranks = accumulate(point, rows, f64::INFINITY, |sum, a, b| sum + a * b)?;
                let own = norm(point);
                for (rank, norm) in ranks.iter_mut().zip(&self.norms[block]) {
                    let norms = own * norm;
                    *rank = if norms > 0.0 { (1.0 - *rank / norms).max(0.0) } else { 1.0 };
                }
                Some(ranks)
            }
        }
    }
}

/// √p·p, left to right.
pub(crate) fn norm(point: &[f64]) -> f64 {
    point.iter().fold(0.0, |sum, x| sum + x * x).sqrt()
}

/// The sums of a block, `None` once all of them are above `bound`; the terms must not be negative if it is finite.
#[inline(always)]
fn accumulate(
    point: &[f64],
    rows: &[[f64; LANES]],
    bound: f64,
    add: impl Fn(f64, f64, f64) -> f64,
) -> Option<[f64; LANES]> {
    let mut sums = [0.0; LANES];
    for (coordinates, rows) in point.chunks(STRIDE).zip(rows.chunks(STRIDE)) {
        for (&a, row) in coordinates.iter().zip(rows) {
            for (sum, &b) in sums.iter_mut().zip(row) {
                *sum = add(*sum, a, b);
            }
        }
        if coordinates.len() == STRIDE && sums.iter().all(|&sum| sum > bound) {
            return None;
        }
    }
    Some(sums)
}

/// The distance of a pair with this rank.
#[inline]
pub(crate) fn distance_of_rank(metric: Metric, rank: f64) -> f64 {
    if metric == Metric::Euclidean { rank.sqrt() } else { rank }
}

/// The largest rank whose distance is at most `radius`, which is not negative.
pub(crate) fn largest_rank(metric: Metric, radius: f64) -> f64 {
    if metric != Metric::Euclidean || radius.is_infinite() {
        return radius;
    }
    // The root is monotone, and the square is off by a rounding or two.
    let mut rank = radius * radius;
    while rank.sqrt() <= radius {
        rank = rank.next_up();
    }
    while rank.sqrt() > radius {
        rank = rank.next_down();
    }
    rank
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{SplitMix64, cube};

    #[test]
    fn ranks_are_the_distances_to_the_last_bit() {
        for metric in [Metric::Euclidean, Metric::Maximum, Metric::Manhattan, Metric::Cosine] {
            for (count, dim) in [(1, 1), (8, 3), (21, 8), (40, 25)] {
                let points = cube(count, dim, 7);
                let lanes = Lanes::new(&points, metric);
                for i in 0..count {
                    for block in 0..count.div_ceil(LANES) {
                        let ranks = lanes.ranks(points.point(i), block);
                        for (rank, j) in ranks.into_iter().zip(block * LANES..count) {
                            let distance = metric.distance(points.point(i), points.point(j));
                            assert_eq!(distance_of_rank(metric, rank).to_bits(), distance.to_bits());
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn the_largest_rank_is_the_last_whose_root_is_at_most_the_radius() {
        let mut random = SplitMix64::new(1);
        let radii = [0.0, 5e-324, 1e-162, 1e-160, 1e-3, 0.253, 1.0, 2f64.sqrt(), 1e154, 1e155, f64::MAX];
        for radius in radii.into_iter().chain((0..1000).map(|_| random.next_unit())) {
            let rank = largest_rank(Metric::Euclidean, radius);
            assert!(rank.sqrt() <= radius && rank.next_up().sqrt() > radius, "{radius:e}");
        }
        assert_eq!(largest_rank(Metric::Euclidean, f64::INFINITY), f64::INFINITY);
    }
}
