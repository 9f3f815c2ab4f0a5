//! TetGen's files, numbered from 0: points in `.node`, tetrahedra in `.ele`, triangles in `.face`, edges in `.edge`; in the
//! plane, as Triangle has them, triangles in `.ele`.

use std::io::{self, Write};

use sig_core::{Dim, Relations};

use super::mesh::Mesh;

/// The end of the name of the file of points.
pub(super) const NODES: &str = "node";

/// The files of a mesh by the ends of their names, and the dimension of the cells in each.
fn files(components: usize) -> &'static [(&'static str, Dim)] {
    if components == 2 { &[("ele", 2), ("edge", 1)] } else { &[("ele", 3), ("face", 2), ("edge", 1)] }
}

/// All ends of names that any mesh has.
pub(super) const ALL: &[&str] = &[NODES, "ele", "face", "edge"];

/// The ends of the names of the files that this mesh needs.
pub(super) fn needed<V: Relations>(mesh: &Mesh<'_, V>) -> Vec<&'static str> {
    let counts = mesh.num_cells();
    let cells = files(mesh.components()).iter().filter(|(_, dim)| counts[*dim] > 0);
    std::iter::once(NODES).chain(cells.map(|(end, _)| *end)).collect()
}

/// Writes the file with this end of its name.
pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, file: &str, out: &mut dyn Write) -> io::Result<()> {
    let Some(&(end, dim)) = files(mesh.components()).iter().find(|(end, _)| *end == file) else {
        writeln!(out, "{} {} 0 0", mesh.num_vertices(), mesh.components())?;
        for (number, vertex) in mesh.vertices().enumerate() {
            write!(out, "{number} ")?;
            mesh.write_point(vertex, out)?;
            writeln!(out)?;
        }
        return Ok(());
    };
    let count = mesh.num_cells()[dim];
    // Cells in `.ele` say how many nodes they have; none has an attribute or a marker.
    let nodes = if end == "ele" { format!(" {}", dim + 1) } else { String::new() };
    writeln!(out, "{count}{nodes} 0")?;
    let mut number = 0;
    mesh.cells(dim..=dim, |cell| {
        write!(out, "{number}")?;
        number += 1;
        cell.iter().try_for_each(|vertex| write!(out, " {vertex}"))?;
        writeln!(out)
    })
}
