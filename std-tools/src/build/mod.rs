//! From top simplices to the arrays of a Simplified Incidence Graph, in canonical order.
//!
//! A [`Soup`] comes in, [`Built`] goes out to the encoder. In between, one step a file:
//!
//! 1. `order` numbers the vertices, `words` rewrites every listed simplex as a sorted word of those numbers and deals the
//!    words out to ranges of vertices;
//! 2. `levels` finds all faces with a given least vertex, one small problem a vertex (`trie`, and `local` for vertices with
//!    many neighbours), and `assemble` lays them end to end: from here on a simplex is its number, and its facets are known;
//! 3. `clusters` finds the partial co-boundary relations C\*, and `lists` writes them as pointers, lists and flags.
//!
//! A [simplex tree](crate::frozen::FrozenTree) skips the first two steps: `complete` reads the facets off it (`facets`).
//!
//! What does not fit memory is built piece by piece by the same steps: [`external`].
//!
//! The result depends on the set of simplices, the labels and the options only: not on the order of the input, nor on
//! the number of threads. Work runs in rayon's current pool.

mod assemble;
mod attributes;
mod blocks;
mod clusters;
mod cofaces;
mod complete;
pub mod external;
mod facets;
mod levels;
mod limits;
mod lists;
mod local;
mod order;
mod report;
mod trie;
mod words;

use std::collections::BTreeSet;

use sig_core::{Dim, Index};

use crate::attribute::Attribute;
use crate::soup::{Coordinates, Labels, Soup};

pub use complete::complete;
pub(crate) use facets::{Families, seek};
pub(crate) use limits::Stage;
pub use limits::available_memory;
use limits::{Limit, Meter, Reservation};
pub(crate) use lists::pack;
pub(crate) use order::hilbert_order;
use order::number_vertices;
pub(crate) use order::numbered_if_possible;
pub use report::BuildReport;

/// How the vertices are numbered, and with them all simplices.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum VertexOrder {
    /// [`Hilbert`](Self::Hilbert) where there are coordinates, else [`Input`](Self::Input): simplices that are near in
    /// space then lie near in the file, which makes building and sweeps two to four times as fast on meshes whose own
    /// order is poor.
    #[default]
    Auto,
    /// By label: integers numerically, tokens bytewise, declared vertices by their index.
    Input,
    /// Along a Hilbert curve through the first three coordinates; ties by label.
    Hilbert,
    /// By the reverse Cuthill–McKee order of the 1-skeleton; ties by label.
    Rcm,
}

/// What becomes of declared vertices that no simplex uses.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Unused {
    /// They stay, as 0-simplices.
    #[default]
    Keep,
    /// They are dropped, with their labels and coordinates.
    Drop,
}

/// What the builder is doing, for a progress report.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Phase {
    /// Numbering the vertices and sorting the listed simplices; counted in simplices listed.
    Words,
    /// Finding the faces; counted in vertices.
    Levels,
    /// Finding the facets that do not share the least vertex; counted in dimensions.
    Boundary,
    /// Finding the partial co-boundary relations; counted in dimensions.
    Coboundary,
    /// Out of core: dealing the listed simplices out to the pieces; counted in simplices listed.
    Distribution,
    /// Out of core: building the pieces to count their simplices; counted in vertices.
    Count,
    /// Out of core: building the pieces again to write them; counted in vertices.
    Write,
}

/// A callback that is told the phase, how much of it is done, and how much there is.
pub type Progress<'a> = &'a (dyn Fn(Phase, u64, u64) + Sync);

/// How to build.
#[derive(Clone, Copy, Default)]
pub struct BuildOptions<'a> {
    /// How the vertices are numbered.
    pub order: VertexOrder,
    /// What becomes of unused vertices.
    pub unused: Unused,
    /// The most simplices that the complex may have.
    pub max_simplices: Option<u64>,
    /// The most bytes that the result may take; the system's available memory if `None` and the system tells it.
    pub max_bytes: Option<u64>,
    /// Told how far the work is, from any thread.
    pub progress: Option<Progress<'a>>,
}

/// Why a soup is not built.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BuildError {
    /// A simplex names a vertex that the label table does not have.
    #[error("simplex {index} of dimension {dim} names vertex number {vertex}, but there are {count} vertices")]
    VertexOutOfRange {
        /// Dimension of the simplex.
        dim: Dim,
        /// Which of the listed simplices of that dimension it is, from 0.
        index: usize,
        /// The vertex number.
        vertex: u32,
        /// The number of vertices.
        count: usize,
    },
    /// A simplex names a vertex twice.
    #[error("simplex {index} of dimension {dim} names vertex number {vertex} twice")]
    RepeatedVertex {
        /// Dimension that the simplex would have.
        dim: Dim,
        /// Which of the listed simplices of that dimension it is, from 0.
        index: usize,
        /// The vertex number.
        vertex: u32,
    },
    /// The array of the listed simplices of a dimension does not hold whole simplices, or the dimension is too large.
    #[error("the simplices of dimension {dim} are malformed: {len} vertex numbers")]
    MalformedSoup {
        /// The dimension.
        dim: Dim,
        /// The vertex numbers in the array.
        len: usize,
    },
    /// The coordinates are not those of the vertices.
    #[error("{values} coordinates do not fit {vertices} vertices of {dim} each")]
    MalformedCoordinates {
        /// Scalars in the table.
        values: usize,
        /// Vertices.
        vertices: usize,
        /// Scalars a vertex.
        dim: usize,
    },
    /// An attribute does not have a row for each vertex, or each simplex of its dimension.
    #[error(
        "attribute {index} has {values} numbers, which is not a row for each of {rows} simplices of dimension {dim}"
    )]
    MalformedAttribute {
        /// Which of the attributes it is, from 0.
        index: usize,
        /// Its dimension.
        dim: Dim,
        /// The numbers that it has.
        values: usize,
        /// The rows that it must have.
        rows: usize,
    },
    /// An order along a curve needs coordinates, and there are none.
    #[error("the Hilbert order needs coordinates, and the input has none")]
    NoCoordinates,
    /// Vertex numbers are 32-bit, and the largest is reserved.
    #[error("{0} vertices are more than 4294967294")]
    TooManyVertices(usize),
    /// The arrays are not a simplex tree in level order, or a simplex lacks a facet.
    #[error("the arrays are not a simplex tree: simplex {0} is out of place, or lacks a facet")]
    MalformedTree(usize),
    /// The complex is larger than the limit, or than memory.
    #[error("the complex has at least {at_least} simplices, and there is room for {limit}")]
    TooLarge {
        /// A lower bound of the number of simplices.
        at_least: u64,
        /// The most that the options, or the memory, allow.
        limit: u64,
    },
}

/// The arrays of a Simplified Incidence Graph over the index type `I`, as the file stores them.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SigArrays<I> {
    /// The first id of each dimension, `d + 1` of them; none for the empty complex.
    pub first: Vec<usize>,
    /// The number of simplices.
    pub num_simplices: usize,
    /// For every p-simplex, p > 0, in id order, its p + 1 facets; the i-th omits the i-th vertex.
    pub boundary: Vec<I>,
    /// For every simplex below dimension d: the d-simplex of its single cluster if flagged, else its offset in `lists`.
    pub pointers: Vec<I>,
    /// The partial co-boundary relations of the unflagged simplices, in id order: ids by decreasing dimension, then
    /// increasing, each list ended by the stop code.
    pub lists: Vec<I>,
    /// One bit for every simplex below dimension d, least significant first, zero padded.
    pub flags: Vec<u8>,
    /// The first child of every simplex below dimension d as a node of the simplex tree, then the number of simplices.
    pub child_offsets: Vec<I>,
    /// The last vertex of every simplex.
    pub last_vertices: Vec<u32>,
}

/// The empty complex.
impl<I> Default for SigArrays<I> {
    fn default() -> Self {
        Self {
            first: Vec::new(),
            num_simplices: 0,
            boundary: Vec::new(),
            pointers: Vec::new(),
            lists: Vec::new(),
            flags: Vec::new(),
            child_offsets: Vec::new(),
            last_vertices: Vec::new(),
        }
    }
}

impl<I: Index> SigArrays<I> {
    /// The dimension of the complex; `None` if it is empty.
    #[must_use]
    pub fn dim(&self) -> Option<Dim> {
        self.first.len().checked_sub(1)
    }

    /// The ids of the simplices of dimension `dim`.
    #[must_use]
    pub fn ids(&self, dim: Dim) -> std::ops::Range<usize> {
        ids(&self.first, self.num_simplices, dim)
    }

    /// The facets of the simplices of dimension `dim`, `dim + 1` each in id order; none for vertices.
    #[must_use]
    pub fn facets(&self, dim: Dim) -> &[I] {
        let start = |dim: Dim| (1..dim).map(|lower| self.ids(lower).len() * (lower + 1)).sum();
        if dim == 0 { &[] } else { self.boundary.get(start(dim)..start(dim + 1)).unwrap_or(&[]) }
    }

    /// The integers of the file: lookup table, boundary, pointers and lists (sig-2004, 4.2).
    #[must_use]
    pub fn num_integers(&self) -> usize {
        self.first.len() + self.boundary.len() + self.pointers.len() + self.lists.len()
    }

    /// The same arrays with wider indices.
    fn widen(self) -> SigArrays<u64> {
        SigArrays {
            first: self.first,
            num_simplices: self.num_simplices,
            boundary: widen(self.boundary),
            pointers: widen(self.pointers),
            lists: widen(self.lists),
            flags: self.flags,
            child_offsets: widen(self.child_offsets),
            last_vertices: self.last_vertices,
        }
    }
}

/// Wider indices.
fn widen<I: Index>(values: Vec<I>) -> Vec<u64> {
    values.into_iter().map(|value| if value == I::STOP { u64::STOP } else { value.to_usize() as u64 }).collect()
}

/// The arrays at the width that the complex needs in memory; a file may store them narrower.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Arrays {
    /// Ids and list offsets fit 32 bits.
    Narrow(SigArrays<u32>),
    /// They do not.
    Wide(SigArrays<u64>),
}

impl Arrays {
    /// The arrays with 64-bit indices, whatever they are stored in.
    #[must_use]
    pub fn into_wide(self) -> SigArrays<u64> {
        match self {
            Self::Narrow(arrays) => arrays.widen(),
            Self::Wide(arrays) => arrays,
        }
    }
}

/// A complex in canonical order, ready to be encoded.
#[derive(Clone, PartialEq, Debug)]
pub struct Built {
    /// The arrays over the simplices.
    pub arrays: Arrays,
    /// The labels of the vertices, by vertex id; [`Labels::Numbered`] if they are the ids themselves.
    pub labels: Labels,
    /// The coordinates of the vertices, by vertex id.
    pub coordinates: Option<Coordinates>,
    /// One bit for every top simplex in id order, least significant first: 1 if the input lists its vertices in an odd
    /// permutation of increasing ids. None if the vertices came in no order, from a simplex tree.
    pub parity: Option<Vec<u8>>,
    /// The filtration value of every simplex, at least that of its faces; no NaN, no −0.
    pub filtration: Option<Vec<f64>>,
    /// Attributes by dimension and name, with a row for each simplex of the dimension in id order.
    pub attributes: Vec<Attribute>,
    /// What the input held.
    pub report: BuildReport,
}

/// The listed words by dimension, and the vertices that are kept though unused: what [`crate::incidence_graph`] starts
/// from.
pub(crate) fn sorted_words(soup: &Soup, options: &BuildOptions<'_>) -> Result<Vec<BTreeSet<Vec<u32>>>, BuildError> {
    let Soup { labels, declared, coordinates, simplices, .. } = soup;
    let used = words::check(simplices, labels.len())?;
    Limit::new(soup, options)?;
    let keep_unused = *declared && options.unused == Unused::Keep;
    let order = number_vertices(labels, coordinates.as_ref(), simplices, &used, keep_unused, options.order)?;
    let words = words::sort(simplices.clone(), &order, words::BUCKET, &Meter::new(options.progress))?;
    let mut levels: Vec<BTreeSet<Vec<u32>>> = Vec::new();
    let vertices = (0..narrow(order.num_vertices())).map(|id| vec![id]);
    for word in words.iter().map(<[u32]>::to_vec).chain(vertices) {
        if levels.len() < word.len() {
            levels.resize_with(word.len(), BTreeSet::new);
        }
        levels[word.len() - 1].insert(word);
    }
    Ok(levels)
}

/// Builds the complex of all faces of the simplices of `soup`.
///
/// Time is linear in the pairs (listed simplex, face), with a sort of a handful of neighbours a vertex; memory peaks at
/// less than three times the result.
///
/// # Errors
/// [`BuildError`]: a soup that is malformed, or a complex that is larger than `options` or memory allow. The size is
/// bounded from below before anything is allocated, and the bound is sharpened while faces are found.
pub fn build(soup: Soup, options: &BuildOptions<'_>) -> Result<Built, BuildError> {
    build_up_to(soup, options, u32::STOP as usize - 1)
}

/// The arrays of all faces of the simplices of `soup`, without pointers, lists and flags: what an incidence graph starts
/// from.
pub(crate) fn faces(soup: Soup, options: &BuildOptions<'_>) -> Result<Arrays, BuildError> {
    let meter = Meter::new(options.progress);
    let (chunks, ..) = find_faces(soup, options, &meter)?;
    Ok(if chunks.num_simplices() < u32::STOP as usize {
        assemble::assemble::<u32>(chunks, &meter).0.into()
    } else {
        assemble::assemble::<u64>(chunks, &meter).0.into()
    })
}

/// All faces of the simplices of a soup, the order of its vertices, the number of simplices that it lists, and its labels
/// and coordinates.
type FoundFaces = (levels::Chunks, order::Order, usize, Labels, Option<Coordinates>);

fn find_faces(soup: Soup, options: &BuildOptions<'_>, meter: &Meter<'_>) -> Result<FoundFaces, BuildError> {
    let used = words::check(&soup.simplices, soup.labels.len())?;
    let limit = Limit::new(&soup, options)?;
    let Soup { labels, declared, coordinates, simplices, .. } = soup;
    let keep_unused = declared && options.unused == Unused::Keep;
    let order = number_vertices(&labels, coordinates.as_ref(), &simplices, &used, keep_unused, options.order)?;
    let num_listed = simplices.iter().enumerate().map(|(dim, flat)| flat.len() / (dim + 1)).sum();
    let words = words::sort(simplices, &order, words::BUCKET, meter)?;
    let chunks = levels::find(&words, |id| !used[order.input(id) as usize], &limit, meter)?;
    Ok((chunks, order, num_listed, labels, coordinates))
}

/// Builds with 32-bit indices if there are up to `most_narrow` simplices.
fn build_up_to(mut soup: Soup, options: &BuildOptions<'_>, most_narrow: usize) -> Result<Built, BuildError> {
    let meter = Meter::new(options.progress);
    let listed = attributes::Listed::take(&mut soup)?;
    let declared = soup.declared;
    let keep_unused = declared && options.unused == Unused::Keep;
    let (chunks, order, num_listed, labels, coordinates) = find_faces(soup, options, &meter)?;
    let (arrays, parity, counts) = if chunks.num_simplices() <= most_narrow {
        let (skeleton, listed) = assemble::assemble::<u32>(chunks, &meter);
        finish(skeleton, &listed, &meter)
    } else {
        let (skeleton, listed) = assemble::assemble::<u64>(chunks, &meter);
        finish(skeleton, &listed, &meter)
    };
    let (attributes, differing) = match &arrays {
        Arrays::Narrow(arrays) => listed.by_id(arrays, &order, options),
        Arrays::Wide(arrays) => listed.by_id(arrays, &order, options),
    }?;
    let report = BuildReport {
        differing,
        unused_kept: if keep_unused { order.num_unused } else { 0 },
        unused_dropped: if keep_unused || !declared { 0 } else { order.num_unused },
        first_unused: order.name_unused(&labels, declared),
        ..counts.report(num_listed)
    };
    let (labels, coordinates) = order.permute(labels, coordinates);
    Ok(Built { arrays, labels, coordinates, parity: Some(parity), filtration: None, attributes, report })
}

/// A number that is known to fit: the caller has checked, or counts what is stored 32 bits wide already.
#[expect(clippy::cast_possible_truncation)]
#[inline]
pub(crate) fn narrow(value: usize) -> u32 {
    debug_assert!(u32::try_from(value).is_ok());
    value as u32
}

/// A number that is known to fit the index type that was chosen for it.
#[inline]
pub(crate) fn index<I: Index>(value: usize) -> I {
    let index = I::from_usize(value);
    debug_assert!(index.is_some());
    index.unwrap_or(I::STOP)
}

/// The ids of dimension `dim`, where `first` holds the first id of each dimension.
pub(crate) fn ids(first: &[usize], num_simplices: usize, dim: Dim) -> std::ops::Range<usize> {
    let end = |dim: Dim| first.get(dim).copied().unwrap_or(num_simplices);
    end(dim)..end(dim + 1)
}

/// Adds the partial co-boundary relations to the arrays of the faces, and reads off what is known of the listed
/// simplices (`listed`: one byte a simplex, see [`local`]).
fn finish<I: clusters::Cell>(
    arrays: SigArrays<I>,
    listed: &[Vec<u8>],
    meter: &Meter<'_>,
) -> (Arrays, Vec<u8>, report::Counts)
where
    Arrays: From<SigArrays<I>>,
{
    let is_top = report::is_top(&arrays, listed);
    let (parity, counts) = report::tally(listed, &is_top);
    (clusters::add(arrays, &is_top, meter), parity, counts)
}

impl From<SigArrays<u32>> for Arrays {
    fn from(arrays: SigArrays<u32>) -> Self {
        Self::Narrow(arrays)
    }
}

impl From<SigArrays<u64>> for Arrays {
    fn from(arrays: SigArrays<u64>) -> Self {
        Self::Wide(arrays)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Complexes that need 64-bit indices are too large for a test, so these are forced.
    #[test]
    fn wide_arrays_equal_narrow_ones() {
        let mut soup = Soup::new(Labels::Numbered(9), true);
        for simplex in [&[0, 1, 2, 3][..], &[0, 4, 1, 5], &[0, 1, 6], &[7, 6]] {
            soup.push(simplex);
        }
        let narrow = build(soup.clone(), &BuildOptions::default()).expect("a good soup");
        let wide = build_up_to(soup, &BuildOptions::default(), 0).expect("a good soup");
        assert!(matches!((&narrow.arrays, &wide.arrays), (Arrays::Narrow(_), Arrays::Wide(_))));
        assert_eq!(narrow.arrays.into_wide(), wide.arrays.into_wide());
        assert_eq!(narrow.parity, wide.parity);
    }
}
