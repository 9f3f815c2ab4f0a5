//! Coreductions: pairs of a cell and a coface of which it is the last face left (M. Mrozek and B. Batko, *Coreduction homology
//! algorithm*, 2009). In the order in which they are found they are an acyclic matching of discrete Morse theory.
//!
//! Cofaces that are ready wait in a set of bits, which is swept from the least to the greatest: near numbers are near in the
//! complex, so what one step touches the next ones touch too.

use std::ops::AddAssign;

use num_traits::{PrimInt, Unsigned};
use rayon::prelude::*;
use sig_core::Index;

use super::bits::{Bits, Sweep};
use super::chains::Level;
use super::limits::{Stopped, Watch};
use crate::build::narrow;

/// What happens to a cell: it goes together with a coface, or, without one, stays as a critical cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    pub(super) cell: u32,
    /// [`NONE`] if the cell is critical.
    pub(super) coface: u32,
}

/// No cell.
pub(super) const NONE: u32 = u32::MAX;

/// Steps for all cells of one dimension that are not gone.
pub(super) struct Matching {
    /// Every face of a coface other than its own cell comes before it, or is gone from the start.
    pub(super) steps: Vec<Step>,
    /// The critical cells, in the order of the steps.
    pub(super) critical: Vec<u32>,
}

/// Steps between two looks at the watch.
const PATIENCE: usize = 1 << 16;

/// Pairs the `num_cells` cells of a dimension that are not `gone` with those of `above` that are not; these go, too.
///
/// Where no coreduction is left, the first cell that is left becomes critical. Cost: two passes over the faces to invert them,
/// in parallel, and one over the cofaces of each cell.
pub(super) fn pair(
    num_cells: usize,
    gone: &Bits,
    above: &Level<'_>,
    gone_above: &mut Bits,
    watch: &Watch<'_>,
) -> Result<Matching, Stopped> {
    // Of what fits small numbers there are the most cells.
    let is_small = above.width().is_some_and(|width| width < 256) && u32::try_from(above.num_faces()).is_ok();
    if is_small {
        pair_with::<u8, u32>(num_cells, gone, above, gone_above, watch)
    } else {
        pair_with::<u32, u64>(num_cells, gone, above, gone_above, watch)
    }
}

/// The same, with numbers of faces of a cell in `N` and of all cells in `S`.
fn pair_with<N: PrimInt + Unsigned + Send + Sync + AddAssign, S: Index>(
    num_cells: usize,
    gone: &Bits,
    above: &Level<'_>,
    gone_above: &mut Bits,
    watch: &Watch<'_>,
) -> Result<Matching, Stopped> {
    let cofaces = Cofaces::<S>::new(num_cells, gone, above);
    let left_of = |coface| {
        let mut left = N::zero();
        above.faces(coface).filter(|&face| !gone.contains(face as usize)).for_each(|_| left += N::one());
        left
    };
    let mut left: Vec<N> = (0..above.num_cells()).into_par_iter().map(left_of).collect();
    let mut ready = Sweep::new(above.num_cells());
    for (coface, _) in left.iter().enumerate().filter(|(_, left)| **left == N::one()) {
        ready.insert(coface);
    }
    let mut done = gone.clone();
    let num_left = num_cells - gone.count();
    let mut matching = Matching { steps: Vec::with_capacity(num_left), critical: Vec::new() };
    let mut first = 0;
    while matching.steps.len() < num_left {
        if matching.steps.len().is_multiple_of(PATIENCE) {
            watch.look(if matching.steps.is_empty() { 0 } else { PATIENCE })?;
        }
        let step = match ready.next() {
            Some(coface) if gone_above.contains(coface) => continue,
            Some(coface) => match last_face(above, coface, &done) {
                Some(cell) => Step { cell, coface: narrow(coface) },
                None => continue,
            },
            None => {
                let Some(next) = done.absent(first..num_cells).next() else { break };
                first = next;
                matching.critical.push(narrow(next));
                Step { cell: narrow(next), coface: NONE }
            }
        };
        matching.steps.push(step);
        done.insert(step.cell as usize);
        if step.coface != NONE {
            gone_above.insert(step.coface as usize);
        }
        for &coface in cofaces.of(step.cell) {
            let left = &mut left[coface as usize];
            *left = *left - N::one();
            if *left == N::one() {
                ready.insert(coface as usize);
            }
        }
    }
    watch.look(matching.steps.len() % PATIENCE)?;
    Ok(matching)
}

/// The only face that is left of a cell, if its incidence number is ±1.
#[inline]
fn last_face(above: &Level<'_>, coface: usize, done: &Bits) -> Option<u32> {
    let (k, face) = above.faces(coface).enumerate().find(|&(_, face)| !done.contains(face as usize))?;
    (above.coefficient(coface, k).abs() == 1).then_some(face)
}

/// The cofaces of cells.
struct Cofaces<S> {
    /// Where those of each cell begin, and the end.
    starts: Vec<S>,
    cofaces: Vec<u32>,
}

impl<S: Index> Cofaces<S> {
    /// Of the cells that are not gone, increasing.
    fn new(num_cells: usize, gone: &Bits, above: &Level<'_>) -> Self {
        // Each task inverts the boundaries for the cells of one range.
        let tasks = rayon::current_num_threads().min(num_cells).max(1);
        let range = |task: usize| task * num_cells / tasks..(task + 1) * num_cells / tasks;
        let is_of = |range: &std::ops::Range<usize>, face: u32| {
            let face = face as usize;
            (range.contains(&face) && !gone.contains(face)).then(|| face - range.start)
        };
        let counted = (0..tasks).into_par_iter().map(|task| {
            let range = range(task);
            let mut counts = vec![0_u32; range.len()];
            for coface in 0..above.num_cells() {
                above.faces(coface).filter_map(|face| is_of(&range, face)).for_each(|cell| counts[cell] += 1);
            }
            counts
        });
        let counted: Vec<Vec<u32>> = counted.collect();
        let mut starts = Vec::with_capacity(num_cells + 1);
        let mut sum = 0;
        for count in counted.into_iter().flatten() {
            starts.push(of::<S>(sum));
            sum += count as usize;
        }
        starts.push(of::<S>(sum));
        let mut cofaces = vec![0; sum];
        let mut parts = Vec::with_capacity(tasks);
        let (mut rest, mut rest_of_starts) = (&mut cofaces[..], &mut starts[..]);
        for task in 0..tasks {
            let range = range(task);
            let next = rest_of_starts[range.len()].to_usize();
            let first = rest_of_starts[0].to_usize();
            let part = rest.split_off_mut(..next - first).unwrap_or_default();
            parts.push((range.clone(), first, rest_of_starts.split_off_mut(..range.len()).unwrap_or_default(), part));
        }
        // Each start moves on as its cofaces are filled in, and ends where that of the next cell begins.
        parts.into_par_iter().for_each(|(range, first, starts, part)| {
            for coface in 0..above.num_cells() {
                for cell in above.faces(coface).filter_map(|face| is_of(&range, face)) {
                    part[starts[cell].to_usize() - first] = narrow(coface);
                    starts[cell] = of::<S>(starts[cell].to_usize() + 1);
                }
            }
        });
        starts.rotate_right(1);
        starts[0] = S::ZERO;
        Self { starts, cofaces }
    }

    #[inline]
    fn of(&self, cell: u32) -> &[u32] {
        &self.cofaces[self.starts[cell as usize].to_usize()..self.starts[cell as usize + 1].to_usize()]
    }
}

/// A position at the width that was chosen for all of them.
fn of<S: Index>(position: usize) -> S {
    S::from_usize(position).unwrap_or(S::STOP)
}
