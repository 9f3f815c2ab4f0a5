//! The checks that go beyond opening and validating a file: its checksums, and whether C\* is complete.
//!
//! [`Complex::validate`] stands between the two. It is linear and needs no memory, but cannot know whether a list lacks a
//! cluster or names a simplex that is not the least of its cluster; [`rebuild`] builds the complex again from its own
//! top simplices and compares.

use rayon::prelude::*;
use sig_core::format::{Blocks, FormatError, SectionKind};
use sig_core::{Complex, Dim, Index, SimplexId};

use super::encode::{EncodeError, EncodeOptions, Encoding, crc32};
use crate::build::{BuildError, BuildOptions, Built, build};
use crate::names::simplex_name;
use crate::soup::{Labels, Soup};
use crate::tops::top_simplices;

/// Checks every byte of a file against its checksums, in parallel; the number of blocks. `file` is in the byte order of a
/// file, as it lies on disk.
///
/// # Errors
/// The first damage in the order of the file, as [`sig_core::format::verify`] has it; [`FormatError::NoChecksums`] if
/// the file has none.
pub fn checksums(file: &[u8]) -> Result<usize, FormatError> {
    let blocks: Vec<_> = Blocks::of_file(file)?.iter().collect();
    match blocks.par_iter().find_map_first(|block| block.check(crc32).err()) {
        Some(damage) => Err(damage),
        None => Ok(blocks.len()),
    }
}

/// Why a complex is not the one that its top simplices span.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RebuildError {
    /// It could not be built.
    #[error("cannot rebuild the complex: {0}")]
    Build(#[from] BuildError),
    /// It could not be encoded.
    #[error("cannot rebuild the complex: {0}")]
    Encode(#[from] EncodeError),
    /// The result could not be read. A defect of this crate.
    #[error("cannot read the rebuilt complex: {0}")]
    Format(#[from] FormatError),
    /// It has more or fewer simplices of a dimension than its top simplices span.
    #[error("{found} simplices of dimension {dim}, but the top simplices span {expected}")]
    Count {
        /// The dimension.
        dim: Dim,
        /// How many the file has.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// A simplex has other facets.
    #[error("simplex {simplex} (id {}): its facets are not those of the rebuilt complex", id.index())]
    Facets {
        /// The simplex.
        id: SimplexId,
        /// The labels of its vertices, separated by commas.
        simplex: String,
    },
    /// A simplex has another partial co-boundary.
    #[error("simplex {simplex} (id {}): its partial co-boundary is {found}, but must be {expected}", id.index())]
    Coboundary {
        /// The simplex.
        id: SimplexId,
        /// The labels of its vertices, separated by commas.
        simplex: String,
        /// What the file has: simplices by their labels.
        found: String,
        /// What it must have.
        expected: String,
    },
    /// The same lists in another layout.
    #[error("section '{section}' differs from that of the rebuilt complex")]
    Layout {
        /// The section.
        section: SectionKind,
    },
}

/// Builds the complex again from its own top simplices and compares boundary, pointers, lists and flags.
///
/// Cost: that of building, in time and memory. Asks for a complex that [`Complex::validate`] accepts; of another one it
/// says some difference.
///
/// # Errors
/// [`RebuildError`]: the first simplex that differs, or why there is nothing to compare with.
pub fn rebuild<I: Index>(complex: &Complex<'_, I>, options: &BuildOptions<'_>) -> Result<(), RebuildError> {
    let built = build_again(complex, options)?;
    let (width, pairs) = (Some(I::WIDTH), complex.has_pairs());
    let encode = EncodeOptions { width, pairs, tree: false, checksums: false, ..EncodeOptions::default() };
    let bytes = Encoding::new(&built, &encode)?.to_bytes()?;
    drop(built);
    let loaded = super::Loaded::from_file_bytes(bytes)?;
    compare(complex, &Complex::from_bytes(loaded.bytes())?)
}

/// The complex of the top simplices, with the vertices in the order of the file.
fn build_again<I: Index>(complex: &Complex<'_, I>, options: &BuildOptions<'_>) -> Result<Built, BuildError> {
    let too_many = |_| BuildError::TooManyVertices(complex.num_vertices());
    u32::try_from(complex.num_vertices()).map_err(too_many)?;
    let mut soup = Soup::new(Labels::Numbered(complex.num_vertices()), true);
    let mut word = Vec::new();
    for top in top_simplices(complex) {
        word.clear();
        word.extend(complex.vertices(top.id).map(|vertex| u32::try_from(vertex.index()).unwrap_or(u32::MAX)));
        // Only a buffer that is no complex has simplices without vertices.
        if !word.is_empty() {
            soup.push(&word);
        }
    }
    build(soup, options)
}

fn compare<I: Index>(found: &Complex<'_, I>, expected: &Complex<'_, I>) -> Result<(), RebuildError> {
    let dims = found.dim().max(expected.dim()).map_or(0, |dim| dim + 1);
    for dim in 0..dims {
        let (found, expected) = (found.num_simplices_of_dim(dim), expected.num_simplices_of_dim(dim));
        if found != expected {
            return Err(RebuildError::Count { dim, found, expected });
        }
    }
    let sections =
        [SectionKind::Boundary, SectionKind::Pointers, SectionKind::Lists, SectionKind::Flags, SectionKind::Pairs];
    let (have, must) = (found.container(), expected.container());
    let Some(section) = sections.into_iter().find(|&kind| have.section(kind) != must.section(kind)) else {
        return Ok(());
    };
    for id in found.simplices() {
        let simplex = || simplex_name(found, id);
        if !found.facets(id).eq(expected.facets(id)) {
            return Err(RebuildError::Facets { id, simplex: simplex() });
        }
        // One more than there must be is enough to see that there are too many.
        let must = expected.partial_coboundary(id);
        let have = found.partial_coboundary(id).take(must.clone().count() + 1);
        if !have.clone().eq(must.clone()) {
            let (found, expected) = (list(found, have), list(found, must));
            return Err(RebuildError::Coboundary { id, simplex: simplex(), found, expected });
        }
    }
    Err(RebuildError::Layout { section })
}

/// Simplices for a message: all if they are few.
fn list<I: Index>(complex: &Complex<'_, I>, simplices: impl Iterator<Item = SimplexId>) -> String {
    const MOST: usize = 6;
    let mut names: Vec<_> = simplices.take(MOST + 1).map(|simplex| simplex_name(complex, simplex)).collect();
    if names.len() > MOST {
        names[MOST] = "…".to_owned();
    }
    format!("{{{}}}", names.join(" "))
}
