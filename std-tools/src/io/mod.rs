//! Readers: meshes and lists of simplices as [`Soup`]s, for [`crate::build`] to make complexes of.
//!
//! One file a format ([`Format`] lists them), one registry: this module picks the reader by content, then by name, or as it is told
//! ([`ReadOptions::format`]), and puts the name of the input before every error. Readers stream: their memory is
//! bounded by the vertices and simplices that the input holds, whatever its headers declare and however much text
//! stands between. Input compressed by gzip, xz or zstd is decompressed on the way.
//!
//! `io` knows files and soups; it knows nothing of complexes.

mod abaqus;
mod attributes;
pub(crate) mod cells;
mod compression;
mod cone;
mod detect;
mod error;
mod format;
pub(crate) mod gudhi;
mod intake;
mod labels;
mod medit;
mod merge;
mod mfem;
mod msh;
mod nastran;
mod obj;
mod off;
mod ply;
mod report;
mod shape;
mod simplex_list;
mod source;
pub mod space;
mod stl;
mod tagged;
mod tags;
#[cfg(test)]
mod tests;
mod tetbin;
mod tetgen;
mod text;
mod tops;
mod volume;
mod vtk;
mod weld;
mod words;

use std::fmt;
use std::fs::File;
use std::io::Read;
use std::path::Path;

pub use compression::Compression;
pub use error::{ErrorKind, Excerpt, Position, ReadError};
pub use format::Format;
pub use merge::{MergeError, MergeReport, Renumbered, merge};
pub use report::{Ignored, ReadReport};
pub use volume::{Endian, read_volume_path};
pub use weld::Weld;

use crate::soup::Soup;
use crate::spool::Spill;
use error::Fault;
use source::Source;

/// What becomes of cells and vertices that cannot be part of a complex.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum OnBad {
    /// The input is refused.
    #[default]
    Refuse,
    /// They are dropped and counted, and the first are named: cells that repeat a vertex or name one that is not there,
    /// vertices whose coordinates are not finite, and the cells at these.
    Drop,
}

/// How to read. Make one by `ReadOptions { format: Some(Format::Off), ..Default::default() }`.
#[derive(Clone, Copy, Default)]
pub struct ReadOptions<'a> {
    /// The format; found by content, then by name, if it is not given.
    pub format: Option<Format>,
    /// Drop simplices that repeat a vertex, and count them, instead of refusing the input.
    pub drop_degenerate: bool,
    /// What becomes of cells that name a vertex which is not there, and of vertices whose coordinates are not finite.
    pub on_bad: OnBad,
    /// Pass over the attributes of vertices and cells, which else are kept, or refused where they do not go into memory.
    pub drop_attributes: bool,
    /// Where the simplices go instead of memory, for a complex larger than that; the soup then has none.
    pub spill: Option<&'a Spill>,
    /// Which vertices become one; by default the corners of STL's triangles with equal coordinates, and no others.
    pub weld: Option<Weld>,
    /// Called now and then with the number of bytes read from the input, before decompression.
    pub progress: Option<&'a (dyn Fn(u64) + Sync)>,
}

impl ReadOptions<'_> {
    /// Whether simplices that repeat a vertex are dropped.
    const fn drops_degenerate(&self) -> bool {
        self.drop_degenerate || matches!(self.on_bad, OnBad::Drop)
    }
}

impl fmt::Debug for ReadOptions<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ReadOptions")
            .field("format", &self.format)
            .field("drop_degenerate", &self.drop_degenerate)
            .field("on_bad", &self.on_bad)
            .field("drop_attributes", &self.drop_attributes)
            .field("spill", &self.spill.is_some())
            .field("weld", &self.weld)
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
    let path = path.as_ref();
    let name = path.to_string_lossy();
    // The one format whose meshes are several files.
    if name != "-" && options.format.or_else(|| detect::by_name(&name)) == Some(Format::Tetgen) {
        let read = tetgen::read_files(path, options)?;
        return welded(read, options).map_err(|fault| fault.in_file(&name));
    }
    with_path(path, |reader, length, name| read_sized(reader, length, name, options))
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
        Source::new(reader, length, options.progress)?.on_bad(options.on_bad).reading(|source| {
            let format = match options.format {
                Some(format) => format,
                None => detect::format(source, name)?,
            };
            let (soup, mut report) = read_as(format, source, options)?;
            report.compression = source.compression;
            welded((soup, report), options)
        })
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
        Format::Vtk => vtk::read_legacy(source, options),
        Format::Vtu => vtk::read_xml(source, options),
        Format::Medit => medit::read(source, options),
        Format::Mfem => mfem::read(source, options),
        Format::Tetgen => tetgen::read(source, options),
        Format::Abaqus => abaqus::read(source, options),
        Format::Nastran => nastran::read(source, options),
        Format::Tetbin => tetbin::read(source, options),
        Format::Tops => tops::read(source, options),
        Format::SimplexList => simplex_list::read(source, options),
    }
}

/// Refuses attributes that were read for the disk, and welds what was read, if so told.
fn welded((mut soup, mut report): (Soup, ReadReport), options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    if !report.refused_attributes.is_empty() {
        let message = format!(
            "the attributes {} are kept in memory alone; --drop-attributes leaves them out",
            report.refused_attributes.join(", ")
        );
        return Err(Fault::new(Position::Whole, ErrorKind::Unsupported(message.into())));
    }
    if options.spill.is_some() && options.on_bad == OnBad::Drop {
        let message =
            "bad cells and vertices are dropped in memory alone; convert the mesh first, or build without a limit";
        return Err(Fault::new(Position::Whole, ErrorKind::Unsupported(message.into())));
    }
    if let Some(weld) = options.weld {
        if options.spill.is_some() && weld != Weld::None {
            let message = "vertices are welded in memory alone; convert the mesh first, or build without a limit";
            return Err(Fault::new(Position::Whole, ErrorKind::Unsupported(message.into())));
        }
        weld::weld(&mut soup, &mut report, weld, options.drops_degenerate())?;
    }
    Ok((soup, report))
}
