//! All pairs up to a radius, by a grid over the coordinates that tell points apart best.
//!
//! Cells are a little wider than the radius, so near points lie in the same or in neighbouring cells. Cells are sorted by
//! their places, last axis last, so that three neighbours along that axis are one run of points; the runs after a cell
//! are found by pointers that only move forward. A grid of no axes is one cell: all pairs, tile by tile. What is in
//! reach by the grid is decided by the exact distance.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use super::lanes::{LANES, Lanes, largest_rank, norm};
use crate::build::narrow;
use crate::points::{Metric, Points};

/// The most axes of a grid: a cell has 3^axes neighbours.
const MAX_AXES: usize = 5;

/// Bits of a cell's key, and the most for one axis.
const KEY_BITS: u32 = 60;
const AXIS_BITS: u32 = 20;

/// Points a task.
const TASK: usize = 512;

/// Bytes of a tile: what stays in the nearest cache while points are compared with it.
const TILE_BYTES: usize = 16 * 1024;

/// Numbers of two points each, the lower first.
pub(crate) type Pairs = Vec<(u32, u32)>;

/// The pairs at a distance of at most `radius`, in parts; in `Err` a number of pairs found that is above `limit`.
pub(super) fn pairs_within(points: &Points, metric: Metric, radius: f64, limit: usize) -> Result<Vec<Pairs>, usize> {
    let grid = Grid::new(points, metric, radius);
    let sorted = points.select(&grid.order);
    let search =
        Search { lanes: Lanes::new(&sorted, metric), points: &sorted, bound: largest_rank(metric, radius), grid };
    let found = AtomicUsize::new(0);
    let count = |more: usize| {
        let all = found.fetch_add(more, Ordering::Relaxed) + more;
        if all > limit { Err(all) } else { Ok(()) }
    };
    let tasks: Vec<usize> = (0..points.len()).step_by(TASK).collect();
    let search = |start: usize| search.task(start, (start + TASK).min(points.len()), count);
    tasks.into_par_iter().map(search).collect()
}

/// A cell's key, and where its points begin in the order of cells.
#[derive(Clone, Copy)]
struct Cell {
    key: u64,
    start: usize,
}

/// Points sorted by cell.
struct Grid {
    /// The numbers of the points, cell by cell, increasing within a cell.
    order: Vec<usize>,
    /// The cells that hold points, by key, and one past the end.
    cells: Vec<Cell>,
    /// What to add to the key of a cell for the middle one of three cells after it, increasing.
    forward: Vec<u64>,
}

/// One axis of a grid.
struct Axis {
    coordinate: usize,
    low: f64,
    width: f64,
    /// The share of the pairs of points that lie in the same or neighbouring cells.
    share: f64,
}

impl Axis {
    /// The cell of a coordinate, from 0.
    ///
    /// Subtraction, division and rounding down are monotone, and each is off by less than a millionth of the width, by
    /// which cells are wider than the radius: points in reach are at most one cell apart.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a cast saturates")]
    fn cell(&self, value: f64) -> u64 {
        ((value - self.low) / self.width) as u64
    }

    /// The axis over one coordinate of the points, unless it would tell nothing.
    #[expect(clippy::cast_precision_loss, reason = "a share need not be exact")]
    fn new(points: &Points, coordinate: usize, reach: f64, bits: u32) -> Option<Self> {
        let values = || points.values().iter().skip(coordinate).step_by(points.dim());
        let (low, high) =
            values().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &value| (low.min(value), high.max(value)));
        let extent = high - low;
        // Two cells are left at the ends, so that a neighbour is never a cell of another row.
        let most = f64::from((1_u32 << bits) - 4);
        let width = (reach * (1.0 + 1e-6)).max(extent / most);
        if !(extent.is_finite() && width > 0.0 && width.is_finite()) {
            return None;
        }
        let mut axis = Self { coordinate, low, width, share: 1.0 };
        let mut counts = vec![0_u32; usize::try_from(axis.cell(high)).ok()? + 2];
        for &value in values() {
            counts[usize::try_from(axis.cell(value)).ok()?] += 1;
        }
        let near = counts.windows(2).map(|pair| f64::from(pair[0]) * (f64::from(pair[0]) + 2.0 * f64::from(pair[1])));
        axis.share = near.sum::<f64>() / (points.len() as f64).powi(2);
        Some(axis)
    }
}

impl Grid {
    fn new(points: &Points, metric: Metric, radius: f64) -> Self {
        let space = match metric {
            Metric::Cosine => directions(points).map(Cow::Owned),
            _ => Some(Cow::Borrowed(points)),
        };
        match space {
            Some(space) => Self::over(&space, &axes(&space, reach(metric, radius))),
            None => Self::over(points, &[]),
        }
    }

    fn over(points: &Points, axes: &[Axis]) -> Self {
        let bits = axis_bits(points.dim());
        let mut keyed: Vec<(u64, u32)> = (0..points.len())
            .into_par_iter()
            .map(|index| {
                let point = points.point(index);
                let key = axes.iter().fold(0, |key, axis| key << bits | (axis.cell(point[axis.coordinate]) + 1));
                (key, narrow(index))
            })
            .collect();
        keyed.par_sort_unstable();
        let order = keyed.iter().map(|&(_, index)| index as usize).collect();
        let mut cells: Vec<Cell> = Vec::new();
        for (start, &(key, _)) in keyed.iter().enumerate() {
            if cells.last().is_none_or(|last| last.key != key) {
                cells.push(Cell { key, start });
            }
        }
        cells.push(Cell { key: u64::MAX, start: points.len() });
        Self { order, cells, forward: forward(axes.len(), bits) }
    }

    /// Where the cells from `key` on begin in `cells`.
    fn find(&self, key: u64) -> usize {
        self.cells.partition_point(|cell| cell.key < key)
    }
}

/// The axes that leave fewest pairs to look at: those of the smallest shares, as long as one more pays.
#[expect(clippy::cast_precision_loss, reason = "an estimate")]
fn axes(points: &Points, reach: f64) -> Vec<Axis> {
    /// Candidates a point that are compared about as fast as the runs of one more axis are found.
    const FEW: f64 = 12.0;
    /// The share above which an axis costs more than it saves.
    const PAYS: f64 = 0.8;
    let bits = axis_bits(points.dim());
    let all = (0..points.dim()).into_par_iter().filter_map(|coordinate| Axis::new(points, coordinate, reach, bits));
    let mut axes: Vec<Axis> = all.collect();
    axes.sort_by(|a, b| a.share.total_cmp(&b.share));
    let mut candidates = points.len() as f64;
    let pays = |axis: &&Axis| {
        let pays = candidates > FEW && axis.share < PAYS;
        candidates *= axis.share;
        pays
    };
    let count = axes.iter().take(MAX_AXES).take_while(pays).count();
    axes.truncate(count);
    axes
}

fn axis_bits(dim: usize) -> u32 {
    (KEY_BITS / narrow(dim.clamp(1, MAX_AXES))).min(AXIS_BITS)
}

/// How far apart two points in reach can be along an axis.
///
/// Squares below the least number vanish from a distance, so anything up to their roots counts as near.
fn reach(metric: Metric, radius: f64) -> f64 {
    match metric {
        // Of unit vectors, |u − v|² = 2 (1 − u·v); both sides are rounded.
        Metric::Cosine => (2.0 * radius + 1e-9).sqrt(),
        _ => radius.max(1e-150),
    }
}

/// The points as unit vectors, in which the cosine is a distance along every axis; `None` if lengths are so large or
/// small that the rule of the distance is no longer that of angles.
fn directions(points: &Points) -> Option<Points> {
    let mut values = Vec::with_capacity(points.values().len());
    for point in (0..points.len()).map(|index| points.point(index)) {
        let norm = norm(point);
        if norm != 0.0 && !(1e-100..=1e100).contains(&norm) || norm == 0.0 && point.iter().any(|&x| x != 0.0) {
            return None;
        }
        values.extend(point.iter().map(|x| if norm > 0.0 { x / norm } else { 0.0 }));
    }
    Points::new(points.dim(), values).ok()
}

/// The keys, relative to that of a cell, of the middle ones of the runs of three cells after it.
fn forward(axes: usize, bits: u32) -> Vec<u64> {
    let rows = axes.saturating_sub(1);
    let mut steps = vec![0_i64];
    for axis in 1..=rows {
        let step = 1_i64 << (bits * narrow(axis));
        steps = steps.iter().flat_map(|&sum| [sum - step, sum, sum + step]).collect();
    }
    let mut forward: Vec<u64> =
        steps.into_iter().filter(|&step| step > 0).filter_map(|step| step.try_into().ok()).collect();
    forward.sort_unstable();
    forward
}

/// The search for the pairs of points that are sorted by cell.
struct Search<'a> {
    grid: Grid,
    points: &'a Points,
    lanes: Lanes,
    /// The largest rank of a pair within the radius.
    bound: f64,
}

impl Search<'_> {
    /// The pairs of the points `start..end` in the order of cells with those after them; `found` is told how many, now
    /// and then.
    fn task(&self, start: usize, end: usize, found: impl Fn(usize) -> Result<(), usize>) -> Result<Pairs, usize> {
        let Grid { cells, forward, .. } = &self.grid;
        let mut pairs = Pairs::new();
        let first = cells.partition_point(|cell| cell.start <= start) - 1;
        let mut runs: Vec<usize> = forward.iter().map(|step| self.grid.find(cells[first].key + step - 1)).collect();
        for (at, cell) in (first..).zip(&cells[first..]).take_while(|(_, cell)| cell.start < end) {
            let own = cell.start.max(start)..cells[at + 1].start.min(end);
            let before = pairs.len();
            // The rest of the cell, and the next cell along the last axis.
            let past = if cells[at + 1].key == cell.key + 1 { at + 2 } else { at + 1 };
            self.compare(own.clone(), own.start + 1..cells[past].start, &mut pairs);
            for (run, step) in runs.iter_mut().zip(forward) {
                let middle = cell.key + step;
                while cells[*run].key < middle - 1 {
                    *run += 1;
                }
                // The one past the end has a key above all others.
                let mut past = *run;
                while cells[past].key <= middle + 1 {
                    past += 1;
                }
                if past > *run {
                    self.compare(own.clone(), cells[*run].start..cells[past].start, &mut pairs);
                }
            }
            found(pairs.len() - before)?;
        }
        Ok(pairs)
    }

    /// Adds the pairs of a point of `own` and a later one of `run` that are within the radius.
    fn compare(&self, own: Range<usize>, run: Range<usize>, pairs: &mut Pairs) {
        let tile = (TILE_BYTES / (LANES * size_of::<f64>() * self.points.dim().max(1))).max(1);
        let blocks = run.start / LANES..run.end.div_ceil(LANES);
        for first in blocks.clone().step_by(tile) {
            let last = (first + tile).min(blocks.end);
            for i in own.clone() {
                let run = run.start.max(i + 1)..run.end;
                let point = self.points.point(i);
                for block in first.max(run.start / LANES)..last {
                    let Some(ranks) = self.lanes.ranks_within(point, block, self.bound) else { continue };
                    if !ranks.iter().any(|&rank| rank <= self.bound) {
                        continue;
                    }
                    for (j, rank) in (block * LANES..).zip(ranks) {
                        if rank <= self.bound && run.contains(&j) {
                            let (a, b) = (self.grid.order[i], self.grid.order[j]);
                            pairs.push((narrow(a.min(b)), narrow(a.max(b))));
                        }
                    }
                }
            }
        }
    }
}
