//! Stanford PLY in text: elements `vertex`, `face` and, if there are any, `edge`.

use std::io::{self, Write};

use sig_core::Relations;

use super::mesh::Mesh;

pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
    let scalar = if mesh.is_single() { "float" } else { "double" };
    let [_, edges, triangles, _] = mesh.num_cells();
    writeln!(out, "ply\nformat ascii 1.0\nelement vertex {}", mesh.num_vertices())?;
    for axis in ["x", "y", "z"].into_iter().take(mesh.components()) {
        writeln!(out, "property {scalar} {axis}")?;
    }
    writeln!(out, "element face {triangles}\nproperty list uchar uint vertex_indices")?;
    if edges > 0 {
        writeln!(out, "element edge {edges}\nproperty uint vertex1\nproperty uint vertex2")?;
    }
    writeln!(out, "end_header")?;
    for vertex in mesh.vertices() {
        mesh.write_point(vertex, out)?;
        writeln!(out)?;
    }
    mesh.cells(2..=2, |cell| {
        write!(out, "3")?;
        cell.iter().try_for_each(|vertex| write!(out, " {vertex}"))?;
        writeln!(out)
    })?;
    mesh.cells(1..=1, |cell| match cell {
        [a, b] => writeln!(out, "{a} {b}"),
        _ => Ok(()),
    })
}
