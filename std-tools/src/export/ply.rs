//! Stanford PLY in text: elements `vertex`, `face` and, if there are any, `edge`, with a property for each component of an
//! attribute.

use std::io::{self, Write};

use sig_core::format::Column;
use sig_core::{Dim, Relations};

use super::attributes::{Attribute, Losses, write_double};
use super::mesh::Mesh;

pub(super) fn write<'v, V: Relations>(mesh: &Mesh<'v, V>, out: &mut dyn Write) -> io::Result<Losses<'v>> {
    let (vertices, cells, mut left_out) = Attribute::all(mesh.complex, 2);
    let mut converted = Vec::new();
    // The names that are taken.
    let [points, faces, lines] = [&["x", "y", "z"][..], &["vertex_indices", "vertex_index"], &["vertex1", "vertex2"]];
    let mut fitting = |all: &[Attribute<'v>], dim: Dim, taken: &[&str]| -> Vec<Attribute<'v>> {
        let (fit, other): (Vec<_>, _) =
            all.iter().filter(|one| one.is_of(dim)).partition(|one| !taken.contains(&one.name));
        left_out.extend(other.into_iter().map(|one: Attribute<'v>| one.name));
        converted.extend(fit.iter().filter(|one| !is_same(one)).map(|one| one.name));
        fit
    };
    let [of_points, of_faces, of_edges] =
        [fitting(&vertices, 0, points), fitting(&cells, 2, faces), fitting(&cells, 1, lines)];
    let scalar = if mesh.is_single() { "float" } else { "double" };
    let [_, edges, triangles, _] = mesh.num_cells();
    writeln!(out, "ply\nformat ascii 1.0\nelement vertex {}", mesh.num_vertices())?;
    for axis in ["x", "y", "z"].into_iter().take(mesh.components()) {
        writeln!(out, "property {scalar} {axis}")?;
    }
    properties(&of_points, out)?;
    writeln!(out, "element face {triangles}\nproperty list uchar uint vertex_indices")?;
    properties(&of_faces, out)?;
    if edges > 0 {
        writeln!(out, "element edge {edges}\nproperty uint vertex1\nproperty uint vertex2")?;
        properties(&of_edges, out)?;
    }
    writeln!(out, "end_header")?;
    for vertex in mesh.vertices() {
        mesh.write_point(vertex, out)?;
        write_row(&of_points, (0, vertex.index()), out)?;
    }
    let mut rows = mesh.rows(2..=2);
    mesh.cells(2..=2, |cell| {
        write!(out, "3")?;
        cell.iter().try_for_each(|vertex| write!(out, " {vertex}"))?;
        write_row(&of_faces, rows.next().unwrap_or_default(), out)
    })?;
    let mut rows = mesh.rows(1..=1);
    mesh.cells(1..=1, |cell| match cell {
        [a, b] => {
            write!(out, "{a} {b}")?;
            write_row(&of_edges, rows.next().unwrap_or_default(), out)
        }
        _ => Ok(()),
    })?;
    Ok(Losses { left_out, converted })
}

/// The type of an attribute here, and whether it is its own.
fn scalar_of(attribute: &Attribute<'_>) -> (&'static str, bool) {
    match attribute.column() {
        Column::Bits { .. } | Column::U8(_) => ("uchar", true),
        Column::U16(_) => ("ushort", true),
        Column::U32(_) => ("uint", true),
        Column::I32(_) => ("int", true),
        Column::F32(_) => ("float", true),
        Column::F64(_) => ("double", true),
        Column::U64(_) | Column::I64(_) => ("double", false),
    }
}

/// The name of an attribute here: one word.
fn name_of(attribute: &Attribute<'_>) -> String {
    attribute.name.replace(|c: char| c.is_whitespace() || c.is_control(), "_")
}

/// Whether an attribute has its own name and type here.
fn is_same(attribute: &Attribute<'_>) -> bool {
    scalar_of(attribute).1 && name_of(attribute) == attribute.name
}

/// Declares the components of attributes: `name`, or `name_0`, `name_1`, ….
fn properties(attributes: &[Attribute<'_>], out: &mut dyn Write) -> io::Result<()> {
    for attribute in attributes {
        let (name, (scalar, _)) = (name_of(attribute), scalar_of(attribute));
        match attribute.components {
            1 => writeln!(out, "property {scalar} {name}")?,
            many => (0..many).try_for_each(|component| writeln!(out, "property {scalar} {name}_{component}"))?,
        }
    }
    Ok(())
}

/// Writes the attributes of a simplex, and ends its row.
fn write_row(attributes: &[Attribute<'_>], (dim, row): (Dim, usize), out: &mut dyn Write) -> io::Result<()> {
    for attribute in attributes {
        if scalar_of(attribute).1 {
            attribute.write_text(dim, row, out)?;
        } else {
            attribute.doubles(dim, row).try_for_each(|double| write_double(double, out))?;
        }
    }
    writeln!(out)
}
