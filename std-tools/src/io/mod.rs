//! Readers: meshes and lists of simplices as [`Soup`]s, for [`crate::build`] to make complexes of.
//!
//! One file a format, one registry: this module picks the reader by content, then by name, or as it is told
//! ([`ReadOptions::format`]), and puts the name of the input before every error. Readers stream: their memory is
//! bounded by the vertices and simplices that the input holds, whatever its headers declare and however much text
//! stands between. Gzip input is decompressed on the way.
//!
//! `io` knows files and soups; it knows nothing of complexes.

pub(crate) mod cells;
mod cone;
mod detect;
mod error;
pub(crate) mod gudhi;
mod intake;
mod labels;
mod merge;
mod msh;
mod obj;
mod off;
mod ply;
mod report;
mod simplex_list;
mod source;
pub mod space;
mod stl;
#[cfg(test)]
mod tests;
mod text;

use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::Path;

pub use error::{ErrorKind, Position, ReadError};
pub use merge::{MergeError, MergeReport, Renumbered, merge};
pub use report::{Ignored, ReadReport};

use crate::soup::Soup;
use error::Fault;
use source::Source;

/// A file format that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Geomview's Object File Format and its variants, in text.
    Off,
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY, in text and both binary byte orders.
    Ply,
    /// STL, in text and binary.
    Stl,
    /// Gmsh's MSH 2.2 and 4.1, in text and binary.
    Msh,
    /// One simplex a line, or lists of lists in brackets.
    SimplexList,
}

impl Format {
    /// All formats, in the order in which help texts list them.
    pub const ALL: &'static [Self] = &[Self::Off, Self::Obj, Self::Ply, Self::Stl, Self::Msh, Self::SimplexList];

    /// The name of the format on a command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Off => "off",
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Stl => "stl",
            Self::Msh => "msh",
            Self::SimplexList => "simplices",
        }
    }

    /// The extensions of file names that stand for the format, in lower case, without the dot.
    #[must_use]
    pub const fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Off => &["off", "coff", "noff", "cnoff"],
            Self::Obj => &["obj"],
            Self::Ply => &["ply"],
            Self::Stl => &["stl", "stla", "stlb"],
            Self::Msh => &["msh", "msh2", "msh4", "gmsh"],
            Self::SimplexList => &["simplices", "facets", "lst", "txt"],
        }
    }

    /// One line on what the format is.
    #[must_use]
    pub const fn description(self) -> &'static str {
        match self {
            Self::Off => "Geomview OFF and its variants COFF, NOFF, 4OFF, nOFF, in text",
            Self::Obj => "Wavefront OBJ: faces, lines and points",
            Self::Ply => "Stanford PLY, in text or binary: faces, edges and triangle strips",
            Self::Stl => "STL, in text or binary; corners with equal coordinates are welded",
            Self::Msh => "Gmsh MSH 2.2 and 4.1, in text or binary, cells of all dimensions",
            Self::SimplexList => "one simplex a line by its vertex labels, or lists of lists like [[1,2,3],[2,3,4]]",
        }
    }

    /// The format with this name or extension, upper and lower case being the same.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        Self::ALL.iter().copied().find(|format| format.name() == name || format.extensions().contains(&&*name))
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// How to read. Make one by `ReadOptions { format: Some(Format::Off), ..Default::default() }`.
#[derive(Clone, Copy, Default)]
pub struct ReadOptions<'a> {
    /// The format; found by content, then by name, if it is not given.
    pub format: Option<Format>,
    /// Drop simplices that repeat a vertex, and count them, instead of refusing the input.
    pub drop_degenerate: bool,
    /// Called now and then with the number of bytes read from the input, before decompression.
    pub progress: Option<&'a (dyn Fn(u64) + Sync)>,
}

impl fmt::Debug for ReadOptions<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ReadOptions")
            .field("format", &self.format)
            .field("drop_degenerate", &self.drop_degenerate)
            .field("progress", &self.progress.is_some())
            .finish()
    }
}

/// Reads the file at `path`, or standard input if `path` is `-`.
///
/// Takes time linear in the input, and memory linear in its vertices and simplices.
///
/// # Errors
/// If the file cannot be read, if its format is not known, or if it breaks the rules of its format.
pub fn read_path(path: impl AsRef<Path>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), ReadError> {
    with_path(path.as_ref(), |reader, length, name| read_sized(reader, length, name, options))
}

/// Opens the file at `path`, or standard input if `path` is `-`, and reads it by `read`, which is told the length, if it
/// is known, and the name.
fn with_path<T>(
    path: &Path,
    read: impl FnOnce(Box<dyn Read>, Option<u64>, &str) -> Result<T, ReadError>,
) -> Result<T, ReadError> {
    if path.as_os_str() == "-" {
        return read(Box::new(std::io::stdin().lock()), None, "-");
    }
    let name = path.to_string_lossy();
    let failed = |error| Fault::new(Position::Whole, ErrorKind::Io(error)).in_file(&name);
    let file = File::open(path).map_err(failed)?;
    let metadata = file.metadata().map_err(failed)?;
    let length = metadata.is_file().then_some(metadata.len());
    read(Box::new(file), length, &name)
}

/// What errors call an input.
fn displayed(name: &str) -> &str {
    if name == "-" { "<stdin>" } else { name }
}

/// Reads an input that is called `name` in errors and, for want of a better clue, in finding the format.
///
/// The reader is asked for large blocks, so it need not be buffered. Costs as [`read_path`].
///
/// # Errors
/// As [`read_path`].
pub fn read(reader: impl Read, name: &str, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), ReadError> {
    read_sized(reader, None, name, options)
}

/// Reads an input that is in memory, as [`read`] does.
///
/// # Errors
/// As [`read_path`].
pub fn read_bytes(bytes: &[u8], name: &str, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), ReadError> {
    read_sized(bytes, Some(bytes.len() as u64), name, options)
}

fn read_sized(
    reader: impl Read,
    length: Option<u64>,
    name: &str,
    options: &ReadOptions<'_>,
) -> Result<(Soup, ReadReport), ReadError> {
    let run = || {
        let mut source = Source::new(reader, length, options.progress)?;
        let format = match options.format {
            Some(format) => format,
            None => detect::format(&mut source, name)?,
        };
        let (soup, mut report) = read_as(format, &mut source, options)?;
        report.gzip = source.gzip;
        Ok((soup, report))
    };
    run().map_err(|fault: Fault| fault.in_file(displayed(name)))
}

/// Reads an input of the given format.
fn read_as(format: Format, source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    match format {
        Format::Off => off::read(source, options),
        Format::Obj => obj::read(source, options),
        Format::Ply => ply::read(source, options),
        Format::Stl => stl::read(source, options),
        Format::Msh => msh::read(source, options),
        Format::SimplexList => simplex_list::read(source, options),
    }
}
