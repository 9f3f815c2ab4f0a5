//! Geomview OFF. Edges are faces of two corners; vertices that no face uses are vertices all the same.

use std::io::{self, Write};

use sig_core::Relations;

use super::mesh::Mesh;

pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
    match mesh.components() {
        3 => writeln!(out, "OFF")?,
        components => writeln!(out, "nOFF\n{components}")?,
    }
    let [_, edges, triangles, _] = mesh.num_cells();
    writeln!(out, "{} {} 0", mesh.num_vertices(), edges + triangles)?;
    for vertex in mesh.vertices() {
        mesh.write_point(vertex, out)?;
        writeln!(out)?;
    }
    mesh.cells(1..=2, |cell| {
        write!(out, "{}", cell.len())?;
        cell.iter().try_for_each(|vertex| write!(out, " {vertex}"))?;
        writeln!(out)
    })
}
