//! Finite metric spaces given by all their distances: [`Distances`].

use rayon::prelude::*;

use crate::graph::{Graph, GraphError};

/// The distances of `len` points, symmetric and 0 on the diagonal: the part below it, row by row, as Ripser writes them.
///
/// The triangle inequality is neither asked for nor used.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Distances {
    len: usize,
    lower: Vec<f64>,
}

/// Why numbers are not the distances of points.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DistancesError {
    /// The numbers are not those below the diagonal of a matrix.
    #[error("{values} numbers are not the distances of {len} points")]
    WrongCount {
        /// Numbers given.
        values: usize,
        /// Points.
        len: usize,
    },
    /// A number is negative, infinite or not a number.
    #[error("the distance of points {0} and {1} is {2}: distances must be finite, and not negative")]
    NotADistance(usize, usize, f64),
}

impl Distances {
    /// The distances of `len` points: of 1 and 0; 2 and 0, 2 and 1; and so on.
    ///
    /// # Errors
    /// [`DistancesError`].
    pub fn new(len: usize, lower: Vec<f64>) -> Result<Self, DistancesError> {
        if pairs(len) != Some(lower.len()) {
            return Err(DistancesError::WrongCount { values: lower.len(), len });
        }
        for (i, j, &value) in
            (0..len).flat_map(|i| (0..i).map(move |j| (i, j))).zip(&lower).map(|((i, j), v)| (i, j, v))
        {
            if !(value.is_finite() && value >= 0.0) {
                return Err(DistancesError::NotADistance(i, j, value));
            }
        }
        Ok(Self { len, lower })
    }

    /// The number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether there is no point.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The distance of two points.
    ///
    /// # Panics
    /// Past the last point.
    #[must_use]
    #[inline]
    pub fn distance(&self, i: usize, j: usize) -> f64 {
        let (low, high) = (i.min(j), i.max(j));
        if low == high { 0.0 } else { self.lower[high * (high - 1) / 2 + low] }
    }

    /// The distances of point `i` to the points before it.
    ///
    /// # Panics
    /// Past the last point.
    #[must_use]
    pub fn row(&self, i: usize) -> &[f64] {
        &self.lower[i * i.saturating_sub(1) / 2..(i + 1) * i / 2]
    }

    /// The space of the points with the given numbers, in that order.
    ///
    /// # Panics
    /// If a number is past the last point.
    #[must_use]
    pub fn select(&self, indices: &[usize]) -> Self {
        let row = |(position, &i): (usize, &usize)| indices[..position].iter().map(move |&j| self.distance(i, j));
        Self { len: indices.len(), lower: indices.iter().enumerate().flat_map(row).collect() }
    }

    /// The graph of all pairs at a distance of at most `radius`, its edges weighted by the distance if `weighted`.
    ///
    /// Time: O(n²), in rayon's current pool.
    ///
    /// # Errors
    /// [`GraphError::TooManyVertices`].
    pub fn radius_graph(&self, radius: f64, weighted: bool) -> Result<Graph, GraphError> {
        let upper = |i: usize| (i + 1..self.len).filter(move |&j| self.distance(i, j) <= radius);
        // Vertex numbers fit, or the graph is refused before they are looked at.
        let number = |j: usize| u32::try_from(j).unwrap_or(u32::MAX);
        let lists: Vec<Vec<u32>> = (0..self.len).into_par_iter().map(|i| upper(i).map(number).collect()).collect();
        let weights = weighted.then(|| {
            let weights = |i: usize| upper(i).map(|j| self.distance(i, j)).collect();
            (0..self.len).into_par_iter().map(weights).collect::<Vec<Vec<f64>>>()
        });
        Graph::from_upper_lists(&lists, weights.as_deref())
    }
}

/// The number of pairs of `len` points.
pub(crate) fn pairs(len: usize) -> Option<usize> {
    // One of the factors is even, and halved first.
    let (a, b) = if len.is_multiple_of(2) { (len / 2, len.saturating_sub(1)) } else { (len, len / 2) };
    a.checked_mul(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of points on a line at 0, 1, 3.
    fn line() -> Distances {
        Distances::new(3, vec![1.0, 3.0, 2.0]).unwrap()
    }

    #[test]
    fn a_matrix_answers_for_both_orders_and_the_diagonal() {
        let matrix = line();
        assert_eq!((matrix.distance(0, 2), matrix.distance(2, 0), matrix.distance(1, 1)), (3.0, 3.0, 0.0));
        assert_eq!(matrix.select(&[2, 0]), Distances::new(2, vec![3.0]).unwrap());
        assert_eq!((matrix.row(0), matrix.row(1), matrix.row(2)), (&[][..], &[1.0][..], &[3.0, 2.0][..]));
    }

    #[test]
    fn edges_are_pairs_up_to_the_radius() {
        let graph = line().radius_graph(2.0, true).unwrap();
        assert_eq!((graph.upper_neighbours(0), graph.upper_neighbours(1)), (&[1][..], &[2][..]));
        assert_eq!(graph.weights(), Some(&[1.0, 2.0][..]));
        assert_eq!(line().radius_graph(0.5, false).unwrap().num_edges(), 0);
    }

    #[test]
    fn what_are_no_distances_is_refused() {
        assert_eq!(Distances::new(3, vec![1.0]), Err(DistancesError::WrongCount { values: 1, len: 3 }));
        assert_eq!(Distances::new(2, vec![-1.0]), Err(DistancesError::NotADistance(1, 0, -1.0)));
        assert!(Distances::new(2, vec![f64::NAN]).is_err() && Distances::new(2, vec![f64::INFINITY]).is_err());
        assert!(Distances::new(0, Vec::new()).unwrap().is_empty());
        assert!(Distances::new(usize::MAX, Vec::new()).is_err());
    }
}
