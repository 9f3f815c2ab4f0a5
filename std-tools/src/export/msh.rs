//! Gmsh's MSH 2.2 in text. Nodes go by the labels of the vertices where those are integers from 1. The attribute `ref`
//! of cells is their physical group, others are data at nodes and elements.

use std::io::{self, Write};

use sig_core::format::Column;
use sig_core::{Dim, Relations};

use super::attributes::{Attribute, Losses, write_double};
use super::mesh::Mesh;

/// The element types of a point, a line, a triangle and a tetrahedron.
const TYPES: [u8; 4] = [15, 1, 2, 4];

/// The tags of the nodes, if they are to be the labels.
pub(super) fn tags<V: Relations>(mesh: &Mesh<'_, V>) -> Option<Vec<u64>> {
    let labels: Vec<u64> = mesh.integer_labels()?.collect();
    (!labels.contains(&0)).then_some(labels)
}

pub(super) fn write<'v, V: Relations>(mesh: &Mesh<'v, V>, out: &mut dyn Write) -> io::Result<Losses<'v>> {
    let (vertices, mut cells, mut left_out) = Attribute::all(mesh.complex, 3);
    let group = cells.iter().position(Attribute::is_reference).map(|at| cells.remove(at));
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
    let (mut number, mut rows) = (0, mesh.rows(0..=3));
    mesh.cells(0..=3, |cell| {
        number += 1;
        let (dim, row) = rows.next().unwrap_or_default();
        write!(out, "{number} {} 2", TYPES[cell.len() - 1])?;
        match &group {
            // The entity of the geometry has the same number.
            Some(group) => (0..2).try_for_each(|_| group.write_text(dim, row, out))?,
            None => write!(out, " 0 0")?,
        }
        cell.iter().try_for_each(|&place| write!(out, " {}", tag(place)))?;
        writeln!(out)
    })?;
    writeln!(out, "$EndElements")?;
    let mut converted = Vec::new();
    for attribute in &vertices {
        let rows = || mesh.vertices().enumerate().map(|(place, vertex)| (tag(place), 0, vertex.index()));
        data("NodeData", attribute, rows, out)?;
    }
    for attribute in &cells {
        let rows = || (1..).zip(mesh.rows(0..=3)).map(|(number, (dim, row))| (number, dim, row));
        data("ElementData", attribute, rows, out)?;
    }
    for attribute in vertices.iter().chain(&cells) {
        if width(attribute).is_none() {
            left_out.push(attribute.name);
        } else if width(attribute) != Some(attribute.components) || !matches!(attribute.column(), Column::F64(_)) {
            converted.push(attribute.name);
        }
    }
    Ok(Losses { left_out, converted })
}

/// How many components an attribute has here, where there may be 1, 3 or 9.
fn width(attribute: &Attribute<'_>) -> Option<usize> {
    [1, 3, 9].into_iter().find(|&width| width >= attribute.components)
}

/// Writes a section of the values at the nodes or elements of these tags, without those that have none.
fn data<R: Iterator<Item = (u64, Dim, usize)>>(
    section: &str,
    attribute: &Attribute<'_>,
    rows: impl Fn() -> R,
    out: &mut dyn Write,
) -> io::Result<()> {
    let Some(width) = width(attribute) else { return Ok(()) };
    let has_values = |&(_, dim, row): &(u64, Dim, usize)| !attribute.doubles(dim, row).all(f64::is_nan);
    let name = attribute.name.replace(|c: char| c.is_control() || c == '"', "_");
    writeln!(out, "${section}\n1\n\"{name}\"\n1\n0\n3\n0\n{width}\n{}", rows().filter(has_values).count())?;
    for (tag, dim, row) in rows().filter(has_values) {
        write!(out, "{tag}")?;
        attribute.doubles(dim, row).try_for_each(|value| write_double(value, out))?;
        (attribute.components..width).try_for_each(|_| write!(out, " 0.0"))?;
        writeln!(out)?;
    }
    writeln!(out, "$End{section}")
}
