//! Points in R^D and the distances between them: where Rips and witness complexes start.
//!
//! Readers are in [`crate::io`]; what is built on points goes through a [`crate::graph::Graph`] or a table of nearest
//! landmarks.

use crate::soup::{Coordinates, Scalars};

/// Points of one dimension, row-major, in double precision.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Points {
    dim: usize,
    values: Vec<f64>,
}

/// Why numbers are not points.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PointsError {
    /// The numbers do not make whole points.
    #[error("{values} numbers do not make whole points of {dim} coordinates")]
    Ragged {
        /// Numbers given.
        values: usize,
        /// Coordinates a point.
        dim: usize,
    },
    /// A coordinate is infinite or not a number.
    #[error("coordinate {coordinate} of point {point} is {value}: coordinates must be finite")]
    NotFinite {
        /// The point, from 0.
        point: usize,
        /// The coordinate, from 0.
        coordinate: usize,
        /// What it is.
        value: f64,
    },
}

impl Points {
    /// Points of `dim` coordinates each.
    ///
    /// # Errors
    /// [`PointsError`]: numbers that do not make whole points, or are not finite.
    pub fn new(dim: usize, values: Vec<f64>) -> Result<Self, PointsError> {
        if if dim == 0 { !values.is_empty() } else { !values.len().is_multiple_of(dim) } {
            return Err(PointsError::Ragged { values: values.len(), dim });
        }
        if let Some(index) = values.iter().position(|value| !value.is_finite()) {
            let (point, coordinate) = (index / dim, index % dim);
            return Err(PointsError::NotFinite { point, coordinate, value: values[index] });
        }
        Ok(Self { dim, values })
    }

    /// Coordinates a point.
    #[must_use]
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// The number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.values.len().checked_div(self.dim).unwrap_or(0)
    }

    /// Whether there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// The coordinates of all points, one point after the other.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The coordinates of a point.
    ///
    /// # Panics
    /// Past the last point.
    #[must_use]
    #[inline]
    pub fn point(&self, index: usize) -> &[f64] {
        &self.values[index * self.dim..(index + 1) * self.dim]
    }

    /// The points with the given numbers, in that order.
    ///
    /// # Panics
    /// If a number is past the last point.
    #[must_use]
    pub fn select(&self, indices: &[usize]) -> Self {
        Self { dim: self.dim, values: indices.iter().flat_map(|&index| self.point(index)).copied().collect() }
    }

    /// The numbers of the points along a Hilbert curve through their first three coordinates, ties by number.
    #[must_use]
    pub fn hilbert_order(&self) -> Vec<usize> {
        crate::build::hilbert_order(self)
    }

    /// The points as the coordinates of vertices.
    #[must_use]
    pub fn into_coordinates(self) -> Coordinates {
        Coordinates { dim: self.dim, values: Scalars::F64(self.values) }
    }
}

/// A distance between points.
///
/// All sums run left to right over the coordinates in double precision without fused multiply-add, so that the same
/// points give the same distances, to the last bit, on every machine and in every search strategy.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Metric {
    /// √Σ (p − q)²; infinite where the sum overflows, from about 1.3·10¹⁵⁴ on.
    #[default]
    Euclidean,
    /// max |p − q|.
    Maximum,
    /// Σ |p − q|.
    Manhattan,
    /// 1 − p·q / (√p·p √q·q), never negative; 1 where one of the two is the origin. Not a metric: the triangle
    /// inequality fails.
    Cosine,
}

impl Metric {
    /// The distance of two points of the same dimension.
    #[must_use]
    #[inline]
    pub fn distance(self, p: &[f64], q: &[f64]) -> f64 {
        let pairs = || p.iter().zip(q);
        match self {
            Self::Euclidean => squared_distance(p, q).sqrt(),
            Self::Maximum => pairs().fold(0.0, |most, (a, b)| (a - b).abs().max(most)),
            Self::Manhattan => pairs().fold(0.0, |sum, (a, b)| sum + (a - b).abs()),
            Self::Cosine => {
                let dot = |p: &[f64], q: &[f64]| p.iter().zip(q).fold(0.0, |sum, (a, b)| sum + a * b);
                let norms = dot(p, p).sqrt() * dot(q, q).sqrt();
                if norms > 0.0 { (1.0 - dot(p, q) / norms).max(0.0) } else { 1.0 }
            }
        }
    }
}

/// Σ (p − q)², left to right.
#[must_use]
#[inline]
pub fn squared_distance(p: &[f64], q: &[f64]) -> f64 {
    p.iter().zip(q).fold(0.0, |sum, (a, b)| sum + (a - b) * (a - b))
}
