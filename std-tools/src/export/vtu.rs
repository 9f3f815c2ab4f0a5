//! VTK's XML format for unstructured grids: cells of all dimensions in one grid, arrays inline in base64.
//!
//! Cells carry their dimension, points their label where labels are integers, so that both can be shown and selected, and
//! both their attributes.

use std::io::{self, Write};

use base64::engine::general_purpose::STANDARD;
use base64::write::EncoderWriter;
use sig_core::format::Column;
use sig_core::{Dim, Relations};

use super::attributes::{Attribute, Losses};
use super::mesh::Mesh;

/// VTK's cell types of a vertex, a line, a triangle and a tetrahedron.
pub(crate) const CELL_TYPES: [u8; 4] = [1, 3, 5, 10];

pub(super) fn write<'v, V: Relations>(mesh: &Mesh<'v, V>, out: &mut dyn Write) -> io::Result<Losses<'v>> {
    let counts = mesh.num_cells();
    let num_cells: usize = counts.iter().sum();
    let num_corners: usize = counts.iter().enumerate().map(|(dim, count)| (dim + 1) * count).sum();
    head(out, mesh.num_vertices(), num_cells)?;
    let losses = data(mesh, 3, out)?;
    writeln!(out, "<Points>")?;
    points(mesh, out)?;
    writeln!(out, "</Points>\n<Cells>")?;
    array(out, r#"type="Int64" Name="connectivity""#, num_corners * 8, |data| {
        mesh.cells(0..=3, |cell| cell.iter().try_for_each(|&vertex| data.write_all(&to_i64(vertex))))
    })?;
    array(out, r#"type="Int64" Name="offsets""#, num_cells * 8, |data| {
        let mut end = 0;
        mesh.cells(0..=3, |cell| {
            end += cell.len();
            data.write_all(&to_i64(end))
        })
    })?;
    array(out, r#"type="UInt8" Name="types""#, num_cells, |data| {
        mesh.cells(0..=3, |cell| data.write_all(&[CELL_TYPES[cell.len() - 1]]))
    })?;
    writeln!(out, "</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>")?;
    Ok(losses)
}

/// The data of the points and of the cells of dimension up to `max_dim`, which come by dimension: labels that are integers,
/// dimensions, attributes.
pub(super) fn data<'v, V: Relations>(mesh: &Mesh<'v, V>, max_dim: Dim, out: &mut dyn Write) -> io::Result<Losses<'v>> {
    let (mut vertices, cells, mut left_out) = Attribute::all(mesh.complex, max_dim);
    let num_cells: usize = mesh.num_cells().iter().take(max_dim + 1).sum();
    let labels = mesh.integer_labels();
    if labels.is_some() {
        // The labels have the name.
        left_out.extend(vertices.extract_if(.., |attribute| attribute.name == LABEL).map(|attribute| attribute.name));
    }
    let has_points = labels.is_some() || !vertices.is_empty();
    if has_points {
        writeln!(out, "<PointData{}>", labels.as_ref().map_or("", |_| r#" Scalars="label""#))?;
    }
    if let Some(labels) = labels {
        array(out, r#"type="UInt64" Name="label""#, mesh.num_vertices() * 8, |data| {
            labels.into_iter().try_for_each(|label| data.write_all(&label.to_le_bytes()))
        })?;
    }
    for attribute in &vertices {
        let bytes = attribute.row_bytes() * mesh.num_vertices();
        array(out, &described(attribute), bytes, |data| {
            mesh.vertices().try_for_each(|vertex| attribute.write_binary(0, vertex.index(), data))
        })?;
    }
    if has_points {
        writeln!(out, "</PointData>")?;
    }
    writeln!(out, r#"<CellData Scalars="dimension">"#)?;
    if cells.iter().all(|attribute| attribute.name != DIMENSION) {
        array(out, r#"type="UInt8" Name="dimension""#, num_cells, |data| {
            mesh.cells(0..=max_dim, |cell| data.write_all(&[to_u8(cell.len() - 1)]))
        })?;
    }
    for attribute in &cells {
        array(out, &described(attribute), attribute.row_bytes() * num_cells, |data| {
            mesh.rows(0..=max_dim).try_for_each(|(dim, row)| attribute.write_binary(dim, row, data))
        })?;
    }
    writeln!(out, "</CellData>")?;
    Ok(Losses { left_out, ..Losses::default() })
}

/// The names of the arrays that are there without attributes.
const LABEL: &str = "label";
const DIMENSION: &str = "dimension";

/// What the tag of the array of an attribute says.
fn described(attribute: &Attribute<'_>) -> String {
    let scalar = match attribute.column() {
        Column::Bits { .. } | Column::U8(_) => "UInt8",
        Column::U16(_) => "UInt16",
        Column::U32(_) => "UInt32",
        Column::U64(_) => "UInt64",
        Column::I32(_) => "Int32",
        Column::I64(_) => "Int64",
        Column::F32(_) => "Float32",
        Column::F64(_) => "Float64",
    };
    let name = attribute.name.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;");
    format!(r#"type="{scalar}" Name="{name}" NumberOfComponents="{}""#, attribute.components)
}

/// The points, filled up to three coordinates, in their own precision.
pub(super) fn points<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
    let (name, bytes) = if mesh.is_single() { ("Float32", 4) } else { ("Float64", 8) };
    let attributes = format!(r#"type="{name}" NumberOfComponents="3""#);
    array(out, &attributes, mesh.num_vertices() * 3 * bytes, |data| {
        for vertex in mesh.vertices() {
            let point = mesh.padded(vertex);
            for value in point {
                if mesh.is_single() {
                    // Exact: it was single before.
                    #[expect(clippy::cast_possible_truncation)]
                    data.write_all(&(value as f32).to_le_bytes())?;
                } else {
                    data.write_all(&value.to_le_bytes())?;
                }
            }
        }
        Ok(())
    })
}

/// How a grid of so many points and cells begins.
pub(crate) fn head(out: &mut dyn Write, points: usize, cells: usize) -> io::Result<()> {
    writeln!(out, r#"<?xml version="1.0"?>"#)?;
    writeln!(out, r#"<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64">"#)?;
    writeln!(out, "<UnstructuredGrid>")?;
    writeln!(out, r#"<Piece NumberOfPoints="{points}" NumberOfCells="{cells}">"#)
}

/// An array of so many bytes, which are what `fill` writes.
pub(crate) fn array(
    out: &mut dyn Write,
    attributes: &str,
    bytes: usize,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    write!(out, r#"<DataArray {attributes} format="binary">"#)?;
    let mut encoder = EncoderWriter::new(&mut *out, &STANDARD);
    encoder.write_all(&(bytes as u64).to_le_bytes())?;
    fill(&mut encoder)?;
    encoder.finish()?;
    drop(encoder);
    writeln!(out, "</DataArray>")
}

/// A number as 64 bits.
pub(super) fn to_i64(number: usize) -> [u8; 8] {
    (number as u64).to_le_bytes()
}

/// A dimension up to 3 as a byte.
fn to_u8(dim: usize) -> u8 {
    u8::try_from(dim).unwrap_or(u8::MAX)
}
