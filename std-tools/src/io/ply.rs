//! PLY, the polygon format of Stanford, in text and both binary byte orders.
//!
//! Read are the elements `vertex` (x, y and perhaps z), `face` (a list of vertices of any length), `edge` (vertex1,
//! vertex2) and `tristrips`, in any order. Other numbers of vertices, faces and edges are attributes: each property one, but
//! `name_0`, `name_1`, … in a row and of one type are the components of the attribute `name`. Other elements and lists are
//! passed over and reported.

use super::error::{ErrorKind, Fault, Position};
use super::intake::{Intake, Refusal};
use super::source::Source;
use super::text::{Line, parse_float, parse_number};
use super::{Format, OnBad, ReadOptions, ReadReport};
use crate::attribute::{Number, Values};
use crate::soup::{Labels, Scalars, Soup};

/// How the data after the header are written.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// The type of a scalar.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// An empty column for values of the type; small integers with sign become wider.
    const fn values(self) -> Values {
        match self {
            Self::U8 => Values::U8(Vec::new()),
            Self::U16 => Values::U16(Vec::new()),
            Self::U32 => Values::U32(Vec::new()),
            Self::I8 | Self::I16 | Self::I32 => Values::I32(Vec::new()),
            Self::F32 => Values::F32(Vec::new()),
            Self::F64 => Values::F64(Vec::new()),
        }
    }

    fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    /// Whether an integer is one of the type, of integers.
    fn holds(self, value: i64) -> bool {
        match self {
            Self::I8 => i8::try_from(value).is_ok(),
            Self::U8 => u8::try_from(value).is_ok(),
            Self::I16 => i16::try_from(value).is_ok(),
            Self::U16 => u16::try_from(value).is_ok(),
            Self::I32 => i32::try_from(value).is_ok(),
            Self::U32 => u32::try_from(value).is_ok(),
            Self::F32 | Self::F64 => false,
        }
    }

    /// Whether every value is one of single precision.
    fn fits_single(self) -> bool {
        !matches!(self, Self::I32 | Self::U32 | Self::F64)
    }

    /// The value in the first [`Self::size`] bytes, NaN if there are fewer; every type fits double precision.
    fn decode(self, bytes: &[u8], encoding: Encoding) -> f64 {
        match self {
            Self::I8 => number(bytes, encoding, i8::from_le_bytes),
            Self::U8 => number(bytes, encoding, u8::from_le_bytes),
            Self::I16 => number(bytes, encoding, i16::from_le_bytes),
            Self::U16 => number(bytes, encoding, u16::from_le_bytes),
            Self::I32 => number(bytes, encoding, i32::from_le_bytes),
            Self::U32 => number(bytes, encoding, u32::from_le_bytes),
            Self::F32 => number(bytes, encoding, f32::from_le_bytes),
            Self::F64 => number(bytes, encoding, f64::from_le_bytes),
        }
    }
}

/// The number in the first `N` bytes, `from_le_bytes` being its reading in little-endian order.
fn number<const N: usize, T: Into<f64>>(bytes: &[u8], encoding: Encoding, from_le_bytes: fn([u8; N]) -> T) -> f64 {
    let Some(&(mut bytes)) = bytes.first_chunk::<N>() else { return f64::NAN };
    if encoding == Encoding::BigEndian {
        bytes.reverse();
    }
    from_le_bytes(bytes).into()
}

struct Property {
    name: Box<[u8]>,
    /// The type of the length, if this is a list.
    length: Option<Type>,
    scalar: Type,
    /// Whether the reader looks at the values.
    used: bool,
    /// Whether it is, or is a component of, an attribute that is kept.
    is_attribute: bool,
}

struct Element {
    name: Box<[u8]>,
    count: u64,
    properties: Vec<Property>,
    /// Where the header declares it.
    position: Position,
}

impl Element {
    /// The place of the property with one of these names, from now on used.
    fn find(&mut self, names: &[&[u8]], list: IsList) -> Option<usize> {
        let fits = |p: &Property| names.contains(&&*p.name) && p.length.is_some() == (list == IsList::Yes);
        let found = self.properties.iter().position(fits)?;
        self.properties[found].used = true;
        Some(found)
    }

    fn unsupported(&self, message: &'static str) -> Fault {
        Fault::new(self.position, ErrorKind::Unsupported(message.into()))
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum IsList {
    Yes,
    No,
}

/// What the rows of an element become; the numbers are those of its properties.
enum Role {
    Vertex { coordinates: Vec<usize> },
    Face,
    Edge { ends: [usize; 2] },
    Strips,
    PassedOver,
}

struct Header {
    encoding: Encoding,
    elements: Vec<Element>,
}

/// Reads the header up to and with `end_header`.
fn header(source: &mut Source<'_>) -> Result<Header, Fault> {
    let mut line = source.need_content(None, "ply")?;
    let magic = line.need_word("ply")?;
    if magic.bytes != b"ply" {
        return Err(line.unexpected(magic, "ply"));
    }
    line.end()?;
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let mut line = source.need_content(None, "end_header")?;
        let keyword = line.need_word("a keyword")?;
        match keyword.bytes {
            b"comment" | b"obj_info" => continue,
            b"format" if encoding.is_none() => encoding = Some(format(&mut line)?),
            b"element" if encoding.is_some() => elements.push(Element {
                name: line.need_word("the name of the element")?.bytes.into(),
                count: line.integer("the number of elements")?,
                properties: Vec::new(),
                position: line.position(keyword.at),
            }),
            b"property" if !elements.is_empty() => {
                let property = property(&mut line)?;
                if let Some(element) = elements.last_mut() {
                    element.properties.push(property);
                }
            }
            b"end_header" => {
                line.end()?;
                let at = line.position(keyword.at);
                let missing = || Fault::new(at, ErrorKind::Unsupported("the header lacks a line `format`".into()));
                return Ok(Header { encoding: encoding.ok_or_else(missing)?, elements });
            }
            _ => return Err(line.unexpected(keyword, "format, element, property, comment or end_header, in order")),
        }
        line.end()?;
    }
}

/// Reads what follows `format`.
fn format(line: &mut Line<'_>) -> Result<Encoding, Fault> {
    const EXPECTED: &str = "ascii, binary_little_endian or binary_big_endian";
    let word = line.need_word(EXPECTED)?;
    let encoding = match word.bytes {
        b"ascii" => Encoding::Text,
        b"binary_little_endian" => Encoding::LittleEndian,
        b"binary_big_endian" => Encoding::BigEndian,
        _ => return Err(line.unexpected(word, EXPECTED)),
    };
    let version = line.need_word("version 1.0")?;
    if version.bytes == b"1.0" { Ok(encoding) } else { Err(line.unexpected(version, "version 1.0")) }
}

/// Reads what follows `property`.
fn property(line: &mut Line<'_>) -> Result<Property, Fault> {
    const EXPECTED: &str = "a type: char, uchar, short, ushort, int, uint, float, double, or list";
    let mut word = line.need_word(EXPECTED)?;
    let mut length = None;
    if word.bytes == b"list" {
        const EXPECTED: &str = "an integer type for the length of the list";
        let of_length = line.need_word(EXPECTED)?;
        length = Type::from_name(of_length.bytes).filter(|of_length| of_length.is_integer());
        if length.is_none() {
            return Err(line.unexpected(of_length, EXPECTED));
        }
        word = line.need_word(EXPECTED)?;
    }
    let scalar = Type::from_name(word.bytes).ok_or_else(|| line.unexpected(word, EXPECTED))?;
    let name = line.need_word("the name of the property")?.bytes.into();
    Ok(Property { name, length, scalar, used: false, is_attribute: false })
}

/// What becomes of an element, by its name and properties.
fn role(element: &mut Element) -> Result<Role, Fault> {
    let role = match &*element.name {
        b"vertex" => {
            let coordinates: Vec<_> =
                [b"x", b"y", b"z"].iter().filter_map(|name| element.find(&[*name], IsList::No)).collect();
            let planar =
                [&b"x"[..], b"y"].iter().all(|name| element.properties.iter().any(|p| p.used && *p.name == **name));
            if !planar {
                return Err(element.unsupported("the element vertex lacks a property x or y"));
            }
            Role::Vertex { coordinates }
        }
        b"face" | b"tristrips" => {
            let list = element.find(&[b"vertex_indices", b"vertex_index"], IsList::Yes);
            match list {
                Some(list) if element.properties[list].scalar.is_integer() => {}
                _ => return Err(element.unsupported("this element lacks a list vertex_indices of integers")),
            }
            if *element.name == *b"face" { Role::Face } else { Role::Strips }
        }
        b"edge" => {
            let ends = [&b"vertex1"[..], b"vertex2"].map(|name| element.find(&[name], IsList::No));
            let integer = |at: usize| element.properties[at].scalar.is_integer();
            match ends {
                [Some(a), Some(b)] if integer(a) && integer(b) => Role::Edge { ends: [a, b] },
                _ => return Err(element.unsupported("the element edge lacks integers vertex1 and vertex2")),
            }
        }
        _ => Role::PassedOver,
    };
    Ok(role)
}

/// A row of an element; reused from row to row.
#[derive(Default)]
struct Row {
    /// The value of each scalar property that is used.
    scalars: Vec<f64>,
    /// The list that is used.
    list: Vec<i64>,
}

/// The attributes of an element.
struct Columns {
    /// The name of each, the numbers of the properties that it consists of, and the values.
    columns: Vec<(String, Vec<usize>, Values)>,
}

impl Columns {
    /// Empty ones for the properties that are attributes.
    fn new(element: &Element) -> Self {
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

    fn push(&mut self, row: &[f64]) {
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
enum Place<'a> {
    /// In this line, the list beginning at this byte of it.
    Text(Line<'a>, usize),
    /// At this byte, the items of the list beginning at another and having so many bytes each.
    Bytes { row: u64, list: u64, item: usize },
}

impl Place<'_> {
    fn row(&self) -> Position {
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
    fn item(&self, number: usize) -> Position {
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
fn text_row(line: &mut Line<'_>, element: &Element, row: &mut Row) -> Result<usize, Fault> {
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
fn binary_row(
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
fn integer(value: f64) -> i64 {
    value as i64
}

/// A PLY file as far as it is read.
struct Ply {
    vertices: u32,
    coordinates: Option<(usize, Scalars)>,
    intake: Intake,
    /// The faces, edges and strips before the row at hand.
    num_cells: usize,
    /// Vertex numbers of the cell at hand.
    word: Vec<u32>,
}

impl Ply {
    /// The number of an existing vertex.
    fn vertex(&mut self, index: i64, position: impl FnOnce() -> Position) -> Result<u32, Fault> {
        match u32::try_from(index) {
            Ok(vertex) if vertex < self.vertices => Ok(vertex),
            _ => {
                let kind = ErrorKind::OutOfRange { index, vertices: self.vertices.into(), first: 0 };
                self.intake.missing(Fault::new(position(), kind))
            }
        }
    }

    /// Takes in one row.
    fn row(&mut self, role: &Role, row: &Row, place: &Place<'_>) -> Result<(), Fault> {
        if matches!(role, Role::Edge { .. } | Role::Face | Role::Strips) {
            self.intake.attributes.begin_cell(self.num_cells);
            self.num_cells += 1;
        }
        match role {
            Role::Vertex { coordinates } => self.point(coordinates, row),
            Role::Edge { ends } => {
                let mut edge = [0; 2];
                for (vertex, &end) in edge.iter_mut().zip(ends) {
                    *vertex = self.vertex(integer(row.scalars[end]), || place.row())?;
                }
                self.intake.simplex(&edge).map_err(|refusal| refused(refusal, place))?;
            }
            Role::Face => {
                if row.list.is_empty() {
                    let kind = ErrorKind::Unsupported("a face without vertices".into());
                    return Err(Fault::new(place.row(), kind));
                }
                self.word.clear();
                for (at, &index) in row.list.iter().enumerate() {
                    let vertex = self.vertex(index, || place.item(at))?;
                    self.word.push(vertex);
                }
                self.intake.polygon(&self.word, u64::from).map_err(|refusal| refused(refusal, place))?;
            }
            Role::Strips => self.strips(&row.list, place)?,
            Role::PassedOver => {}
        }
        Ok(())
    }

    #[allow(clippy::cast_possible_truncation)]
    fn point(&mut self, properties: &[usize], row: &Row) {
        let values = properties.iter().map(|&property| row.scalars[property]);
        match &mut self.coordinates {
            Some((_, Scalars::F32(all))) => all.extend(values.map(|value| value as f32)),
            Some((_, Scalars::F64(all))) => all.extend(values),
            None => {}
        }
    }

    /// Takes in triangle strips, which −1 separates.
    fn strips(&mut self, list: &[i64], place: &Place<'_>) -> Result<(), Fault> {
        let mut first = 0;
        for strip in list.split(|&index| index == -1) {
            self.word.clear();
            for (at, &index) in strip.iter().enumerate() {
                let vertex = self.vertex(index, || place.item(first + at))?;
                self.word.push(vertex);
            }
            self.intake.strip(&self.word).map_err(|refusal| refused(refusal, place))?;
            first += strip.len() + 1;
        }
        Ok(())
    }
}

fn refused(refusal: Refusal, place: &Place<'_>) -> Fault {
    Fault::new(place.row(), refusal.kind(|vertex| vertex.to_string()))
}

/// Notes what the reader does not use, and prepares for the vertices.
fn prepare(ply: &mut Ply, element: &Element, role: &Role) -> Result<(), Fault> {
    if let Role::PassedOver = role {
        ply.intake.report.ignored.note(&element.name);
        return Ok(());
    }
    for property in element.properties.iter().filter(|property| !property.used && !property.is_attribute) {
        let name = [&element.name[..], b" ", &property.name[..]].concat();
        if property.length.is_none() {
            ply.intake.pass_over(&name);
        } else {
            ply.intake.report.ignored.note(&name);
        }
    }
    if let Role::Vertex { coordinates } = role {
        if ply.coordinates.is_some() {
            return Err(element.unsupported("a second element vertex"));
        }
        ply.vertices =
            u32::try_from(element.count).map_err(|_| Fault::new(element.position, ErrorKind::TooManyVertices))?;
        let single = coordinates.iter().all(|&property| element.properties[property].scalar.fits_single());
        let values = if single { Scalars::F32(Vec::new()) } else { Scalars::F64(Vec::new()) };
        ply.coordinates = Some((coordinates.len(), values));
    }
    Ok(())
}

/// Reads a PLY file.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let Header { encoding, mut elements } = header(source)?;
    source.binary = encoding != Encoding::Text;
    let mut ply = Ply {
        vertices: 0,
        coordinates: None,
        intake: Intake::new(Format::Ply, options),
        num_cells: 0,
        word: Vec::new(),
    };
    let roles = elements.iter_mut().map(role).collect::<Result<Vec<_>, _>>()?;
    if ply.intake.attributes.are_kept() {
        for (element, _) in elements.iter_mut().zip(&roles).filter(|(_, role)| !matches!(role, Role::PassedOver)) {
            let rest = element.properties.iter_mut().filter(|property| !property.used && property.length.is_none());
            rest.for_each(|property| property.is_attribute = true);
        }
    }
    // All elements first: faces may come before the vertices whose number they need.
    for (element, role) in elements.iter().zip(&roles) {
        prepare(&mut ply, element, role)?;
    }
    let mut row = Row::default();
    // Rows without properties are no bytes at all, so their count bounds nothing.
    for (element, role) in elements.iter().zip(&roles).filter(|(element, _)| !element.properties.is_empty()) {
        row.scalars.clear();
        row.scalars.resize(element.properties.len(), 0.0);
        let (first, mut columns) = (ply.num_cells, Columns::new(element));
        for _ in 0..element.count {
            if encoding == Encoding::Text {
                let mut line = source.need_content(None, "as many rows of the element as the header says")?;
                let list = text_row(&mut line, element, &mut row)?;
                columns.push(&row.scalars);
                ply.row(role, &row, &Place::Text(line, list))?;
            } else {
                let place = binary_row(source, element, encoding, options.on_bad, &mut row)?;
                columns.push(&row.scalars);
                ply.row(role, &row, &place)?;
            }
        }
        for (name, components, values) in columns.columns {
            match role {
                Role::Vertex { .. } => ply.intake.vertex_attribute(&name, components.len(), values),
                _ => ply.intake.cell_attribute(&name, components.len(), values, first),
            }
        }
    }
    if encoding == Encoding::Text {
        source.need_end(None, "file after the last element")?;
    } else {
        source.need_end_of_bytes("file after the last element")?;
    }
    Ok(ply.intake.finish(Labels::Numbered(ply.vertices as usize), true, ply.coordinates))
}
