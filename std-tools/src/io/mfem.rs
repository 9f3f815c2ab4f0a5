//! MFEM's mesh format: `MFEM mesh v1.x`, then sections of dimension, elements, boundary and vertices.
//!
//! Elements of all kinds and the elements of the boundary are cells, and the number that each begins with their attribute
//! `ref`, unless it is the usual 1; vertices are numbered from 0. Where the mesh is
//! curved or periodic, a section `nodes` holds points of the elements and the vertices have no coordinates of their own;
//! that section is passed over. Meshes that do not conform, NURBS and inline meshes are not read.

use super::attributes::References;
use super::error::{ErrorKind, Fault, Position};
use super::intake::{Intake, reserve};
use super::shape::Shape;
use super::source::Source;
use super::words::Words;
use super::{Format, ReadOptions, ReadReport};
use crate::soup::{Labels, Scalars, Soup};

const COMMENT: Option<u8> = Some(b'#');

/// The words that a file begins with, whatever its kind and version.
pub(super) const KEYWORD: &[u8] = b"MFEM ";

/// The geometry type with this number.
fn shape(number: i64) -> Option<Shape> {
    Some(match number {
        0 => Shape::simplex(1, 1),
        1 => Shape::simplex(2, 2),
        2 => Shape::simplex(3, 3),
        3 => Shape::quadrangle(4),
        4 => Shape::simplex(4, 4),
        5 => Shape::hexahedron(8),
        6 => Shape::prism(6),
        7 => Shape::pyramid(5),
        _ => return None,
    })
}

/// A mesh as far as it is read.
struct Mesh {
    intake: Intake,
    references: References,
    num_cells: usize,
    /// The greatest vertex number so far, and where; the number of vertices comes last.
    greatest: Option<(u32, Position)>,
    /// How many times an element names a vertex.
    named: u64,
    /// The number of vertices and, if they have any, their coordinates.
    vertices: Option<(u32, Option<(usize, Scalars)>)>,
}

impl Mesh {
    /// Reads `attribute geometry v1 v2 …`, as many rows as the section says.
    fn elements(&mut self, words: &mut Words<'_, '_>) -> Result<(), Fault> {
        const GEOMETRY: &str = "the number of a geometry type, from 0 to 7";
        let count: u64 = words.integer("the number of elements")?;
        let mut nodes = Vec::new();
        for _ in 0..count {
            let attribute = words.integer("the attribute of an element, as many elements as the section says")?;
            self.references.push(attribute);
            self.intake.attributes.begin_cell(self.num_cells);
            self.num_cells += 1;
            let mut line = words.need(GEOMETRY)?;
            let word = line.need_word(GEOMETRY)?;
            let position = line.position(word.at);
            let shape = shape(line.parse_integer(word, GEOMETRY)?).ok_or_else(|| line.unexpected(word, GEOMETRY))?;
            nodes.clear();
            for _ in 0..shape.num_nodes {
                let mut line = words.need("as many vertices as the geometry type asks for")?;
                let vertex: u32 = line.integer("the number of a vertex, from 0")?;
                if vertex == u32::MAX {
                    return Err(line.fault(0, ErrorKind::TooManyVertices));
                }
                if self.greatest.is_none_or(|(greatest, _)| vertex > greatest) {
                    self.greatest = Some((vertex, line.position(0)));
                }
                nodes.push(vertex);
            }
            self.named += nodes.len() as u64;
            self.intake
                .element(shape, &nodes, u64::from)
                .map_err(|refusal| Fault::new(position, refusal.kind(|vertex| vertex.to_string())))?;
        }
        Ok(())
    }

    /// Reads the number of vertices and, if they follow, their coordinates.
    fn read_vertices(&mut self, words: &mut Words<'_, '_>) -> Result<(), Fault> {
        let count: u32 = words.integer("the number of vertices (below 2^32)")?;
        if !words.first_byte()?.is_some_and(|first| first.is_ascii_digit()) {
            // Nothing but elements vouches for them: a number alone may not ask for memory.
            if u64::from(count) > self.named {
                let kind = ErrorKind::WrongCount {
                    what: "vertices without coordinates that an element has",
                    declared: count.into(),
                    found: self.named,
                };
                return Err(Fault::new(words.source.end_of_text(), kind));
            }
            self.vertices = Some((count, None));
            return Ok(());
        }
        const DIMENSION: &str = "the dimension of the space, from 1 to 255";
        let line = words.need(DIMENSION)?;
        let dim: u8 = line.parse_integer(line.as_word(), DIMENSION)?;
        if dim == 0 {
            return Err(line.unexpected(line.as_word(), DIMENSION));
        }
        let mut values = Vec::with_capacity(reserve(u64::from(count) * u64::from(dim)));
        for _ in 0..u64::from(count) * u64::from(dim) {
            values.push(words.float("a coordinate of a vertex, as many vertices as the section says")?);
        }
        self.vertices = Some((count, Some((dim.into(), Scalars::F64(values)))));
        Ok(())
    }

    fn finish(mut self, end: Position) -> Result<(Soup, ReadReport), Fault> {
        let Some((count, coordinates)) = self.vertices else {
            return Err(Fault::new(end, ErrorKind::Truncated { expected: "the section vertices".into() }));
        };
        if let Some((vertex, position)) = self.greatest
            && vertex >= count
            && !self.intake.drops_bad()
        {
            let kind = ErrorKind::OutOfRange { index: vertex.into(), vertices: count.into(), first: 0 };
            return Err(Fault::new(position, kind));
        }
        let of_vertices = References::new(0, &self.intake.attributes);
        self.intake.references(of_vertices, self.references);
        Ok(self.intake.finish(Labels::Numbered(count as usize), true, coordinates))
    }
}

/// Reads the first line.
fn header(source: &mut Source<'_>) -> Result<(), Fault> {
    const EXPECTED: &str = "MFEM mesh v1.0, or a later version of 1";
    let mut line = source.need_content(COMMENT, EXPECTED)?;
    for expected in [&b"MFEM"[..], b"mesh"] {
        let word = line.need_word(EXPECTED)?;
        if word.bytes == b"NC" || word.bytes == b"NURBS" || word.bytes == b"INLINE" {
            let advice = "meshes that do not conform, NURBS and inline meshes are not read; let MFEM save a plain mesh";
            return Err(line.fault(word.at, ErrorKind::Unsupported(advice.into())));
        }
        if word.bytes != expected {
            return Err(line.unexpected(word, EXPECTED));
        }
    }
    let word = line.need_word(EXPECTED)?;
    if !word.bytes.starts_with(b"v1.") {
        return Err(line.unexpected(word, EXPECTED));
    }
    line.end()
}

/// Reads a mesh.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    header(source)?;
    let mut words = Words::new(source, COMMENT);
    let intake = Intake::new(Format::Mfem, options);
    let references = References::new(1, &intake.attributes);
    let mut mesh = Mesh { intake, references, num_cells: 0, greatest: None, named: 0, vertices: None };
    while let Some(mut line) = words.next()? {
        let word = line.need_word("a section")?;
        match word.bytes {
            b"dimension" => drop(words.integer::<u8>("the dimension, a small number")?),
            b"elements" | b"boundary" => mesh.elements(&mut words)?,
            b"vertices" if mesh.vertices.is_none() => mesh.read_vertices(&mut words)?,
            b"mfem_mesh_end" => words.end("file after mfem_mesh_end")?,
            // Functions on the elements: the rest of the file.
            b"nodes" if mesh.vertices.is_some() => {
                mesh.intake.report.ignored.note(b"nodes");
                break;
            }
            name if name.first().is_some_and(u8::is_ascii_alphabetic) && name != b"vertices" && name != b"nodes" => {
                mesh.intake.report.ignored.note(name);
                while words.first_byte()?.is_some_and(|first| !first.is_ascii_alphabetic()) {
                    words.next()?;
                }
            }
            _ => return Err(line.unexpected(word, "a section: dimension, elements, boundary, vertices, nodes")),
        }
    }
    let end = words.source.end_of_text();
    mesh.finish(end)
}
