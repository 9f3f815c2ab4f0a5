//! Readers of what Rips and witness complexes start from: points, distance matrices, weighted graphs.
//!
//! One file a family of formats; this module picks the reader by content, then by name, or as it is told
//! ([`SpaceOptions::format`]). As with meshes, readers stream, gzip, xz and zstd are decompressed on the way, and every error names
//! the input and the place in it. Points at one place are legal, and so are distances that break the triangle
//! inequality; numbers that are not finite are not.

mod binary;
mod detect;
mod dot;
mod edges;
mod graphml;
mod gudhi;
mod matrix;
mod npy;
mod row;
mod table;
#[cfg(test)]
mod tests;

use std::fmt;
use std::io::Read;
use std::path::Path;

use super::error::{ErrorKind, Fault, Position, ReadError};
use super::source::Source;
use super::{Compression, Format, ReadOptions};
use crate::distances::Distances;
use crate::graph::Graph;
use crate::points::Points;
use crate::soup::{Coordinates, Labels, Scalars};

/// A finite space as an input describes it.
#[derive(Clone, PartialEq, Debug)]
pub enum Space {
    /// Points by their coordinates; the metric is chosen later.
    Points(Points),
    /// Points by all their distances.
    Distances(Distances),
    /// Points by some of their distances: a graph, and what its vertices are called.
    Graph {
        /// The graph; its edges have weights unless the input gives none.
        graph: Graph,
        /// The labels of its vertices, by vertex number: integers increase, other labels are in bytewise order.
        labels: Labels,
    },
}

/// A format in which points, distances or graphs are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SpaceFormat {
    /// Points in text, one a line.
    Points,
    /// The vertices of a mesh, in any of the formats for meshes.
    Mesh,
    /// Points in a two-dimensional array of NumPy.
    Npy,
    /// Points in binary behind `PTS1`.
    Pts,
    /// All entries of a distance matrix, in text.
    Full,
    /// The part of a distance matrix below the diagonal, in text, as Ripser reads it.
    Lower,
    /// The part of a distance matrix above the diagonal, in text, as Ripser reads it.
    Upper,
    /// Some of the entries of a distance matrix, in text, as Ripser reads them.
    Sparse,
    /// The part of a distance matrix below the diagonal as 32-bit numbers, as Ripser reads it.
    LowerBinary,
    /// DIPHA's distance matrices, full or sparse.
    Dipha,
    /// The edges of a graph, by labels, in text.
    Edges,
    /// Graphviz' DOT.
    Dot,
    /// GraphML.
    GraphMl,
    /// The vertices and edges of a complex in the text of GUDHI's `Simplex_tree`, with their values as weights.
    Gudhi,
}

impl SpaceFormat {
    /// All formats, in the order in which help texts list them.
    pub const ALL: &'static [Self] = &[
        Self::Points,
        Self::Mesh,
        Self::Npy,
        Self::Pts,
        Self::Full,
        Self::Lower,
        Self::Upper,
        Self::Sparse,
        Self::LowerBinary,
        Self::Dipha,
        Self::Edges,
        Self::Dot,
        Self::GraphMl,
        Self::Gudhi,
    ];

    /// Those that give points by their coordinates.
    pub const OF_POINTS: &'static [Self] = &[Self::Points, Self::Mesh, Self::Npy, Self::Pts];

    /// The name of the format on a command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Points => "points",
            Self::Mesh => "mesh",
            Self::Npy => "npy",
            Self::Pts => "pts",
            Self::Full => "full",
            Self::Lower => "lower",
            Self::Upper => "upper",
            Self::Sparse => "sparse",
            Self::LowerBinary => "lower-binary",
            Self::Dipha => "dipha",
            Self::Edges => "edges",
            Self::Dot => "dot",
            Self::GraphMl => "graphml",
            Self::Gudhi => "gudhi",
        }
    }

    /// One line on what the format is.
    #[must_use]
    pub const fn description(self) -> &'static str {
        match self {
            Self::Points => {
                "points, one a line, numbers separated by commas, semicolons or blanks; perhaps a header line"
            }
            Self::Mesh => "the vertices of a mesh: OFF (also nOFF of any dimension), OBJ, PLY, VTU, …",
            Self::Npy => "points as the rows of a NumPy array of numbers, .npy",
            Self::Pts => "points in binary: PTS1, 32-bit dimension, 64-bit count, doubles, little-endian",
            Self::Full => "a distance matrix in text, a row a line",
            Self::Lower => "the rows of a distance matrix below the diagonal, with or without it",
            Self::Upper => "the rows of a distance matrix above the diagonal, with or without it",
            Self::Sparse => "entries of a distance matrix: lines i j d, points numbered from 0",
            Self::LowerBinary => "the rows of a distance matrix below the diagonal as 32-bit floats, little-endian",
            Self::Dipha => "DIPHA's distance matrix, full or sparse",
            Self::Edges => "a graph: lines u v or u v weight with any labels; a label alone is a vertex",
            Self::Dot => "a graph in Graphviz' DOT; weight=… gives the weights of edges",
            Self::GraphMl => "a graph in GraphML; data called weight give the weights of edges",
            Self::Gudhi => "the graph of a complex: GUDHI's simplex-tree text, lines 0 v value, 1 v w value, …",
        }
    }
}

impl fmt::Display for SpaceFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How to read a space. Make one by `SpaceOptions { format: Some(SpaceFormat::Npy), ..Default::default() }`.
#[derive(Clone, Copy, Default)]
pub struct SpaceOptions<'a> {
    /// The format; found by content, then by name, if it is not given.
    pub format: Option<SpaceFormat>,
    /// Whether the input is known to be a graph: rows of numbers are then read as edges or as GUDHI's text, where they could
    /// as well be points.
    pub is_graph: bool,
    /// Called now and then with the number of bytes read from the input, before decompression.
    pub progress: Option<&'a (dyn Fn(u64) + Sync)>,
}

impl fmt::Debug for SpaceOptions<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let progress = self.progress.is_some();
        f.debug_struct("SpaceOptions")
            .field("format", &self.format)
            .field("is_graph", &self.is_graph)
            .field("progress", &progress)
            .finish()
    }
}

/// What was found in an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct SpaceReport {
    /// The format in which the input was read.
    pub format: SpaceFormat,
    /// How the input was compressed, if it was.
    pub compression: Option<Compression>,
    /// Edges, or entries off the diagonal, that repeat another with the same weight.
    pub repeated: usize,
}

/// Reads the file at `path`, or standard input if `path` is `-`.
///
/// Time and memory are linear in the input.
///
/// # Errors
/// If the file cannot be read, if its format is not known, or if it breaks the rules of its format.
pub fn read_space_path(path: impl AsRef<Path>, options: &SpaceOptions<'_>) -> Result<(Space, SpaceReport), ReadError> {
    super::with_path(path.as_ref(), |reader, length, name| read_space(reader, length, name, options))
}

/// Reads an input that is in memory and called `name`, as [`read_space_path`] does.
///
/// # Errors
/// As [`read_space_path`].
pub fn read_space_bytes(
    bytes: &[u8],
    name: &str,
    options: &SpaceOptions<'_>,
) -> Result<(Space, SpaceReport), ReadError> {
    read_space(bytes, Some(bytes.len() as u64), name, options)
}

/// Reads a file, or standard input if `path` is `-`, that must hold points.
///
/// # Errors
/// As [`read_space_path`], and if the input gives distances only.
pub fn read_points_path(
    path: impl AsRef<Path>,
    options: &SpaceOptions<'_>,
) -> Result<(Points, SpaceReport), ReadError> {
    let path = path.as_ref();
    match read_space_path(path, options)? {
        (Space::Points(points), report) => Ok((points, report)),
        (_, report) => {
            let message =
                format!("this was read as `{}`, but points are needed; --format says what it is", report.format);
            let fault = Fault::new(Position::Whole, ErrorKind::Unsupported(message.into()));
            Err(fault.in_file(&path.to_string_lossy()))
        }
    }
}

/// Reads an input called `name`, of `length` bytes if that is known, as [`read_space_path`] does.
///
/// # Errors
/// As [`read_space_path`].
pub fn read_space(
    reader: impl Read,
    length: Option<u64>,
    name: &str,
    options: &SpaceOptions<'_>,
) -> Result<(Space, SpaceReport), ReadError> {
    let run = || {
        Source::new(reader, length, options.progress)?.reading(|source| {
            let format = match options.format {
                Some(format) => format,
                None => detect::format(source, name, options.is_graph)?,
            };
            let mut repeated = 0;
            let space = match format {
                SpaceFormat::Points => Space::Points(table::read(source)?),
                SpaceFormat::Mesh => Space::Points(mesh(source, name)?),
                SpaceFormat::Npy => Space::Points(npy::read(source)?),
                SpaceFormat::Pts => Space::Points(binary::pts(source)?),
                SpaceFormat::Full => Space::Distances(matrix::full(source)?),
                SpaceFormat::Lower => Space::Distances(matrix::lower(source)?),
                SpaceFormat::Upper => Space::Distances(matrix::upper(source)?),
                SpaceFormat::LowerBinary => Space::Distances(binary::lower(source)?),
                SpaceFormat::Dipha => binary::dipha(source, &mut repeated)?,
                SpaceFormat::Sparse => edges::sparse(source, &mut repeated)?,
                SpaceFormat::Edges => edges::list(source, &mut repeated)?,
                SpaceFormat::Dot => dot::read(source, &mut repeated)?,
                SpaceFormat::GraphMl => graphml::read(source, &mut repeated)?,
                SpaceFormat::Gudhi => gudhi::read(source)?,
            };
            Ok((space, SpaceReport { format, compression: source.compression, repeated }))
        })
    };
    run().map_err(|fault: Fault| fault.in_file(super::displayed(name)))
}

/// The vertices of a mesh.
fn mesh(source: &mut Source<'_>, name: &str) -> Result<Points, Fault> {
    let format = super::detect::format(source, name)?;
    let options = ReadOptions { drop_degenerate: true, ..ReadOptions::default() };
    let (soup, _) = super::read_as(format, source, &options)?;
    let Some(Coordinates { dim, values }) = soup.coordinates.filter(|_| format != Format::SimplexList) else {
        let message = "a list of simplices has no coordinates";
        return Err(Fault::new(Position::Whole, ErrorKind::Unsupported(message.into())));
    };
    let values = match values {
        Scalars::F32(values) => values.into_iter().map(f64::from).collect(),
        Scalars::F64(values) => values,
    };
    points(dim, values)
}

/// Values that the readers have checked, as points.
fn points(dim: usize, values: Vec<f64>) -> Result<Points, Fault> {
    let kind = |error: crate::points::PointsError| ErrorKind::Unsupported(error.to_string().into());
    Points::new(dim, values).map_err(|error| Fault::new(Position::Whole, kind(error)))
}

/// Values that the readers have checked, as distances.
fn distances(len: usize, lower: Vec<f64>) -> Result<Distances, Fault> {
    let kind = |error: crate::distances::DistancesError| ErrorKind::Unsupported(error.to_string().into());
    Distances::new(len, lower).map_err(|error| Fault::new(Position::Whole, kind(error)))
}
