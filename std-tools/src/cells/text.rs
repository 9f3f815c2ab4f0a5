//! Cell complexes in text, one boundary a line: `io::cells` has the grammar.

use std::io::{self, Read, Write};

use sig_core::{Arc, CellId, Dim, Incidence};

use super::{BrokenInvariant, CellComplex};
use crate::build::narrow;
use crate::io::ReadError;
use crate::io::cells::{CellList, read_cell_list};

/// Reads a cell complex, which is called `name` in errors.
///
/// ```text
/// cells 1 1 1 1     # the lens space L(3,1): how many cells of dimension 0, 1, 2, 3
/// +0 -0             # the 1-cell goes from vertex 0 to vertex 0
/// 3*+0              # the 2-cell winds round it three times
/// +0 -0             # the 3-cell has the 2-cell on either side
/// ```
///
/// After the counts there is a line for each cell of dimension 1 and more, lower dimensions first: the cells on its boundary by
/// their numbers in their dimension, with their orientations. `n*` stands for n appearances, `.` for no boundary, `#` begins a
/// comment. Cell `k` of dimension i is number n_0 + … + n_{i−1} + k of the complex. Gzip input is decompressed.
///
/// Takes time linear in the input, and that of [`CellComplex::check`].
///
/// # Errors
/// [`ReadError`], with the place: a line that does not follow the grammar, a cell that is not there, a boundary whose own
/// boundary is not zero.
pub fn read_cells(reader: impl Read, name: &str) -> Result<CellComplex, ReadError> {
    let list = read_cell_list(reader, name)?;
    let complex = from_list(&list);
    complex.check().map_err(|error| {
        let vertices = list.counts.first().copied().unwrap_or(0);
        let cell = match error {
            BrokenInvariant::BoundaryOfBoundary { cell, .. } => cell.index().checked_sub(vertices),
            _ => None,
        };
        list.refuse(name, cell, error.to_string())
    })?;
    Ok(complex)
}

fn from_list(list: &CellList) -> CellComplex {
    let CellList { counts, faces, ends, .. } = list;
    let vertices = counts.first().copied().unwrap_or(0);
    // By dimension: its first cell.
    let firsts: Vec<usize> = counts.iter().scan(0, |sum, &count| Some(std::mem::replace(sum, *sum + count))).collect();
    let dims = counts.iter().enumerate().flat_map(|(dim, &count): (Dim, &usize)| std::iter::repeat_n(dim, count));
    CellComplex::lay_out(dims, |number, visit| {
        let number = number as usize;
        let Some(row) = number.checked_sub(vertices) else { return };
        let start = row.checked_sub(1).map_or(0, |before| ends[before]);
        let below = firsts.partition_point(|&first| first <= number) - 2;
        for &(face, incidence) in &faces[start..ends[row]] {
            visit(Arc { cell: CellId::new(narrow(firsts[below]) + face), incidence });
        }
    })
}

/// Writes a cell complex as [`read_cells`] reads it: cells of a dimension by increasing number, without the vacant ones.
///
/// # Errors
/// Those of the writer.
pub fn write_cells(complex: &CellComplex, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
    write!(out, "cells")?;
    complex.counts().iter().try_for_each(|count| write!(out, " {count}"))?;
    writeln!(out)?;
    // The number of each cell in its dimension.
    let mut numbers = vec![0_u32; complex.num_ids()];
    let mut next = vec![0; complex.counts().len()];
    for cell in complex.cells() {
        let next = &mut next[complex.dim_of(cell).unwrap_or(0)];
        numbers[cell.index()] = *next;
        *next += 1;
    }
    for dim in 1..complex.counts().len() {
        for cell in complex.cells().filter(|&cell| complex.dim_of(cell) == Some(dim)) {
            let mut separator = "";
            for arc in complex.boundary(cell) {
                write_appearances(out, &mut separator, numbers[arc.cell.index()], arc.incidence)?;
            }
            writeln!(out, "{}", if complex.num_boundary(cell) == 0 { "." } else { "" })?;
        }
    }
    Ok(())
}

/// Writes the appearances of a face in either orientation.
fn write_appearances(
    out: &mut (impl Write + ?Sized),
    separator: &mut &str,
    face: u32,
    incidence: Incidence,
) -> io::Result<()> {
    let both = (i64::from(incidence.multiplicity), i64::from(incidence.sign));
    for (times, sign) in [((both.0 + both.1) / 2, '+'), ((both.0 - both.1) / 2, '-')] {
        match times {
            0 => continue,
            1 => write!(out, "{separator}{sign}{face}")?,
            _ => write!(out, "{separator}{times}*{sign}{face}")?,
        }
        *separator = " ";
    }
    Ok(())
}
