//! TetGen's files: points in `.node`, tetrahedra in `.ele`, triangles in `.face`, edges in `.edge`, numbered from 0 or 1.
//!
//! A file of cells needs the `.node` beside it; a `.node` brings the files of cells that lie beside it. Tetrahedra of 10
//! nodes stand for their corners. Triangle's files of points in the plane are read too.
//!
//! The numbers that follow a node or a tetrahedron are the components of the attribute `attribute`, for the format has no
//! names; boundary markers of nodes, triangles and edges are the attribute `ref`.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::attributes::{Attributes, References};
use super::error::{ErrorKind, Fault, Position, ReadError};
use super::intake::{Intake, reserve};
use super::shape::Shape;
use super::source::Source;
use super::text::{Line, parse_number};
use super::{Format, ReadOptions, ReadReport};
use crate::attribute::{NAMELESS, Values};
use crate::soup::{Labels, Scalars, Soup};

const COMMENT: Option<u8> = Some(b'#');

/// A mesh as far as it is read.
struct Mesh {
    /// The number of the first node.
    first: u8,
    nodes: u32,
    dim: usize,
    values: Vec<f64>,
    of_vertices: References,
    of_cells: References,
    /// The cells of the files before.
    num_cells: usize,
    intake: Intake,
}

/// The numbers behind the nodes or the cells of a file.
struct Numbers {
    components: usize,
    values: Vec<f64>,
    /// Whether a boundary marker comes after them.
    has_marker: bool,
}

impl Numbers {
    /// As many as the first line of the file says.
    const fn new(components: u32, markers: u32) -> Self {
        Self { components: components as usize, values: Vec::new(), has_marker: markers > 0 }
    }

    /// Reads those of a line, to its end, and gives the marker, 0 for want of one.
    fn read(&mut self, line: &mut Line<'_>, attributes: &Attributes) -> Result<i64, Fault> {
        for _ in 0..self.components {
            const EXPECTED: &str = "an attribute, a number, as many as the first line says";
            let word = line.need_word(EXPECTED)?;
            let value = parse_number(word.bytes).ok_or_else(|| line.unexpected(word, EXPECTED))?;
            if attributes.are_kept() {
                self.values.push(value);
            }
        }
        let marker = if self.has_marker { line.integer("a boundary marker, an integer")? } else { 0 };
        // Two tetrahedra may follow a triangle.
        pass_numbers(line)?;
        Ok(marker)
    }

    /// The attribute that the numbers are, with its components; `None` if there are none, or none is kept.
    fn attribute(self, intake: &mut Intake) -> Option<(usize, Values)> {
        if self.components > 0 && !intake.attributes.are_kept() {
            intake.pass_over(NAMELESS.as_bytes());
            return None;
        }
        (self.components > 0).then_some((self.components, Values::F64(self.values)))
    }
}

/// The rest of a line of numbers.
fn pass_numbers(line: &mut Line<'_>) -> Result<(), Fault> {
    while line.skip_blanks() {
        line.float::<f64>("numbers to the end of the line")?;
    }
    Ok(())
}

/// The files of cells.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Cells {
    Tetrahedra,
    Triangles,
    Edges,
}

impl Cells {
    const ALL: [Self; 3] = [Self::Tetrahedra, Self::Triangles, Self::Edges];

    const fn extension(self) -> &'static str {
        match self {
            Self::Tetrahedra => "ele",
            Self::Triangles => "face",
            Self::Edges => "edge",
        }
    }
}

/// The numbers of the first line; those that are not there are 0, but not the first `needed`.
fn counts<const N: usize>(source: &mut Source<'_>, needed: usize, expected: &'static str) -> Result<[u32; N], Fault> {
    let mut line = source.need_content(COMMENT, expected)?;
    let mut counts = [0; N];
    for (place, count) in counts.iter_mut().enumerate() {
        if place < needed || line.skip_blanks() {
            *count = line.integer(expected)?;
        }
    }
    pass_numbers(&mut line)?;
    Ok(counts)
}

impl Mesh {
    fn read_nodes(&mut self, source: &mut Source<'_>) -> Result<(), Fault> {
        const EXPECTED: &str =
            "the numbers of nodes (below 2^32), of their coordinates, 2 or 3, of their attributes and of their markers";
        let [nodes, dim, attributes, markers] = counts(source, 2, EXPECTED)?;
        if !(2..=3).contains(&dim) {
            let kind = ErrorKind::Unsupported(format!("nodes of {dim} coordinates are not read, but of 2 or 3").into());
            return Err(Fault::new(source.end_of_text(), kind));
        }
        self.dim = dim as usize;
        self.nodes = nodes;
        self.values.reserve(reserve(u64::from(nodes) * 3));
        let mut numbers = Numbers::new(attributes, markers);
        for number in 0..nodes {
            let mut line = source.need_content(COMMENT, "as many nodes as the first line says")?;
            let word = line.need_word("the number of the node")?;
            let tag: u64 = line.parse_integer(word, "the number of the node")?;
            if number == 0 {
                self.first = u8::from(tag == 1);
            }
            let due = u64::from(number) + u64::from(self.first);
            if tag != due {
                return Err(line.unexpected(word, format!("{due}, as nodes are numbered one after the other")));
            }
            for _ in 0..dim {
                self.values.push(line.float("a coordinate of the node")?);
            }
            self.of_vertices.push(numbers.read(&mut line, &self.intake.attributes)?);
        }
        if let Some((components, values)) = numbers.attribute(&mut self.intake) {
            self.intake.vertex_attribute(NAMELESS, components, values);
        }
        source.need_end(COMMENT, "file after the last node")
    }

    fn read_cells(&mut self, source: &mut Source<'_>, cells: Cells) -> Result<(), Fault> {
        let (count, shape, mut numbers) = match cells {
            Cells::Tetrahedra => {
                const EXPECTED: &str = "the numbers of tetrahedra, of their nodes, 4 or 10, and of their attributes";
                let [count, nodes, attributes] = counts(source, 2, EXPECTED)?;
                let shape = match (nodes, self.dim) {
                    (4, 3) => Shape::simplex(4, 4),
                    (10, _) => Shape::simplex(4, 10),
                    (3, 2) => Shape::simplex(3, 3),
                    (6, _) => Shape::simplex(3, 6),
                    _ => {
                        let message = format!("cells of {nodes} nodes are not read");
                        return Err(Fault::new(source.end_of_text(), ErrorKind::Unsupported(message.into())));
                    }
                };
                (count, shape, Numbers::new(attributes, 0))
            }
            Cells::Triangles => {
                let [count, markers] = counts(source, 1, "the number of triangles, and of their markers")?;
                (count, Shape::simplex(3, 3), Numbers::new(0, markers))
            }
            Cells::Edges => {
                let [count, markers] = counts(source, 1, "the number of edges, and of their markers")?;
                (count, Shape::simplex(2, 2), Numbers::new(0, markers))
            }
        };
        let first = self.num_cells;
        let mut nodes = Vec::new();
        for _ in 0..count {
            let mut line = source.need_content(COMMENT, "as many cells as the first line says")?;
            line.skip_blanks();
            let start = line.at();
            line.integer::<i64>("the number of the cell")?;
            nodes.clear();
            for _ in 0..shape.num_nodes {
                nodes.push(self.node(&mut line)?);
            }
            self.of_cells.push(numbers.read(&mut line, &self.intake.attributes)?);
            self.intake.attributes.begin_cell(self.num_cells);
            self.num_cells += 1;
            let label = |vertex: u32| u64::from(vertex) + u64::from(self.first);
            let added = self.intake.element(shape, &nodes, label);
            added.map_err(|refusal| line.fault(start, refusal.kind(|vertex| label(vertex).to_string())))?;
        }
        if let Some((components, values)) = numbers.attribute(&mut self.intake) {
            self.intake.cell_attribute(NAMELESS, components, values, first);
        }
        source.need_end(COMMENT, "file after the last cell")
    }

    fn node(&mut self, line: &mut Line<'_>) -> Result<u32, Fault> {
        let word = line.need_word("as many nodes as the cell has")?;
        let index: i64 = line.parse_integer(word, "the number of a node")?;
        match u32::try_from(index.saturating_sub(self.first.into())) {
            Ok(vertex) if vertex < self.nodes => Ok(vertex),
            _ => {
                let kind = ErrorKind::OutOfRange { index, vertices: self.nodes.into(), first: self.first };
                self.intake.missing(line.fault(word.at, kind))
            }
        }
    }

    fn finish(mut self) -> (Soup, ReadReport) {
        self.intake.references(self.of_vertices, self.of_cells);
        let labels = match self.first {
            0 => Labels::Numbered(self.nodes as usize),
            _ => Labels::Integers((1..=u64::from(self.nodes)).collect()),
        };
        self.intake.finish(labels, true, Some((self.dim, Scalars::F64(self.values))))
    }
}

fn mesh(options: &ReadOptions<'_>) -> Mesh {
    let intake = Intake::new(Format::Tetgen, options);
    let [of_vertices, of_cells] = [0, 0].map(|absent| References::new(absent, &intake.attributes));
    Mesh { first: 0, nodes: 0, dim: 3, values: Vec::new(), of_vertices, of_cells, num_cells: 0, intake }
}

/// Reads a `.node` file alone: points.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let mut mesh = mesh(options);
    mesh.read_nodes(source)?;
    Ok(mesh.finish())
}

/// Reads the file at `path` and those that belong to it, which lie beside it.
///
/// # Errors
/// As [`super::read_path`], in the name of the file in which the error is.
pub(super) fn read_files(path: &Path, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), ReadError> {
    // As in `a.1.node.gz`.
    let name = path.to_string_lossy();
    let plain = super::compression::without_suffix(&name);
    let packed = &name[plain.len()..];
    let (stem, extension) = plain.rsplit_once('.').unwrap_or((plain, ""));
    let beside = |extension: &str| PathBuf::from(format!("{stem}.{extension}{packed}"));
    let named = Cells::ALL.into_iter().find(|cells| extension.eq_ignore_ascii_case(cells.extension()));
    let mut mesh = mesh(options);
    let nodes = if named.is_some() { beside("node") } else { path.to_owned() };
    let compression = with_file(&nodes, options, |source| {
        mesh.read_nodes(source)?;
        Ok(source.compression)
    })?;
    mesh.intake.report.compression = compression;
    for cells in Cells::ALL {
        let file = if named == Some(cells) { path.to_owned() } else { beside(cells.extension()) };
        if named.map_or(file != nodes && file.exists(), |named| named == cells) {
            with_file(&file, options, |source| mesh.read_cells(source, cells))?;
        }
    }
    Ok(mesh.finish())
}

fn with_file<T>(
    path: &Path,
    options: &ReadOptions<'_>,
    read: impl FnOnce(&mut Source<'_>) -> Result<T, Fault>,
) -> Result<T, ReadError> {
    let run = || {
        let failed = |error| Fault::new(Position::Whole, ErrorKind::Io(error));
        let file = File::open(path).map_err(failed)?;
        Source::new(file, None, options.progress)?.on_bad(options.on_bad).reading(read)
    };
    run().map_err(|fault: Fault| fault.in_file(&path.to_string_lossy()))
}
