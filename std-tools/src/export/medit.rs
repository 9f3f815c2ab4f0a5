//! MEDIT's `.mesh` in text: vertices, then edges, triangles and tetrahedra, each with the reference 0.

use std::io::{self, Write};

use sig_core::Relations;

use super::mesh::Mesh;

pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "MeshVersionFormatted 2\n\nDimension {}\n\nVertices\n{}", mesh.components(), mesh.num_vertices())?;
    for vertex in mesh.vertices() {
        mesh.write_point(vertex, out)?;
        writeln!(out, " 0")?;
    }
    let counts = mesh.num_cells();
    for (dim, name) in [(1, "Edges"), (2, "Triangles"), (3, "Tetrahedra")] {
        if counts[dim] == 0 {
            continue;
        }
        writeln!(out, "\n{name}\n{}", counts[dim])?;
        mesh.cells(dim..=dim, |cell| {
            cell.iter().try_for_each(|vertex| write!(out, "{} ", vertex + 1))?;
            writeln!(out, "0")
        })?;
    }
    writeln!(out, "\nEnd")
}
