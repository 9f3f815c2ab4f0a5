//! The rows of the elements of a PLY file, in text and in bytes.

use super::header::{Element, Encoding, Property, Type};
use crate::attribute::{Number, Values};
use crate::io::OnBad;
use crate::io::error::{ErrorKind, Fault, Position};
use crate::io::source::Source;
use crate::io::text::{Line, parse_float, parse_number};

/// A row of an element; reused from row to row.
#[derive(Default)]
pub(super) struct Row {
    /// The value of each scalar property that is used.
    pub(super) scalars: Vec<f64>,
    /// The list that is used.
    pub(super) list: Vec<i64>,
}

/// The attributes of an element.
pub(super) struct Columns {
    /// The name of each, the numbers of the properties that it consists of, and the values.
    pub(super) columns: Vec<(String, Vec<usize>, Values)>,
}

impl Columns {
    /// Empty ones for the properties that are attributes.
    pub(super) fn new(element: &Element) -> Self {
        let mut columns: Vec<(String, Vec<usize>, Values)> = Vec::new();
        let attributes = element.properties.iter().enumerate().filter(|(_, property)| property.is_attribute);
        for (number, Property { name, scalar, .. }) in attributes {
            let name = String::from_utf8_lossy(name);
            let values = scalar.values();
            if let Some((whole, components, all)) = columns.last_mut()
                && values.is_alike(all)
            {
                // The second component tells that the one before it is the first.
                let stem = if components.len() == 1 { whole.strip_suffix("_0") } else { Some(&**whole) };
                let is_next = |stem: &&str| !stem.is_empty() && *name == format!("{stem}_{}", components.len());
                if let Some(stem) = stem.filter(is_next) {
                    *whole = stem.to_owned();
                    components.push(number);
                    continue;
                }
            }
            columns.push((name.into_owned(), vec![number], values));
        }
        Self { columns }
    }

    pub(super) fn push(&mut self, row: &[f64]) {
        for (_, components, values) in &mut self.columns {
            for &property in &*components {
                let value = row[property];
                let number =
                    if values.are_integers() { Number::Integer(integer(value).into()) } else { Number::Float(value) };
                values.push(number);
            }
        }
    }
}

/// Where the row at hand stands.
pub(super) enum Place<'a> {
    /// In this line, the list beginning at this byte of it.
    Text(Line<'a>, usize),
    /// At this byte, the items of the list beginning at another and having so many bytes each.
    Bytes { row: u64, list: u64, item: usize },
}

impl Place<'_> {
    pub(super) fn row(&self) -> Position {
        match self {
            Self::Text(line, _) => {
                let mut line = line.clone();
                line.seek(0);
                line.skip_blanks();
                line.position(line.at())
            }
            Self::Bytes { row, .. } => Position::Byte(*row),
        }
    }

    /// The place of an item of the list.
    pub(super) fn item(&self, number: usize) -> Position {
        match self {
            Self::Text(line, list) => {
                let mut line = line.clone();
                line.seek(*list);
                for _ in 0..number {
                    line.word();
                }
                line.skip_blanks();
                line.position(line.at())
            }
            Self::Bytes { list, item, .. } => Position::Byte(list + (number * item) as u64),
        }
    }
}

/// Reads a row of text; gives the byte of the line at which the list begins.
pub(super) fn text_row(line: &mut Line<'_>, element: &Element, row: &mut Row) -> Result<usize, Fault> {
    let mut list = 0;
    for (property, scalar) in element.properties.iter().zip(&mut row.scalars) {
        if property.length.is_some() {
            let length: u64 = line.integer("the length of a list")?;
            if property.used {
                list = line.at();
                row.list.clear();
                for _ in 0..length {
                    row.list.push(line.integer("a vertex number, as many as the length of the list says")?);
                }
            } else {
                for _ in 0..length {
                    line.need_word("as many items as the length of the list says")?;
                }
            }
        } else if !property.used && !property.is_attribute {
            line.need_word("the value of a property")?;
        } else if property.scalar.is_integer() {
            let word = line.need_word("an integer")?;
            let value = line.parse_integer::<i64>(word, "an integer")?;
            if property.is_attribute && !property.scalar.holds(value) {
                return Err(line.unexpected(word, "an integer of the type of the property"));
            }
            *scalar = parse_float(word.bytes).unwrap_or(f64::NAN);
        } else if property.is_attribute {
            let word = line.need_word("the value of a property")?;
            // In single precision at once: rounded twice it may be another number.
            let value = if property.scalar == Type::F32 {
                parse_number::<f32>(word.bytes).map(f64::from)
            } else {
                parse_number(word.bytes)
            };
            *scalar = value.ok_or_else(|| line.unexpected(word, "the value of a property, a number"))?;
        } else if property.scalar == Type::F32 {
            *scalar = line.float::<f32>("a coordinate")?.into();
        } else {
            *scalar = line.float("a coordinate")?;
        }
    }
    line.end()?;
    Ok(list)
}

/// Reads a binary row; gives the place of the list.
pub(super) fn binary_row(
    source: &mut Source<'_>,
    element: &Element,
    encoding: Encoding,
    on_bad: OnBad,
    row: &mut Row,
) -> Result<Place<'static>, Fault> {
    const EXPECTED: &str = "as many rows of the element as the header says";
    let start = source.offset();
    let (mut list, mut item) = (start, 0);
    for (property, scalar) in element.properties.iter().zip(&mut row.scalars) {
        let size = property.scalar.size();
        let position = source.byte();
        let Some(of_length) = property.length else {
            let value = property.scalar.decode(source.take(size, EXPECTED)?, encoding);
            if property.used && !value.is_finite() && on_bad == OnBad::Refuse {
                return Err(Fault::new(position, ErrorKind::NotFinite { found: value.to_string().into() }));
            }
            *scalar = value;
            continue;
        };
        let length = of_length.decode(source.take(of_length.size(), EXPECTED)?, encoding);
        if length < 0.0 {
            let kind =
                ErrorKind::Expected { expected: "the length of a list".into(), found: length.to_string().into() };
            return Err(Fault::new(position, kind));
        }
        let length = integer(length).unsigned_abs();
        if !property.used {
            source.skip(length * size as u64, EXPECTED)?;
            continue;
        }
        (list, item) = (source.offset(), size);
        row.list.clear();
        // In pieces: the length may be a lie.
        let mut left = length;
        while left > 0 {
            let piece = left.min(1024);
            let bytes = source.take(piece as usize * size, EXPECTED)?;
            row.list.extend(bytes.chunks_exact(size).map(|item| integer(property.scalar.decode(item, encoding))));
            left -= piece;
        }
    }
    Ok(Place::Bytes { row: start, list, item })
}

/// The integer that a value of an integer type stands for.
#[allow(clippy::cast_possible_truncation)]
pub(super) fn integer(value: f64) -> i64 {
    value as i64
}
