//! A line of text as fields: numbers or labels between commas, semicolons or blanks.

use super::super::error::{ErrorKind, Fault, excerpt};
use super::super::text::{Line, Word, parse_float};

/// What begins a comment.
pub(super) const COMMENT: Option<u8> = Some(b'#');

/// What a distance must be.
pub(super) const A_DISTANCE: &str = "a distance: a finite number, not negative";

fn is_separator(byte: u8) -> bool {
    matches!(byte, b',' | b';')
}

/// The next field; quotes around it are no part of it. A separator may end the line, but not stand before a field that
/// is missing.
pub(super) fn field<'a>(line: &mut Line<'a>, first: bool) -> Result<Option<Word<'a>>, Fault> {
    let Some(mut word) = line.part(is_separator) else { return Ok(None) };
    if is_separator(word.bytes[0]) {
        if first {
            return Err(line.unexpected(word, "a field before the separator"));
        }
        match line.part(is_separator) {
            None => return Ok(None),
            Some(next) if is_separator(next.bytes[0]) => {
                return Err(line.unexpected(next, "a field between the separators"));
            }
            Some(next) => word = next,
        }
    }
    if let [b'"', inner @ .., b'"'] = word.bytes {
        word = Word { bytes: inner, at: word.at + 1 };
    }
    Ok(Some(word))
}

/// Calls `take` with each field of a line; how many there are.
pub(super) fn fields<'a>(
    mut line: Line<'a>,
    mut take: impl FnMut(&Line<'a>, Word<'a>) -> Result<(), Fault>,
) -> Result<usize, Fault> {
    let mut count = 0;
    while let Some(word) = field(&mut line, count == 0)? {
        take(&line, word)?;
        count += 1;
    }
    Ok(count)
}

/// A field as a coordinate.
pub(super) fn coordinate(line: &Line<'_>, word: Word<'_>) -> Result<f64, Fault> {
    match parse_float::<f64>(word.bytes) {
        Some(value) if value.is_finite() => Ok(value),
        Some(_) => Err(line.fault(word.at, ErrorKind::NotFinite { found: excerpt(word.bytes) })),
        None => Err(line.unexpected(word, "a coordinate: a number")),
    }
}

/// A field as a distance.
pub(super) fn distance(line: &Line<'_>, word: Word<'_>) -> Result<f64, Fault> {
    match parse_float::<f64>(word.bytes) {
        // −0 and 0 are one distance.
        Some(value) if value.is_finite() && value >= 0.0 => Ok(value + 0.0),
        _ => Err(line.unexpected(word, A_DISTANCE)),
    }
}
