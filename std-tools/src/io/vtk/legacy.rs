//! VTK's legacy format: five parts, of which `data` reads the last, data at points and cells.
//!
//! Unstructured grids and poly data of all versions, in text and binary (which is big-endian).

use super::super::error::{ErrorKind, Fault, Position, excerpt};
use super::super::intake::Intake;
use super::super::source::{Source, truncated};
use super::super::words::Words;
use super::super::{Format, ReadOptions, ReadReport};
use super::{Cells, Type, Types, Values, data};
use crate::soup::{Labels, Scalars, Soup};

/// The sections of poly data, and the types of their cells.
const POLY_DATA: &[(&[u8], u8)] = &[(b"VERTICES", 2), (b"LINES", 4), (b"POLYGONS", 7), (b"TRIANGLE_STRIPS", 6)];

pub(super) fn scalar_type(name: &[u8]) -> Option<Type> {
    Some(match &*name.to_ascii_lowercase() {
        b"char" | b"signed_char" | b"vtktypeint8" => Type::I8,
        b"unsigned_char" | b"vtktypeuint8" => Type::U8,
        b"short" | b"vtktypeint16" => Type::I16,
        b"unsigned_short" | b"vtktypeuint16" => Type::U16,
        b"int" | b"vtktypeint32" | b"vtkidtype" => Type::I32,
        b"unsigned_int" | b"vtktypeuint32" => Type::U32,
        b"long" | b"vtktypeint64" => Type::I64,
        b"unsigned_long" | b"vtktypeuint64" => Type::U64,
        b"float" => Type::F32,
        b"double" => Type::F64,
        _ => return None,
    })
}

/// A list of cells, without their types.
struct List {
    vertices: Vec<u32>,
    ends: Vec<u64>,
    position: Position,
    /// The type of all, if the section tells it.
    kind: Option<u8>,
}

pub(super) struct File {
    pub(super) binary: bool,
    points: Option<(u32, Scalars)>,
    lists: Vec<List>,
    types: Option<Vec<u8>>,
    /// What the data that follow are at, and of how many of them.
    pub(super) data: Option<(Of, u64)>,
    pub(super) intake: Intake,
}

/// What data are at.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Of {
    Points,
    Cells,
}

impl File {
    /// Reads `count` numbers of a type, as text or binary.
    pub(super) fn numbers(
        &self,
        source: &mut Source<'_>,
        scalar: Type,
        count: u64,
        expected: &'static str,
        values: &mut Values,
    ) -> Result<(), Fault> {
        if self.binary {
            return source.each_record(count, scalar.size(), expected, |position, bytes| {
                values.push(scalar.decode(bytes, true), self.intake.on_bad).map_err(|kind| Fault::new(position, kind))
            });
        }
        let mut words = Words::new(source, None);
        for _ in 0..count {
            if !values.push_plain(words.source)? {
                values.push_text(&words.need(expected)?, self.intake.on_bad)?;
            }
        }
        Ok(())
    }

    /// Passes over `count` numbers.
    pub(super) fn skip(&self, source: &mut Source<'_>, scalar: Type, count: u64) -> Result<(), Fault> {
        const EXPECTED: &str = "as many numbers as the array has";
        if self.binary {
            return source.skip(count.saturating_mul(scalar.size() as u64), EXPECTED);
        }
        let mut words = Words::new(source, None);
        (0..count).try_for_each(|_| words.need(EXPECTED).map(|_| ()))
    }

    fn read_points(&mut self, source: &mut Source<'_>, count: u32, scalar: Type) -> Result<(), Fault> {
        let is_single = scalar.fits_single();
        let scalars = if is_single { Scalars::F32(Vec::new()) } else { Scalars::F64(Vec::new()) };
        let mut values = Values::Points(scalars);
        self.numbers(source, scalar, 3 * u64::from(count), "as many points as the section says", &mut values)?;
        if let Values::Points(values) = values {
            self.points = Some((count, values));
        }
        Ok(())
    }

    /// Reads cells as `k v1 … vk`, `size` numbers in all, or as the ends of the cells and their vertices.
    fn read_cells(
        &mut self,
        source: &mut Source<'_>,
        [count, size]: [u64; 2],
        kind: Option<u8>,
        position: Position,
    ) -> Result<(), Fault> {
        const EXPECTED: &str = "as many cells as the section says";
        let vertices = self.points.as_ref().map_or(0, |(count, _)| *count);
        if let Some(scalar) = self.array_header(source, b"OFFSETS")? {
            let mut ends = Values::Ends(Vec::new());
            self.numbers(source, scalar, count, EXPECTED, &mut ends)?;
            let Some(scalar) = self.array_header(source, b"CONNECTIVITY")? else {
                return Err(truncated(source.end_of_text(), "the array CONNECTIVITY after OFFSETS"));
            };
            let mut list = Values::Vertices(Vec::new(), vertices);
            self.numbers(source, scalar, size, EXPECTED, &mut list)?;
            if let (Values::Ends(mut ends), Values::Vertices(vertices, _)) = (ends, list) {
                // The first offset is the 0 at which the first cell begins.
                if !ends.is_empty() {
                    ends.remove(0);
                }
                self.lists.push(List { vertices, ends, position, kind });
            }
            return Ok(());
        }
        let (mut list, mut ends, mut left) = (Values::Vertices(Vec::new(), vertices), Vec::new(), size);
        for _ in 0..count {
            let mut length = Values::Ends(Vec::new());
            self.numbers(source, Type::I32, 1, EXPECTED, &mut length)?;
            let length = if let Values::Ends(length) = length { length.first().copied().unwrap_or(0) } else { 0 };
            left = left.checked_sub(length.saturating_add(1)).ok_or_else(|| {
                let kind = ErrorKind::WrongCount { what: "numbers of the cells", declared: size, found: size + 1 };
                Fault::new(source.end_of_text(), kind)
            })?;
            self.numbers(source, Type::I32, length, EXPECTED, &mut list)?;
            ends.push(list.len() as u64);
        }
        if left > 0 {
            let kind = ErrorKind::WrongCount { what: "numbers of the cells", declared: size, found: size - left };
            return Err(Fault::new(source.end_of_text(), kind));
        }
        if let Values::Vertices(vertices, _) = list {
            self.lists.push(List { vertices, ends, position, kind });
        }
        Ok(())
    }

    /// Reads the line `name type` if that is the next one, and gives the type.
    fn array_header(&self, source: &mut Source<'_>, name: &[u8]) -> Result<Option<Type>, Fault> {
        // A line end may stand after binary data, and never is data here: cells begin with their number.
        let blanks = source.peek(2)?.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
        let starts = source.peek(blanks + name.len())?[blanks..].eq_ignore_ascii_case(name);
        if !starts {
            return Ok(None);
        }
        let mut line = source.need_content(None, "an array")?;
        line.need_word("the name of the array")?;
        let word = line.need_word("the type of the array")?;
        scalar_type(word.bytes).map(Some).ok_or_else(|| line.unexpected(word, "the type of the array"))
    }

    /// Reads what follows the line of a section; whether that is the end of the geometry.
    fn section(&mut self, source: &mut Source<'_>) -> Result<bool, Fault> {
        let Some(mut line) = source.next_content(None)? else { return Ok(true) };
        let word = line.need_word("a section")?;
        let keyword = word.bytes.to_ascii_uppercase();
        let position = line.position(word.at);
        match (&*keyword, self.points.is_some()) {
            (b"POINT_DATA" | b"CELL_DATA", _) if !self.intake.attributes.are_kept() => {
                self.intake.pass_over(word.bytes);
                return Ok(true);
            }
            (b"POINT_DATA", true) => {
                let count = line.integer("the number of points")?;
                let points = self.points.as_ref().map_or(0, |&(points, _)| points.into());
                self.begin_data(Of::Points, count, points).map_err(|kind| line.fault(word.at, kind))?;
            }
            (b"CELL_DATA", true) => {
                let count = line.integer("the number of cells")?;
                let cells = self.lists.iter().map(|list| list.ends.len() as u64).sum();
                self.begin_data(Of::Cells, count, cells).map_err(|kind| line.fault(word.at, kind))?;
            }
            (b"POINTS", false) => {
                let count = line.integer("the number of points (below 2^32)")?;
                let word = line.need_word("the type of coordinates")?;
                let scalar = scalar_type(word.bytes).ok_or_else(|| line.unexpected(word, "the type of coordinates"))?;
                self.read_points(source, count, scalar)?;
            }
            (b"CELL_TYPES", true) => {
                let count = line.integer("the number of cells")?;
                let mut values = Values::Types(Vec::new());
                self.numbers(source, Type::I32, count, "as many types as there are cells", &mut values)?;
                if let Values::Types(types) = values {
                    self.types = Some(types);
                }
            }
            (name, true) if name == b"CELLS" || POLY_DATA.iter().any(|(section, _)| *section == name) => {
                const COUNTS: &str = "the numbers of cells and of all numbers that follow";
                let counts = [line.integer(COUNTS)?, line.integer(COUNTS)?];
                let kind = POLY_DATA.iter().find(|(section, _)| *section == name).map(|&(_, kind)| kind);
                self.read_cells(source, counts, kind, position)?;
            }
            (b"FIELD", _) => {
                line.need_word("the name of the field")?;
                let arrays = line.integer("the number of arrays")?;
                return self.field(source, arrays);
            }
            (name, true) if data::is_attribute(name) && self.data.is_some() => {
                let tuples = self.data.map_or(0, |(_, count)| count);
                let header = data::header(&mut line, name, tuples, self.binary)?;
                return self.attribute(source, name, header);
            }
            // Up to an empty line.
            (b"METADATA", _) => while source.next_line()?.is_some_and(|is_empty| !is_empty) {},
            _ => {
                let expected =
                    "a section: POINTS, then CELLS and CELL_TYPES, or VERTICES, LINES, POLYGONS, TRIANGLE_STRIPS";
                return Err(line.unexpected(word, expected));
            }
        }
        Ok(false)
    }

    fn finish(mut self, end: Position) -> Result<(Soup, ReadReport), Fault> {
        let (points, values) = self.points.ok_or_else(|| truncated(end, "the section POINTS"))?;
        // The cells of poly data are numbered in this order, in which they stand as a rule.
        self.lists.sort_by_key(|list| POLY_DATA.iter().position(|&(_, kind)| Some(kind) == list.kind));
        let mut before = 0;
        for List { vertices, ends, position, kind } in &self.lists {
            let types = match (kind, &self.types) {
                (Some(kind), _) => Types::All(*kind),
                (None, Some(types)) if types.len() == ends.len() => Types::Each(types),
                (None, Some(types)) => {
                    let (declared, found) = (ends.len() as u64, types.len() as u64);
                    return Err(Fault::new(
                        *position,
                        ErrorKind::WrongCount { what: "types of cells", declared, found },
                    ));
                }
                (None, None) => return Err(truncated(end, "the section CELL_TYPES")),
            };
            Cells { vertices, ends, types, position: *position }.add(0, before, &mut self.intake)?;
            before += ends.len();
        }
        Ok(self.intake.finish(Labels::Numbered(points as usize), true, Some((3, values))))
    }
}

/// Reads the lines up to the kind of data set; whether the file is binary.
fn header(source: &mut Source<'_>) -> Result<bool, Fault> {
    const DATASET: &str = "DATASET UNSTRUCTURED_GRID or DATASET POLYDATA";
    if !super::is_legacy(source.peek(64)?) {
        let found = excerpt(source.peek(64)?);
        let kind = ErrorKind::Expected { expected: "# vtk DataFile Version".into(), found };
        return Err(Fault::new(source.end_of_text(), kind));
    }
    // The version, which nothing depends on, and the title, which may be empty.
    for _ in 0..2 {
        if source.next_line()?.is_none() {
            return Err(truncated(source.end_of_text(), "the title"));
        }
    }
    let mut line = source.need_content(None, "ASCII or BINARY")?;
    let word = line.need_word("ASCII or BINARY")?;
    let binary = match &*word.bytes.to_ascii_uppercase() {
        b"ASCII" => false,
        b"BINARY" => true,
        _ => return Err(line.unexpected(word, "ASCII or BINARY")),
    };
    let mut line = source.need_content(None, DATASET)?;
    let word = line.need_word(DATASET)?;
    if !word.bytes.eq_ignore_ascii_case(b"DATASET") {
        return Err(line.unexpected(word, DATASET));
    }
    let word = line.need_word(DATASET)?;
    match &*word.bytes.to_ascii_uppercase() {
        b"UNSTRUCTURED_GRID" | b"POLYDATA" => Ok(binary),
        _ => Err(line.unexpected(word, "UNSTRUCTURED_GRID or POLYDATA; other data sets are not read")),
    }
}

/// Reads a file.
pub(in super::super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let binary = header(source)?;
    source.binary = binary;
    let intake = Intake::new(Format::Vtk, options);
    let mut file = File { binary, points: None, lists: Vec::new(), types: None, data: None, intake };
    while !file.section(source)? {}
    file.finish(source.end_of_text())
}
