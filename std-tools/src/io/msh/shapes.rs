//! The element types of Gmsh, as numbered by `elm-type` in its manual.

use super::super::shape::Shape;

/// The element type with this number.
pub(super) fn shape(number: i64) -> Option<Shape> {
    Some(match number {
        15 => Shape::simplex(1, 1),
        1 => Shape::simplex(2, 2),
        8 => Shape::simplex(2, 3),
        26 => Shape::simplex(2, 4),
        27 => Shape::simplex(2, 5),
        28 => Shape::simplex(2, 6),
        2 => Shape::simplex(3, 3),
        9 => Shape::simplex(3, 6),
        20 => Shape::simplex(3, 9),
        21 => Shape::simplex(3, 10),
        22 => Shape::simplex(3, 12),
        23 | 24 => Shape::simplex(3, 15),
        25 => Shape::simplex(3, 21),
        4 => Shape::simplex(4, 4),
        11 => Shape::simplex(4, 10),
        29 => Shape::simplex(4, 20),
        30 => Shape::simplex(4, 35),
        31 => Shape::simplex(4, 56),
        3 => Shape::quadrangle(4),
        16 => Shape::quadrangle(8),
        10 => Shape::quadrangle(9),
        5 => Shape::hexahedron(8),
        17 => Shape::hexahedron(20),
        12 => Shape::hexahedron(27),
        6 => Shape::prism(6),
        18 => Shape::prism(15),
        13 => Shape::prism(18),
        7 => Shape::pyramid(5),
        19 => Shape::pyramid(13),
        14 => Shape::pyramid(14),
        _ => return None,
    })
}
