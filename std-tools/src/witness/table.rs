//! The nearest landmarks of every witness: all that a witness complex knows of the points.

use rayon::prelude::*;

use crate::points::{Metric, Points, squared_distance};
use crate::proximity::lanes::{LANES, Lanes, distance_of_rank, largest_rank};
use crate::witness::Relaxation;
use crate::witness::sieve::{self, Sieve, View};

/// For each of some witnesses, landmarks by increasing distance, of equal ones the lower number first.
#[derive(Clone, Debug, Default)]
pub(super) struct Table {
    /// Where the row of each witness starts, and the end.
    starts: Vec<usize>,
    landmarks: Vec<u32>,
    /// The distances, or their squares if relaxations are differences of squares; infinity is the largest number.
    distances: Vec<f64>,
}

/// What one witness sees.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<'a> {
    pub(super) landmarks: &'a [u32],
    pub(super) distances: &'a [f64],
}

impl<'a> Row<'a> {
    pub(super) fn iter(self) -> impl Iterator<Item = Near> + 'a {
        let pairs = self.distances.iter().zip(self.landmarks);
        pairs.map(|(&distance, &landmark)| Near { distance, landmark })
    }

    /// How many of the landmarks are farther than the one of rank `rank` by no more than `relaxation`, or nearer.
    pub(super) fn width(self, rank: usize, relaxation: f64) -> usize {
        let last = self.distances[rank];
        rank + self.distances[rank..].partition_point(|distance| distance - last <= relaxation)
    }
}

impl Table {
    pub(super) fn row(&self, witness: usize) -> Row<'_> {
        let range = self.starts[witness]..self.starts[witness + 1];
        Row { landmarks: &self.landmarks[range.clone()], distances: &self.distances[range] }
    }

    fn of_rows(rows: impl Iterator<Item = Vec<Near>>) -> Self {
        let mut table = Self { starts: vec![0], ..Self::default() };
        for row in rows {
            table.landmarks.extend(row.iter().map(|near| near.landmark));
            table.distances.extend(row.iter().map(|near| near.distance));
            table.starts.push(table.landmarks.len());
        }
        table
    }
}

/// A landmark near a witness.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Near {
    pub(super) distance: f64,
    pub(super) landmark: u32,
}

impl Near {
    pub(super) fn order(&self, other: &Self) -> std::cmp::Ordering {
        self.distance.total_cmp(&other.distance).then(self.landmark.cmp(&other.landmark))
    }
}

/// Distances from landmarks, in the convention of a relaxation.
pub(super) struct Search<'a> {
    landmarks: &'a Points,
    scale: Scale,
    blocks: Blocks,
}

/// Landmarks as they are looked at.
enum Blocks {
    /// For the Euclidean distance.
    Sieve(Sieve),
    /// For others.
    Lanes(Lanes),
}

impl<'a> Search<'a> {
    pub(super) fn new(landmarks: &'a Points, scale: Scale) -> Self {
        let blocks = match scale.metric {
            Metric::Euclidean => Blocks::Sieve(Sieve::new(landmarks)),
            metric => Blocks::Lanes(Lanes::new(landmarks, metric)),
        };
        Self { landmarks, scale, blocks }
    }

    /// For each of the given witnesses, the `depth` nearest landmarks and all others that are farther than the last of
    /// these by at most the relaxation.
    ///
    /// Time: O(witnesses · landmarks) distances, in rayon's current pool. Landmarks come by in tiles that stay in the
    /// nearest cache while several witnesses look at them.
    pub(super) fn nearest(&self, points: &Points, witnesses: &[u32], depth: usize) -> Table {
        /// Witnesses a task.
        const WITNESSES: usize = 64;
        let rows = |witnesses: &[u32]| {
            let points: Vec<&[f64]> = witnesses.iter().map(|&witness| points.point(witness as usize)).collect();
            let rows = vec![Nearest::new(depth, self.scale); points.len()];
            match &self.blocks {
                Blocks::Sieve(sieve) => self.sift(sieve, &points, rows),
                Blocks::Lanes(lanes) => self.scan(lanes, &points, rows),
            }
        };
        let rows: Vec<Vec<Vec<Near>>> = witnesses.par_chunks(WITNESSES).map(rows).collect();
        Table::of_rows(rows.into_iter().flatten())
    }

    /// The rows of some witnesses, where the sieve says which landmarks are looked at.
    fn sift(&self, sieve: &Sieve, points: &[&[f64]], mut rows: Vec<Nearest>) -> Vec<Vec<Near>> {
        let blocks = sieve.num_blocks();
        let tile = blocks_a_tile(self.landmarks.dim() * sieve::WIDTH * size_of::<f32>());
        let views: Vec<View> = points.iter().map(|point| sieve.view(point)).collect();
        for start in (0..blocks).step_by(tile) {
            for ((row, view), point) in rows.iter_mut().zip(&views).zip(points) {
                let mut bound = sieve.bound(view, row.bound);
                for block in start..blocks.min(start + tile) {
                    let mut near = sieve.near(view, block, bound);
                    while near != 0 {
                        let landmark = block * sieve::WIDTH + near.trailing_zeros() as usize;
                        near &= near - 1;
                        if landmark < self.landmarks.len() {
                            row.offer(landmark, &[squared_distance(point, self.landmarks.point(landmark))]);
                        }
                        if near == 0 {
                            bound = sieve.bound(view, row.bound);
                        }
                    }
                }
            }
        }
        rows.into_iter().map(Nearest::finish).collect()
    }

    /// The rows of some witnesses.
    fn scan(&self, lanes: &Lanes, points: &[&[f64]], mut rows: Vec<Nearest>) -> Vec<Vec<Near>> {
        let count = self.landmarks.len();
        let blocks = count.div_ceil(LANES);
        let tile = blocks_a_tile(self.landmarks.dim() * LANES * size_of::<f64>());
        for start in (0..blocks).step_by(tile) {
            for (row, point) in rows.iter_mut().zip(points) {
                for block in start..blocks.min(start + tile) {
                    if let Some(ranks) = lanes.ranks_within(point, block, row.bound) {
                        row.offer(block * LANES, &ranks[..LANES.min(count - block * LANES)]);
                    }
                }
            }
        }
        rows.into_iter().map(Nearest::finish).collect()
    }
}

/// Blocks of so many bytes that together stay in the nearest cache.
fn blocks_a_tile(bytes: usize) -> usize {
    const TILE: usize = 1 << 14;
    (TILE / bytes.max(1)).max(1)
}

/// What a distance is in a table.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    pub(super) metric: Metric,
    pub(super) relaxation: Relaxation,
}

impl Scale {
    /// The distance, or its square, of a rank.
    fn distance(self, rank: f64) -> f64 {
        let distance = match (self.relaxation, self.metric) {
            (Relaxation::Distance(_), metric) => distance_of_rank(metric, rank),
            (Relaxation::Squared(_), Metric::Euclidean) => rank,
            (Relaxation::Squared(_), _) => rank * rank,
        };
        distance.min(f64::MAX)
    }

    /// A rank that none is above whose distance, or its square, is at most `distance`.
    fn bound(self, distance: f64) -> f64 {
        match (self.relaxation, self.metric) {
            _ if distance >= f64::MAX => f64::INFINITY,
            (Relaxation::Distance(_), metric) => largest_rank(metric, distance),
            (Relaxation::Squared(_), Metric::Euclidean) => distance,
            // A square that underflows says little of its root: all roots of what is subnormal are within.
            (Relaxation::Squared(_), _) => (distance.max(f64::MIN_POSITIVE).sqrt() * (1.0 + SLACK)).next_up(),
        }
    }
}

/// More than the relative error of two or three roundings.
const SLACK: f64 = 4.0 * f64::EPSILON;

/// The nearest of the landmarks that one witness has seen so far, and some that are not.
#[derive(Clone)]
struct Nearest {
    depth: usize,
    scale: Scale,
    /// Ranks above it are too far.
    bound: f64,
    seen: Vec<Near>,
    /// How many are kept before it is looked which are too far.
    room: usize,
}

impl Nearest {
    fn new(depth: usize, scale: Scale) -> Self {
        Self { depth, scale, bound: f64::INFINITY, seen: Vec::new(), room: 2 * depth.max(4) }
    }

    /// Takes the landmarks from number `first` on that are not too far.
    #[inline]
    fn offer(&mut self, first: usize, ranks: &[f64]) {
        for (landmark, &rank) in (first..).zip(ranks) {
            if rank <= self.bound {
                self.seen.push(Near { distance: self.scale.distance(rank), landmark: crate::build::narrow(landmark) });
            }
        }
        if self.seen.len() >= self.room {
            self.drop_far();
        }
    }

    /// Drops what is farther than the depth-th nearest by more than the relaxation.
    fn drop_far(&mut self) {
        if self.seen.len() < self.depth || self.depth == 0 {
            return;
        }
        let relaxation = self.scale.relaxation.amount();
        let last = self.seen.select_nth_unstable_by(self.depth - 1, Near::order).1.distance;
        self.seen.retain(|near| near.distance - last <= relaxation);
        self.bound = self.scale.bound((last + relaxation) * (1.0 + SLACK));
        self.room = self.room.max(2 * self.seen.len());
    }

    fn finish(mut self) -> Vec<Near> {
        self.drop_far();
        self.seen.sort_unstable_by(Near::order);
        self.seen
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::cube;

    /// All landmarks sorted, and cut as the definition of a row says.
    fn by_sorting(point: &[f64], landmarks: &Points, scale: Scale, depth: usize) -> Vec<Near> {
        let distance = |landmark| {
            let distance = scale.metric.distance(point, landmarks.point(landmark));
            let square = match scale.metric {
                Metric::Euclidean => squared_distance(point, landmarks.point(landmark)),
                _ => distance * distance,
            };
            if matches!(scale.relaxation, Relaxation::Squared(_)) { square } else { distance }.min(f64::MAX)
        };
        let near = |landmark| Near { distance: distance(landmark), landmark: crate::build::narrow(landmark) };
        let mut row: Vec<Near> = (0..landmarks.len()).map(near).collect();
        row.sort_by(Near::order);
        let last = row[depth.min(row.len()) - 1].distance;
        row.retain(|near| near.distance - last <= scale.relaxation.amount());
        row
    }

    /// Near zero, far from the origin, tiny and huge, where single precision underflows and overflows.
    #[test]
    fn rows_are_those_of_a_sort_at_any_place_and_size() {
        let unit = cube(150, 3, 5);
        for (factor, offset) in
            [(1.0, 0.0), (1.0, 1e6), (1e-3, 1e8), (1e-25, 0.0), (1e-170, 0.0), (1e25, 0.0), (1e200, 0.0)]
        {
            let values: Vec<f64> = unit.values().iter().map(|value| offset + factor * value).collect();
            let points = Points::new(3, values).unwrap();
            let landmarks = points.select(&(0..90).collect::<Vec<_>>());
            let witnesses: Vec<u32> = (0..150).collect();
            for metric in [Metric::Euclidean, Metric::Maximum, Metric::Cosine] {
                for amount in [0.0, 0.05] {
                    let squared = Relaxation::Squared((amount * factor) * factor);
                    for relaxation in [Relaxation::Distance(amount * factor), squared] {
                        let scale = Scale { metric, relaxation };
                        for depth in [1, 4, 200] {
                            let table = Search::new(&landmarks, scale).nearest(&points, &witnesses, depth);
                            for witness in 0..150 {
                                let row: Vec<Near> = table.row(witness).iter().collect();
                                let expected = by_sorting(points.point(witness), &landmarks, scale, depth);
                                assert_eq!(row, expected, "{scale:?} {factor} {offset} {depth} {witness}");
                            }
                        }
                    }
                }
            }
        }
    }
}
