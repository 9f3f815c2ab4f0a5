//! Distance matrices in text: all of it, or the part below or above the diagonal; entries separated by commas,
//! semicolons or blanks. Comments run from `#` to the end of the line.
//!
//! A triangle may have the diagonal or not. A file that begins with an empty line is one without, for that line is its
//! first row (so Ripser's programs write it); otherwise it has one if all the entries in its place are 0.

use super::super::error::Fault;
use super::super::source::{Source, truncated};
use super::row::{COMMENT, distance, fields};
use crate::distances::Distances;

/// A full matrix as far as it is read, entry by entry.
pub(super) struct Full {
    len: usize,
    row: usize,
    column: usize,
    /// The entries above the diagonal, row by row.
    upper: Vec<f64>,
}

impl Full {
    pub(super) fn new(len: usize) -> Self {
        Self { len, row: 0, column: 0, upper: Vec::new() }
    }

    /// Adds the next entry, a distance; in `Err` what it must be.
    pub(super) fn push(&mut self, value: f64) -> Result<(), String> {
        let (row, column) = (self.row, self.column);
        if column > row {
            self.upper.push(value);
        } else if column == row {
            if value != 0.0 {
                return Err("0, the distance of a point and itself".to_owned());
            }
        } else {
            let twin = self.upper[upper_index(self.len, column, row)];
            if value != twin {
                return Err(format!(
                    "{twin}, the entry of row {} and column {}, for distances are symmetric",
                    column + 1,
                    row + 1
                ));
            }
        }
        self.column += 1;
        if self.column == self.len {
            (self.row, self.column) = (row + 1, 0);
        }
        Ok(())
    }

    /// The matrix, now that all entries are there.
    pub(super) fn finish(self) -> Result<Distances, Fault> {
        super::distances(self.len, transpose(self.len, &self.upper))
    }
}

/// Where the entry of row `i` and column `j` > `i` stands among those above the diagonal.
fn upper_index(len: usize, i: usize, j: usize) -> usize {
    i * (2 * len - i - 1) / 2 + j - i - 1
}

/// The entries below the diagonal, of those above it.
fn transpose(len: usize, upper: &[f64]) -> Vec<f64> {
    (0..len).flat_map(|i| (0..i).map(move |j| upper[upper_index(len, j, i)])).collect()
}

/// Reads a full matrix.
pub(super) fn full(source: &mut Source<'_>) -> Result<Distances, Fault> {
    let mut matrix: Option<Full> = None;
    loop {
        let end = source.end_of_text();
        let Some(line) = source.next_content(COMMENT)? else {
            return match matrix {
                Some(matrix) if matrix.row < matrix.len => {
                    Err(truncated(end, format!("{} rows, as many as columns", matrix.len)))
                }
                Some(matrix) => matrix.finish(),
                None => super::distances(0, Vec::new()),
            };
        };
        let columns = match &matrix {
            Some(matrix) => matrix.len,
            None => fields(line.clone(), |_, _| Ok(()))?,
        };
        let matrix = matrix.get_or_insert_with(|| Full::new(columns));
        if matrix.row == columns {
            let mut line = line;
            return Err(line.trailing("file after as many rows as columns"));
        }
        let mut count = 0;
        let found = fields(line.clone(), |line, word| {
            if count == columns {
                return Err(line.unexpected(word, format!("the end of a row of {columns} distances")));
            }
            count += 1;
            let value = distance(line, word)?;
            matrix.push(value).map_err(|expected| line.unexpected(word, expected))
        })?;
        if found < columns {
            return Err(line.short(format!("{columns} distances, as in the first row")));
        }
    }
}

/// The rows of a triangle in text.
struct Triangle {
    /// The entries, row by row.
    values: Vec<f64>,
    /// The length of each row is one more (or less) than that of the row before.
    lengths: Vec<usize>,
    /// The file begins with an empty line.
    begins_empty: bool,
}

/// Reads the rows of a triangle; `next` is the length of a row after one of the given length.
fn triangle(source: &mut Source<'_>, first: Option<usize>, next: impl Fn(usize) -> usize) -> Result<Triangle, Fault> {
    let begins_empty = matches!(source.peek(2)?, [b'\n', ..] | [b'\r', b'\n']);
    let mut triangle = Triangle { values: Vec::new(), lengths: Vec::new(), begins_empty };
    while let Some(line) = source.next_content(COMMENT)? {
        let expected = triangle.lengths.last().map_or(first, |&length| Some(next(length)));
        let start = triangle.values.len();
        let values = &mut triangle.values;
        let count = fields(line.clone(), |line, word| {
            if expected.is_some_and(|expected| values.len() - start == expected) {
                let expected = expected.unwrap_or(0);
                return Err(line.unexpected(word, format!("the end of a row of {expected} distances")));
            }
            values.push(distance(line, word)?);
            Ok(())
        })?;
        if let Some(expected) = expected.filter(|&expected| count < expected) {
            return Err(line.short(format!("{expected} distances in this row of the triangle")));
        }
        triangle.lengths.push(count);
    }
    Ok(triangle)
}

/// Reads the rows of a matrix below the diagonal.
pub(super) fn lower(source: &mut Source<'_>) -> Result<Distances, Fault> {
    let Triangle { mut values, lengths, begins_empty } = triangle(source, Some(1), |length| length + 1)?;
    let rows = lengths.len();
    let ends = || (1..=rows).map(|row| row * (row + 1) / 2 - 1);
    if rows == 0 {
        return super::distances(usize::from(begins_empty), Vec::new());
    }
    if begins_empty || ends().any(|end| values[end] != 0.0) {
        return super::distances(rows + 1, values);
    }
    let mut kept = 0;
    for row in 0..rows {
        let start = row * (row + 1) / 2;
        values.copy_within(start..start + row, kept);
        kept += row;
    }
    values.truncate(kept);
    super::distances(rows, values)
}

/// Reads the rows of a matrix above the diagonal.
pub(super) fn upper(source: &mut Source<'_>) -> Result<Distances, Fault> {
    let Triangle { mut values, lengths, begins_empty } = triangle(source, None, |length| length.saturating_sub(1))?;
    let Some(&columns) = lengths.first() else { return super::distances(usize::from(begins_empty), Vec::new()) };
    if lengths.last() != Some(&1) {
        return Err(truncated(source.end_of_text(), "rows down to a single distance"));
    }
    let starts: Vec<usize> =
        lengths.iter().scan(0, |end, length| Some(std::mem::replace(end, *end + length))).collect();
    if starts.iter().any(|&start| values[start] != 0.0) {
        return super::distances(columns + 1, transpose(columns + 1, &values));
    }
    let mut diagonal = starts.into_iter().peekable();
    let mut index = 0;
    values.retain(|_| {
        let is_diagonal = diagonal.next_if_eq(&index).is_some();
        index += 1;
        !is_diagonal
    });
    super::distances(columns, transpose(columns, &values))
}
