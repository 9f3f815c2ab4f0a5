//! The nearest landmarks of every witness: all that a witness complex knows of the points.

use rayon::prelude::*;

use crate::points::{Metric, Points};
use crate::proximity::lanes::{LANES, Lanes, distance_of_rank, largest_rank};
use crate::witness::Relaxation;

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
pub(super) struct Search {
    lanes: Lanes,
    count: usize,
    scale: Scale,
}

impl Search {
    pub(super) fn new(landmarks: &Points, scale: Scale) -> Self {
        Self { lanes: Lanes::new(landmarks, scale.metric), count: landmarks.len(), scale }
    }

    /// For each of the given witnesses, the `depth` nearest landmarks and all others that are farther than the last of
    /// these by at most the relaxation.
    ///
    /// Time: O(witnesses · landmarks) distances, in rayon's current pool. Landmarks come by in tiles that stay in the
    /// nearest cache while several witnesses look at them.
    pub(super) fn nearest(&self, points: &Points, witnesses: &[u32], depth: usize) -> Table {
        /// Witnesses a task.
        const WITNESSES: usize = 64;
        let rows: Vec<Vec<Vec<Near>>> =
            witnesses.par_chunks(WITNESSES).map(|witnesses| self.rows(points, witnesses, depth)).collect();
        Table::of_rows(rows.into_iter().flatten())
    }

    fn rows(&self, points: &Points, witnesses: &[u32], depth: usize) -> Vec<Vec<Near>> {
        /// Bytes of coordinates in a tile.
        const TILE: usize = 1 << 14;
        let blocks = self.lanes.num_blocks();
        let tile = (TILE / (size_of::<f64>() * LANES * points.dim().max(1))).max(1);
        let mut rows = vec![Nearest::new(depth, self.scale); witnesses.len()];
        for start in (0..blocks).step_by(tile) {
            for (row, &witness) in rows.iter_mut().zip(witnesses) {
                let point = points.point(witness as usize);
                for block in start..blocks.min(start + tile) {
                    if let Some(ranks) = self.lanes.ranks_within(point, block, row.bound) {
                        row.offer(block * LANES, &ranks[..LANES.min(self.count - block * LANES)]);
                    }
                }
            }
        }
        rows.into_iter().map(Nearest::finish).collect()
    }
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
            (Relaxation::Squared(_), _) => (distance.sqrt() * (1.0 + SLACK)).next_up(),
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
        Self { depth, scale, bound: f64::INFINITY, seen: Vec::new(), room: 2 * depth + LANES }
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
