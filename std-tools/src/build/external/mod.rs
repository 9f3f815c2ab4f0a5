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
//!    to the pieces, on disk;
//! 2. every piece is built and counted, and the numbers of the simplices at its border go to disk for the pieces that
//!    need them: facets without the least vertex, and top simplices that begin in another piece;
//! 3. `whole` adds up where everything goes, and lays out the file (`output`);
//! 4. every piece is built again, which is cheaper than to keep it, and written to its places (`write`).
//!
//! Disk: each listed simplex once as it comes, and once for each piece that it is in (one or two where the vertex order is
//! a good one, its vertices where it is not), and a number for each simplex at a border. Time: about twice that of building
//! in memory. What has to fit the memory is the vertices and, on each thread, the simplices around any one vertex.

mod output;
mod piece;
mod plan;
#[cfg(test)]
mod tests;
mod whole;
mod write;

use std::fs::File;
use std::io;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

use sig_core::{Dim, IndexWidth, MAX_DIM};

use super::limits::Stage;
use super::order::{Order, number_vertices};
use super::{BuildError, BuildOptions, BuildReport, Meter, Phase, Unused, VertexOrder, words};
use crate::soup::{Coordinates, Labels, Scalars, Soup};
use crate::spool::{Rows, Spill, Spool};
use crate::store::{EncodeError, EncodeOptions};
use piece::{Counted, Piece};
use plan::{Ranges, Survey};
use whole::Whole;
use write::{Needed, Writer};

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
/// `file`, which is empty.
///
/// # Errors
/// [`Error`]; what `file` holds then is of no use.
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
    let used = check(&spill, labels.len())?;
    let keep_unused = declared && options.unused == Unused::Keep;
    let order = number_vertices(&labels, coordinates.as_ref(), &[], &used, keep_unused, options.order)?;
    drop(used);
    let num_unused = order.num_unused;
    let listed: usize = spill.counts().iter().sum();
    let Pieces { ranges, words, counted, borders, needed } =
        Pieces::count(&Listed { spill: &spill, order: &order }, resources, cut, &meter)?;
    let temporary_bytes = spill.bytes() + words.spool.bytes() + borders.bytes();
    drop(spill);
    let first_unused = order.name_unused(&labels, declared);
    let (labels, coordinates) = order.permute(labels, coordinates);
    drop(order);
    let whole = Whole::new(&counted);
    if let Some(limit) = options.max_simplices.filter(|&limit| whole.num_simplices as u64 > limit) {
        return Err(BuildError::TooLarge { at_least: whole.num_simplices as u64, limit }.into());
    }
    let mut report = BuildReport {
        listed,
        unused_kept: if keep_unused { num_unused } else { 0 },
        unused_dropped: if keep_unused || !declared { 0 } else { num_unused },
        first_unused,
        top_simplices: vec![0; whole.first.len()],
        ..BuildReport::default()
    };
    let mut distinct_listed = 0;
    for counts in counted.iter().map(|counted| &counted.report) {
        distinct_listed += counts.distinct_listed;
        report.non_maximal += counts.non_maximal;
        report.conflicting += counts.conflicting;
        report.top_simplices.iter_mut().zip(&counts.top_simplices).for_each(|(all, more)| *all += more);
    }
    report.repeated = listed - distinct_listed;
    let (output, width, file_bytes) = whole.begin(file, &labels, coordinates.as_ref(), encode)?;
    let stage = meter.stage(Phase::Write, labels.len());
    drop((labels, coordinates));
    for_each_piece(ranges.len(), |number| {
        let range = ranges.get(number);
        let piece = Piece::build(&range, words.of(number)?, u64::from(u32::MAX))?;
        let writer = Writer::new((&piece, number), &ranges, (&whole, &output), (&borders, &needed[number]))?;
        writer.write()?;
        stage.add(range.len());
        Ok::<(), Error>(())
    })?;
    output.finish()?;
    Ok(Outcome { report, simplices: whole.counts(), width, file_bytes, pieces: ranges.len(), temporary_bytes })
}

/// Checks the listed simplices; tells which of `count` vertices they use.
fn check(spill: &Spill, count: usize) -> Result<Vec<bool>, Error> {
    let mut used = words::check(&[], count)?;
    let mut before: Vec<usize> = Vec::new();
    spill.try_for_each(|dim, rows| {
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

/// The listed simplices of each piece, on disk.
struct Words {
    spool: Spool,
    /// By piece and dimension.
    rows: Vec<Vec<Rows>>,
}

impl Words {
    /// Deals the listed simplices out to the ranges that have a vertex of them.
    fn new(listed: &Listed<'_>, ranges: &Ranges, resources: Resources<'_>, stage: &Stage<'_>) -> Result<Self, Error> {
        let spool = Spool::new_in(resources.directory)?;
        let dims = listed.spill.dim().map_or(0, |dim| dim + 1);
        let mut rows: Vec<Vec<Rows>> =
            (0..ranges.len()).map(|_| (0..dims).map(|_| Rows::default()).collect()).collect();
        // A sixteenth of the memory, in numbers, for all streams together.
        let most = resources.memory / 64 / (ranges.len() * dims).max(1) as u64;
        let most = usize::try_from(most.clamp(64, 1 << 16)).unwrap_or(1 << 16);
        let mut pieces = Vec::with_capacity(MAX_DIM + 1);
        let mut dealt = 0;
        listed.try_for_each(|dim, word| {
            pieces.clear();
            for &vertex in word {
                let piece = ranges.of(vertex);
                if !pieces.contains(&piece) {
                    pieces.push(piece);
                    rows[piece][dim].push(&spool, word, most)?;
                }
            }
            dealt += 1;
            if dealt % (1 << 16) == 0 {
                stage.add(1 << 16);
            }
            Ok(())
        })?;
        rows.iter_mut().flatten().try_for_each(|rows| rows.flush(&spool))?;
        Ok(Self { spool, rows })
    }

    /// Those of one piece, by dimension.
    fn of(&self, piece: usize) -> io::Result<Vec<Vec<u32>>> {
        let read = |rows: &Rows| {
            let mut numbers = Vec::with_capacity(rows.runs().iter().map(|run| run.len).sum());
            rows.runs().iter().try_for_each(|&run| self.spool.read(run, &mut numbers))?;
            Ok(numbers)
        };
        self.rows[piece].iter().map(read).collect()
    }
}

/// All pieces, counted.
struct Pieces {
    ranges: Ranges,
    words: Words,
    counted: Vec<Counted>,
    /// The numbers of simplices that pieces need of others, and where they are for each piece.
    borders: Spool,
    needed: Vec<Vec<Needed>>,
}

impl Pieces {
    /// Cuts the complex into pieces that fit, and counts them.
    fn count(listed: &Listed<'_>, resources: Resources<'_>, cut: &Cut<'_>, meter: &Meter<'_>) -> Result<Self, Error> {
        let bytes = match *cut {
            Cut::At(starts) => {
                let ranges = Ranges::new(starts.to_vec());
                return Self::of_ranges(listed, resources, ranges, u64::from(u32::MAX), meter)
                    .map_err(|(_, error)| error);
            }
            Cut::ToFit(bytes) => bytes / PEAK,
        };
        let mut survey = Survey::new(listed, bytes)?;
        let limit = survey.simplices(bytes);
        loop {
            let ranges = survey.cut(bytes / 4 * 3);
            match Self::of_ranges(listed, resources, ranges, limit, meter) {
                Ok(pieces) => return Ok(pieces),
                // The samples promised less.
                Err((range, Error::Build(BuildError::TooLarge { .. }))) if range.len() > 1 => survey.be_careful(2.0),
                Err((range, Error::Build(BuildError::TooLarge { at_least, limit }))) => {
                    return Err(Error::Star { vertex: range.start, at_least, limit });
                }
                Err((_, error)) => return Err(error),
            }
        }
    }

    /// Counts the pieces of the ranges; the error of a piece with its range.
    fn of_ranges(
        listed: &Listed<'_>,
        resources: Resources<'_>,
        ranges: Ranges,
        limit: u64,
        meter: &Meter<'_>,
    ) -> Result<Self, (Range<u32>, Error)> {
        let of_none = |error: Error| (0..0, error);
        let num_listed = listed.spill.counts().iter().sum();
        let words =
            Words::new(listed, &ranges, resources, &meter.stage(Phase::Distribution, num_listed)).map_err(of_none)?;
        let borders = Spool::new_in(resources.directory).map_err(|error| of_none(error.into()))?;
        let needed: Mutex<Vec<Vec<Needed>>> = Mutex::new(vec![Vec::new(); ranges.len()]);
        let stage = meter.stage(Phase::Count, listed.order.num_vertices());
        let count = |number: usize| {
            let range = ranges.get(number);
            let piece = Piece::build(&range, words.of(number)?, limit)?;
            let shared = piece.shared(number, &ranges);
            let numbers: Vec<u32> = shared.iter().map(|&key| piece::unpack(key).2).collect();
            let all = borders.append(&numbers)?;
            let mut start = 0;
            for run in shared.chunk_by(|&a, &b| a >> 32 == b >> 32) {
                let (user, dim, _) = piece::unpack(run[0]);
                let mut needed = needed.lock().unwrap_or_else(PoisonError::into_inner);
                needed[user].push((number, dim, all.part(start..start + run.len())));
                start += run.len();
            }
            stage.add(range.len());
            Ok(piece.count())
        };
        let counted = for_each_piece(ranges.len(), |number| count(number).map_err(|error| (ranges.get(number), error)));
        let counted = counted?;
        let needed = needed.into_inner().unwrap_or_else(PoisonError::into_inner);
        Ok(Self { ranges, words, counted, borders, needed })
    }
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
