//! The element types of Gmsh, as numbered by `elm-type` in its manual: what their corners are, how many nodes follow.

use super::super::cone::Polyhedron;

/// What the corners of an element span.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Corners {
    /// A simplex.
    Simplex,
    /// A quadrangle.
    Quadrangle,
    /// A hexahedron, prism or pyramid.
    Polyhedron(Polyhedron),
}

/// An element type. The corners come first among the nodes; the others lie on edges, faces or inside.
#[derive(Clone, Copy)]
pub(super) struct Shape {
    pub(super) corners: Corners,
    pub(super) num_corners: usize,
    pub(super) num_nodes: usize,
}

/// The element type with this number.
pub(super) fn shape(number: i64) -> Option<Shape> {
    use Corners::{Polyhedron as Poly, Quadrangle, Simplex};
    let (corners, num_corners, num_nodes) = match number {
        15 => (Simplex, 1, 1),
        1 => (Simplex, 2, 2),
        8 => (Simplex, 2, 3),
        26 => (Simplex, 2, 4),
        27 => (Simplex, 2, 5),
        28 => (Simplex, 2, 6),
        2 => (Simplex, 3, 3),
        9 => (Simplex, 3, 6),
        20 => (Simplex, 3, 9),
        21 => (Simplex, 3, 10),
        22 => (Simplex, 3, 12),
        23 | 24 => (Simplex, 3, 15),
        25 => (Simplex, 3, 21),
        4 => (Simplex, 4, 4),
        11 => (Simplex, 4, 10),
        29 => (Simplex, 4, 20),
        30 => (Simplex, 4, 35),
        31 => (Simplex, 4, 56),
        3 => (Quadrangle, 4, 4),
        16 => (Quadrangle, 4, 8),
        10 => (Quadrangle, 4, 9),
        5 => (Poly(Polyhedron::Hexahedron), 8, 8),
        17 => (Poly(Polyhedron::Hexahedron), 8, 20),
        12 => (Poly(Polyhedron::Hexahedron), 8, 27),
        6 => (Poly(Polyhedron::Prism), 6, 6),
        18 => (Poly(Polyhedron::Prism), 6, 15),
        13 => (Poly(Polyhedron::Prism), 6, 18),
        7 => (Poly(Polyhedron::Pyramid), 5, 5),
        19 => (Poly(Polyhedron::Pyramid), 5, 13),
        14 => (Poly(Polyhedron::Pyramid), 5, 14),
        _ => return None,
    };
    Some(Shape { corners, num_corners, num_nodes })
}
