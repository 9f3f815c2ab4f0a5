//! TetGen's files: points in `.node`, tetrahedra in `.ele`, triangles in `.face`, edges in `.edge`, numbered from 0 or 1.
//!
//! A file of cells needs the `.node` beside it; a `.node` brings the files of cells that lie beside it. Tetrahedra of 10
//! nodes stand for their corners. Attributes and boundary markers are passed over. Triangle's files of points in the plane
//! are read too.

use std::fs::File;
use std::path::{Path, PathBuf};

use super::error::{ErrorKind, Fault, Position, ReadError};
use super::intake::{Intake, reserve};
use super::shape::Shape;
use super::source::Source;
use super::text::Line;
use super::{Format, ReadOptions, ReadReport};
use crate::soup::{Labels, Scalars, Soup};

const COMMENT: Option<u8> = Some(b'#');

/// A mesh as far as it is read.
struct Mesh {
    /// The number of the first node.
    first: u8,
    nodes: u32,
    dim: usize,
    values: Vec<f64>,
    intake: Intake,
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

/// The rest of a line of numbers: attributes, markers.
fn pass_numbers(line: &mut Line<'_>) -> Result<(), Fault> {
    while line.skip_blanks() {
        line.float::<f64>("an attribute or a marker, which are numbers")?;
    }
    Ok(())
}

/// The numbers at the start of the first line.
fn counts<const N: usize>(source: &mut Source<'_>, expected: &'static str) -> Result<[u32; N], Fault> {
    let mut line = source.need_content(COMMENT, expected)?;
    let mut counts = [0; N];
    for count in &mut counts {
        *count = line.integer(expected)?;
    }
    pass_numbers(&mut line)?;
    Ok(counts)
}

impl Mesh {
    fn read_nodes(&mut self, source: &mut Source<'_>) -> Result<(), Fault> {
        let [nodes, dim] = counts(source, "the numbers of nodes (below 2^32) and of their coordinates, 2 or 3")?;
        if !(2..=3).contains(&dim) {
            let kind = ErrorKind::Unsupported(format!("nodes of {dim} coordinates are not read, but of 2 or 3").into());
            return Err(Fault::new(source.end_of_text(), kind));
        }
        self.dim = dim as usize;
        self.nodes = nodes;
        self.values.reserve(reserve(u64::from(nodes) * 3));
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
            pass_numbers(&mut line)?;
        }
        source.need_end(COMMENT, "file after the last node")
    }

    fn read_cells(&mut self, source: &mut Source<'_>, cells: Cells) -> Result<(), Fault> {
        let (count, shape) = match cells {
            Cells::Tetrahedra => {
                let [count, nodes] = counts(source, "the numbers of tetrahedra and of their nodes, 4 or 10")?;
                match (nodes, self.dim) {
                    (4, 3) => (count, Shape::simplex(4, 4)),
                    (10, _) => (count, Shape::simplex(4, 10)),
                    (3, 2) => (count, Shape::simplex(3, 3)),
                    (6, _) => (count, Shape::simplex(3, 6)),
                    _ => {
                        let message = format!("cells of {nodes} nodes are not read");
                        return Err(Fault::new(source.end_of_text(), ErrorKind::Unsupported(message.into())));
                    }
                }
            }
            Cells::Triangles => (counts::<1>(source, "the number of triangles")?[0], Shape::simplex(3, 3)),
            Cells::Edges => (counts::<1>(source, "the number of edges")?[0], Shape::simplex(2, 2)),
        };
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
            pass_numbers(&mut line)?;
            let label = |vertex: u32| u64::from(vertex) + u64::from(self.first);
            let added = self.intake.element(shape, &nodes, label);
            added.map_err(|refusal| line.fault(start, refusal.kind(|vertex| label(vertex).to_string())))?;
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

    fn finish(self) -> (Soup, ReadReport) {
        let labels = match self.first {
            0 => Labels::Numbered(self.nodes as usize),
            _ => Labels::Integers((1..=u64::from(self.nodes)).collect()),
        };
        self.intake.finish(labels, true, Some((self.dim, Scalars::F64(self.values))))
    }
}

fn mesh(options: &ReadOptions<'_>) -> Mesh {
    Mesh { first: 0, nodes: 0, dim: 3, values: Vec::new(), intake: Intake::new(Format::Tetgen, options) }
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
