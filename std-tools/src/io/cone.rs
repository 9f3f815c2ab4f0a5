//! Polygons and polyhedra as simplices.
//!
//! Each is coned from its vertex of least label: a polygon over its edges, a polyhedron over its faces, which are
//! coned the same way first. The split of a face depends on that face alone, so neighbours agree on it.

use sig_core::MAX_DIM;

/// Corner polyhedra with their faces, which are listed counter-clockwise as seen from outside (VTK's and Gmsh's
/// numbering of corners).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Polyhedron {
    Hexahedron,
    Prism,
    Pyramid,
}

impl Polyhedron {
    fn faces(self) -> &'static [&'static [usize]] {
        match self {
            Self::Hexahedron => {
                &[&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]]
            }
            Self::Prism => &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]],
            Self::Pyramid => &[&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]],
        }
    }

    /// The tetrahedra of the polyhedron with the given corners, positively oriented if it is.
    pub(super) fn split(self, corners: &[u32], label: impl Fn(u32) -> u64, mut each: impl FnMut([u32; 4])) {
        let Some(&apex) = corners.iter().min_by_key(|&&corner| label(corner)) else { return };
        for face in self.faces() {
            let mut polygon = [0; 4];
            for (vertex, &corner) in polygon.iter_mut().zip(*face) {
                *vertex = corners[corner];
            }
            let polygon = &polygon[..face.len()];
            if !polygon.contains(&apex) {
                split_polygon(polygon, &label, |[a, b, c]| each([apex, a, b, c]));
            }
        }
    }
}

/// The triangles of a polygon, oriented like it.
pub(super) fn split_polygon(vertices: &[u32], label: impl Fn(u32) -> u64, mut each: impl FnMut([u32; 3])) {
    let Some(apex) = (0..vertices.len()).min_by_key(|&at| label(vertices[at])) else { return };
    let mut around = vertices[apex + 1..].iter().chain(&vertices[..apex]);
    let Some(mut last) = around.next() else { return };
    for next in around {
        each([vertices[apex], *last, *next]);
        last = next;
    }
}

/// A vertex that stands more than once among `vertices`.
pub(super) fn repeated(vertices: &[u32]) -> Option<u32> {
    if vertices.len() <= MAX_DIM + 1 {
        return (1..vertices.len()).find(|&at| vertices[..at].contains(&vertices[at])).map(|at| vertices[at]);
    }
    let mut sorted = vertices.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0])
}
