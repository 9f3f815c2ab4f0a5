//! The choice of landmarks: all points of a set, given ones, random ones, or the greedy choice of far ones.

use crate::build::narrow;
use crate::generate::SplitMix64;
use crate::points::{Metric, Points};
use crate::soup::Labels;
use crate::subsample::farthest_points;
use crate::witness::WitnessError;

/// Landmarks and their numbers among the points that they were chosen from.
///
/// They stand by increasing number, whatever the order in which they were chosen: so the complex depends on the set of
/// landmarks alone.
#[derive(Clone, PartialEq, Debug)]
pub struct Landmarks {
    points: Points,
    numbers: Vec<u64>,
}

impl Landmarks {
    /// All of the points, numbered from 0.
    #[must_use]
    pub fn all(points: Points) -> Self {
        Self { numbers: (0..points.len() as u64).collect(), points }
    }

    /// The points with the given numbers, each once.
    ///
    /// # Errors
    /// [`WitnessError::NoSuchPoint`].
    pub fn chosen(points: &Points, numbers: &[usize]) -> Result<Self, WitnessError> {
        if let Some(&number) = numbers.iter().find(|&&number| number >= points.len()) {
            return Err(WitnessError::NoSuchPoint { number, points: points.len() });
        }
        let mut numbers = numbers.to_vec();
        numbers.sort_unstable();
        numbers.dedup();
        Ok(Self { points: points.select(&numbers), numbers: numbers.iter().map(|&number| number as u64).collect() })
    }

    /// `count` of the points, any set of so many with about the same probability: those that the first `count` steps of a
    /// Fisher–Yates shuffle with [`SplitMix64`] from `seed` bring to the front.
    ///
    /// # Errors
    /// [`WitnessError::TooManyLandmarks`].
    pub fn random(points: &Points, count: usize, seed: u64) -> Result<Self, WitnessError> {
        check_count(points, count)?;
        let mut random = SplitMix64::new(seed);
        let mut numbers: Vec<usize> = (0..points.len()).collect();
        for position in 0..count {
            let other = position + random.next_below(numbers.len() - position);
            numbers.swap(position, other);
        }
        Self::chosen(points, &numbers[..count])
    }

    /// `count` of the points, point 0 first, then each the farthest from those before it: maxmin (de Silva and Carlsson,
    /// 2004). Of several that are as far the lowest number. Time: O(points · `count`) distances.
    ///
    /// # Errors
    /// [`WitnessError::TooManyLandmarks`].
    pub fn maxmin(points: &Points, metric: Metric, count: usize) -> Result<Self, WitnessError> {
        check_count(points, count)?;
        Self::chosen(points, &farthest_points(points, metric, count, 0).indices)
    }

    /// Where they are.
    #[must_use]
    pub fn points(&self) -> &Points {
        &self.points
    }

    /// Their numbers, increasing.
    #[must_use]
    pub fn numbers(&self) -> &[u64] {
        &self.numbers
    }

    /// The labels and the coordinates of those that are kept, and the numbers of the others.
    pub(super) fn split(&self, is_kept: impl Fn(usize) -> bool) -> (Labels, Points, Vec<u64>) {
        let (kept, absent): (Vec<usize>, Vec<usize>) = (0..self.numbers.len()).partition(|&landmark| is_kept(landmark));
        let numbers = |landmarks: &[usize]| landmarks.iter().map(|&landmark| self.numbers[landmark]).collect();
        let labels: Vec<u64> = numbers(&kept);
        let are_ids = labels.iter().copied().eq(0..u64::from(narrow(labels.len())));
        let labels = if are_ids { Labels::Numbered(labels.len()) } else { Labels::Integers(labels) };
        (labels, self.points.select(&kept), numbers(&absent))
    }

    /// These and one more, with the next number after the largest.
    pub(super) fn with(&self, point: &[f64]) -> Result<Self, WitnessError> {
        let points = Points::new(self.points.dim(), [self.points.values(), point].concat())?;
        let number = self.numbers.last().map_or(0, |&last| last + 1);
        Ok(Self { points, numbers: [self.numbers.as_slice(), &[number]].concat() })
    }
}

fn check_count(points: &Points, asked: usize) -> Result<(), WitnessError> {
    if asked == 0 {
        return Err(WitnessError::NoLandmarks);
    }
    if asked > points.len() {
        return Err(WitnessError::TooManyLandmarks { asked, points: points.len() });
    }
    Ok(())
}
