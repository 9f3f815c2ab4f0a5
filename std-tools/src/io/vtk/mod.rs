//! VTK's formats: `legacy` reads those that begin with `# vtk DataFile`, `xml` those in XML.
//!
//! This file holds what they have in common: scalar types, the arrays that describe a grid, and how they become cells. Cells
//! of every kind that VTK has for triangles, quadrangles, polygons, lines, points, tetrahedra, hexahedra, prisms and
//! pyramids are read, of higher order by their corners.

mod bytes;
mod data;
mod legacy;
mod shapes;
mod xml;

pub(super) use legacy::read as read_legacy;
pub(super) use xml::read as read_xml;

use super::OnBad;
use super::error::{ErrorKind, Fault, Position};
use super::intake::{Intake, NOWHERE};
use super::source::Source;
use super::text::{Decimal, Line, parse_number};
use crate::attribute::{self, Number};
use crate::soup::Scalars;

/// Whether a file that begins so says that it is in the legacy format.
pub(super) fn is_legacy(head: &[u8]) -> bool {
    head.trim_ascii_start().get(..14).is_some_and(|start| start.eq_ignore_ascii_case(b"# vtk DataFile"))
}

/// Whether a file that begins so says that it is in an XML format.
pub(super) fn is_xml(head: &[u8]) -> bool {
    let head = head.trim_ascii_start();
    (head.starts_with(b"<?xml") || head.starts_with(b"<!--") || head.starts_with(b"<VTKFile"))
        && memchr::memmem::find(head, b"<VTKFile").is_some()
}

/// The type of a scalar.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Type {
    const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    const fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// Whether every value is one of single precision.
    const fn fits_single(self) -> bool {
        matches!(self, Self::F32 | Self::I8 | Self::U8 | Self::I16 | Self::U16)
    }

    /// An empty column for values of the type; small integers with sign become wider.
    const fn values(self) -> attribute::Values {
        match self {
            Self::U8 => attribute::Values::U8(Vec::new()),
            Self::U16 => attribute::Values::U16(Vec::new()),
            Self::U32 => attribute::Values::U32(Vec::new()),
            Self::U64 => attribute::Values::U64(Vec::new()),
            Self::I8 | Self::I16 | Self::I32 => attribute::Values::I32(Vec::new()),
            Self::I64 => attribute::Values::I64(Vec::new()),
            Self::F32 => attribute::Values::F32(Vec::new()),
            Self::F64 => attribute::Values::F64(Vec::new()),
        }
    }

    /// The number in as many bytes as the type has.
    fn decode(self, bytes: &[u8], big_endian: bool) -> Number {
        fn number<const N: usize, T>(bytes: &[u8], big_endian: bool, from: fn([u8; N]) -> T) -> T {
            let mut number = bytes.first_chunk::<N>().copied().unwrap_or([0; N]);
            if big_endian {
                number.reverse();
            }
            from(number)
        }
        Number::Integer(match self {
            Self::I8 => number(bytes, big_endian, i8::from_le_bytes).into(),
            Self::U8 => number(bytes, big_endian, u8::from_le_bytes).into(),
            Self::I16 => number(bytes, big_endian, i16::from_le_bytes).into(),
            Self::U16 => number(bytes, big_endian, u16::from_le_bytes).into(),
            Self::I32 => number(bytes, big_endian, i32::from_le_bytes).into(),
            Self::U32 => number(bytes, big_endian, u32::from_le_bytes).into(),
            Self::I64 => number(bytes, big_endian, i64::from_le_bytes).into(),
            Self::U64 => number(bytes, big_endian, u64::from_le_bytes).into(),
            Self::F32 => return Number::Float(number(bytes, big_endian, f32::from_le_bytes).into()),
            Self::F64 => return Number::Float(number(bytes, big_endian, f64::from_le_bytes)),
        })
    }
}

/// The values of an array that the reader needs.
enum Values {
    /// Coordinates.
    Points(Scalars),
    /// Numbers of points, of which there are so many.
    Vertices(Vec<u32>, u32),
    /// Where the vertices of each cell end.
    Ends(Vec<u64>),
    /// Types of cells.
    Types(Vec<u8>),
    /// Labels of points.
    Labels(Vec<u64>),
    /// An attribute.
    Data(attribute::Values),
}

impl Values {
    fn len(&self) -> usize {
        match self {
            Self::Points(Scalars::F32(values)) => values.len(),
            Self::Points(Scalars::F64(values)) => values.len(),
            Self::Vertices(values, _) => values.len(),
            Self::Ends(values) | Self::Labels(values) => values.len(),
            Self::Types(values) => values.len(),
            Self::Data(values) => values.len(),
        }
    }

    /// What is wrong with a number, if that is not possible here.
    fn refusal(&self, number: Number) -> ErrorKind {
        let found = match number {
            Number::Integer(number) => number.to_string(),
            Number::Float(number) => number.to_string(),
        };
        match (self, number) {
            (Self::Points(_), _) => ErrorKind::NotFinite { found: found.into() },
            (Self::Vertices(_, vertices), Number::Integer(index)) => {
                let index = i64::try_from(index).unwrap_or(i64::MAX);
                ErrorKind::OutOfRange { index, vertices: (*vertices).into(), first: 0 }
            }
            (Self::Data(values), _) if !values.are_integers() => {
                ErrorKind::Expected { expected: "a number".into(), found: found.into() }
            }
            (Self::Data(_), _) => {
                ErrorKind::Expected { expected: "an integer of the type of the array".into(), found: found.into() }
            }
            _ => ErrorKind::Expected { expected: "an integer, from 0".into(), found: found.into() },
        }
    }

    /// Adds a number; what is wrong with it, if it is not possible here.
    #[expect(clippy::cast_possible_truncation, reason = "single precision goes to single precision")]
    fn push(&mut self, number: Number, on_bad: OnBad) -> Result<(), ErrorKind> {
        if let Self::Data(values) = self {
            return if values.push(number) { Ok(()) } else { Err(self.refusal(number)) };
        }
        #[expect(clippy::cast_precision_loss, reason = "coordinates that are integers")]
        let float = match number {
            Number::Integer(number) => number as f64,
            Number::Float(number) => number,
        };
        let drops = on_bad == OnBad::Drop;
        let integer = match number {
            Number::Integer(number) => u64::try_from(number).ok(),
            Number::Float(_) => None,
        };
        match (&mut *self, integer) {
            (Self::Points(Scalars::F32(values)), _) if float.is_finite() || drops => values.push(float as f32),
            (Self::Points(Scalars::F64(values)), _) if float.is_finite() || drops => values.push(float),
            (Self::Vertices(values, vertices), Some(number)) if number < u64::from(*vertices) => {
                values.push(number as u32);
            }
            (Self::Vertices(values, _), _) if drops => values.push(NOWHERE),
            (Self::Ends(values) | Self::Labels(values), Some(number)) => values.push(number),
            (Self::Types(values), Some(number)) if number < 256 => values.push(number as u8),
            _ => return Err(self.refusal(number)),
        }
        Ok(())
    }

    /// Adds the next word if it is a plain decimal that is possible here; whether it was.
    fn push_plain(&mut self, source: &mut Source<'_>) -> Result<bool, Fault> {
        fn push<T>(values: &mut Vec<T>, value: Option<T>) -> bool {
            let Some(value) = value else { return false };
            values.push(value);
            true
        }
        Ok(match self {
            Self::Points(Scalars::F32(values)) => push(values, source.plain(Decimal::float)?),
            Self::Points(Scalars::F64(values)) => push(values, source.plain(Decimal::float)?),
            Self::Vertices(values, vertices) => {
                let vertices = *vertices;
                let vertex = |number: i64| u32::try_from(number).ok().filter(|&vertex| vertex < vertices);
                push(values, source.plain(|decimal| vertex(decimal.integer()?))?)
            }
            Self::Ends(values) | Self::Labels(values) => {
                push(values, source.plain(|decimal| decimal.integer()?.try_into().ok())?)
            }
            Self::Types(values) => push(values, source.plain(|decimal| decimal.integer()?.try_into().ok())?),
            Self::Data(_) => false,
        })
    }

    /// Adds a number in text, which is all of the line.
    fn push_text(&mut self, line: &Line<'_>, on_bad: OnBad) -> Result<(), Fault> {
        const COORDINATE: &str = "a coordinate of a point";
        match self {
            Self::Points(Scalars::F32(values)) => values.push(line.parse_finite(line.as_word(), COORDINATE)?),
            Self::Points(Scalars::F64(values)) => values.push(line.parse_finite(line.as_word(), COORDINATE)?),
            Self::Data(attribute::Values::F32(values)) => {
                values.push(
                    parse_number(line.as_word().bytes).ok_or_else(|| line.unexpected(line.as_word(), "a number"))?,
                );
            }
            Self::Data(attribute::Values::F64(values)) => {
                values.push(
                    parse_number(line.as_word().bytes).ok_or_else(|| line.unexpected(line.as_word(), "a number"))?,
                );
            }
            Self::Data(_) => {
                let text = std::str::from_utf8(line.as_word().bytes).ok();
                let number = text.and_then(|text| text.parse().ok());
                let number = number.ok_or_else(|| line.unexpected(line.as_word(), "an integer"))?;
                self.push(Number::Integer(number), OnBad::Refuse).map_err(|kind| line.fault(0, kind))?;
            }
            _ => {
                let number: i64 = line.parse_integer(line.as_word(), "an integer")?;
                self.push(Number::Integer(number.into()), on_bad).map_err(|kind| line.fault(0, kind))?;
            }
        }
        Ok(())
    }
}

/// Cells as their vertices one after the other, where those of each end, and what kind each is.
struct Cells<'a> {
    vertices: &'a [u32],
    ends: &'a [u64],
    /// The types of the cells, or the one of all.
    types: Types<'a>,
    /// Where the vertices begin, for errors.
    position: Position,
}

#[derive(Clone, Copy)]
enum Types<'a> {
    Each(&'a [u8]),
    All(u8),
}

impl Cells<'_> {
    /// Adds the cells, whose vertices are numbered from `shift` on; `before` is the number of cells before them.
    fn add(&self, shift: u32, before: usize, intake: &mut Intake) -> Result<(), Fault> {
        let fault = |message: String| Fault::new(self.position, ErrorKind::Rule(message.into()));
        let (mut start, mut word) = (0, Vec::new());
        for (cell, &end) in self.ends.iter().enumerate() {
            let end = usize::try_from(end).unwrap_or(usize::MAX);
            let Some(vertices) = self.vertices.get(start..end) else {
                let count = self.vertices.len();
                return Err(fault(format!("cell {cell} goes from vertex {start} to {end} of {count} in the list")));
            };
            let kind = match self.types {
                Types::Each(types) => types.get(cell).copied().unwrap_or(0),
                Types::All(kind) => kind,
            };
            word.clear();
            // A sum that does not fit was refused with the number of points.
            word.extend(vertices.iter().map(|vertex| vertex.saturating_add(shift)));
            intake.attributes.begin_cell(before + cell);
            if word.contains(&NOWHERE) {
                intake.report.note_bad(format!(": cell {} names a vertex that is not there", before + cell));
            }
            shapes::add(kind, &word, intake).map_err(|kind| fault(format!("cell {cell}: {kind}")))?;
            start = end;
        }
        if start < self.vertices.len() {
            let left = self.vertices.len() - start;
            return Err(fault(format!("{left} vertices are left over after the last of {} cells", self.ends.len())));
        }
        Ok(())
    }
}
