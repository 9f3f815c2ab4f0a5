//! MFEM's mesh format, version 1.0: elements of one dimension, with the attribute `ref` as theirs where that is
//! positive, else 1, and vertices.

use std::io::{self, Write};

use sig_core::Relations;

use super::attributes::{Attribute, Losses};
use super::mesh::Mesh;
use crate::attribute::Number;

/// The geometry types of a point, a segment, a triangle and a tetrahedron.
const TYPES: [u8; 4] = [0, 1, 2, 4];

pub(super) fn write<'v, V: Relations>(mesh: &Mesh<'v, V>, out: &mut dyn Write) -> io::Result<Losses<'v>> {
    let (vertices, cells, mut left_out) = Attribute::all(mesh.complex, 3);
    left_out.extend(vertices.iter().map(|attribute| attribute.name));
    let (references, others): (Vec<Attribute<'v>>, Vec<Attribute<'v>>) =
        cells.into_iter().partition(Attribute::is_reference);
    left_out.extend(others.iter().map(|attribute| attribute.name));
    let mut converted = Vec::new();
    let dim = mesh.dim();
    writeln!(out, "MFEM mesh v1.0\n\ndimension\n{dim}\n\nelements\n{}", mesh.num_cells()[dim])?;
    let mut rows = mesh.rows(dim..=dim);
    mesh.cells(dim..=dim, |cell| {
        let (_, row) = rows.next().unwrap_or_default();
        let mut number = 1;
        if let Some(reference) = references.first()
            && let Some(Number::Integer(integer)) = reference.number(dim, row, 0)
        {
            number = integer.max(1);
            if integer < 0 && converted.is_empty() {
                converted.push(reference.name);
            }
        }
        write!(out, "{number} {}", TYPES[dim])?;
        cell.iter().try_for_each(|vertex| write!(out, " {vertex}"))?;
        writeln!(out)
    })?;
    writeln!(out, "\nboundary\n0\n\nvertices\n{}\n{}", mesh.num_vertices(), mesh.components())?;
    for vertex in mesh.vertices() {
        mesh.write_point(vertex, out)?;
        writeln!(out)?;
    }
    Ok(Losses { left_out, converted })
}
