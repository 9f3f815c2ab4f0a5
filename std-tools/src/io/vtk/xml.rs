//! VTK's XML formats for unstructured grids (`.vtu`) and poly data (`.vtp`).
//!
//! Arrays may stand in text, inline in base64, or appended raw or in base64, plain or compressed by zlib. Of the data
//! at the points an array of integers called `label` gives what the vertices are called, as this program writes it; an
//! array of the dimensions of the cells, which it writes too, says nothing new. A library for XML is of no help: raw
//! appended data are no XML, and text would be held whole.

use super::super::error::{ErrorKind, Fault, Position};
use super::super::intake::Intake;
use super::super::source::{Source, truncated};
use super::super::tags::{self, Tag};
use super::super::words::Words;
use super::super::{Format, OnBad, ReadOptions, ReadReport};
use super::bytes::{Bytes, Layout};
use super::legacy::Of;
use super::{Cells, Type, Types, Values};
use crate::attribute::{self, Attribute, MOST_COMPONENTS};
use crate::soup::{Labels, Scalars, Soup};

/// The elements that hold cells, and the type of those of which the file does not tell one; in the order in which data at
/// cells have them.
const GROUPS: [(&str, &str, Option<u8>); 5] = [
    ("Cells", "NumberOfCells", None),
    ("Verts", "NumberOfVerts", Some(2)),
    ("Lines", "NumberOfLines", Some(4)),
    ("Polys", "NumberOfPolys", Some(7)),
    ("Strips", "NumberOfStrips", Some(6)),
];

/// What an array is for; groups by number.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    Points,
    Labels,
    Vertices(usize),
    Ends(usize),
    Types(usize),
    /// An attribute of the points or the cells, by its name among those of the file.
    Data(Of, usize),
}

/// An array that the reader needs.
struct Array {
    role: Role,
    values: Values,
    /// Numbers a row.
    components: u64,
    position: Position,
}

/// A part of a grid.
struct Piece {
    points: u32,
    /// The number of cells of each group.
    cells: [u64; GROUPS.len()],
    arrays: Vec<Array>,
}

impl Piece {
    fn new(tag: &Tag) -> Result<Self, Fault> {
        let points = u32::try_from(tag.number("NumberOfPoints")?)
            .map_err(|_| Fault::new(tag.position, ErrorKind::TooManyVertices))?;
        let mut cells = [0; GROUPS.len()];
        for (count, (_, attribute, _)) in cells.iter_mut().zip(GROUPS) {
            *count = tag.number(attribute)?;
        }
        Ok(Self { points, cells, arrays: Vec::new() })
    }

    /// How many numbers an array must have, if that is known.
    fn expected(&self, role: Role, components: u64) -> Option<u64> {
        match role {
            Role::Data(of, _) => Some(self.rows(of).saturating_mul(components)),
            Role::Points => Some(3 * u64::from(self.points)),
            Role::Labels => Some(self.points.into()),
            Role::Vertices(_) => None,
            Role::Ends(group) | Role::Types(group) => Some(self.cells[group]),
        }
    }

    /// The number of its points, or of its cells.
    fn rows(&self, of: Of) -> u64 {
        match of {
            Of::Points => self.points.into(),
            Of::Cells => self.cells.iter().fold(0, |sum, &count| sum.saturating_add(count)),
        }
    }

    fn find(&self, role: Role) -> Option<&Array> {
        self.arrays.iter().find(|array| array.role == role)
    }

    /// Empty values for an array.
    fn values(&self, role: Role, scalar: Type) -> Values {
        match role {
            Role::Points if !scalar.fits_single() => Values::Points(Scalars::F64(Vec::new())),
            Role::Points => Values::Points(Scalars::F32(Vec::new())),
            Role::Labels => Values::Labels(Vec::new()),
            Role::Vertices(_) => Values::Vertices(Vec::new(), self.points),
            Role::Ends(_) => Values::Ends(Vec::new()),
            Role::Types(_) => Values::Types(Vec::new()),
            Role::Data(..) => Values::Data(scalar.values()),
        }
    }
}

/// An array whose data come at the end of the file.
struct Appended {
    piece: usize,
    array: usize,
    scalar: Type,
    offset: u64,
}

struct Grid {
    layout: Layout,
    pieces: Vec<Piece>,
    appended: Vec<Appended>,
    /// The names of the attributes.
    names: Vec<(Of, Box<str>)>,
    intake: Intake,
}

fn scalar_type(name: &str) -> Option<Type> {
    Some(match name {
        "Int8" => Type::I8,
        "UInt8" => Type::U8,
        "Int16" => Type::I16,
        "UInt16" => Type::U16,
        "Int32" => Type::I32,
        "UInt32" => Type::U32,
        "Int64" => Type::I64,
        "UInt64" => Type::U64,
        "Float32" => Type::F32,
        "Float64" => Type::F64,
        _ => return None,
    })
}

/// Reads what the first tag says.
fn layout(tag: &Tag) -> Result<Layout, Fault> {
    match tag.get("type") {
        Some("UnstructuredGrid" | "PolyData") => {}
        found => {
            let found = found.unwrap_or("no type");
            let message = format!("{found} is not read, but UnstructuredGrid and PolyData");
            return Err(tag.unsupported(message));
        }
    }
    let zlib = match tag.get("compressor") {
        None | Some("") => false,
        Some("vtkZLibDataCompressor") => true,
        Some(other) => {
            return Err(tag.unsupported(format!("data of {other} are not read; save with zlib or without compression")));
        }
    };
    let big_endian = tag.get("byte_order") == Some("BigEndian");
    Ok(Layout { on_bad: OnBad::Refuse, big_endian, wide: tag.get("header_type") == Some("UInt64"), zlib })
}

/// What the array of a tag in the element `section` is for, if the reader needs it.
fn role(tag: &Tag, section: &str) -> Option<Role> {
    let name = tag.get("Name").unwrap_or("");
    if let Some(group) = GROUPS.iter().position(|(element, ..)| *element == section) {
        return match name {
            "connectivity" => Some(Role::Vertices(group)),
            "offsets" => Some(Role::Ends(group)),
            "types" if group == 0 => Some(Role::Types(group)),
            _ => None,
        };
    }
    match section {
        "Points" => Some(Role::Points),
        "PointData" if name == "label" => {
            let is_integer = tag.get("type").and_then(scalar_type).is_some_and(Type::is_integer);
            let is_scalar = tag.get("NumberOfComponents").is_none_or(|number| number == "1");
            (is_integer && is_scalar).then_some(Role::Labels)
        }
        _ => None,
    }
}

impl Grid {
    /// Reads the array of a tag, or notes where its data will come.
    fn array(&mut self, tag: &Tag, section: &str, source: &mut Source<'_>) -> Result<(), Fault> {
        let role = role(tag, section).or_else(|| self.data_role(tag, section));
        let (Some(role), Some(piece)) = (role, self.pieces.last_mut()) else {
            if matches!(section, "PointData" | "CellData") {
                self.intake.pass_over(tag.get("Name").unwrap_or("").as_bytes());
            }
            return Ok(());
        };
        if piece.find(role).is_some() {
            return Err(tag.unsupported("a second array of this kind in the piece"));
        }
        if role == Role::Points && tag.get("NumberOfComponents").unwrap_or("3") != "3" {
            return Err(tag.unsupported("points that have not three coordinates"));
        }
        let Some(scalar) = tag.get("type").and_then(scalar_type) else {
            return Err(tag.unsupported("an array that is not of type Int8 to UInt64, Float32 or Float64"));
        };
        let components = if tag.get("NumberOfComponents").is_some() { tag.number("NumberOfComponents")? } else { 1 };
        let (mut values, most) = (piece.values(role, scalar), piece.expected(role, components));
        match tag.get("format").unwrap_or("ascii") {
            "ascii" if tag.empty => {}
            "ascii" => {
                let mut words = Words::before(source, b'<');
                loop {
                    let is_full = most == Some(values.len() as u64);
                    if !is_full && values.push_plain(words.source)? {
                        continue;
                    }
                    let Some(mut line) = words.next()? else { break };
                    if is_full {
                        return Err(line.trailing("array, which has as many numbers as the piece says,"));
                    }
                    values.push_text(&line, self.layout.on_bad)?;
                }
            }
            "binary" => {
                source.skip_blanks()?;
                Bytes::base64(source).array(self.layout, scalar, most, &mut values)?;
            }
            "appended" => {
                let (piece_number, array) = (self.pieces.len() - 1, self.pieces.last().map_or(0, |p| p.arrays.len()));
                let offset = tag.number("offset")?;
                self.appended.push(Appended { piece: piece_number, array, scalar, offset });
            }
            _ => return Err(tag.unsupported("an array whose format is not ascii, binary or appended")),
        }
        if let Some(piece) = self.pieces.last_mut() {
            piece.arrays.push(Array { role, values, components, position: tag.position });
        }
        Ok(())
    }

    /// What an array of data at points or cells is for, if it is an attribute that is kept.
    fn data_role(&mut self, tag: &Tag, section: &str) -> Option<Role> {
        let of = match section {
            "PointData" => Of::Points,
            "CellData" => Of::Cells,
            _ => return None,
        };
        let name = tag.get("Name").filter(|name| !name.is_empty())?;
        // Strings have other types.
        tag.get("type").and_then(scalar_type).filter(|_| self.intake.attributes.are_kept())?;
        let number = self.names.iter().position(|(there, known)| *there == of && **known == *name);
        // A second of the name in a piece is passed over.
        let is_there = |number| self.pieces.last().is_some_and(|piece| piece.find(Role::Data(of, number)).is_some());
        if number.is_some_and(is_there) {
            return None;
        }
        Some(Role::Data(
            of,
            number.unwrap_or_else(|| {
                self.names.push((of, name.into()));
                self.names.len() - 1
            }),
        ))
    }

    /// Puts the arrays of each attribute together; where a piece has none, there are no values. Those that differ in type
    /// are noted only.
    fn add_attributes(&mut self) {
        for (number, (of, name)) in std::mem::take(&mut self.names).into_iter().enumerate() {
            let mut all: Option<(u64, attribute::Values)> = None;
            let (mut rows, mut differ) = (0, false);
            for piece in &mut self.pieces {
                let found = piece.arrays.iter_mut().find(|array| array.role == Role::Data(of, number));
                if let Some(Array { components, values: Values::Data(values), .. }) = found {
                    let more = std::mem::replace(values, attribute::Values::U8(Vec::new()));
                    let all = all.get_or_insert_with(|| (*components, more.rows(1, std::iter::empty())));
                    differ |= all.0 != *components || *components > MOST_COMPONENTS as u64;
                    if !differ {
                        all.1.fill(to_usize(rows * all.0));
                        differ = !all.1.append(more);
                    }
                }
                rows += piece.rows(of);
            }
            match all {
                Some((components, mut values)) if !differ => {
                    values.fill(to_usize(rows * components));
                    match of {
                        Of::Points => self.intake.vertex_attribute(&name, to_usize(components), values),
                        Of::Cells => self.intake.cell_attribute(&name, to_usize(components), values, 0),
                    }
                }
                _ => self.intake.report.ignored.note(name.as_bytes()),
            }
        }
    }

    /// Reads the data that were appended.
    fn read_appended(&mut self, tag: &Tag, source: &mut Source<'_>) -> Result<(), Fault> {
        let position = source.end_of_text();
        if source.skip_blanks()? != Some(b'_') {
            return Err(truncated(position, "`_`, after which appended data begin"));
        }
        source.skip(1, "`_`")?;
        self.appended.sort_by_key(|appended| appended.offset);
        let mut bytes = match tag.get("encoding") {
            Some("raw") => {
                source.binary = true;
                Bytes::raw(source)
            }
            _ => Bytes::base64(source),
        };
        for Appended { piece, array, scalar, offset } in std::mem::take(&mut self.appended) {
            let Some(gap) = offset.checked_sub(bytes.consumed) else {
                return Err(tag.unsupported("appended arrays that overlap"));
            };
            bytes.skip(gap)?;
            let Some(piece) = self.pieces.get_mut(piece) else { continue };
            let most = piece.arrays.get(array).and_then(|array| piece.expected(array.role, array.components));
            if let Some(array) = piece.arrays.get_mut(array) {
                bytes.array(self.layout, scalar, most, &mut array.values)?;
            }
        }
        Ok(())
    }

    fn finish(mut self, end: Position) -> Result<(Soup, ReadReport), Fault> {
        let (mut points, mut labels, mut shift, mut before) = (None, Some(Vec::new()), 0_u32, 0);
        for piece in &self.pieces {
            check(piece, end)?;
            append(&mut points, piece.find(Role::Points));
            match (&mut labels, piece.find(Role::Labels)) {
                (Some(all), Some(Array { values: Values::Labels(more), .. })) => all.extend(more),
                _ => labels = None,
            }
            for (group, (_, _, fixed)) in GROUPS.into_iter().enumerate() {
                let vertices = piece.find(Role::Vertices(group));
                let (Some(vertices), Some(ends)) = (vertices, piece.find(Role::Ends(group))) else { continue };
                let types = match (fixed, piece.find(Role::Types(group)).map(|array| &array.values)) {
                    (Some(kind), _) => Types::All(kind),
                    (None, Some(Values::Types(types))) => Types::Each(types),
                    _ => continue,
                };
                if let (Values::Vertices(vertices, _), Values::Ends(ends), position) =
                    (&vertices.values, &ends.values, vertices.position)
                {
                    Cells { vertices, ends, types, position }.add(shift, before, &mut self.intake)?;
                    before += ends.len();
                }
            }
            shift = shift.checked_add(piece.points).ok_or_else(|| Fault::new(end, ErrorKind::TooManyVertices))?;
        }
        self.add_attributes();
        if let Some(same) = labels.take_if(|labels| !all_differ(labels)) {
            self.intake.vertex_attribute("label", 1, attribute::Values::U64(same));
        }
        let labels = labels.map_or(Labels::Numbered(shift as usize), Labels::from_integers);
        let points = points.unwrap_or(Scalars::F32(Vec::new()));
        let (mut soup, report) = self.intake.finish(labels, true, Some((3, points)));
        drop_dimensions(&mut soup.attributes);
        Ok((soup, report))
    }
}

/// Leaves out the dimensions of cells, which are no news.
fn drop_dimensions(attributes: &mut Vec<Attribute>) {
    let is_one = |attribute: &Attribute| *attribute.name == *"dimension";
    let is_its_own = |attribute: &Attribute| match &attribute.values {
        attribute::Values::U8(values) => values.iter().all(|&value| usize::from(value) == attribute.dim),
        _ => false,
    };
    if attributes.iter().filter(|attribute| is_one(attribute)).all(is_its_own) {
        attributes.retain(|attribute| !is_one(attribute));
    }
}

/// A number of rows or numbers that are there.
fn to_usize(number: u64) -> usize {
    usize::try_from(number).unwrap_or(usize::MAX)
}

/// Whether no number stands there twice.
fn all_differ(numbers: &[u64]) -> bool {
    let mut sorted = numbers.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).all(|pair| pair[0] != pair[1])
}

/// Checks that the arrays of a piece are there and have the lengths that it says.
fn check(piece: &Piece, end: Position) -> Result<(), Fault> {
    for array in &piece.arrays {
        let found = array.values.len() as u64;
        if let Some(declared) = piece.expected(array.role, array.components).filter(|&declared| declared != found) {
            let what = match array.role {
                Role::Points => "coordinates of points",
                Role::Labels => "labels of points",
                Role::Data(..) => "numbers of the attribute",
                _ => "cells of the piece",
            };
            return Err(Fault::new(array.position, ErrorKind::WrongCount { what, declared, found }));
        }
    }
    let missing = |expected: &'static str| Err(truncated(end, expected));
    if piece.points > 0 && piece.find(Role::Points).is_none() {
        return missing("an array of points in each piece that has some");
    }
    for (group, (_, _, fixed)) in GROUPS.into_iter().enumerate().filter(|(group, _)| piece.cells[*group] > 0) {
        let types = fixed.is_some() || piece.find(Role::Types(group)).is_some();
        if piece.find(Role::Vertices(group)).is_none() || piece.find(Role::Ends(group)).is_none() || !types {
            return missing("the arrays connectivity, offsets and, of an unstructured grid, types");
        }
    }
    Ok(())
}

/// Appends points, in double precision if those of any piece are.
fn append(all: &mut Option<Scalars>, more: Option<&Array>) {
    let Some(Array { values: Values::Points(more), .. }) = more else { return };
    match (all.as_mut(), more) {
        (None, more) => *all = Some(more.clone()),
        (Some(Scalars::F32(all)), Scalars::F32(more)) => all.extend(more),
        (Some(Scalars::F64(all)), Scalars::F64(more)) => all.extend(more),
        (Some(Scalars::F64(all)), Scalars::F32(more)) => all.extend(more.iter().copied().map(f64::from)),
        (Some(Scalars::F32(single)), Scalars::F64(more)) => {
            *all = Some(Scalars::F64(single.iter().copied().map(f64::from).chain(more.iter().copied()).collect()));
        }
    }
}

/// Reads a file.
pub(in super::super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let first = tags::first(source, "VTKFile")?;
    let (pieces, appended) = (Vec::new(), Vec::new());
    let intake = Intake::new(Format::Vtu, options);
    let mut grid = Grid {
        layout: Layout { on_bad: options.on_bad, ..layout(&first)? },
        pieces,
        appended,
        names: Vec::new(),
        intake,
    };
    // The element within the piece.
    let mut section: Box<str> = "".into();
    loop {
        let end = source.end_of_text();
        let Some(tag) = tags::next(source)? else { return Err(truncated(end, "the tag that ends VTKFile")) };
        match (&*tag.name, tag.closing) {
            ("VTKFile", true) => {
                if let Some(appended) = grid.appended.first() {
                    let position = grid.pieces[appended.piece].arrays[appended.array].position;
                    return Err(truncated(position, "the appended data of this array"));
                }
                return grid.finish(end);
            }
            ("Piece", false) => grid.pieces.push(Piece::new(&tag)?),
            ("DataArray", false) => grid.array(&tag, &section, source)?,
            ("AppendedData", false) => {
                grid.read_appended(&tag, source)?;
                let end = source.end_of_text();
                return grid.finish(end);
            }
            (name, false) if !tag.empty => section = name.into(),
            (
                "Points" | "PointData" | "CellData" | "FieldData" | "Cells" | "Verts" | "Lines" | "Strips" | "Polys",
                true,
            ) => {
                section = "".into();
            }
            _ => {}
        }
    }
}
