//! MEDIT's `.mesh` in text: sections of a keyword, a count and as many rows, each row closed by a reference number:
//! the attribute `ref` of vertices and cells.
//!
//! Cells of all dimensions are read, those of higher order by their corners. Vertices are numbered from 1. Sections of
//! geometry (ridges, normals, required entities, …) are passed over. Binary files (`.meshb`) are not read.

use super::attributes::References;
use super::error::{ErrorKind, Fault};
use super::intake::{Intake, reserve};
use super::shape::Shape;
use super::source::Source;
use super::words::Words;
use super::{Format, ReadOptions, ReadReport};
use crate::soup::{Labels, Scalars, Soup};

const COMMENT: Option<u8> = Some(b'#');

/// The word that a file begins with.
pub(super) const KEYWORD: &[u8] = b"MeshVersionFormatted";

/// The sections of cells.
const CELLS: &[(&[u8], Shape)] = &[
    (b"Edges", Shape::simplex(2, 2)),
    (b"EdgesP2", Shape::simplex(2, 3)),
    (b"Triangles", Shape::simplex(3, 3)),
    (b"TrianglesP2", Shape::simplex(3, 6)),
    (b"Quadrilaterals", Shape::quadrangle(4)),
    (b"QuadrilateralsQ2", Shape::quadrangle(9)),
    (b"Tetrahedra", Shape::simplex(4, 4)),
    (b"TetrahedraP2", Shape::simplex(4, 10)),
    (b"Hexahedra", Shape::hexahedron(8)),
    (b"HexahedraQ2", Shape::hexahedron(27)),
    (b"Prisms", Shape::prism(6)),
    (b"Pentahedra", Shape::prism(6)),
    (b"PrismsP2", Shape::prism(18)),
    (b"Pyramids", Shape::pyramid(5)),
    (b"PyramidsP2", Shape::pyramid(14)),
];

/// Sections that say nothing about the complex and are not worth a word in the report.
const PASSED_OVER: &[&[u8]] = &[
    b"Corners",
    b"Ridges",
    b"RequiredVertices",
    b"RequiredEdges",
    b"RequiredTriangles",
    b"RequiredQuadrilaterals",
    b"Normals",
    b"NormalAtVertices",
    b"Tangents",
    b"TangentAtVertices",
    b"Identifier",
    b"Geometry",
];

/// A mesh as far as it is read.
struct Mesh {
    dim: usize,
    /// `None` before the section of vertices.
    values: Option<Vec<f64>>,
    vertices: u32,
    intake: Intake,
    of_vertices: References,
    of_cells: References,
    num_cells: usize,
}

impl Mesh {
    fn read_vertices(&mut self, words: &mut Words<'_, '_>) -> Result<(), Fault> {
        let count: u32 = words.integer("the number of vertices (below 2^32)")?;
        let mut values = Vec::with_capacity(reserve(u64::from(count) * self.dim as u64));
        for _ in 0..count {
            for _ in 0..self.dim {
                values.push(words.float("a coordinate of a vertex, as many vertices as the section says")?);
            }
            self.of_vertices.push(words.integer("the reference of the vertex, an integer")?);
        }
        (self.values, self.vertices) = (Some(values), count);
        Ok(())
    }

    fn read_cells(&mut self, words: &mut Words<'_, '_>, shape: Shape) -> Result<(), Fault> {
        let count: u64 = words.integer("the number of cells")?;
        let mut nodes = vec![0; shape.num_nodes];
        for _ in 0..count {
            words.first_byte()?;
            let position = words.source.end_of_text();
            for node in &mut nodes {
                let found = words.vertex(1, self.vertices, "a vertex of a cell, as many cells as the section says");
                *node = found.or_else(|fault| self.intake.missing(fault))?;
            }
            self.of_cells.push(words.integer("the reference of the cell, an integer")?);
            self.intake.attributes.begin_cell(self.num_cells);
            self.num_cells += 1;
            let label = |vertex: u32| u64::from(vertex) + 1;
            self.intake.element(shape, &nodes, label).map_err(|refusal| {
                let kind = refusal.kind(|vertex| label(vertex).to_string());
                Fault::new(position, kind)
            })?;
        }
        Ok(())
    }

    /// Passes over the numbers up to the next keyword.
    fn pass_over(&mut self, words: &mut Words<'_, '_>, name: &[u8]) -> Result<(), Fault> {
        if !PASSED_OVER.contains(&name) {
            self.intake.report.ignored.note(name);
        }
        while words.first_byte()?.is_some_and(|first| !first.is_ascii_alphabetic()) {
            words.next()?;
        }
        Ok(())
    }
}

/// Reads the version and the dimension.
fn header(words: &mut Words<'_, '_>) -> Result<usize, Fault> {
    let mut line = words.need("MeshVersionFormatted")?;
    let word = line.need_word("MeshVersionFormatted")?;
    if !word.bytes.eq_ignore_ascii_case(KEYWORD) {
        return Err(line.unexpected(word, "MeshVersionFormatted"));
    }
    words.integer::<u8>("the version, a small integer")?;
    let mut line = words.need("Dimension")?;
    let word = line.need_word("Dimension")?;
    if word.bytes != b"Dimension" {
        return Err(line.unexpected(word, "Dimension"));
    }
    let mut line = words.need("the dimension, 2 or 3")?;
    let word = line.need_word("the dimension, 2 or 3")?;
    match word.bytes {
        b"2" => Ok(2),
        b"3" => Ok(3),
        _ => Err(line.unexpected(word, "the dimension, 2 or 3")),
    }
}

/// Reads a MEDIT file.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let mut words = Words::new(source, COMMENT);
    let dim = header(&mut words)?;
    let intake = Intake::new(Format::Medit, options);
    let [of_vertices, of_cells] = [References::new(0, &intake.attributes), References::new(0, &intake.attributes)];
    let mut mesh = Mesh { dim, values: None, vertices: 0, intake, of_vertices, of_cells, num_cells: 0 };
    while let Some(mut line) = words.next()? {
        let word = line.need_word("a keyword")?;
        let cells = CELLS.iter().find(|(name, _)| *name == word.bytes);
        match (word.bytes, cells, mesh.values.is_some()) {
            (b"End", ..) => {
                words.end("file after End")?;
                break;
            }
            (b"Vertices", _, false) => mesh.read_vertices(&mut words)?,
            (b"Vertices", _, true) => return Err(line.unexpected(word, "one section of vertices")),
            (_, Some(&(_, shape)), true) => mesh.read_cells(&mut words, shape)?,
            (_, Some(_), false) => return Err(line.unexpected(word, "the section Vertices before those of cells")),
            (name, None, _) if name.first().is_some_and(u8::is_ascii_alphabetic) => {
                let name = name.to_vec();
                mesh.pass_over(&mut words, &name)?;
            }
            _ => return Err(line.unexpected(word, "a keyword, like Triangles, or End")),
        }
    }
    let Some(values) = mesh.values else {
        let position = words.source.end_of_text();
        return Err(Fault::new(position, ErrorKind::Truncated { expected: "the section Vertices".into() }));
    };
    let labels = Labels::Integers((1..=u64::from(mesh.vertices)).collect());
    mesh.intake.references(mesh.of_vertices, mesh.of_cells);
    Ok(mesh.intake.finish(labels, true, Some((dim, Scalars::F64(values)))))
}
