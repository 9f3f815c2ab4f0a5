//! Tests of the readers: real files against counts from elsewhere, then each format, then all formats together.

mod agreement;
mod attributes;
mod bad;
mod detection;
mod fixtures;
mod foreign;
mod hostile;
mod merging;
mod msh;
mod obj;
mod off;
mod ply;
mod simplex_list;
mod stl;
mod text;
mod tops;
mod weld;

use std::collections::HashSet;

use super::{Format, ReadError, ReadOptions, ReadReport, read_bytes};
use crate::soup::{Scalars, Soup};

/// Reads bytes as a format.
fn read_as(format: Format, bytes: impl AsRef<[u8]>) -> Result<(Soup, ReadReport), ReadError> {
    read_bytes(bytes.as_ref(), "test", &ReadOptions { format: Some(format), ..Default::default() })
}

/// Reads bytes as a format, dropping simplices that repeat a vertex.
fn read_dropping(format: Format, bytes: impl AsRef<[u8]>) -> (Soup, ReadReport) {
    let options = ReadOptions { format: Some(format), drop_degenerate: true, ..Default::default() };
    read_bytes(bytes.as_ref(), "test", &options).unwrap()
}

/// What an input that is refused is refused with.
#[track_caller]
fn message(format: Format, bytes: impl AsRef<[u8]>) -> String {
    read_as(format, bytes).expect_err("the input should be refused").to_string()
}

/// Checks that each input is refused with a message that starts like this.
#[track_caller]
fn refused(format: Format, cases: &[(&str, &str)]) {
    for (input, expected) in cases {
        let found = message(format, input);
        assert!(found.starts_with(expected), "input {input:?}\n   found {found}\nexpected {expected}");
    }
}

/// The simplices of dimension `dim`, as lists.
fn listed(soup: &Soup, dim: usize) -> Vec<Vec<u32>> {
    soup.of_dim(dim).map(<[u32]>::to_vec).collect()
}

/// Double-precision coordinates.
fn doubles(soup: &Soup) -> &[f64] {
    match &soup.coordinates.as_ref().unwrap().values {
        Scalars::F64(values) => values,
        Scalars::F32(_) => panic!("single precision"),
    }
}

/// Single-precision coordinates.
fn singles(soup: &Soup) -> &[f32] {
    match &soup.coordinates.as_ref().unwrap().values {
        Scalars::F32(values) => values,
        Scalars::F64(_) => panic!("double precision"),
    }
}

/// The number of simplices of each dimension of the complex that a soup spans, by listing every subset of every
/// simplex. Declared vertices that no simplex uses are not counted.
fn f_vector(soup: &Soup) -> Vec<usize> {
    let mut faces = HashSet::new();
    for dim in 0..soup.simplices.len() {
        for simplex in soup.of_dim(dim) {
            for subset in 1u32..1 << simplex.len() {
                let mut word: Vec<u32> =
                    (0..simplex.len()).filter(|at| subset >> at & 1 == 1).map(|at| simplex[at]).collect();
                word.sort_unstable();
                faces.insert(word);
            }
        }
    }
    let mut counts = vec![0; soup.simplices.len()];
    for face in faces {
        counts[face.len() - 1] += 1;
    }
    counts
}

/// Numbers that look random and are the same in every run (Knuth's 64-bit linear congruential generator).
struct Random(u64);

impl Random {
    fn below(&mut self, bound: u32) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        usize::try_from((self.0 >> 33) % u64::from(bound)).unwrap()
    }
}
