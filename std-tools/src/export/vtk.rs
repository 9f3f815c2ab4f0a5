//! VTK's legacy format in text: an unstructured grid with cells of all dimensions.

use std::io::{self, Write};

use sig_core::format::Column;
use sig_core::{Dim, Relations};

use super::attributes::{Attribute, Losses};
use super::mesh::Mesh;
use super::vtu::CELL_TYPES;

pub(super) fn write<'v, V: Relations>(mesh: &Mesh<'v, V>, out: &mut dyn Write) -> io::Result<Losses<'v>> {
    let counts = mesh.num_cells();
    let num_cells: usize = counts.iter().sum();
    let numbers: usize = counts.iter().enumerate().map(|(dim, count)| (dim + 2) * count).sum();
    let scalar = if mesh.is_single() { "float" } else { "double" };
    writeln!(out, "# vtk DataFile Version 3.0\nsimplicial complex\nASCII\nDATASET UNSTRUCTURED_GRID")?;
    writeln!(out, "POINTS {} {scalar}", mesh.num_vertices())?;
    for vertex in mesh.vertices() {
        mesh.write_padded_point(vertex, out)?;
        writeln!(out)?;
    }
    writeln!(out, "CELLS {num_cells} {numbers}")?;
    mesh.cells(0..=3, |cell| {
        write!(out, "{}", cell.len())?;
        cell.iter().try_for_each(|vertex| write!(out, " {vertex}"))?;
        writeln!(out)
    })?;
    writeln!(out, "CELL_TYPES {num_cells}")?;
    mesh.cells(0..=3, |cell| writeln!(out, "{}", CELL_TYPES[cell.len() - 1]))?;
    let (vertices, cells, left_out) = Attribute::all(mesh.complex, 3);
    if !vertices.is_empty() {
        let num_vertices = mesh.num_vertices();
        writeln!(out, "POINT_DATA {num_vertices}")?;
        field(&vertices, num_vertices, || mesh.vertices().map(|vertex| (0, vertex.index())), out)?;
    }
    if !cells.is_empty() {
        writeln!(out, "CELL_DATA {num_cells}")?;
        field(&cells, num_cells, || mesh.rows(0..=3), out)?;
    }
    Ok(Losses { left_out, ..Losses::default() })
}

/// Writes attributes of points or cells as a field, which may be of any type and have any number of components.
fn field<R: Iterator<Item = (Dim, usize)>>(
    attributes: &[Attribute<'_>],
    count: usize,
    rows: impl Fn() -> R,
    out: &mut dyn Write,
) -> io::Result<()> {
    writeln!(out, "FIELD FieldData {}", attributes.len())?;
    for attribute in attributes {
        let scalar = match attribute.column() {
            Column::Bits { .. } | Column::U8(_) => "unsigned_char",
            Column::U16(_) => "unsigned_short",
            Column::U32(_) => "unsigned_int",
            Column::U64(_) => "unsigned_long",
            Column::I32(_) => "int",
            Column::I64(_) => "long",
            Column::F32(_) => "float",
            Column::F64(_) => "double",
        };
        writeln!(out, "{} {} {count} {scalar}", escaped(attribute.name), attribute.components)?;
        for (dim, row) in rows() {
            attribute.write_text(dim, row, out)?;
            writeln!(out)?;
        }
    }
    Ok(())
}

/// A name as one word, as VTK escapes it.
fn escaped(name: &str) -> String {
    let escape = |byte: u8| match byte {
        b'!'..=b'~' if !matches!(byte, b'"' | b'%') => char::from(byte).to_string(),
        _ => format!("%{byte:02X}"),
    };
    name.bytes().map(escape).collect()
}
