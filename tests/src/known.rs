//! Triangulations from the literature, by construction.

use crate::oracle::Word;

/// The boundary of the simplex of dimension `dim` + 1: the smallest sphere of dimension `dim`.
#[must_use]
pub fn sphere(dim: usize) -> Vec<Word> {
    (0..=dim + 1).map(|omitted| (0..=dim + 1).filter(|&vertex| vertex != omitted).collect()).collect()
}

/// The boundary of the cross-polytope: a sphere of dimension `dim` on 2 (dim + 1) vertices, antipodes 2i and 2i + 1.
#[must_use]
pub fn cross_polytope(dim: usize) -> Vec<Word> {
    let choose = |signs: usize| (0..=dim).map(|axis| 2 * axis + (signs >> axis & 1)).collect();
    (0..1 << (dim + 1)).map(choose).collect()
}

/// The torus on seven vertices (Möbius 1886, Császár 1949): {i, i+1, i+3} and {i, i+2, i+3} modulo 7.
#[must_use]
pub fn seven_vertex_torus() -> Vec<Word> {
    let orbit = |steps: [usize; 3]| (0..7).map(move |start| steps.map(|step| (start + step) % 7).to_vec());
    orbit([0, 1, 3]).chain(orbit([0, 2, 3])).collect()
}

/// The real projective plane on six vertices: the hemi-icosahedron.
#[must_use]
pub fn six_vertex_projective_plane() -> Vec<Word> {
    words("012 023 034 045 015 124 235 134 245 135")
}

/// The complex projective plane on nine vertices (W. Kühnel and T. F. Banchoff, *The 9-vertex complex projective plane*,
/// 1983), from vertex 1 to 9.
#[must_use]
pub fn nine_vertex_complex_projective_plane() -> Vec<Word> {
    words(
        "12456 45789 78123 23564 56897 89231 31645 64978 97312 12459 45783 78126 \
         23567 56891 89234 31648 64972 97315 23649 56973 89316 31457 64781 97124 \
         12568 45892 78235 31569 64893 97236 12647 45971 78314 23458 56782 89125",
    )
}

/// Words in digits, separated by blanks.
///
/// # Panics
/// If a character is neither a digit nor a blank.
#[must_use]
pub fn words(digits: &str) -> Vec<Word> {
    let vertex = |digit: char| digit.to_digit(10).expect("a digit") as usize;
    digits.split_whitespace().map(|word| word.chars().map(vertex).collect()).collect()
}
