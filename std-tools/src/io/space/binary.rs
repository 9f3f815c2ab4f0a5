//! Binary formats without a crate of their own: points behind `PTS1`, Ripser's lower triangle, DIPHA's matrices. All are
//! little-endian, and counts are believed only as far as bytes arrive.

use super::super::error::{ErrorKind, Fault, Position, excerpt};
use super::super::intake::reserve;
use super::super::source::Source;
use super::Space;
use super::edges::Edges;
use super::matrix::Full;
use super::row::A_DISTANCE;
use crate::distances::{Distances, pairs};
use crate::points::Points;
use crate::soup::Labels;

pub(super) const PTS_MAGIC: &[u8] = b"PTS1";

/// The first number of a DIPHA file.
pub(super) const DIPHA_MAGIC: u64 = 8_067_171_840;

fn double(bytes: &[u8]) -> f64 {
    bytes.first_chunk().map_or(f64::NAN, |&bytes| f64::from_le_bytes(bytes))
}

fn unexpected(position: Position, expected: impl Into<String>, found: &impl ToString) -> Fault {
    let found = excerpt(found.to_string().as_bytes());
    Fault::new(position, ErrorKind::Expected { expected: expected.into().into(), found })
}

fn distance(position: Position, value: f64) -> Result<f64, Fault> {
    if value.is_finite() && value >= 0.0 { Ok(value + 0.0) } else { Err(unexpected(position, A_DISTANCE, &value)) }
}

/// The next 64-bit number.
fn count(source: &mut Source<'_>, expected: &'static str) -> Result<u64, Fault> {
    let bytes = source.take(8, expected)?;
    Ok(bytes.first_chunk().map_or(0, |&bytes| u64::from_le_bytes(bytes)))
}

/// Reads points behind `PTS1`.
pub(super) fn pts(source: &mut Source<'_>) -> Result<Points, Fault> {
    let magic = source.take(4, "PTS1")?;
    if magic != PTS_MAGIC {
        return Err(unexpected(Position::Byte(0), "PTS1", &magic.escape_ascii()));
    }
    let dim =
        source.take(4, "the dimension of the points")?.first_chunk().map_or(0, |&bytes| u32::from_le_bytes(bytes));
    let position = source.byte();
    let points = count(source, "the number of points")?;
    let Some(values) = points.checked_mul(dim.into()).filter(|_| dim > 0 || points == 0) else {
        return Err(unexpected(position, format!("a possible number of points of dimension {dim}"), &points));
    };
    let mut coordinates = Vec::with_capacity(reserve(values));
    source.each_record(values, 8, "as many coordinates as the header says", |position, bytes| {
        let value = double(bytes);
        if !value.is_finite() {
            return Err(Fault::new(position, ErrorKind::NotFinite { found: value.to_string().into() }));
        }
        coordinates.push(value);
        Ok(())
    })?;
    source.need_end_of_bytes("file after the points")?;
    super::points(dim as usize, coordinates)
}

/// Reads Ripser's binary lower triangle: nothing but distances.
pub(super) fn lower(source: &mut Source<'_>) -> Result<Distances, Fault> {
    let mut values = Vec::new();
    while !source.peek(1)?.is_empty() {
        source.each_record(1, 4, "a distance of 4 bytes", |position, bytes| {
            let value = bytes.first_chunk().map_or(f32::NAN, |&bytes| f32::from_le_bytes(bytes));
            values.push(distance(position, value.into())?);
            Ok(())
        })?;
    }
    let len = (1..).find(|&len| pairs(len).is_none_or(|pairs| pairs >= values.len())).unwrap_or(0);
    if values.is_empty() || pairs(len) != Some(values.len()) {
        let expected = "as many distances as points have pairs: 1, 3, 6, 10, … numbers of 32 bits";
        return Err(unexpected(Position::Whole, expected, &values.len()));
    }
    super::distances(len, values)
}

/// Reads a distance matrix of DIPHA's, full or sparse.
pub(super) fn dipha(source: &mut Source<'_>, repeated: &mut usize) -> Result<Space, Fault> {
    const FULL: u64 = 7;
    const SPARSE: u64 = 8;
    let magic = count(source, "DIPHA's first number, 8067171840")?;
    if magic != DIPHA_MAGIC {
        return Err(unexpected(Position::Byte(0), "DIPHA's first number, 8067171840", &magic));
    }
    match count(source, "the type of the file")? {
        FULL => full(source).map(Space::Distances),
        SPARSE => sparse(source, repeated),
        other => {
            let expected = "a distance matrix: type 7, or 8 for a sparse one";
            Err(unexpected(Position::Byte(8), expected, &other))
        }
    }
}

fn full(source: &mut Source<'_>) -> Result<Distances, Fault> {
    let position = source.byte();
    let points = count(source, "the number of points")?;
    let (Ok(len), Some(entries)) = (usize::try_from(points), points.checked_mul(points)) else {
        return Err(unexpected(position, "a possible number of points", &points));
    };
    let mut matrix = Full::new(len);
    source.each_record(entries, 8, "as many entries as the header says", |position, bytes| {
        let value = distance(position, double(bytes))?;
        matrix.push(value).map_err(|expected| unexpected(position, expected, &value))
    })?;
    source.need_end_of_bytes("file after the matrix")?;
    matrix.finish()
}

/// The number of entries of each row, then the column of every entry, then its distance.
fn sparse(source: &mut Source<'_>, repeated: &mut usize) -> Result<Space, Fault> {
    let position = source.byte();
    let points = count(source, "the number of points")?;
    if points >= u64::from(u32::MAX) {
        return Err(unexpected(position, "fewer than 4294967295 points", &points));
    }
    let mut degrees: Vec<u64> = Vec::with_capacity(reserve(points));
    let mut entries = 0_u64;
    source.each_record(points, 8, "the number of entries of each row", |position, bytes| {
        let degree = bytes.first_chunk().map_or(0, |&bytes| u64::from_le_bytes(bytes));
        entries =
            entries.checked_add(degree).ok_or_else(|| unexpected(position, "a possible number of entries", &degree))?;
        degrees.push(degree);
        Ok(())
    })?;
    let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(reserve(entries));
    let mut rows = (0..).zip(&degrees).flat_map(|(row, &degree)| (0..degree).map(move |_| row));
    source.each_record(entries, 8, "the column of each entry", |position, bytes| {
        let column = bytes.first_chunk().map_or(0, |&bytes| u64::from_le_bytes(bytes));
        match (rows.next(), u32::try_from(column)) {
            (Some(row), Ok(number)) if column < points => pairs.push((row, number)),
            _ => return Err(unexpected(position, format!("the number of a point below {points}"), &column)),
        }
        Ok(())
    })?;
    let mut edges = Edges::default();
    let mut each_pair = pairs.iter();
    source.each_record(entries, 8, "the distance of each entry", |position, bytes| {
        let value = distance(position, double(bytes))?;
        match each_pair.next() {
            Some(&(a, b)) if a != b => edges.push(a, b, value, position),
            _ if value != 0.0 => return Err(unexpected(position, "0, the distance of a point and itself", &value)),
            _ => {}
        }
        Ok(())
    })?;
    source.need_end_of_bytes("file after the matrix")?;
    Ok(Space::Graph { graph: edges.graph(degrees.len(), true, repeated)?, labels: Labels::Numbered(degrees.len()) })
}
