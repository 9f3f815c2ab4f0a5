//! TetGen's files, numbered from 0: points in `.node`, tetrahedra in `.ele`, triangles in `.face`, edges in `.edge`; in the
//! plane, as Triangle has them, triangles in `.ele`.
//!
//! The attribute `attribute`, of any number type and any number of components, stands behind points and the cells in `.ele`,
//! the integer `ref` behind points and the cells of the other files, as their boundary marker.

use std::io::{self, Write};

use sig_core::format::Column;
use sig_core::{Dim, Relations};

use super::attributes::{Attribute, Losses, write_double};
use super::mesh::Mesh;
use crate::attribute::NAMELESS;

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

/// The attributes that have a place in these files.
struct Kept<'v> {
    numbers: Option<Attribute<'v>>,
    markers: Option<Attribute<'v>>,
}

impl<'v> Kept<'v> {
    fn of(attributes: &[Attribute<'v>]) -> Self {
        let find = |is: fn(&Attribute<'v>) -> bool| attributes.iter().copied().find(is);
        Self { numbers: find(|attribute| attribute.name == NAMELESS), markers: find(Attribute::is_reference) }
    }

    /// How many numbers stand behind simplices of a dimension, and whether a marker does.
    fn counts(&self, dim: Dim) -> (usize, usize) {
        let components = self.numbers.filter(|numbers| numbers.is_of(dim)).map_or(0, |numbers| numbers.components);
        (components, usize::from(self.markers.is_some_and(|markers| markers.is_of(dim))))
    }

    /// Writes what stands behind a simplex; markers only where the file has them.
    fn write(&self, dim: Dim, row: usize, (numbers, markers): (usize, usize), out: &mut dyn Write) -> io::Result<()> {
        if let Some(attribute) = self.numbers.filter(|_| numbers > 0) {
            attribute.doubles(dim, row).try_for_each(|number| write_double(number, out))?;
        }
        if let Some(attribute) = self.markers.filter(|_| markers > 0) {
            attribute.write_text(dim, row, out)?;
        }
        writeln!(out)
    }
}

/// What becomes of the attributes: `ref` has no place at cells in `.ele`, `attribute` none at others, and all numbers in
/// `.ele` and `.node` are doubles.
pub(super) fn losses<'v, V: Relations>(mesh: &Mesh<'v, V>) -> Losses<'v> {
    let (vertices, cells, mut left_out) = Attribute::all(mesh.complex, 3);
    let mut converted = Vec::new();
    let top = files(mesh.components()).first().map_or(3, |(_, dim)| *dim);
    for (attribute, dims) in vertices.iter().map(|vertex| (vertex, 0..1)).chain(cells.iter().map(|cell| (cell, 1..4))) {
        for dim in dims.filter(|&dim| attribute.is_of(dim)) {
            let (is_numbers, is_marker) = (attribute.name == NAMELESS, attribute.is_reference());
            match (is_numbers && (dim == 0 || dim == top), is_marker && dim != top) {
                (false, false) => left_out.push(attribute.name),
                (true, _) if !matches!(attribute.column(), Column::F64(_)) => converted.push(attribute.name),
                _ => {}
            }
        }
    }
    Losses { left_out, converted }
}

/// Writes the file with this end of its name.
pub(super) fn write<V: Relations>(mesh: &Mesh<'_, V>, file: &str, out: &mut dyn Write) -> io::Result<()> {
    let (vertices, cells, _) = Attribute::all(mesh.complex, 3);
    let Some(&(end, dim)) = files(mesh.components()).iter().find(|(end, _)| *end == file) else {
        let kept = Kept::of(&vertices);
        let counts = kept.counts(0);
        writeln!(out, "{} {} {} {}", mesh.num_vertices(), mesh.components(), counts.0, counts.1)?;
        for (number, vertex) in mesh.vertices().enumerate() {
            write!(out, "{number} ")?;
            mesh.write_point(vertex, out)?;
            kept.write(0, vertex.index(), counts, out)?;
        }
        return Ok(());
    };
    let count = mesh.num_cells()[dim];
    let kept = Kept::of(&cells);
    let (numbers, markers) = kept.counts(dim);
    // Cells in `.ele` say how many nodes they have, and have numbers, the others markers.
    let counts = if end == "ele" { (numbers, 0) } else { (0, markers) };
    if end == "ele" {
        writeln!(out, "{count} {} {numbers}", dim + 1)?;
    } else {
        writeln!(out, "{count} {markers}")?;
    }
    let mut rows = mesh.rows(dim..=dim);
    let mut number = 0;
    mesh.cells(dim..=dim, |cell| {
        write!(out, "{number}")?;
        number += 1;
        cell.iter().try_for_each(|vertex| write!(out, " {vertex}"))?;
        let (dim, row) = rows.next().unwrap_or_default();
        kept.write(dim, row, counts, out)
    })
}
