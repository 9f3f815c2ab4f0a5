//! The tree over the sites of refinements: [`Mcc::in_box`](sig_core::mcc::Mcc::in_box) reads it, and says how it is laid out.

use std::cmp::Ordering;

use crate::build::narrow;
use crate::soup::{Coordinates, Scalars};

/// Below so many refinements a range is not divided between threads.
const SMALL: usize = 1 << 14;

/// A refinement, and up to three coordinates of its site.
struct Placed {
    point: [f64; 3],
    number: u32,
}

/// The refinements by their places in the tree; none if a site has no coordinates.
///
/// Cost: O(m log m), in parallel; 32 bytes for each refinement on the way.
pub(super) fn site_tree(sites: &[u32], coordinates: &Coordinates) -> Vec<u32> {
    let (dim, axes) = (coordinates.dim, coordinates.dim.min(3));
    let point = |site: u32| {
        let row = (site as usize).checked_mul(dim)?;
        let mut point = [0.0; 3];
        for (axis, slot) in point.iter_mut().enumerate().take(axes) {
            *slot = match &coordinates.values {
                Scalars::F32(values) => f64::from(*values.get(row + axis)?),
                Scalars::F64(values) => *values.get(row + axis)?,
            };
        }
        Some(point)
    };
    let placed = |(number, &site): (usize, &u32)| Some(Placed { point: point(site)?, number: narrow(number) });
    let placed: Option<Vec<Placed>> = sites.iter().enumerate().map(placed).collect();
    let Some(mut placed) = placed.filter(|_| axes > 0) else { return Vec::new() };
    arrange(&mut placed, 0, axes);
    placed.iter().map(|placed| placed.number).collect()
}

/// Puts the middle of a range at its place along an axis, then those of its halves along the next one.
fn arrange(range: &mut [Placed], axis: usize, axes: usize) {
    if range.len() < 2 {
        return;
    }
    let middle = range.len() / 2;
    let (before, _, after) = range.select_nth_unstable_by(middle, |one, other| compare(one, other, axis));
    let next = (axis + 1) % axes;
    if before.len() < SMALL {
        arrange(before, next, axes);
        arrange(after, next, axes);
    } else {
        rayon::join(|| arrange(before, next, axes), || arrange(after, next, axes));
    }
}

/// By coordinate, what is no number last, then by number.
fn compare(one: &Placed, other: &Placed, axis: usize) -> Ordering {
    let (one_value, other_value) = (one.point[axis], other.point[axis]);
    let by_value = one_value.partial_cmp(&other_value);
    let by_value = by_value.unwrap_or_else(|| one_value.is_nan().cmp(&other_value.is_nan()));
    by_value.then(one.number.cmp(&other.number))
}
