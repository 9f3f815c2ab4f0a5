//! Which refinements are in a box, found without a look at the others.
//!
//! `site_tree` holds the refinements as a balanced tree of Bentley's (a k-d tree, 1975) that is implicit in their order: the
//! root of a range is its middle, what comes before it has a lesser coordinate along the axis of the level, or the same and a
//! lesser number, what comes after it a greater one. Axes take turns, the first at the root.

use core::cmp::Ordering;

use heapless::Vec;

use super::Mcc;
use crate::format::Section;

/// A box with sides along the axes, its faces included. Of coordinates, the first three count.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct AxisBox {
    /// The least coordinates.
    pub low: [f64; 3],
    /// The largest coordinates.
    pub high: [f64; 3],
}

impl AxisBox {
    /// Nothing.
    pub const EMPTY: Self = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };
    /// All of space.
    pub const SPACE: Self = Self { low: [f64::NEG_INFINITY; 3], high: [f64::INFINITY; 3] };

    /// Whether a point is in the box; axes that it has no coordinate for do not count.
    #[must_use]
    pub fn contains(&self, point: &[f64]) -> bool {
        self.low.iter().zip(&self.high).zip(point).all(|((low, high), value)| (low..=high).contains(&value))
    }

    /// Whether a point may be in both boxes.
    fn meets(&self, other: &Self) -> bool {
        let are_near = |((low, high), (other_low, other_high)): Sides<'_>| low <= other_high && other_low <= high;
        self.low.iter().zip(&self.high).zip(other.low.iter().zip(&other.high)).all(are_near)
    }

    /// Whether all points of another box are in this one.
    fn covers(&self, other: &Self) -> bool {
        let is_within = |((low, high), (other_low, other_high)): Sides<'_>| low <= other_low && other_high <= high;
        self.low.iter().zip(&self.high).zip(other.low.iter().zip(&other.high)).all(is_within)
    }
}

/// The least and the largest coordinate of one box, and of another.
type Sides<'s> = ((&'s f64, &'s f64), (&'s f64, &'s f64));

/// Where a refinement is: up to three coordinates.
#[derive(Clone, Copy, Debug)]
struct Point {
    values: [f64; 3],
    axes: usize,
}

impl Point {
    fn coordinates(&self) -> &[f64] {
        self.values.get(..self.axes).unwrap_or(&[])
    }

    fn along(&self, axis: usize) -> Option<f64> {
        self.coordinates().get(axis).copied()
    }
}

/// A range of the tree that is yet to be looked at.
#[derive(Clone, Copy, Debug)]
struct Node {
    start: u32,
    end: u32,
    axis: usize,
    /// A box around the sites in it.
    around: AxisBox,
}

/// Ranges that wait at a time: one a level, the levels of a tree of 2^32 nodes.
const LEVELS: usize = 33;

/// The refinements in a box: see [`Mcc::in_box`].
#[derive(Clone, Debug)]
pub struct InBox<'a> {
    mcc: Mcc<'a>,
    coordinates: Section<'a>,
    inside: AxisBox,
    but_not: AxisBox,
    waiting: Vec<Node, LEVELS>,
}

impl Iterator for InBox<'_> {
    type Item = usize;

    fn next(&mut self) -> Option<usize> {
        while let Some(Node { start, end, axis, around }) = self.waiting.pop() {
            if start >= end || !around.meets(&self.inside) || self.but_not.covers(&around) {
                continue;
            }
            let middle = start + (end - start) / 2;
            let number = self.mcc.arrays.site_tree.get(middle as usize).map(|&number| number as usize)?;
            let point = self.mcc.site_point(&self.coordinates, number);
            let (mut before, mut after) = (around, around);
            if let Some(value) = point.and_then(|point| point.along(axis)).filter(|value| !value.is_nan()) {
                set(&mut before.high, axis, value);
                set(&mut after.low, axis, value);
            }
            let axis = (axis + 1) % axes(&self.coordinates);
            // The levels are halves, so there is room.
            let _ = self.waiting.push(Node { start: middle + 1, end, axis, around: after });
            let _ = self.waiting.push(Node { start, end: middle, axis, around: before });
            let is_in =
                |point: Point| self.inside.contains(point.coordinates()) && !self.but_not.contains(point.coordinates());
            if point.is_some_and(is_in) {
                return Some(number);
            }
        }
        None
    }
}

impl core::iter::FusedIterator for InBox<'_> {}

/// The axes that take turns.
fn axes(coordinates: &Section<'_>) -> usize {
    (coordinates.components as usize).clamp(1, 3)
}

fn set(values: &mut [f64; 3], axis: usize, value: f64) {
    if let Some(slot) = values.get_mut(axis) {
        *slot = value;
    }
}

impl<'a> Mcc<'a> {
    /// The refinements whose sites are in a box and not in another one, in no particular order: with [`AxisBox::EMPTY`] those of
    /// a box, with the box before what comes in when a box moves. `None` if the file has no tree over the sites.
    ///
    /// Cost: O(k + m^(1 − 1/D)) for k refinements in the first box and D coordinates; what is in both boxes is counted out where
    /// a range of the tree is wholly in the second.
    #[must_use]
    pub fn in_box(&self, inside: AxisBox, but_not: AxisBox) -> Option<InBox<'a>> {
        let coordinates = self.coordinates()?;
        let end = u32::try_from(self.arrays.site_tree.len()).ok().filter(|&end| end > 0)?;
        let mut waiting = Vec::new();
        waiting.push(Node { start: 0, end, axis: 0, around: AxisBox::SPACE }).ok()?;
        Some(InBox { mcc: *self, coordinates, inside, but_not, waiting })
    }

    /// Whether the site of a refinement is in a box; `None` where there are no sites, or no coordinates.
    #[must_use]
    pub fn is_in_box(&self, refinement: usize, inside: &AxisBox) -> Option<bool> {
        let point = self.site_point(&self.coordinates()?, refinement)?;
        Some(inside.contains(point.coordinates()))
    }

    /// How two refinements come in the order of an axis of the tree over the sites: by coordinate, then by number. What is not a
    /// number comes last.
    fn compare_sites(&self, coordinates: &Section<'_>, axis: usize, one: usize, other: usize) -> Ordering {
        let value = |refinement| self.site_point(coordinates, refinement).and_then(|point| point.along(axis));
        let (one_value, other_value) = (value(one).unwrap_or(f64::NAN), value(other).unwrap_or(f64::NAN));
        let by_value = one_value.partial_cmp(&other_value);
        let by_value = by_value.unwrap_or_else(|| one_value.is_nan().cmp(&other_value.is_nan()));
        by_value.then(one.cmp(&other))
    }

    /// The first three coordinates of the site of a refinement.
    fn site_point(&self, coordinates: &Section<'_>, refinement: usize) -> Option<Point> {
        let components = coordinates.components as usize;
        let first = self.site(refinement)?.checked_mul(components)?;
        let mut point = Point { values: [0.0; 3], axes: components.min(3) };
        for (place, slot) in (first..).zip(point.values.iter_mut().take(components)) {
            *slot = coordinates.column.number_at(place)?;
        }
        Some(point)
    }

    /// The first place of the tree over the sites that is not as it must be. Every node is between those above it along every
    /// axis, strictly, so that none appears twice.
    pub(super) fn wrong_place_in_site_tree(&self) -> Option<usize> {
        let tree = self.arrays.site_tree;
        if tree.is_empty() {
            return None;
        }
        let Some(coordinates) = self.coordinates() else { return Some(0) };
        let axes = axes(&coordinates);
        // A range with the refinements that it is between along each axis.
        type Bounds = [[Option<usize>; 2]; 3];
        let mut waiting: Vec<(usize, usize, usize, Bounds), LEVELS> = Vec::new();
        let _ = waiting.push((0, tree.len(), 0, Bounds::default()));
        while let Some((start, end, axis, bounds)) = waiting.pop() {
            if start >= end {
                continue;
            }
            let middle = start + (end - start) / 2;
            let number = tree.get(middle).map_or(usize::MAX, |&number| number as usize);
            let compare = |other: usize, axis| self.compare_sites(&coordinates, axis, number, other);
            let is_between = |(axis, [low, high]): (usize, &[Option<usize>; 2])| {
                low.is_none_or(|low| compare(low, axis) == Ordering::Greater)
                    && high.is_none_or(|high| compare(high, axis) == Ordering::Less)
            };
            let is_right = number < self.num_refinements()
                && self.site_point(&coordinates, number).is_some()
                && bounds.iter().take(axes).enumerate().all(is_between);
            if !is_right {
                return Some(middle);
            }
            let (mut before, mut after) = (bounds, bounds);
            if let (Some([_, high]), Some([low, _])) = (before.get_mut(axis), after.get_mut(axis)) {
                (*high, *low) = (Some(number), Some(number));
            }
            let axis = (axis + 1) % axes;
            let _ = waiting.push((middle + 1, end, axis, after));
            let _ = waiting.push((start, middle, axis, before));
        }
        None
    }
}
