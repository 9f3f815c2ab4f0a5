//! The text of a cell complex: how many cells of each dimension there are, then the boundary of each, one a line.
//!
//! ```text
//! cells 1 1 1 1     # the lens space L(3,1)
//! +0 -0             # the 1-cell goes from vertex 0 to vertex 0
//! 3*+0              # the 2-cell winds round it three times
//! +0 -0             # the 3-cell has the 2-cell on either side
//! ```
//!
//! Cells of dimension 1 come first, then those of dimension 2, and so on. A word is one appearance of a cell of the dimension
//! below, by its number there from 0, with its orientation; `n*` before it is n appearances, a sign may be left out for `+`,
//! and `.` stands for a boundary without cells. Comments run from `#` to the end of the line.

use std::io::Read;

use sig_core::{CellId, Dim, Incidence, MAX_DIM};

use super::error::{ErrorKind, Fault, Position, ReadError};
use super::intake::may_have;
use super::source::Source;
use super::text::{Line, Word, parse_integer};

/// The cells of an input, by dimension.
pub(crate) struct CellList {
    /// How many there are of each dimension.
    pub(crate) counts: Vec<usize>,
    /// The boundaries of the cells of dimension 1 and more, one after the other, each by increasing number in the dimension
    /// below.
    pub(crate) faces: Vec<(u32, Incidence)>,
    /// Where each boundary ends.
    pub(crate) ends: Vec<usize>,
    /// On which line each stands.
    pub(crate) lines: Vec<Position>,
}

impl CellList {
    /// The error of a rule of the input that a cell breaks, by its number among those with boundaries.
    pub(crate) fn refuse(&self, name: &str, cell: Option<usize>, message: String) -> ReadError {
        let position = cell.and_then(|cell| self.lines.get(cell)).copied().unwrap_or(Position::Whole);
        Fault::new(position, ErrorKind::Rule(message.into())).in_file(super::displayed(name))
    }
}

/// Reads the cells of an input.
///
/// Takes time linear in the input, but for a sort of each boundary.
///
/// # Errors
/// If the input cannot be read or does not follow the grammar, or names a cell that is not there.
pub(crate) fn read_cell_list(reader: impl Read, name: &str) -> Result<CellList, ReadError> {
    let run = || Source::new(reader, None, None)?.reading(read);
    run().map_err(|fault: Fault| fault.in_file(super::displayed(name)))
}

const COMMENT: Option<u8> = Some(b'#');

fn read(source: &mut Source<'_>) -> Result<CellList, Fault> {
    let line = source.need_content(COMMENT, "`cells` and the number of cells of each dimension")?;
    let (counts, position) = counts(line)?;
    let mut list = CellList { counts, faces: Vec::new(), ends: Vec::new(), lines: Vec::new() };
    for dim in 1..list.counts.len() {
        for _ in 0..list.counts[dim] {
            let line = source.need_content(COMMENT, "the boundary of a cell")?;
            boundary(line, dim, &mut list)?;
        }
    }
    source.need_end(COMMENT, "file after the last cell")?;
    // All other cells have lines of their own.
    let (vertices, named) = (list.counts.first().copied().unwrap_or(0), list.faces.len());
    if !may_have(vertices, named) {
        let rule = format!("{vertices} vertices, but the boundaries have only {named} cells in all");
        return Err(Fault::new(position, ErrorKind::Rule(rule.into())));
    }
    Ok(list)
}

/// The number of cells of each dimension, and where they are told.
fn counts(mut line: Line<'_>) -> Result<(Vec<usize>, Position), Fault> {
    let word = line.need_word("`cells`")?;
    if word.bytes != b"cells" {
        return Err(line.unexpected(word, "`cells` and the number of cells of each dimension"));
    }
    line.skip_blanks();
    let position = line.position(line.at());
    let (mut counts, mut total) = (Vec::new(), 0_usize);
    while let Some(word) = line.word() {
        let count: u32 = line.parse_integer(word, "a number of cells")?;
        total = total.saturating_add(count as usize);
        if total > CellId::LIMIT || counts.len() > MAX_DIM {
            let rule = format!("more than {} cells, or of more than {} dimensions", CellId::LIMIT, MAX_DIM + 1);
            return Err(line.fault(word.at, ErrorKind::Rule(rule.into())));
        }
        counts.push(count as usize);
    }
    counts.truncate(counts.iter().rposition(|&count| count > 0).map_or(0, |last| last + 1));
    Ok((counts, position))
}

/// Reads the boundary of a cell.
fn boundary(mut line: Line<'_>, dim: Dim, list: &mut CellList) -> Result<(), Fault> {
    line.skip_blanks();
    list.lines.push(line.position(line.at()));
    let start = list.faces.len();
    let mut is_empty = false;
    while let Some(word) = line.word() {
        if is_empty || word.bytes == b"." && list.faces.len() > start {
            return Err(line.unexpected(word, "a boundary, or `.` alone for none"));
        }
        is_empty = word.bytes == b".";
        if !is_empty {
            list.faces.push(appearances(word, &line, list.counts[dim - 1])?);
        }
    }
    let faces = &mut list.faces;
    faces[start..].sort_by_key(|&(face, _)| face);
    let mut kept = start;
    for at in start..faces.len() {
        let (face, incidence) = faces[at];
        if kept > start && faces[kept - 1].0 == face {
            let sum = &mut faces[kept - 1].1;
            let multiplicity = sum.multiplicity.checked_add(incidence.multiplicity);
            let sign = sum.sign.checked_add(incidence.sign);
            let too_many = || line.fault(0, ErrorKind::Rule("a cell appears too often on this boundary".into()));
            let (Some(multiplicity), Some(sign)) = (multiplicity, sign) else { return Err(too_many()) };
            *sum = Incidence { multiplicity, sign };
        } else {
            faces[kept] = (face, incidence);
            kept += 1;
        }
    }
    faces.truncate(kept);
    list.ends.push(kept);
    Ok(())
}

/// A word: `7`, `-7`, `3*+7`.
fn appearances(word: Word<'_>, line: &Line<'_>, num_faces: usize) -> Result<(u32, Incidence), Fault> {
    let star = word.bytes.iter().position(|&byte| byte == b'*');
    let (times, face) = star.map_or((&b"1"[..], word.bytes), |at| (&word.bytes[..at], &word.bytes[at + 1..]));
    let times = parse_integer(times).and_then(|times| i32::try_from(times).ok()).filter(|&times| times > 0);
    let is_negative = face.first() == Some(&b'-');
    let number = parse_integer(face).and_then(|face| u32::try_from(face.checked_abs()?).ok());
    let (Some(times), Some(number)) = (times, number) else {
        return Err(line.unexpected(word, "a cell of the dimension below, like 7, -7 or 3*-7"));
    };
    if number as usize >= num_faces {
        let rule = format!("there is no cell {number} in the dimension below: it has {num_faces}");
        return Err(line.fault(word.at, ErrorKind::Rule(rule.into())));
    }
    let sign = if is_negative { -times } else { times };
    Ok((number, Incidence { multiplicity: times.unsigned_abs(), sign }))
}
