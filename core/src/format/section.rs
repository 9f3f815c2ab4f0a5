//! Sections and the typed columns in them.

use core::fmt;
use core::ops::Range;

use crate::id::{Dim, Index, IndexWidth};

/// What a section holds. The numbers are part of the format.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
#[repr(u16)]
#[non_exhaustive]
pub enum SectionKind {
    /// The first id of each dimension: d + 1 indices (sig-2004, 4.2: the lookup table).
    Lookup = 1,
    /// B_{p,p−1}, 0 < p ≤ d: F\[σ\]\[0..=p\] in the order of the ids.
    Boundary = 2,
    /// One pointer for each simplex of dimension below d; below d − 1 beside pairs.
    Pointers = 3,
    /// The partial co-boundary lists, each ended by one stop code.
    Lists = 4,
    /// One flag for each simplex of dimension below d, or d − 1 beside pairs: the pointer is the only cluster's d-simplex.
    Flags = 5,
    /// The first child of each simplex of dimension below d, and the number of simplices at the end.
    ChildOffsets = 6,
    /// The last vertex of each simplex.
    LastVertices = 7,
    /// The labels of the vertices: integers.
    IntegerLabels = 8,
    /// Where the textual labels of the vertices start, and the length of them all at the end.
    LabelOffsets = 9,
    /// The textual labels of the vertices, UTF-8, one after the other.
    LabelText = 10,
    /// Coordinates of the vertices.
    Coordinates = 11,
    /// One bit for each top simplex, in the order of the ids: whether sorting its vertices was an odd permutation.
    Parity = 12,
    /// The filtration value of each simplex.
    Filtration = 13,
    /// A named column over the simplices of one dimension.
    Attribute = 14,
    /// Where the complex comes from: UTF-8 text of the caller's.
    Provenance = 15,
    /// CRC-32 of the blocks of all other sections, and of these checksums at the end.
    Checksums = 16,
    /// Where the lower neighbours of each vertex start, and the number of edges at the end.
    LowerOffsets = 17,
    /// The lower neighbours of each vertex, increasing: the other ends of its edges that come before it.
    LowerNeighbours = 18,
    /// Two indices for each simplex of dimension d − 1: its d-simplices, where none has more than two (sig-2004, 7.4).
    Pairs = 19,
    /// Where the boundary of each base cell starts in the arcs, and the end of the last one.
    BaseOffsets = 32,
    /// Arcs of a cell complex: a neighbour and how it is incident, packed.
    CellArcs = 33,
    /// Incidences that no packed arc holds: the place of the arc, the multiplicity and the sign.
    LargeIncidences = 34,
    /// The cell of the full complex that each cell is.
    Origins = 35,
    /// Where the arcs of each refinement start, and the end of the last one.
    RefinementOffsets = 36,
    /// The dimension of the lower cell of each refinement, and the sign of the pair.
    RefinementShapes = 37,
    /// The lengths of the first three lists of each refinement.
    RefinementSplits = 38,
    /// The error of the complex without the refinement.
    RefinementErrors = 39,
    /// The vertex of the full complex where each refinement is.
    RefinementSites = 40,
    /// The refinements as a tree over the coordinates of their sites.
    SiteTree = 41,
}

impl SectionKind {
    /// Every kind, in the order of their numbers.
    pub const ALL: [Self; 29] = [
        Self::Lookup,
        Self::Boundary,
        Self::Pointers,
        Self::Lists,
        Self::Flags,
        Self::ChildOffsets,
        Self::LastVertices,
        Self::IntegerLabels,
        Self::LabelOffsets,
        Self::LabelText,
        Self::Coordinates,
        Self::Parity,
        Self::Filtration,
        Self::Attribute,
        Self::Provenance,
        Self::Checksums,
        Self::LowerOffsets,
        Self::LowerNeighbours,
        Self::Pairs,
        Self::BaseOffsets,
        Self::CellArcs,
        Self::LargeIncidences,
        Self::Origins,
        Self::RefinementOffsets,
        Self::RefinementShapes,
        Self::RefinementSplits,
        Self::RefinementErrors,
        Self::RefinementSites,
        Self::SiteTree,
    ];

    /// The number of the kind in the section table.
    #[must_use]
    pub const fn code(self) -> u16 {
        self as u16
    }

    pub(super) fn from_code(code: u16) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.code() == code)
    }

    /// Whether files of kind SIG have the section and trees do not.
    pub(crate) const fn is_of_sig_only(self) -> bool {
        matches!(self, Self::Boundary | Self::Pointers | Self::Lists | Self::Flags | Self::Parity | Self::Pairs)
    }

    /// Whether no simplicial complex has such a section.
    pub(crate) fn is_of_cells(self) -> bool {
        self >= Self::BaseOffsets
    }

    /// The name of the kind, as `FORMAT.md` has it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lookup => "lookup",
            Self::Boundary => "boundary",
            Self::Pointers => "pointers",
            Self::Lists => "lists",
            Self::Flags => "flags",
            Self::ChildOffsets => "child-offsets",
            Self::LastVertices => "last-vertices",
            Self::IntegerLabels => "integer-labels",
            Self::LabelOffsets => "label-offsets",
            Self::LabelText => "label-text",
            Self::Coordinates => "coordinates",
            Self::Parity => "parity",
            Self::Filtration => "filtration",
            Self::Attribute => "attribute",
            Self::Provenance => "provenance",
            Self::Checksums => "checksums",
            Self::LowerOffsets => "lower-offsets",
            Self::LowerNeighbours => "lower-neighbours",
            Self::Pairs => "pairs",
            Self::BaseOffsets => "base-offsets",
            Self::CellArcs => "cell-arcs",
            Self::LargeIncidences => "large-incidences",
            Self::Origins => "origins",
            Self::RefinementOffsets => "refinement-offsets",
            Self::RefinementShapes => "refinement-shapes",
            Self::RefinementSplits => "refinement-splits",
            Self::RefinementErrors => "refinement-errors",
            Self::RefinementSites => "refinement-sites",
            Self::SiteTree => "site-tree",
        }
    }
}

impl fmt::Display for SectionKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The elements of a section, where they lie, in the host's byte order.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Column<'a> {
    /// Bits, least significant first within a byte, padded with zero bits.
    Bits {
        /// The bytes that hold them.
        bytes: &'a [u8],
        /// How many bits there are.
        len: usize,
    },
    /// Bytes.
    U8(&'a [u8]),
    /// 16-bit integers.
    U16(&'a [u16]),
    /// 32-bit integers.
    U32(&'a [u32]),
    /// 64-bit integers.
    U64(&'a [u64]),
    /// Single-precision numbers.
    F32(&'a [f32]),
    /// Double-precision numbers.
    F64(&'a [f64]),
    /// 32-bit integers with sign.
    I32(&'a [i32]),
    /// 64-bit integers with sign.
    I64(&'a [i64]),
}

impl<'a> Column<'a> {
    /// A column of indices.
    #[must_use]
    pub fn from_indices<I: Index>(indices: &'a [I]) -> Self {
        let bytes: &[u8] = bytemuck::cast_slice(indices);
        match I::WIDTH {
            IndexWidth::Bits16 => Self::U16(bytemuck::cast_slice(bytes)),
            IndexWidth::Bits32 => Self::U32(bytemuck::cast_slice(bytes)),
            IndexWidth::Bits64 => Self::U64(bytemuck::cast_slice(bytes)),
        }
    }

    /// The number of elements.
    #[must_use]
    pub const fn len(&self) -> usize {
        match self {
            Self::Bits { len, .. } => *len,
            Self::U8(column) => column.len(),
            Self::U16(column) => column.len(),
            Self::U32(column) => column.len(),
            Self::U64(column) => column.len(),
            Self::F32(column) => column.len(),
            Self::F64(column) => column.len(),
            Self::I32(column) => column.len(),
            Self::I64(column) => column.len(),
        }
    }

    /// Whether there is no element.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The bytes of the column in the host's order.
    #[must_use]
    pub fn as_bytes(&self) -> &'a [u8] {
        match self {
            Self::Bits { bytes, .. } => bytes,
            Self::U8(column) => column,
            Self::U16(column) => bytemuck::cast_slice(column),
            Self::U32(column) => bytemuck::cast_slice(column),
            Self::U64(column) => bytemuck::cast_slice(column),
            Self::F32(column) => bytemuck::cast_slice(column),
            Self::F64(column) => bytemuck::cast_slice(column),
            Self::I32(column) => bytemuck::cast_slice(column),
            Self::I64(column) => bytemuck::cast_slice(column),
        }
    }

    /// The element in row `row` as a `usize`, if the column holds integers of 16 bits or more and has that row;
    /// `usize::MAX` where the host's `usize` is too narrow.
    #[must_use]
    #[inline]
    pub fn index_at(&self, row: usize) -> Option<usize> {
        match self {
            Self::U16(column) => column.get(row).map(|value| value.to_usize()),
            Self::U32(column) => column.get(row).map(|value| value.to_usize()),
            Self::U64(column) => column.get(row).map(|value| value.to_usize()),
            _ => None,
        }
    }

    /// The element in row `row` as an `f64`, if the column holds numbers and has that row.
    #[must_use]
    #[inline]
    pub fn number_at(&self, row: usize) -> Option<f64> {
        match self {
            Self::F32(column) => column.get(row).map(|&value| f64::from(value)),
            Self::F64(column) => column.get(row).copied(),
            _ => None,
        }
    }

    /// Bit `row`, if the column holds bits and has that row.
    #[must_use]
    #[inline]
    pub fn bit_at(&self, row: usize) -> Option<bool> {
        match self {
            Self::Bits { bytes, len } if row < *len => bytes.get(row / 8).map(|byte| byte >> (row % 8) & 1 == 1),
            _ => None,
        }
    }

    /// The first of the rows in `range`, whose integers increase, that holds `value` or more; the end of the range if none
    /// does.
    #[inline]
    pub(crate) fn lower_bound(&self, range: Range<usize>, value: usize) -> usize {
        let before = match self {
            Self::U16(column) => num_below(column, &range, value),
            Self::U32(column) => num_below(column, &range, value),
            Self::U64(column) => num_below(column, &range, value),
            _ => 0,
        };
        range.start + before
    }

    /// The row in `range`, whose integers increase, that holds `value`.
    #[inline]
    pub(crate) fn find(&self, range: Range<usize>, value: usize) -> Option<usize> {
        match self {
            Self::U16(column) => find_in(column, range, value),
            Self::U32(column) => find_in(column, range, value),
            Self::U64(column) => find_in(column, range, value),
            _ => None,
        }
    }

    pub(crate) const fn element_code(&self) -> u8 {
        match self {
            Self::Bits { .. } => 0,
            Self::U8(_) => 1,
            Self::U16(_) => 2,
            Self::U32(_) => 3,
            Self::U64(_) => 4,
            Self::F32(_) => 5,
            Self::F64(_) => 6,
            Self::I32(_) => 7,
            Self::I64(_) => 8,
        }
    }

    /// The column of `len` elements of type `code` that `bytes` are; `None` if the code is unknown, or the bytes are
    /// too few, too many or misaligned.
    pub(super) fn from_parts(code: u8, len: usize, bytes: &'a [u8]) -> Option<Self> {
        let column = match code {
            0 => Self::Bits { bytes, len },
            1 => Self::U8(bytes),
            2 => Self::U16(bytemuck::try_cast_slice(bytes).ok()?),
            3 => Self::U32(bytemuck::try_cast_slice(bytes).ok()?),
            4 => Self::U64(bytemuck::try_cast_slice(bytes).ok()?),
            5 => Self::F32(bytemuck::try_cast_slice(bytes).ok()?),
            6 => Self::F64(bytemuck::try_cast_slice(bytes).ok()?),
            7 => Self::I32(bytemuck::try_cast_slice(bytes).ok()?),
            8 => Self::I64(bytemuck::try_cast_slice(bytes).ok()?),
            _ => return None,
        };
        (column.len() == len && bytes.len() as u64 == byte_len(code, len as u64)?).then_some(column)
    }
}

/// Up to how many indices are searched from the start. A processor guesses where such a search ends and goes on, while it
/// waits for the indices; halving takes the guess from it, for there each step needs the one before.
const SHORT: usize = 16;

/// Whether memory is far away, so that reading ahead is worth its code: not on machines of 32 bits, which are small.
pub(crate) const WAITS: bool = cfg!(not(target_pointer_width = "32"));

/// Into how many parts a step of a search in many indices divides them.
const PARTS: usize = 16;

/// How many of the indices in a range, which increase, are less than a value.
#[inline]
fn num_below<I: Index>(column: &[I], range: &Range<usize>, value: usize) -> usize {
    let indices = column.get(range.clone()).unwrap_or(&[]);
    indices.partition_point(|index| index.to_usize() < value)
}

/// How many of some indices, which do not decrease, are not more than a value.
///
/// A step reads an index of each of [`PARTS`] parts, for the memory delivers them together, where halving waits for one
/// after the other.
pub(crate) fn num_up_to<I: Index>(indices: &[I], value: usize) -> usize {
    if !WAITS {
        return indices.partition_point(|index| index.to_usize() <= value);
    }
    let (mut before, mut rest) = (0, indices);
    while rest.len() > PARTS {
        let step = rest.len() / PARTS;
        let is_in_or_after = |part: &usize| rest.get(part * step).is_some_and(|index| index.to_usize() <= value);
        let part = (1..PARTS).filter(is_in_or_after).count();
        let end = if part + 1 == PARTS { rest.len() } else { (part + 1) * step };
        before += part * step;
        rest = rest.get(part * step..end).unwrap_or(&[]);
    }
    before + rest.iter().filter(|index| index.to_usize() <= value).count()
}

/// The first place from `start` on in indices that increase that holds `value` or more; the end if none does. Cost: the
/// logarithm of how far it is.
#[inline]
pub(crate) fn first_from<I: Index>(indices: &[I], start: usize, value: usize) -> usize {
    let is_before = |index: &I| index.to_usize() < value;
    let (mut low, mut step) = (start, 1);
    while indices.get(low).is_some_and(is_before) {
        let high = low.saturating_add(step);
        match indices.get(high) {
            Some(index) if is_before(index) => (low, step) = (high, step * 2),
            _ => {
                let high = high.min(indices.len());
                let between = indices.get(low..high).unwrap_or(&[]);
                return low + between.partition_point(is_before);
            }
        }
    }
    low.min(indices.len()).max(start)
}

/// The row in a range, whose indices increase, that holds a value.
#[inline]
fn find_in<I: Index>(column: &[I], range: Range<usize>, value: usize) -> Option<usize> {
    let (start, indices) = (range.start, column.get(range)?);
    let place = if indices.len() <= SHORT {
        indices.iter().position(|index| index.to_usize() >= value)?
    } else {
        indices.partition_point(|index| index.to_usize() < value)
    };
    (indices.get(place)?.to_usize() == value).then_some(start + place)
}

/// Bytes of an element of type `code`; `None` for bits and for unknown codes.
pub(super) const fn element_bytes(code: u8) -> Option<usize> {
    match code {
        1 => Some(1),
        2 => Some(2),
        3 | 5 | 7 => Some(4),
        4 | 6 | 8 => Some(8),
        _ => None,
    }
}

/// Bytes of `len` elements of type `code`; `None` if the code is unknown or the number does not fit.
pub(super) fn byte_len(code: u8, len: u64) -> Option<u64> {
    if code == 0 { Some(len.div_ceil(8)) } else { len.checked_mul(element_bytes(code)? as u64) }
}

/// A section: a column with what the table says of it.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Section<'a> {
    /// What the section holds.
    pub kind: SectionKind,
    /// The dimension to which the section belongs, where it belongs to one.
    pub dim: Option<Dim>,
    /// The name of an attribute; empty otherwise.
    pub name: &'a str,
    /// Elements a row: 1, or the number of components of a vector.
    pub components: u32,
    /// The elements: rows × components of them.
    pub column: Column<'a>,
}

impl<'a> Section<'a> {
    /// A section of one component that belongs to the whole complex.
    #[must_use]
    pub const fn new(kind: SectionKind, column: Column<'a>) -> Self {
        Self { kind, dim: None, name: "", components: 1, column }
    }
}
