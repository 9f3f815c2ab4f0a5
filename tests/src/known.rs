//! Triangulations from the literature, by construction.

use crate::oracle::Word;

/// The torus on seven vertices (Möbius 1886, Császár 1949): {i, i+1, i+3} and {i, i+2, i+3} modulo 7.
#[must_use]
pub fn seven_vertex_torus() -> Vec<Word> {
    let orbit = |steps: [usize; 3]| (0..7).map(move |start| steps.map(|step| (start + step) % 7).to_vec());
    orbit([0, 1, 3]).chain(orbit([0, 2, 3])).collect()
}

/// The real projective plane on six vertices: the hemi-icosahedron.
#[must_use]
pub fn six_vertex_projective_plane() -> Vec<Word> {
    const TRIANGLES: [[usize; 3]; 10] = [
        [0, 1, 2],
        [0, 2, 3],
        [0, 3, 4],
        [0, 4, 5],
        [0, 1, 5],
        [1, 2, 4],
        [2, 3, 5],
        [1, 3, 4],
        [2, 4, 5],
        [1, 3, 5],
    ];
    TRIANGLES.iter().map(|triangle| triangle.to_vec()).collect()
}

/// The complex projective plane on nine vertices (Kühnel, Banchoff 1983): the orbits of {1,2,4,5,6}... under a group of
/// order 54 that acts on the points of the affine plane of order three.
///
/// Vertices are pairs (a, b) modulo 3, numbered 3a + b. A 4-simplex is a line of one of three parallel classes with two
/// points of the next line of the class, or, for the fourth class, with the two points of a pair of lines that
/// complete it.
#[must_use]
pub fn simplex_boundary(dim: usize) -> Vec<Word> {
    (0..=dim + 1).map(|omitted| (0..=dim + 1).filter(|&vertex| vertex != omitted).collect()).collect()
}
