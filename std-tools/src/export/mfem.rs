//! MFEM's mesh format, version 1.0: elements of one dimension, with the attribute 1, and vertices.

use std::io::{self, Write};

use sig_core::Relations;

use super::mesh::Mesh;

/// The geometry types of a point, a segment, a triangle and a tetrahedron.
const TYPES: [u8; 4] = [0, 1, 2, 4];

pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
    let dim = mesh.dim();
    writeln!(out, "MFEM mesh v1.0\n\ndimension\n{dim}\n\nelements\n{}", mesh.num_cells()[dim])?;
    mesh.cells(dim..=dim, |cell| {
        write!(out, "1 {}", TYPES[dim])?;
        cell.iter().try_for_each(|vertex| write!(out, " {vertex}"))?;
        writeln!(out)
    })?;
    writeln!(out, "\nboundary\n0\n\nvertices\n{}\n{}", mesh.num_vertices(), mesh.components())?;
    for vertex in mesh.vertices() {
        mesh.write_point(vertex, out)?;
        writeln!(out)?;
    }
    Ok(())
}
