//! A few points that stand for many: the greedy permutation ([`farthest_points`]).

use rayon::prelude::*;

use crate::distances::Distances;
use crate::points::{Metric, Points};
use crate::proximity::lanes::{LANES, Lanes, distance_of_rank};

/// Points chosen one after the other, each the farthest from those before it.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct FarthestPoints {
    /// The numbers of the points, in the order in which they were chosen.
    pub indices: Vec<usize>,
    /// After each choice, the largest distance of any point to its nearest chosen one; it never increases.
    pub covering_radii: Vec<f64>,
}

/// The first `count` points of the greedy permutation (maxmin, farthest-point sampling) that begins with `start`: each
/// next point is the one farthest from those already chosen, of several the one with the lowest number. All points if
/// there are not more.
///
/// Distances are compared as [`Metric::distance`] gives them, so the choice is the same on every machine and for any
/// number of threads. Time: O(n · `count`) distances, in rayon's current pool; memory: a copy of the points.
///
/// The procedure of Gonzalez (1985); for a metric, the covering radius is at most twice the least possible.
///
/// # Panics
/// If there are points, and `start` is past the last.
#[must_use]
pub fn farthest_points(points: &Points, metric: Metric, count: usize, start: usize) -> FarthestPoints {
    /// Blocks a task: more than a task costs to start.
    const BLOCKS: usize = 64;
    let lanes = Lanes::new(points, metric);
    let nearer = |chosen: usize, nearest: &mut [f64]| {
        let point = points.point(chosen);
        nearest.par_chunks_mut(BLOCKS * LANES).enumerate().for_each(|(task, nearest)| {
            for (block, nearest) in (task * BLOCKS..).zip(nearest.chunks_mut(LANES)) {
                for (nearest, rank) in nearest.iter_mut().zip(lanes.ranks(point, block)) {
                    *nearest = if rank < *nearest { rank } else { *nearest };
                }
            }
        });
    };
    greedy(points.len(), count, start, nearer, |rank| distance_of_rank(metric, rank))
}

/// The same for points given by their distances.
///
/// # Panics
/// If there are points, and `start` is past the last.
#[must_use]
pub fn farthest_points_of(distances: &Distances, count: usize, start: usize) -> FarthestPoints {
    let nearer = |chosen: usize, nearest: &mut [f64]| {
        for (other, nearest) in nearest.iter_mut().enumerate() {
            *nearest = nearest.min(distances.distance(chosen, other));
        }
    };
    greedy(distances.len(), count, start, nearer, |distance| distance)
}

/// The greedy permutation, where `nearer` lowers the rank of every point's nearest chosen point to that of a new one.
fn greedy(
    len: usize,
    count: usize,
    start: usize,
    nearer: impl Fn(usize, &mut [f64]),
    distance: impl Fn(f64) -> f64,
) -> FarthestPoints {
    /// The rank of chosen points: they are never the farthest, not even among points that are all at one place.
    const CHOSEN: f64 = f64::NEG_INFINITY;
    let mut chosen = FarthestPoints::default();
    let mut nearest = vec![f64::INFINITY; len];
    let mut next = start;
    assert!(len == 0 || start < len, "start {start} of {len} points");
    while chosen.indices.len() < count.min(len) {
        chosen.indices.push(next);
        nearest[next] = CHOSEN;
        nearer(next, &mut nearest);
        let most = nearest.iter().fold(CHOSEN, |most, &rank| if rank > most { rank } else { most });
        chosen.covering_radii.push(if most > CHOSEN { distance(most) } else { 0.0 });
        // Different squares may have one root: look for the first of those that are as far, not of the largest rank.
        let (nearly, farthest) = (most * (1.0 - 1e-12), distance(most));
        next = nearest.iter().position(|&rank| rank >= nearly && distance(rank) >= farthest).unwrap_or(next);
    }
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::cube;
    use proptest::prelude::*;

    /// The definition: of the points not chosen, the first with the largest distance to its nearest chosen one.
    fn by_definition(len: usize, count: usize, start: usize, distance: impl Fn(usize, usize) -> f64) -> FarthestPoints {
        let mut found = FarthestPoints::default();
        let mut next = Some(start);
        while let Some(point) = next.filter(|_| found.indices.len() < count) {
            found.indices.push(point);
            let nearest = |i: usize| found.indices.iter().map(|&j| distance(i, j)).fold(f64::INFINITY, f64::min);
            let others = (0..len).filter(|i| !found.indices.contains(i));
            next = others.clone().rev().max_by(|&a, &b| nearest(a).total_cmp(&nearest(b)));
            let radius = next.map_or(0.0, nearest);
            found.covering_radii.push(radius);
        }
        found
    }

    const METRICS: [Metric; 4] = [Metric::Euclidean, Metric::Maximum, Metric::Manhattan, Metric::Cosine];

    proptest! {
        /// Small whole coordinates give many ties and repeated points.
        #[test]
        fn the_choice_is_that_of_the_definition(
            values in proptest::collection::vec(-3i8..4, 2..120), dim in 1usize..4, count in 0usize..70, metric in 0..4usize
        ) {
            let whole = values.len() / dim * dim;
            let points = Points::new(dim, values[..whole].iter().map(|&value| value.into()).collect()).unwrap();
            let metric = METRICS[metric];
            let distance = |i, j| metric.distance(points.point(i), points.point(j));
            prop_assume!(!points.is_empty());
            let start = count % points.len();
            let expected = by_definition(points.len(), count, start, distance);
            prop_assert_eq!(&farthest_points(&points, metric, count, start), &expected);
            let lower = (0..points.len()).flat_map(|i| (0..i).map(move |j| distance(i, j))).collect();
            let matrix = Distances::new(points.len(), lower).unwrap();
            prop_assert_eq!(&farthest_points_of(&matrix, count, start), &expected);
        }
    }

    #[test]
    fn many_points_are_chosen_as_by_the_definition() {
        let points = cube(700, 9, 2);
        let distance = |i, j| Metric::Euclidean.distance(points.point(i), points.point(j));
        assert_eq!(farthest_points(&points, Metric::Euclidean, 40, 11), by_definition(700, 40, 11, distance));
    }

    #[test]
    fn of_no_point_none_is_chosen() {
        assert_eq!(farthest_points(&Points::default(), Metric::Euclidean, 3, 0), FarthestPoints::default());
        assert_eq!(farthest_points_of(&Distances::default(), 3, 0), FarthestPoints::default());
    }
}
