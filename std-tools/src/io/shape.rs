//! The cells that mesh formats have in common: corners first among the nodes of a cell, the others on its edges, faces or
//! inside.

use super::cone::Polyhedron;

/// What the corners of a cell span.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Corners {
    /// A simplex.
    Simplex,
    /// A polygon.
    Polygon,
    /// A hexahedron, prism or pyramid.
    Polyhedron(Polyhedron),
}

/// A kind of cell.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Shape {
    pub(super) corners: Corners,
    pub(super) num_corners: usize,
    pub(super) num_nodes: usize,
}

impl Shape {
    /// A simplex of so many corners, and so many nodes in all.
    pub(super) const fn simplex(num_corners: usize, num_nodes: usize) -> Self {
        Self { corners: Corners::Simplex, num_corners, num_nodes }
    }

    /// A quadrangle of so many nodes.
    pub(super) const fn quadrangle(num_nodes: usize) -> Self {
        Self { corners: Corners::Polygon, num_corners: 4, num_nodes }
    }

    /// A hexahedron of so many nodes.
    pub(super) const fn hexahedron(num_nodes: usize) -> Self {
        Self { corners: Corners::Polyhedron(Polyhedron::Hexahedron), num_corners: 8, num_nodes }
    }

    /// A prism over a triangle, of so many nodes.
    pub(super) const fn prism(num_nodes: usize) -> Self {
        Self { corners: Corners::Polyhedron(Polyhedron::Prism), num_corners: 6, num_nodes }
    }

    /// A pyramid over a quadrangle, of so many nodes.
    pub(super) const fn pyramid(num_nodes: usize) -> Self {
        Self { corners: Corners::Polyhedron(Polyhedron::Pyramid), num_corners: 5, num_nodes }
    }
}
