//! What can be wrong with the bytes of a container, and where.

use core::fmt;

use super::{BUFFER_ALIGN, Kind, SectionKind, VERSION};
use crate::id::{Dim, IndexWidth};

/// Why bytes are not a container, or not the one asked for. Offsets are in bytes from the start of the file.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum FormatError {
    /// The buffer does not start at a multiple of [`BUFFER_ALIGN`](super::BUFFER_ALIGN) bytes in memory.
    Misaligned,
    /// The buffer ends before the header or the section table does.
    Truncated {
        /// Bytes that the header or table needs.
        needed: u64,
        /// Bytes that there are.
        found: u64,
    },
    /// The first eight bytes are not the magic ones: another kind of file.
    NotASigFile,
    /// The buffer is in the other byte order than the host's.
    ForeignByteOrder,
    /// The file follows a major version of the format that this reader does not know.
    UnsupportedVersion {
        /// The file's major version.
        major: u16,
        /// The file's minor version.
        minor: u16,
    },
    /// The header declares another length than the buffer has.
    Length {
        /// The length that the header declares.
        declared: u64,
        /// The buffer's length.
        found: u64,
    },
    /// A field of the header has a value that the format does not define.
    Header {
        /// Where the field starts.
        offset: usize,
    },
    /// The header or the section table is damaged: its checksum does not agree.
    HeaderChecksum {
        /// The checksum that the header holds.
        stored: u32,
        /// The checksum of the bytes.
        computed: u32,
    },
    /// The file is larger than this host can address.
    TooLarge {
        /// The length that the header declares.
        length: u64,
    },
    /// An entry of the section table is wrong.
    Table {
        /// The number of the entry, from 0.
        entry: u32,
        /// What is wrong with it.
        error: TableError,
    },
    /// The file is of another kind than the view that was asked for.
    WrongKind {
        /// The kind of the file.
        found: Kind,
        /// The kind that was asked for.
        expected: Kind,
    },
    /// The file's indices are of another width than the view that was asked for.
    WrongWidth {
        /// The width of the file.
        found: IndexWidth,
        /// The width that was asked for.
        expected: IndexWidth,
    },
    /// A section that this kind of file must have is missing.
    MissingSection(SectionKind),
    /// A section breaks a rule of the format.
    Invalid {
        /// The section.
        section: SectionKind,
        /// The element of the section at which the rule is broken, from 0.
        element: u64,
        /// The rule.
        rule: Rule,
    },
    /// A block of a section is damaged: its checksum does not agree.
    Checksum {
        /// The section.
        section: SectionKind,
        /// The dimension to which the section belongs, where it belongs to one.
        dim: Option<Dim>,
        /// Where the block starts in the file.
        offset: u64,
        /// Bytes of the block.
        length: u64,
    },
    /// A byte between two sections is not zero.
    Padding {
        /// Where the byte stands.
        offset: u64,
    },
    /// The file has no checksums that could be verified.
    NoChecksums,
}

/// What is wrong with an entry of the section table.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum TableError {
    /// The kind is not one that this version of the format defines.
    UnknownKind(u16),
    /// The element type is not defined, or not the one that the kind asks for.
    ElementType(u8),
    /// The dimension is not one of the complex, or not one that the kind asks for.
    Dimension(u8),
    /// The number of components is zero or not the one that the kind asks for.
    Components(u32),
    /// The name is not UTF-8, holds a zero, is not where it must be, or is too long for the table.
    Name,
    /// The count is not the one that follows from the numbers of simplices.
    Count {
        /// The count in the entry.
        found: u64,
        /// The count that follows.
        expected: u64,
    },
    /// The section does not start where the one before it ends, rounded up.
    Offset {
        /// The offset in the entry.
        found: u64,
        /// The offset that follows.
        expected: u64,
    },
    /// The section reaches past the end of the file.
    PastEnd,
    /// The entries are not in strictly increasing order of (kind, dimension, name).
    Order,
}

/// A rule of the format that [`Complex::validate`](crate::Complex::validate) or the opening of a view checks.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Rule {
    /// The first ids of the dimensions start at 0 and increase strictly, up to the number of simplices, of which there are
    /// at least as many of each dimension as a simplex of the highest has.
    FirstIds,
    /// A boundary entry is a simplex of the dimension below.
    FacetRange,
    /// F\[F\[σ\]\[j\]\]\[i\] = F\[F\[σ\]\[i\]\]\[j−1\] for i < j.
    SemiSimplicial,
    /// The simplices of one dimension increase strictly by (F\[σ\]\[p\], F\[σ\]\[0\]), and F\[e\]\[1\] < F\[e\]\[0\].
    CanonicalOrder,
    /// A bit array is padded with zero bits, and flags are zero at dimension d − 1.
    FlagBits,
    /// The pointer of a flagged simplex is a d-simplex that contains it.
    FlaggedPointer,
    /// The pointer of an unflagged simplex is the offset at which the list before it ends.
    ListOffset,
    /// A list ends with a stop code, inside the section, and the last one ends the section.
    ListEnd,
    /// A list is ordered by decreasing dimension, then increasing id.
    ListOrder,
    /// A list entry is a top simplex that contains the owner of the list properly.
    ListEntry,
    /// A list that is one d-simplex must be a flagged pointer where p < d − 1.
    Unflagged,
    /// A simplex with a coface has an entry in its partial co-boundary.
    MissingEntry,
    /// Child offsets agree with the boundary.
    ChildOffset,
    /// Last vertices agree with the boundary.
    LastVertex,
    /// The child offsets of a dimension do not decrease, from the start of the next dimension to its end.
    OffsetOrder,
    /// The last vertices of siblings increase strictly, are above that of their parent, and are vertices; that of vertex v
    /// is v.
    SiblingOrder,
    /// All facets of a simplex are in the tree.
    MissingFacet,
    /// The lower neighbours of a vertex are the first ends of the edges that it ends, increasing.
    LowerNeighbours,
    /// Filtration values are not NaN, not −0, and do not decrease along faces.
    Filtration,
    /// Labels are UTF-8 between increasing offsets.
    Labels,
    /// Text is UTF-8.
    Text,
    /// Arcs lead by increasing number to cells of the dimension beside that were made before, with a multiplicity that is not
    /// zero and a sign that fits it.
    Arc,
    /// The offsets of lists of arcs do not decrease, and the lists of a refinement are as long as its arcs are many.
    ArcOffset,
    /// The dimension of a refinement is one of the complex.
    Shape,
    /// Errors are numbers, and a refinement's is not less than that of one that depends on it.
    ErrorOrder,
    /// There is an origin for each cell, and a site is a vertex of the full complex.
    Origin,
    /// The tree over the sites has each refinement once, between those above it, and each site has coordinates.
    SiteTree,
}

impl fmt::Display for FormatError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Misaligned => write!(f, "the buffer is not aligned to {BUFFER_ALIGN} bytes in memory"),
            Self::Truncated { needed, found } => write!(f, "truncated: {needed} bytes needed, {found} found"),
            Self::NotASigFile => f.write_str("not a SIG file: the first eight bytes are not its signature"),
            Self::ForeignByteOrder => {
                f.write_str("the buffer is in the other byte order than this host: load it with a swap instead")
            }
            Self::UnsupportedVersion { major, minor } => {
                let (ours, _) = VERSION;
                write!(f, "format version {major}.{minor}, but this reader knows version {ours}: use a newer reader")
            }
            Self::Length { declared, found } => {
                write!(f, "the header declares {declared} bytes, but there are {found}: cut off, or with a tail")
            }
            Self::Header { offset } => write!(f, "byte {offset}: undefined value in the header"),
            Self::HeaderChecksum { stored, computed } => {
                write!(f, "damaged header: checksum {stored:08x} stored, {computed:08x} computed")
            }
            Self::TooLarge { length } => write!(f, "{length} bytes are more than this host can address"),
            Self::Table { entry, error } => write!(f, "section table, entry {entry}: {error}"),
            Self::WrongKind { found, expected } => write!(f, "the file holds a {found}, not a {expected}"),
            Self::WrongWidth { found, expected } => {
                write!(f, "indices of {} bits in the file, {} bits asked for", found.bits(), expected.bits())
            }
            Self::MissingSection(kind) => write!(f, "section '{kind}' is missing"),
            Self::Invalid { section, element, rule } => write!(f, "section '{section}', element {element}: {rule}"),
            Self::Checksum { section, dim, offset, length } => {
                write!(f, "section '{section}'")?;
                if let Some(dim) = dim {
                    write!(f, " of dimension {dim}")?;
                }
                write!(f, ": damaged between byte {offset} and byte {}", offset + length)
            }
            Self::Padding { offset } => write!(f, "byte {offset}: padding that is not zero"),
            Self::NoChecksums => f.write_str("the file has no checksums"),
        }
    }
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::UnknownKind(kind) => write!(f, "unknown section kind {kind}"),
            Self::ElementType(code) => write!(f, "element type {code} does not fit the section"),
            Self::Dimension(dim) => write!(f, "dimension {dim} does not fit the section"),
            Self::Components(components) => write!(f, "{components} components do not fit the section"),
            Self::Name => f.write_str("the name is not UTF-8, holds a zero, or is missing or not allowed here"),
            Self::Count { found, expected } => write!(f, "{found} elements, but {expected} follow from the complex"),
            Self::Offset { found, expected } => write!(f, "starts at byte {found} instead of {expected}"),
            Self::PastEnd => f.write_str("reaches past the end of the file"),
            Self::Order => f.write_str("not in increasing order of kind, dimension and name"),
        }
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::FirstIds => {
                "the first ids of the dimensions do not start at 0 and increase, by as much as one simplex takes"
            }
            Self::FacetRange => "a facet is not a simplex of the dimension below",
            Self::SemiSimplicial => "facets of facets do not agree (semi-simplicial identity)",
            Self::CanonicalOrder => "simplices are not in canonical order",
            Self::FlagBits => "a bit that must be zero is not",
            Self::FlaggedPointer => "a flagged pointer is not a simplex of the highest dimension around its owner",
            Self::ListOffset => "a pointer is not where the list before it ends",
            Self::ListEnd => "a list has no stop code at its end, or the last list does not end the section",
            Self::ListOrder => "a list is not by decreasing dimension, then increasing id",
            Self::ListEntry => "a list entry is not a top simplex around its owner",
            Self::Unflagged => "a list of a single simplex of the highest dimension must be a flagged pointer",
            Self::MissingEntry => "a simplex with cofaces has an empty partial co-boundary",
            Self::ChildOffset => "a child offset disagrees with the boundary",
            Self::LastVertex => "a last vertex disagrees with the boundary",
            Self::OffsetOrder => "a child offset is before the one before it, or in another dimension",
            Self::SiblingOrder => "a last vertex is not above that of the sibling before it, or of its parent",
            Self::MissingFacet => "a facet of the simplex is not in the tree",
            Self::LowerNeighbours => "the lower neighbours of a vertex are not those of its edges, increasing",
            Self::Filtration => "a filtration value is NaN, −0, or less than that of a face",
            Self::Labels => "labels are not UTF-8 between increasing offsets",
            Self::Text => "text is not UTF-8",
            Self::Arc => "an arc leads to a cell of the wrong dimension or order, or has no possible incidence",
            Self::ArcOffset => "lists of arcs are not one after the other, or not as long as their lengths say",
            Self::Shape => "the dimension of a refinement is not one of the complex",
            Self::ErrorOrder => "an error is not a number, or less than that of a refinement that depends on it",
            Self::Origin => "not as many origins as cells, or a site that is no cell of the full complex",
            Self::SiteTree => "the tree over the sites has a refinement in the wrong place, or one without coordinates",
        })
    }
}

impl core::error::Error for FormatError {}
