//! Points in text: one a line, coordinates separated by commas, semicolons or blanks. CSV with or without a header line,
//! and tables of blanks or tabs, are one format. Comments run from `#` to the end of the line.
//!
//! Not the `csv` crate: it tells the place of a record, and errors here name the column of the field.

use super::super::error::Fault;
use super::super::source::Source;
use super::super::text::parse_float;
use super::row::{COMMENT, coordinate, fields};
use crate::points::Points;

/// Reads a table of points.
pub(super) fn read(source: &mut Source<'_>) -> Result<Points, Fault> {
    let (mut dim, mut values) = (None, Vec::new());
    let mut first = true;
    while let Some(line) = source.next_content(COMMENT)? {
        let mut words = false;
        if std::mem::take(&mut first) {
            fields(line.clone(), |_, word| {
                words |= parse_float::<f64>(word.bytes).is_none();
                Ok(())
            })?;
        }
        if words {
            // Names of the columns.
            continue;
        }
        let start = values.len();
        let end = line.clone();
        fields(line, |line, word| {
            if dim.is_some_and(|dim| values.len() - start == dim) {
                let expected = format!("{} coordinates, as in the rows above", values.len() - start);
                return Err(line.unexpected(word, format!("the end of a row of {expected}")));
            }
            values.push(coordinate(line, word)?);
            Ok(())
        })?;
        let count = values.len() - start;
        let dim = *dim.get_or_insert(count);
        if count < dim {
            return Err(end.short(format!("{dim} coordinates, as in the rows above")));
        }
    }
    super::points(dim.unwrap_or(0), values)
}
