//! Which landmarks may be near a witness, told in single precision at a third of the cost of their distances.
//!
//! |w − l|² = |w|² + |l|² − 2 w·l, about the centre of the landmarks: a multiplication and an addition a coordinate, and
//! four of each at a time even on the oldest 64-bit processors. The error is bounded, so a landmark that is rejected is
//! truly farther than the bound; of the few others the exact distance decides. So the sieve changes no result.

use crate::points::Points;

/// Landmarks a block.
pub(super) const WIDTH: usize = 16;

/// Landmarks in blocks, for the Euclidean distance.
pub(super) struct Sieve {
    dim: usize,
    centre: Vec<f64>,
    /// −2 l of a block's landmarks l, axis by axis.
    rows: Vec<[f32; WIDTH]>,
    /// |l|²; infinite past the last landmark.
    squares: Vec<[f32; WIDTH]>,
    /// The largest |l|.
    largest: f64,
}

/// A witness as the sieve sees it.
pub(super) struct View {
    point: Vec<f32>,
    norm: f64,
}

#[expect(clippy::cast_possible_truncation, reason = "the error of rounding is accounted for")]
fn single(value: f64) -> f32 {
    value as f32
}

fn square(point: &[f32]) -> f64 {
    point.iter().fold(0.0, |sum, &x| sum + f64::from(x) * f64::from(x))
}

impl Sieve {
    #[expect(clippy::cast_precision_loss, reason = "any centre will do")]
    pub(super) fn new(landmarks: &Points) -> Self {
        let (dim, count) = (landmarks.dim(), landmarks.len());
        let mut centre = vec![0.0; dim];
        for landmark in 0..count {
            for (sum, value) in centre.iter_mut().zip(landmarks.point(landmark)) {
                *sum += value / count as f64;
            }
        }
        let blocks = count.div_ceil(WIDTH);
        let mut sieve = Self {
            dim,
            centre,
            rows: vec![[0.0; WIDTH]; dim * blocks],
            squares: vec![[f32::INFINITY; WIDTH]; blocks],
            largest: 0.0,
        };
        for landmark in 0..count {
            let (block, lane) = (landmark / WIDTH, landmark % WIDTH);
            let View { point, norm } = sieve.view(landmarks.point(landmark));
            for (row, value) in sieve.rows[block * dim..].iter_mut().zip(&point) {
                row[lane] = -2.0 * value;
            }
            sieve.squares[block][lane] = single(square(&point));
            // What is not a number stays: it makes every bound infinite.
            sieve.largest = if norm <= sieve.largest { sieve.largest } else { norm };
        }
        sieve
    }

    pub(super) fn num_blocks(&self) -> usize {
        self.squares.len()
    }

    pub(super) fn view(&self, witness: &[f64]) -> View {
        let point: Vec<f32> = witness.iter().zip(&self.centre).map(|(value, centre)| single(value - centre)).collect();
        let norm = square(&point).sqrt();
        View { point, norm }
    }

    /// The bound for [`near`](Self::near) that no landmark exceeds whose squared distance is at most `square`.
    ///
    /// With u = 2^−24 and M = |w| + |l|, rounding w and l to single precision changes |w − l|² by 2uM² and little more,
    /// the products and sums by (d + 2)uM², and each underflow by less than the least normal number. Twice as much and
    /// more is allowed.
    #[expect(clippy::cast_precision_loss, reason = "dimensions are small")]
    pub(super) fn bound(&self, view: &View, square: f64) -> f32 {
        /// Where single precision might overflow.
        const MOST: f64 = 1e37;
        let reach = view.norm + self.largest;
        let size = reach * reach;
        if size.is_nan() || size >= MOST || square >= MOST {
            return f32::INFINITY;
        }
        let terms = self.dim as f64 + 16.0;
        let error = terms * (f64::from(f32::EPSILON) * size + f64::from(f32::MIN_POSITIVE));
        single(square - view.norm * view.norm + error).next_up()
    }

    /// The landmarks of a block that are not above a bound, a bit each.
    #[inline]
    pub(super) fn near(&self, view: &View, block: usize, bound: f32) -> u32 {
        let rows = &self.rows[block * self.dim..(block + 1) * self.dim];
        let mut sums = self.squares[block];
        for (&value, row) in view.point.iter().zip(rows) {
            for (sum, &landmark) in sums.iter_mut().zip(row) {
                *sum += value * landmark;
            }
        }
        // What is not a number is above nothing.
        let is_near = |sum: f32| sum <= bound || sum.is_nan();
        if !sums.iter().fold(false, |any, &sum| any | is_near(sum)) {
            return 0;
        }
        (0..).zip(sums).fold(0, |bits, (lane, sum)| bits | u32::from(is_near(sum)) << lane)
    }
}
