//! The numbers of points and top simplices, the points, and the simplices as `k v1 … vk`: any dimension of either.

use std::io::{self, Write};

use sig_core::{MAX_DIM, Relations};

use super::mesh::Mesh;

pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{} {}", mesh.num_vertices(), mesh.num_tops())?;
    for vertex in mesh.vertices() {
        mesh.write_point(vertex, out)?;
        writeln!(out)?;
    }
    mesh.cells(0..=MAX_DIM, |cell| {
        write!(out, "{}", cell.len())?;
        cell.iter().try_for_each(|vertex| write!(out, " {vertex}"))?;
        writeln!(out)
    })
}
