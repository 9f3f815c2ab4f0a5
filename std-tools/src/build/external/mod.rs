//! Out of core: complexes larger than memory, straight into a file. The bytes are those that [`build`](super::build()) and
//! [`Encoding`](crate::store::Encoding) give.
//!
//! The vertices are held in memory, with their labels and coordinates; the listed simplices are on disk ([`Spill`]). The
//! vertices, in their order, are cut into ranges. Whatever contains a simplex contains its least vertex, so all that is to
//! be known about the simplices whose least vertex is in a range is in the *piece* of the range: the complex of the listed
//! simplices that have a vertex there (`piece`), which the builder builds in memory, one on each thread. The simplices that a
//! piece owns are consecutive in each dimension of the whole. One step a file:
//!
//! 1. `plan` samples the complex and cuts it into ranges whose pieces fit the memory; the listed simplices are dealt out
//!    to the pieces, on disk (`count`);
//! 2. every piece is built and counted, and the numbers of the simplices at its border go to disk for the pieces that
//!    need them: facets without the least vertex, and top simplices that begin in another piece;
//! 3. `whole` adds up where everything goes, and lays out the file (`output`);
//! 4. every piece is built again, which is cheaper than to keep it, and written to its places (`write`).
//!
//! Disk: each listed simplex once as it comes, and once for each piece that it is in (one or two where the vertex order is
//! a good one, its vertices where it is not), and a number for each simplex at a border. Time: about twice that of building
//! in memory. What has to fit the memory is the vertices and, on each thread, the simplices around any one vertex.
//!
//! What is on disk has no name and is gone when the work ends. Where it is to outlive an interruption, it has, and it is on
//! record that the simplices were dealt out, and which pieces were counted and written ([`Kept`]): none of that is done again.

mod count;
mod kept;
mod key;
mod output;
mod piece;
mod plan;
#[cfg(test)]
mod tests;
mod whole;
mod write;

use std::borrow::Cow;
use std::fs::File;
use std::hash::Hasher;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use sig_core::{Dim, IndexWidth, MAX_DIM};

use super::order::{Order, number_vertices};
use super::report::Counts;
use super::{BuildError, BuildOptions, BuildReport, Meter, Phase, Unused, VertexOrder, words};
use crate::soup::{Coordinates, Labels, Scalars, Soup};
use crate::spool::{Spill, Spool};
use crate::store::{EncodeError, EncodeOptions};
use count::Pieces;
use kept::{Past, Record};
use key::Fingerprint;
use piece::Piece;
use whole::Whole;
use write::Writer;

pub use kept::Kept;

/// How many times the result a piece takes in memory while it is built, at most.
const PEAK: u64 = 3;
/// Bytes that the program takes whatever it builds, and bytes for each thread.
const BASE: u64 = 16 << 20;
/// Bytes for each vertex while the vertices are put in order; less later.
const BYTES_PER_VERTEX: u64 = 28;

/// What the builder may use.
#[derive(Clone, Copy, Debug)]
pub struct Resources<'a> {
    /// The most bytes of memory.
    pub memory: u64,
    /// Where temporary data are kept; they have no name there and are gone when the work ends, however it does.
    pub directory: &'a Path,
    /// Where those are kept that outlive an interruption, if that is wanted.
    pub kept: Option<&'a Kept>,
}

impl Resources<'_> {
    /// Numbers on disk: those that `kept` takes where they outlive an interruption, else none.
    fn spool(&self, kept: impl FnOnce(&Kept) -> io::Result<Spool>) -> io::Result<Spool> {
        self.kept.map_or_else(|| Spool::new_in(self.directory), kept)
    }

    /// Something was done; it is on record where that outlives an interruption.
    fn record(&self, record: &Record<'_>) -> io::Result<()> {
        self.kept.map_or(Ok(()), |kept| kept.record(record))
    }
}

/// What was built.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Outcome {
    /// What the input held.
    pub report: BuildReport,
    /// The number of simplices of each dimension.
    pub simplices: Vec<usize>,
    /// The width of the indices.
    pub width: IndexWidth,
    /// The length of the file.
    pub file_bytes: u64,
    /// The pieces in which it was built.
    pub pieces: usize,
    /// The most bytes that temporary data took on disk.
    pub temporary_bytes: u64,
}

/// Why a complex is not built.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// As in memory.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// As in memory.
    #[error(transparent)]
    Encode(#[from] EncodeError),
    /// The temporary data or the file cannot be written or read.
    #[error("cannot write or read the file or the temporary data: {0}")]
    Io(#[from] io::Error),
    /// The vertices do not fit the memory.
    #[error(
        "the program and {vertices} vertices with labels and coordinates take {needed} bytes, at most three quarters of the {memory} \
         that are allowed; simplices need the rest"
    )]
    Vertices {
        /// The number of vertices.
        vertices: usize,
        /// What they take.
        needed: u64,
        /// What is allowed.
        memory: u64,
    },
    /// The simplices around a vertex do not fit the memory.
    #[error(
        "there are at least {at_least} simplices around one vertex, number {vertex} in the order of the file, and the memory allowed has room for {limit}"
    )]
    Star {
        /// The vertex, by its number in the complex.
        vertex: u32,
        /// A lower bound.
        at_least: u64,
        /// What there is room for.
        limit: u64,
    },
    /// [`VertexOrder::Rcm`] needs all edges in memory.
    #[error("the reverse Cuthill–McKee order needs all edges in memory; choose another")]
    Rcm,
    /// Attributes are for complexes in memory.
    #[error("attributes are kept of complexes in memory only; --drop-attributes leaves them out")]
    Attributes,
    /// [`EncodeOptions::pairs`] is for complexes in memory.
    #[error("pairs are written of complexes in memory only")]
    Pairs,
    /// A directory for a build that can be interrupted, or a file in it, cannot be created or read.
    #[error("{}: cannot keep what is done there: {error}", path.display())]
    Keep {
        /// The directory or file.
        path: PathBuf,
        /// What the system says.
        #[source]
        error: io::Error,
    },
    /// A file has the name of one that is kept, and is none.
    #[error("{}: not a file that an interrupted build left, or damaged; remove it, or keep what is done elsewhere", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// Another process builds with the directory.
    #[error("{}: another build is at work there", directory.display())]
    InUse {
        /// The directory.
        directory: PathBuf,
    },
    /// What is kept is of another build.
    #[error(
        "{}: what is kept there is of a build with another {what}: {was}, now {is}; build as then, or remove the directory, \
         or take another one",
        directory.display()
    )]
    OfAnother {
        /// The directory.
        directory: PathBuf,
        /// What differs.
        what: String,
        /// What it was.
        was: String,
        /// What it is now.
        is: String,
    },
}

/// How the ranges are found.
enum Cut<'a> {
    /// So that pieces fit so many bytes on each thread.
    ToFit(u64),
    /// As given: where each starts, and the end.
    #[cfg_attr(not(test), expect(dead_code, reason = "for tests, to whom small complexes have to be large"))]
    At(&'a [u32]),
}

/// Builds the complex of all faces of the simplices of `soup` and of `spill`, on the vertices of `soup`, and writes it to
/// `file`, which is empty; with [`Resources::kept`] it is [`Kept::file`], whatever that holds.
///
/// What is kept of another build, of other simplices or with other options or resources, is refused, and stays. What is kept
/// of this one stays too, until [`Kept::finish`] is called, or its data are damaged, or it ends with another error than
/// [`Error::Io`].
///
/// # Errors
/// [`Error`]; what `file` holds then is of no use, but for another process with the same [`Resources::kept`].
pub fn build_to_file(
    soup: Soup,
    spill: Spill,
    options: &BuildOptions<'_>,
    encode: &EncodeOptions<'_>,
    resources: Resources<'_>,
    file: &File,
) -> Result<Outcome, Error> {
    let vertices = soup.labels.len();
    let kept = bytes_of_vertices(&soup.labels, soup.coordinates.as_ref());
    let ordering = kept + BYTES_PER_VERTEX * vertices as u64 + BASE;
    if ordering > resources.memory / 4 * 3 {
        return Err(Error::Vertices { vertices, needed: ordering, memory: resources.memory });
    }
    let threads = rayon::current_num_threads() as u64;
    // Numbers of the vertices and back, and their weights; buffers of as much again as a sixteenth.
    let left = resources.memory - kept - 12 * vertices as u64 - BASE - resources.memory / 16;
    let cut = Cut::ToFit(left / threads);
    build_in_pieces(soup, spill, options, encode, resources, &cut, file)
}

fn bytes_of_vertices(labels: &Labels, coordinates: Option<&Coordinates>) -> u64 {
    let labels = match labels {
        Labels::Numbered(_) => 0,
        Labels::Integers(labels) => size_of_val(labels.as_slice()),
        // With what the allocator adds.
        Labels::Tokens(labels) => labels.iter().map(|label| size_of_val(label) + label.len() + 16).sum(),
    };
    let coordinates = coordinates.map_or(0, |coordinates| match &coordinates.values {
        Scalars::F32(values) => size_of_val(values.as_slice()),
        Scalars::F64(values) => size_of_val(values.as_slice()),
    });
    (labels + coordinates) as u64
}

/// The listed simplices, which are on disk, by the vertices of the complex.
struct Listed<'a> {
    spill: &'a Spill,
    order: &'a Order,
}

impl Listed<'_> {
    /// Calls `visit` with every listed simplex, its vertices in the order of the input, until it fails.
    fn try_for_each(&self, mut visit: impl FnMut(Dim, &[u32]) -> Result<(), Error>) -> Result<(), Error> {
        let mut word = [0; MAX_DIM + 1];
        self.spill.try_for_each(|dim, rows| {
            rows.chunks_exact(dim + 1).try_for_each(|row| {
                for (vertex, &number) in word.iter_mut().zip(row) {
                    *vertex = self.order.id(number);
                }
                visit(dim, &word[..=dim])
            })
        })
    }
}

fn build_in_pieces(
    soup: Soup,
    spill: Spill,
    options: &BuildOptions<'_>,
    encode: &EncodeOptions<'_>,
    resources: Resources<'_>,
    cut: &Cut<'_>,
    file: &File,
) -> Result<Outcome, Error> {
    let built = build(soup, spill, options, encode, resources, cut, file);
    if let (Err(error), Some(kept)) = (&built, resources.kept)
        && !matches!(error, Error::Io(error) if error.kind() != io::ErrorKind::InvalidData)
    {
        kept.give_up();
    }
    built
}

fn build(
    mut soup: Soup,
    spill: Spill,
    options: &BuildOptions<'_>,
    encode: &EncodeOptions<'_>,
    resources: Resources<'_>,
    cut: &Cut<'_>,
    file: &File,
) -> Result<Outcome, Error> {
    if options.order == VertexOrder::Rcm {
        return Err(Error::Rcm);
    }
    if encode.pairs {
        return Err(Error::Pairs);
    }
    if !soup.attributes.is_empty() {
        return Err(Error::Attributes);
    }
    words::check(&soup.simplices, soup.labels.len())?;
    for (dim, simplices) in std::mem::take(&mut soup.simplices).into_iter().enumerate() {
        spill.append(dim, &simplices);
    }
    let Soup { labels, declared, coordinates, .. } = soup;
    let meter = Meter::new(options.progress);
    let mut fingerprint = resources.kept.map(|_| Fingerprint::new(&labels, declared, coordinates.as_ref()));
    let used = check(&spill, labels.len(), fingerprint.as_mut())?;
    let mut past = match (resources.kept, fingerprint) {
        (Some(kept), Some(fingerprint)) => kept.begin(fingerprint.key(&spill, options, encode, resources))?,
        _ => Past::default(),
    };
    let keep_unused = declared && options.unused == Unused::Keep;
    let order = number_vertices(&labels, coordinates.as_ref(), &[], &used, keep_unused, options.order)?;
    drop(used);
    let num_unused = order.num_unused;
    let listed = spill.counts().iter().sum();
    let Pieces { ranges, words, counted, borders, needed } =
        Pieces::count(&Listed { spill: &spill, order: &order }, resources, cut, &mut past, &meter)?;
    let temporary_bytes = spill.bytes() + words.bytes() + borders.bytes();
    drop(spill);
    let first_unused = order.name_unused(&labels, declared);
    let (labels, coordinates) = order.permute(labels, coordinates);
    drop(order);
    let whole = Whole::new(&counted);
    if let Some(limit) = options.max_simplices.filter(|&limit| whole.num_simplices as u64 > limit) {
        return Err(BuildError::TooLarge { at_least: whole.num_simplices as u64, limit }.into());
    }
    let mut counts = Counts::new(whole.first.len());
    counted.iter().for_each(|piece| counts.merge(&piece.report));
    let report = BuildReport {
        unused_kept: if keep_unused { num_unused } else { 0 },
        unused_dropped: if keep_unused || !declared { 0 } else { num_unused },
        first_unused,
        ..counts.report(listed)
    };
    let (output, width, file_bytes) = whole.begin(file, &labels, coordinates.as_ref(), encode)?;
    let stage = meter.stage(Phase::Write, labels.len());
    drop((labels, coordinates));
    for_each_piece(ranges.len(), |number| {
        let range = ranges.get(number);
        let written = match past.written.get(&number).filter(|_| !output.is_new) {
            Some(written) => written.clone(),
            None => {
                let piece = Piece::build(&range, words.of(number)?, u64::from(u32::MAX))?;
                let writer = Writer::new((&piece, number), &ranges, (&whole, &output), (&borders, &needed[number]))?;
                let written = writer.write()?;
                resources.record(&Record::Written(number, Cow::Borrowed(&written)))?;
                written
            }
        };
        output.add(written);
        stage.add(range.len());
        Ok::<(), Error>(())
    })?;
    output.finish()?;
    Ok(Outcome { report, simplices: whole.counts(), width, file_bytes, pieces: ranges.len(), temporary_bytes })
}

/// Checks the listed simplices, and takes their fingerprint; tells which of `count` vertices they use.
fn check(spill: &Spill, count: usize, mut fingerprint: Option<&mut Fingerprint>) -> Result<Vec<bool>, Error> {
    let mut used = words::check(&[], count)?;
    let mut before: Vec<usize> = Vec::new();
    spill.try_for_each(|dim, rows| {
        if let Some(fingerprint) = &mut fingerprint {
            fingerprint.simplices.write(bytemuck::cast_slice(rows));
        }
        before.resize(before.len().max(dim + 1), 0);
        for row in rows.chunks_exact(dim + 1) {
            let index = before[dim];
            before[dim] += 1;
            for (place, &vertex) in row.iter().enumerate() {
                let Some(used) = used.get_mut(vertex as usize) else {
                    return Err(BuildError::VertexOutOfRange { dim, index, vertex, count }.into());
                };
                *used = true;
                if row[..place].contains(&vertex) {
                    return Err(BuildError::RepeatedVertex { dim, index, vertex }.into());
                }
            }
        }
        Ok::<(), Error>(())
    })?;
    Ok(used)
}

/// Does some work for each of `count` pieces: one at a time on each thread, so that no more are in memory, and what the
/// work itself would split among threads stays on its own. One error of several.
fn for_each_piece<T: Send, E: Send>(count: usize, work: impl Fn(usize) -> Result<T, E> + Sync) -> Result<Vec<T>, E> {
    let next = AtomicUsize::new(0);
    let has_failed = AtomicBool::new(false);
    let results = Mutex::new(Vec::with_capacity(count));
    let run = || {
        while !has_failed.load(Ordering::Relaxed) {
            let piece = next.fetch_add(1, Ordering::Relaxed);
            if piece >= count {
                break;
            }
            let result = work(piece);
            has_failed.fetch_or(result.is_err(), Ordering::Relaxed);
            results.lock().unwrap_or_else(PoisonError::into_inner).push((piece, result));
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..rayon::current_num_threads().min(count) {
            scope.spawn(|| match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
                Ok(pool) => pool.install(run),
                // Then the threads are shared, which is no mistake.
                Err(_) => run(),
            });
        }
    });
    let mut results = results.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.sort_unstable_by_key(|&(piece, _)| piece);
    results.into_iter().map(|(_, result)| result).collect()
}
