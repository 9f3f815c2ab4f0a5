//! NumPy's `.npy`: a two-dimensional array of real numbers, one point a row.

use npyz::{DType, Endianness, NpyHeader, Order, TypeChar, TypeStr};

use super::super::error::{ErrorKind, Fault, Position};
use super::super::intake::reserve;
use super::super::source::Source;
use crate::points::Points;

/// What every file begins with.
pub(super) const MAGIC: &[u8] = b"\x93NUMPY";

/// The longest header that is read; NumPy itself stops at 10,000 bytes.
const LONGEST_HEADER: usize = 10_000;

fn unsupported(message: impl Into<String>) -> Fault {
    Fault::new(Position::Byte(0), ErrorKind::Unsupported(message.into().into()))
}

/// Reads the header, and nothing after it.
fn header(source: &mut Source<'_>) -> Result<NpyHeader, Fault> {
    const EXPECTED: &str = "the header of an NPY file";
    let start = source.peek(12)?;
    let (before, length) = match *start {
        [_, _, _, _, _, _, 1, _, a, b, ..] => (10, usize::from(u16::from_le_bytes([a, b]))),
        [_, _, _, _, _, _, 2 | 3, _, a, b, c, d] => (12, u32::from_le_bytes([a, b, c, d]) as usize),
        _ => return Err(unsupported("expected an NPY file of version 1, 2 or 3")),
    };
    if length > LONGEST_HEADER {
        return Err(unsupported(format!("a header of {length} bytes; this is more than that of any array of points")));
    }
    let bytes = source.take(before + length, EXPECTED)?;
    check_numbers(&bytes[before..])?;
    check_brackets(&bytes[before..])?;
    NpyHeader::from_reader(bytes).map_err(|error| unsupported(format!("not the header of an NPY file: {error}")))
}

/// A fault if the numbers of a header have a product that does not fit, which the parser relies on.
fn check_numbers(header: &[u8]) -> Result<(), Fault> {
    let numbers = header.split(|byte| !byte.is_ascii_digit()).filter(|digits| !digits.is_empty());
    let number = |digits: &[u8]| std::str::from_utf8(digits).ok().and_then(|digits| digits.parse::<u64>().ok());
    let mut product = numbers.map(|digits| number(digits).map(|number| number.max(1)));
    let fits = product.try_fold(1_u64, |product, number| product.checked_mul(number?));
    fits.map(|_| ()).ok_or_else(|| unsupported("an array of more elements than 64 bits can count"))
}

/// A fault if there are many brackets: the parser tries each in several ways, so that their nesting takes time that grows
/// exponentially. The header of an array of numbers has two, one of records more than it has fields.
fn check_brackets(header: &[u8]) -> Result<(), Fault> {
    const MOST: usize = 8;
    if header.iter().filter(|byte| matches!(byte, b'(' | b'[' | b'{')).count() > MOST {
        let message =
            "an array of records, or no array: there are more than 8 brackets; points are rows of plain numbers";
        return Err(unsupported(message));
    }
    Ok(())
}

/// Reads an array as points.
pub(super) fn read(source: &mut Source<'_>) -> Result<Points, Fault> {
    let header = header(source)?;
    let &[rows, columns] = header.shape() else {
        let message = format!("an array of shape {:?}; points are the rows of a two-dimensional one", header.shape());
        return Err(unsupported(message));
    };
    let DType::Plain(scalar) = header.dtype() else {
        return Err(unsupported("an array of records; points are rows of plain numbers"));
    };
    let size = scalar.num_bytes().filter(|_| decode(&scalar, &[0; 8]).is_some());
    let Some(size) = size else {
        return Err(unsupported(format!("an array of type '{scalar}'; read are '<f8', '<f4' and integers, also '>'")));
    };
    // The product of the shape fits: the header was checked.
    let count = rows * columns;
    let dim = usize::try_from(columns).map_err(|_| unsupported("too many columns"))?;
    let mut values = Vec::with_capacity(reserve(count));
    source.each_record(count, size, "as many elements as the header says", |position, bytes| {
        let value = decode(&scalar, bytes).unwrap_or(f64::NAN);
        if !value.is_finite() {
            return Err(Fault::new(position, ErrorKind::NotFinite { found: value.to_string().into() }));
        }
        values.push(value);
        Ok(())
    })?;
    source.need_end_of_bytes("file after the array")?;
    if header.order() == Order::Fortran {
        let rows = values.len().checked_div(dim).unwrap_or(0);
        values = (0..rows).flat_map(|row| values.iter().skip(row).step_by(rows.max(1)).copied()).collect();
    }
    super::points(dim, values)
}

/// The element in the first bytes; `None` if its type is not a real number of a size that is read.
#[expect(clippy::cast_precision_loss, reason = "coordinates are double precision")]
fn decode(scalar: &TypeStr, bytes: &[u8]) -> Option<f64> {
    let size = scalar.num_bytes()?;
    let mut raw = [0; 8];
    raw.get_mut(..size)?.copy_from_slice(bytes.get(..size)?);
    if scalar.endianness() == Endianness::Big {
        raw[..size].reverse();
    }
    let [a, b, c, d, ..] = raw;
    Some(match (scalar.type_char(), size) {
        (TypeChar::Float, 8) => f64::from_le_bytes(raw),
        (TypeChar::Float, 4) => f32::from_le_bytes([a, b, c, d]).into(),
        (TypeChar::Int, 1) => i8::from_le_bytes([a]).into(),
        (TypeChar::Int, 2) => i16::from_le_bytes([a, b]).into(),
        (TypeChar::Int, 4) => i32::from_le_bytes([a, b, c, d]).into(),
        (TypeChar::Int, 8) => i64::from_le_bytes(raw) as f64,
        (TypeChar::Uint | TypeChar::Bool, 1) => a.into(),
        (TypeChar::Uint, 2) => u16::from_le_bytes([a, b]).into(),
        (TypeChar::Uint, 4) => u32::from_le_bytes([a, b, c, d]).into(),
        (TypeChar::Uint, 8) => u64::from_le_bytes(raw) as f64,
        _ => return None,
    })
}
