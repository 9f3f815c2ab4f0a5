//! MEDIT's `.mesh` in text: vertices, then edges, triangles and tetrahedra, each with the attribute `ref` as
//! its reference, 0 for want of one.

use std::io::{self, Write};

use sig_core::{Dim, Relations};

use super::attributes::{Attribute, Losses};
use super::mesh::Mesh;

pub(super) fn write<'v, V: Relations>(mesh: &Mesh<'v, V>, out: &mut dyn Write) -> io::Result<Losses<'v>> {
    let (vertices, cells, mut left_out) = Attribute::all(mesh.complex, 3);
    let [of_vertices, of_cells] = [&vertices, &cells].map(|all| all.iter().find(|attribute| attribute.is_reference()));
    let others = vertices.iter().chain(&cells).filter(|attribute| !attribute.is_reference());
    left_out.extend(others.map(|attribute| attribute.name));
    let write_reference = |attribute: Option<&Attribute<'_>>, dim: Dim, row: usize, out: &mut dyn Write| {
        match attribute {
            Some(attribute) => attribute.write_text(dim, row, out)?,
            None => write!(out, " 0")?,
        }
        writeln!(out)
    };
    writeln!(out, "MeshVersionFormatted 2\n\nDimension {}\n\nVertices\n{}", mesh.components(), mesh.num_vertices())?;
    for vertex in mesh.vertices() {
        mesh.write_point(vertex, out)?;
        write_reference(of_vertices, 0, vertex.index(), out)?;
    }
    let counts = mesh.num_cells();
    for (dim, name) in [(1, "Edges"), (2, "Triangles"), (3, "Tetrahedra")] {
        if counts[dim] == 0 {
            continue;
        }
        writeln!(out, "\n{name}\n{}", counts[dim])?;
        let mut rows = mesh.rows(dim..=dim);
        mesh.cells(dim..=dim, |cell| {
            let mut blank = "";
            for vertex in cell {
                write!(out, "{blank}{}", vertex + 1)?;
                blank = " ";
            }
            let (dim, row) = rows.next().unwrap_or_default();
            write_reference(of_cells, dim, row, out)
        })?;
    }
    writeln!(out, "\nEnd")?;
    Ok(Losses { left_out, ..Losses::default() })
}
