//! Point clouds and triangulations by a documented rule and seed: for tests, benchmarks and examples that need no file.
//!
//! [`Triangulation`] is a stream of simplices of any length. The rules of the clouds use nothing but SplitMix64 and IEEE
//! + − × ÷ √, so any language gives the same bits; only [`klein_bottle_grid`] also uses the sine and cosine of the platform.

mod induced;
mod triangulation;
mod vtu;

use std::f64::consts::PI;

use crate::points::Points;

pub use induced::Vertices;
pub use triangulation::{GenerateError, Triangulation};

/// SplitMix64 (Steele, Lea and Flood, 2014), and uniform numbers from its upper 53 bits.
#[derive(Clone, Debug)]
pub struct SplitMix64 {
    state: u64,
}

impl SplitMix64 {
    /// The generator whose state starts at `seed`.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The next 64 bits.
    pub fn next_u64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut bits = self.state;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        bits ^ (bits >> 31)
    }

    /// A number in [0, 1): a multiple of 2^−53.
    #[expect(clippy::cast_precision_loss, reason = "53 bits are exact")]
    pub fn next_unit(&mut self) -> f64 {
        (self.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number below `bound`, which is not 0, each about as likely (the bias is below `bound` / 2^64).
    pub fn next_below(&mut self, bound: usize) -> usize {
        let product = u128::from(self.next_u64()) * bound as u128;
        usize::try_from(product >> 64).unwrap_or(0)
    }

    /// A uniform direction in R^N, by rejection from the cube.
    fn direction<const N: usize>(&mut self) -> [f64; N] {
        loop {
            let vector: [f64; N] = std::array::from_fn(|_| 2.0 * self.next_unit() - 1.0);
            let square = vector.iter().fold(0.0, |sum, x| sum + x * x);
            if (1e-4..=1.0).contains(&square) {
                let norm = square.sqrt();
                return vector.map(|x| x / norm);
            }
        }
    }
}

/// `count` uniform points on the unit 4-sphere in R^5.
#[must_use]
pub fn sphere4(count: usize, seed: u64) -> Points {
    let mut random = SplitMix64::new(seed);
    points(5, (0..count).flat_map(|_| random.direction::<5>()).collect())
}

/// `count` uniform points in the unit cube of dimension `dim`.
#[must_use]
pub fn cube(count: usize, dim: usize, seed: u64) -> Points {
    let mut random = SplitMix64::new(seed);
    points(dim, (0..count * dim).map(|_| random.next_unit()).collect())
}

/// The products of the coordinates of `count` uniform points on the unit 4-sphere: a set of intrinsic dimension 4 in
/// R^25 (a Veronese map).
#[must_use]
pub fn veronese(count: usize, seed: u64) -> Points {
    let mut random = SplitMix64::new(seed);
    let mut values = Vec::with_capacity(25 * count);
    for _ in 0..count {
        let x: [f64; 5] = random.direction();
        values.extend(x.iter().flat_map(|a| x.iter().map(move |b| a * b)));
    }
    points(25, values)
}

/// A grid of `side` × `side` points on the figure-8 Klein bottle in R^5: the data set Kl of simplex-tree-2012 for a side
/// of 300.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "sides are small")]
pub fn klein_bottle_grid(side: usize) -> Points {
    let mut values = Vec::with_capacity(5 * side * side);
    for (i, j) in (0..side * side).map(|number| (number / side, number % side)) {
        let u = 2.0 * PI * i as f64 / side as f64;
        let v = 2.0 * PI * j as f64 / side as f64;
        let (half_sin, half_cos) = (u / 2.0).sin_cos();
        let (sin_2v, sin_v) = ((2.0 * v).sin(), v.sin());
        let a = half_cos * sin_v - half_sin * sin_2v;
        let b = half_sin * sin_v + half_cos * sin_2v;
        values.extend([(0.5 + a) * u.cos(), (0.5 + a) * u.sin(), b, u.sin(), v.cos()]);
    }
    points(5, values)
}

fn points(dim: usize, values: Vec<f64>) -> Points {
    Points::new(dim, values).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// FNV-1a over the little-endian bytes of the coordinates.
    fn fingerprint(points: &Points) -> u64 {
        let bytes = points.values().iter().flat_map(|value| value.to_le_bytes());
        bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    }

    /// The fingerprints that the reference generator, a C++ program, prints.
    #[test]
    fn clouds_equal_those_of_the_reference_generator() {
        assert_eq!(fingerprint(&sphere4(50_000, 1)), 0xd779_5e39_4b59_0e2f);
        assert_eq!(fingerprint(&sphere4(20_000, 3)), 0x508d_c00b_ac7a_b616);
        assert_eq!(fingerprint(&cube(15_000, 25, 4)), 0x4929_5aa2_3470_427b);
        assert_eq!(fingerprint(&veronese(15_000, 5)), 0x5f61_793c_2198_bcb1);
    }

    #[test]
    fn the_klein_bottle_is_that_of_the_reference_generator_where_sines_are_the_same() {
        let grid = klein_bottle_grid(300);
        assert_eq!(grid.len(), 90_000);
        if cfg!(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64")) {
            assert_eq!(fingerprint(&grid), 0x4069_7c1d_7ab4_7b30);
        }
    }
}
