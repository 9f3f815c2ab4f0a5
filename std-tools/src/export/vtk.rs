//! VTK's legacy format in text: an unstructured grid with cells of all dimensions.

use std::io::{self, Write};

use sig_core::Relations;

use super::mesh::Mesh;
use super::vtu::CELL_TYPES;

pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, out: &mut dyn Write) -> io::Result<()> {
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
    mesh.cells(0..=3, |cell| writeln!(out, "{}", CELL_TYPES[cell.len() - 1]))
}
