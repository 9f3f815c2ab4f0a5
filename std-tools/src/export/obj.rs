//! Wavefront OBJ: vertices numbered from 1, faces `f`, lines `l`, points `p`.

use std::io::{self, Write};

use sig_core::Relations;

use super::mesh::Mesh;

pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
    for vertex in mesh.vertices() {
        out.write_all(b"v ")?;
        mesh.write_point(vertex, out)?;
        writeln!(out)?;
    }
    mesh.cells(0..=2, |cell| {
        out.write_all(match cell.len() {
            1 => b"p",
            2 => b"l",
            _ => b"f",
        })?;
        cell.iter().try_for_each(|vertex| write!(out, " {}", vertex + 1))?;
        writeln!(out)
    })
}
