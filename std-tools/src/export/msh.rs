//! Gmsh's MSH 2.2 in text. Nodes go by the labels of the vertices where those are integers from 1.

use std::io::{self, Write};

use sig_core::Relations;

use super::mesh::Mesh;

/// The element types of a point, a line, a triangle and a tetrahedron.
const TYPES: [u8; 4] = [15, 1, 2, 4];

/// The tags of the nodes, if they are to be the labels.
pub(super) fn tags<V: Relations>(mesh: &Mesh<'_, V>) -> Option<Vec<u64>> {
    let labels: Vec<u64> = mesh.integer_labels()?.collect();
    (!labels.contains(&0)).then_some(labels)
}

pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
    let tags = tags(mesh);
    let tag = |place: usize| tags.as_ref().map_or(place as u64 + 1, |tags| tags[place]);
    writeln!(out, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}", mesh.num_vertices())?;
    for (place, vertex) in mesh.vertices().enumerate() {
        write!(out, "{} ", tag(place))?;
        mesh.write_padded_point(vertex, out)?;
        writeln!(out)?;
    }
    let num_cells: usize = mesh.num_cells().iter().sum();
    writeln!(out, "$EndNodes\n$Elements\n{num_cells}")?;
    let mut number = 0;
    mesh.cells(0..=3, |cell| {
        number += 1;
        write!(out, "{number} {} 2 0 0", TYPES[cell.len() - 1])?;
        cell.iter().try_for_each(|&place| write!(out, " {}", tag(place)))?;
        writeln!(out)
    })?;
    writeln!(out, "$EndElements")
}
