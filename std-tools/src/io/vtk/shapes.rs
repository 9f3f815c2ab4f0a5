//! The cell types of VTK (vtkCellType.h).

use super::super::error::ErrorKind;
use super::super::intake::{Intake, Refusal};
use super::super::shape::{Corners, Shape};

/// The shape of a type whose cells have any number of nodes, as many as follow.
fn of_any_order(kind: u8, nodes: usize) -> Option<Shape> {
    let shape = match kind {
        // Lagrange's and Bézier's cells of any order.
        68 | 75 => Shape::simplex(2, nodes),
        69 | 76 => Shape::simplex(3, nodes),
        70 | 77 => Shape::quadrangle(nodes),
        71 | 78 => Shape::simplex(4, nodes),
        72 | 79 => Shape::hexahedron(nodes),
        73 | 80 => Shape::prism(nodes),
        74 | 81 => Shape::pyramid(nodes),
        36 if nodes.is_multiple_of(2) => Shape { corners: Corners::Polygon, num_corners: nodes / 2, num_nodes: nodes },
        7 => Shape { corners: Corners::Polygon, num_corners: nodes, num_nodes: nodes },
        _ => return None,
    };
    (nodes >= shape.num_corners && nodes > 0).then_some(shape)
}

/// The shape of a type whose cells have a fixed number of nodes.
fn shape(kind: u8) -> Option<Shape> {
    Some(match kind {
        1 => Shape::simplex(1, 1),
        3 => Shape::simplex(2, 2),
        5 => Shape::simplex(3, 3),
        8 | 9 => Shape::quadrangle(4),
        10 => Shape::simplex(4, 4),
        11 | 12 => Shape::hexahedron(8),
        13 => Shape::prism(6),
        14 => Shape::pyramid(5),
        21 => Shape::simplex(2, 3),
        22 => Shape::simplex(3, 6),
        23 => Shape::quadrangle(8),
        24 => Shape::simplex(4, 10),
        25 => Shape::hexahedron(20),
        26 => Shape::prism(15),
        27 => Shape::pyramid(13),
        28 => Shape::quadrangle(9),
        29 => Shape::hexahedron(27),
        30 => Shape::quadrangle(6),
        31 => Shape::prism(12),
        32 => Shape::prism(18),
        33 => Shape::hexahedron(24),
        34 => Shape::simplex(3, 7),
        35 => Shape::simplex(2, 4),
        37 => Shape::pyramid(19),
        _ => return None,
    })
}

/// Adds a cell of the given type by its nodes.
pub(super) fn add(kind: u8, nodes: &[u32], intake: &mut Intake) -> Result<(), ErrorKind> {
    let refused = |refusal: Refusal| refusal.kind(|vertex| vertex.to_string());
    match (kind, nodes) {
        // The empty cell.
        (0, []) => return Ok(()),
        // Points, lines and strips of any number.
        (2, _) => return nodes.chunks(1).try_for_each(|point| intake.simplex(point)).map_err(refused),
        (4, [_, _, ..]) => return nodes.windows(2).try_for_each(|edge| intake.simplex(edge)).map_err(refused),
        (6, [_, _, _, ..]) => return intake.strip(nodes).map_err(refused),
        _ => {}
    }
    let Some(shape) = shape(kind).or_else(|| of_any_order(kind, nodes.len())) else {
        return Err(ErrorKind::Unsupported(
            format!("cells of VTK's type {kind} with {} vertices are not read", nodes.len()).into(),
        ));
    };
    if shape.num_nodes != nodes.len() {
        let message = format!("a cell of VTK's type {kind} has {} vertices, not {}", shape.num_nodes, nodes.len());
        return Err(ErrorKind::Rule(message.into()));
    }
    // Pixels and voxels go row by row, not around.
    let added = match (kind, nodes) {
        (8, &[a, b, c, d]) => intake.element(shape, &[a, b, d, c], u64::from),
        // The first triangle of a prism looks out of it, where other formats have it look in.
        (13 | 26 | 31 | 32, [a, b, c, d, e, f, rest @ ..]) => {
            let corners = [*a, *c, *b, *d, *f, *e];
            intake.element(shape, &[&corners[..], rest].concat(), u64::from)
        }
        (11, &[a, b, c, d, e, f, g, h]) => intake.element(shape, &[a, b, d, c, e, f, h, g], u64::from),
        _ => intake.element(shape, nodes, u64::from),
    };
    added.map_err(refused)
}
