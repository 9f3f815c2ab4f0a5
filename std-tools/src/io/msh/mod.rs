//! MSH, the mesh format of Gmsh: versions 2.0 to 2.2 and 4.1, in text and binary of both byte orders.
//!
//! This file reads the sections and holds the mesh; `v2` and `v4` read nodes and elements, `entities` physical groups,
//! `shapes` knows the element types. Cells of every dimension are kept. The physical group of an element is its
//! attribute `ref`, and `data` reads others. Elements of higher order stand for their corners; a node that is never a
//! corner and lies in such an element is no vertex. Sections other than nodes and elements are passed over.

mod data;
mod entities;
mod shapes;
mod tags;
mod v2;
mod v4;

use super::attributes::References;
use super::error::{ErrorKind, Fault, Position};
use super::intake::Intake;
use super::shape::Shape;
use super::source::{Source, truncated};
use super::text::{Line, Word};
use super::{Format, OnBad, ReadOptions, ReadReport};
use crate::soup::{Labels, Scalars, Soup};
use entities::Groups;
use shapes::shape;
use tags::Tags;

/// How numbers are written.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Text,
    Binary { big_endian: bool },
}

/// The variants of the format that have their own sections of nodes and elements.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Version {
    V2,
    V4 { size_of_size: usize },
}

/// Sections that say nothing about the complex and are not worth a word in the report.
const PASSED_OVER: &[&[u8]] = &[b"Comments", b"PhysicalNames", b"Entities", b"PartitionedEntities"];

/// A mesh as far as it is read.
struct Mesh {
    nodes: Tags,
    /// The coordinates of the nodes, three each.
    points: Vec<f64>,
    /// The tags of the elements, if attributes are kept.
    elements: Tags,
    num_elements: usize,
    /// The physical group of each element.
    references: References,
    groups: Groups,
    intake: Intake,
    /// The vertex numbers of the nodes of the element at hand.
    word: Vec<u32>,
}

impl Mesh {
    /// Says that an element follows, of a physical group, 0 for none.
    fn begin_element(&mut self, tag: u64, group: i64) {
        self.references.push(group);
        self.intake.attributes.begin_cell(self.num_elements);
        self.num_elements += 1;
        if self.intake.attributes.are_kept() {
            self.elements.push(tag);
        }
    }

    /// Adds the element of the given shape whose nodes are `self.word`.
    fn element(&mut self, shape: Shape) -> Result<(), ErrorKind> {
        let tags = self.nodes.as_slice();
        let label = |vertex: u32| tags.get(vertex as usize).copied().unwrap_or(0);
        let added = self.intake.element(shape, &self.word, label);
        added.map_err(|refusal| refusal.kind(|vertex| label(vertex).to_string()))
    }

    /// The vertex number of the node with a tag.
    fn node(&mut self, tag: u64, position: impl FnOnce() -> Position) -> Result<u32, Fault> {
        match self.nodes.find(tag) {
            Some(node) => Ok(node),
            None => {
                let kind = ErrorKind::UnknownNode { tag, nodes: self.nodes.len() as u64 };
                self.intake.missing(Fault::new(position(), kind))
            }
        }
    }

    /// Reads the nodes of an element from the rest of a line of text, and adds it.
    fn text_element(&mut self, line: &mut Line<'_>, start: usize, shape: Shape) -> Result<(), Fault> {
        self.word.clear();
        for _ in 0..shape.num_nodes {
            let word = line.need_word("as many node tags as the type of the element asks for")?;
            let tag = line.parse_integer(word, "a node tag")?;
            let node = self.node(tag, || line.position(word.at))?;
            self.word.push(node);
        }
        line.end()?;
        self.element(shape).map_err(|kind| line.fault(start, kind))
    }

    /// The soup of the vertices that are left without inner nodes.
    fn finish(mut self) -> (Soup, ReadReport) {
        let of_nodes = References::new(0, &self.intake.attributes);
        self.intake.references(of_nodes, self.references);
        let labels = Labels::from_integers(self.nodes.into_vec());
        self.intake.finish(labels, true, Some((3, Scalars::F64(self.points))))
    }
}

/// The element type with the number that stands in `word`.
fn text_shape(line: &Line<'_>, word: Word<'_>) -> Result<Shape, Fault> {
    const EXPECTED: &str = "an element type of Gmsh of first to fifth order that is read (see its manual)";
    shape(line.parse_integer(word, EXPECTED)?).ok_or_else(|| line.unexpected(word, EXPECTED))
}

/// The next element type in binary data.
fn binary_shape(source: &mut Source<'_>, binary: Binary, expected: &'static str) -> Result<Shape, Fault> {
    let position = source.byte();
    let number = binary.int(source, expected)?;
    shape(number.into()).ok_or_else(|| {
        Fault::new(position, ErrorKind::Unsupported(format!("elements of type {number} are not read").into()))
    })
}

/// Reads `version file-type data-size`, and the 1 that tells the byte order of a binary file.
fn mesh_format(source: &mut Source<'_>) -> Result<(Version, Encoding), Fault> {
    let mut line = source.need_content(None, "the version of the format")?;
    let version = line.need_word("the version of the format")?;
    let file_type = line.need_word("0 for text or 1 for binary")?;
    let size = line.need_word("the size of numbers in bytes")?;
    line.end()?;
    let size_of_size = match size.bytes {
        b"8" => 8,
        b"4" if version.bytes.starts_with(b"4") => 4,
        _ => return Err(line.unexpected(size, "8, the size of numbers in bytes")),
    };
    let version = match version.bytes {
        b"2" | b"2.0" | b"2.1" | b"2.2" => Version::V2,
        b"4.1" => Version::V4 { size_of_size },
        _ => return Err(line.unexpected(version, "version 2.2 or 4.1; let Gmsh save the mesh as one of these")),
    };
    let encoding = match file_type.bytes {
        b"0" => Encoding::Text,
        b"1" => {
            let position = source.byte();
            source.binary = true;
            let one = source.take(4, "the number 1 in binary, which tells the byte order")?;
            let big_endian = match one {
                [1, 0, 0, 0] => false,
                [0, 0, 0, 1] => true,
                _ => {
                    let found = super::error::excerpt(one);
                    let expected = "the number 1 in binary, which tells the byte order".into();
                    return Err(Fault::new(position, ErrorKind::Expected { expected, found }));
                }
            };
            Encoding::Binary { big_endian }
        }
        _ => return Err(line.unexpected(file_type, "0 for text or 1 for binary")),
    };
    end_section(source, "$EndMeshFormat")?;
    Ok((version, encoding))
}

/// Reads the line that ends a section.
fn end_section(source: &mut Source<'_>, mark: &'static str) -> Result<(), Fault> {
    let mut line = source.need_content(None, mark)?;
    let word = line.need_word(mark)?;
    if word.bytes == mark.as_bytes() { line.end() } else { Err(line.unexpected(word, mark)) }
}

/// Passes over the rest of a section.
fn skip_section(source: &mut Source<'_>, name: &[u8]) -> Result<(), Fault> {
    let mark = [b"$End", name].concat();
    if source.skip_to_line(&mark)? {
        source.next_content(None)?;
        return Ok(());
    }
    Err(truncated(source.end_of_text(), String::from_utf8_lossy(&mark).into_owned()))
}

/// Reads an MSH file.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let intake = Intake::new(Format::Msh, options);
    let mut mesh = Mesh {
        nodes: Tags::new(),
        points: Vec::new(),
        elements: Tags::new(),
        num_elements: 0,
        references: References::new(0, &intake.attributes),
        groups: Groups::default(),
        intake,
        word: Vec::new(),
    };
    let mut format = None;
    let (mut nodes_read, mut elements_read) = (false, false);
    loop {
        let end = source.end_of_text();
        let Some(mut line) = source.next_content(None)? else {
            return match (format, nodes_read, elements_read) {
                (Some(_), true, true) => Ok(mesh.finish()),
                (None, ..) => Err(truncated(end, "the section $MeshFormat")),
                (_, false, _) => Err(truncated(end, "the section $Nodes")),
                _ => Err(truncated(end, "the section $Elements")),
            };
        };
        let word = line.need_word("a section")?;
        let Some(name) = word.bytes.strip_prefix(b"$").filter(|name| !name.starts_with(b"End")) else {
            return Err(line.unexpected(word, "a line that opens a section, like $Nodes"));
        };
        line.end()?;
        match (name, format) {
            (b"MeshFormat", None) => format = Some(mesh_format(source)?),
            (b"Nodes", Some((version, encoding))) if !nodes_read => {
                match version {
                    Version::V2 => v2::nodes(source, encoding, &mut mesh)?,
                    Version::V4 { size_of_size } => v4::nodes(source, encoding, size_of_size, &mut mesh)?,
                }
                let end = source.end_of_text();
                mesh.nodes.index().map_err(|tag| Fault::new(end, ErrorKind::DuplicateNode { tag }))?;
                end_section(source, "$EndNodes")?;
                nodes_read = true;
            }
            (b"Elements", Some((version, encoding))) if nodes_read => {
                match version {
                    Version::V2 => v2::elements(source, encoding, &mut mesh)?,
                    Version::V4 { size_of_size } => v4::elements(source, encoding, size_of_size, &mut mesh)?,
                }
                end_section(source, "$EndElements")?;
                elements_read = true;
            }
            (b"Entities", Some((Version::V4 { size_of_size }, encoding))) => {
                mesh.groups = entities::read(source, encoding, size_of_size)?;
                end_section(source, "$EndEntities")?;
            }
            (b"NodeData", Some((_, encoding))) if nodes_read && mesh.intake.attributes.are_kept() => {
                data::read(source, encoding, data::Of::Nodes, &mut mesh)?;
                end_section(source, "$EndNodeData")?;
            }
            (b"ElementData", Some((_, encoding))) if elements_read && mesh.intake.attributes.are_kept() => {
                data::read(source, encoding, data::Of::Elements, &mut mesh)?;
                end_section(source, "$EndElementData")?;
            }
            (b"MeshFormat" | b"Nodes" | b"Elements", _) => {
                return Err(line.unexpected(word, "the sections $MeshFormat, $Nodes and $Elements, in this order"));
            }
            (b"NOD" | b"ELM", None) => {
                let advice = "version 1 of the format is not read; let Gmsh save the mesh as version 2.2 or 4.1";
                return Err(line.fault(word.at, ErrorKind::Unsupported(advice.into())));
            }
            _ => {
                let name = name.to_vec();
                if name == b"NodeData" || name == b"ElementData" {
                    mesh.intake.pass_over(&[b"$", &*name].concat());
                } else if !PASSED_OVER.contains(&&*name) {
                    mesh.intake.report.ignored.note(&[b"$", &*name].concat());
                }
                skip_section(source, &name)?;
            }
        }
    }
}

/// Binary numbers of one byte order.
#[derive(Clone, Copy)]
struct Binary {
    big_endian: bool,
}

impl Binary {
    /// The next integer of 4 bytes with sign.
    fn int(self, source: &mut Source<'_>, expected: &'static str) -> Result<i32, Fault> {
        let bytes = source.take(4, expected)?;
        let bytes = [bytes[0], bytes[1], bytes[2], bytes[3]];
        Ok(if self.big_endian { i32::from_be_bytes(bytes) } else { i32::from_le_bytes(bytes) })
    }

    /// The next integer of 4 bytes that may not be negative.
    fn count(self, source: &mut Source<'_>, expected: &'static str) -> Result<u64, Fault> {
        let position = source.byte();
        let value = self.int(source, expected)?;
        u64::try_from(value).map_err(|_| {
            Fault::new(position, ErrorKind::Expected { expected: expected.into(), found: value.to_string().into() })
        })
    }

    /// The next integer of `size` bytes, 4 or 8, without sign.
    fn size(self, source: &mut Source<'_>, size: usize, expected: &'static str) -> Result<u64, Fault> {
        let mut little = [0; 8];
        let bytes = &mut little[..size];
        bytes.copy_from_slice(source.take(size, expected)?);
        if self.big_endian {
            bytes.reverse();
        }
        Ok(u64::from_le_bytes(little))
    }

    /// The next coordinate, or other floating-point number.
    fn float(self, source: &mut Source<'_>, expected: &'static str) -> Result<f64, Fault> {
        let mut number = [0; 8];
        number.copy_from_slice(source.take(8, expected)?);
        Ok(if self.big_endian { f64::from_be_bytes(number) } else { f64::from_le_bytes(number) })
    }

    /// The next three coordinates.
    fn point(self, source: &mut Source<'_>, on_bad: OnBad) -> Result<[f64; 3], Fault> {
        let mut point = [0.0; 3];
        for value in &mut point {
            let position = source.byte();
            *value = self.float(source, "a coordinate of the node")?;
            if !value.is_finite() && on_bad == OnBad::Refuse {
                return Err(Fault::new(position, ErrorKind::NotFinite { found: value.to_string().into() }));
            }
        }
        Ok(point)
    }
}

/// Reads three coordinates from a line of text.
fn text_point(line: &mut Line<'_>) -> Result<[f64; 3], Fault> {
    let mut point = [0.0; 3];
    for value in &mut point {
        *value = line.float("a coordinate of the node")?;
    }
    Ok(point)
}
