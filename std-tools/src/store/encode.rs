//! From the builder's arrays to the bytes of a file.
//!
//! The arrays are written as they are where they have the width of the file; only a narrower or wider file needs
//! copies. The layout of the bytes is the business of [`sig_core::format::Encoder`].

use std::borrow::Cow;
use std::io::{self, Write};

use rayon::prelude::*;
use sig_core::format::{self, Column, Encoder, Kind, Section, SectionKind};
use sig_core::{Dim, Index, IndexWidth};

use super::AlignedBytes;
use crate::attribute::Attribute;
use crate::build::{Arrays, Built, SigArrays};
use crate::frozen::{FrozenTree, LastVertices};
use crate::soup::{Coordinates, Labels, Scalars};

/// Bytes that one task copies.
const COPY: usize = 1 << 20;

/// The dimension from which on a SIG gets lower neighbours by default: they cost an index an edge, little where most
/// simplices are larger, and stars in such complexes have so many top simplices that the tree finds them faster than the
/// partial co-boundary.
pub(crate) const LOWER_NEIGHBOURS_FROM: usize = 4;

/// How a complex is encoded. The default: the least width, tree sections, checksums, no provenance.
#[derive(Clone, Copy, Debug)]
pub struct EncodeOptions<'a> {
    /// The index width; the least that fits if it is not given.
    pub width: Option<IndexWidth>,
    /// Whether the file carries the child offsets and last vertices, which make [`find`](sig_core::Complex::find) fast.
    pub tree: bool,
    /// Whether a SIG with the tree's sections carries the lower neighbours of each vertex too, which make
    /// [`star`](sig_core::Complex::star) and the like fast where simplices have many cofaces. If it is not given, it
    /// does from dimension 4 on.
    pub lower_neighbours: Option<bool>,
    /// Whether a SIG has the d-simplices of each (d−1)-simplex in a pair of fixed place in place of pointer, list and flag
    /// (sig-2004, 7.4), which takes κ_{d−1}^d integers less; for complexes in which none has more than two of them. Without
    /// meaning in dimension 0.
    pub pairs: bool,
    /// Whether the file carries checksums.
    pub checksums: bool,
    /// Where the complex comes from, in the caller's words; nothing of the kind is added by itself.
    pub provenance: Option<&'a str>,
}

impl Default for EncodeOptions<'_> {
    fn default() -> Self {
        Self { width: None, tree: true, lower_neighbours: None, pairs: false, checksums: true, provenance: None }
    }
}

/// Why a complex cannot be encoded.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EncodeError {
    /// The width that was asked for is too narrow.
    #[error(
        "indices of {} bits hold numbers up to {}, but this complex has ids or list offsets up to {largest}; \
         {} bits are enough", width.bits(), width.max_value(), least.bits()
    )]
    TooNarrow {
        /// The width that was asked for.
        width: IndexWidth,
        /// The largest number to be held.
        largest: u64,
        /// The least width that holds it.
        least: IndexWidth,
    },
    /// Pairs were asked for, and a simplex does not have room in one.
    #[error("simplex number {simplex}, of dimension {}, is a face of {cofaces} simplices; pairs have room for two", dim - 1)]
    Crowded {
        /// The first such simplex, of dimension d − 1, by its id.
        simplex: usize,
        /// d.
        dim: Dim,
        /// How many d-simplices have it as a face.
        cofaces: usize,
    },
    /// The sections cannot be a file: see [`format::EncodeError`].
    #[error("cannot encode the complex: {0}")]
    Format(#[from] format::EncodeError),
}

/// A complex, laid out as a file.
///
/// Built from the same complex with the same options it gives the same bytes, on every host.
#[derive(Clone, Debug)]
pub struct Encoding<'a> {
    kind: Kind,
    width: IndexWidth,
    dims: usize,
    num_simplices: usize,
    checksums: bool,
    /// The indices in the order of the sections, with what kind of section they are.
    indices: Vec<(SectionKind, Indices<'a>)>,
    flags: Option<(&'a [u8], usize)>,
    last_vertices: Option<Indices<'a>>,
    lower_neighbours: Option<Indices<'a>>,
    labels: EncodedLabels<'a>,
    coordinates: Option<(u32, Column<'a>)>,
    parity: Option<(&'a [u8], usize)>,
    filtration: Option<&'a [f64]>,
    provenance: Option<&'a str>,
    attributes: &'a [Attribute],
}

/// Integers of one of the widths of a file, borrowed where the builder has them at that width.
#[derive(Clone, Debug)]
enum Indices<'a> {
    Bits16(Cow<'a, [u16]>),
    Bits32(Cow<'a, [u32]>),
    Bits64(Cow<'a, [u64]>),
}

impl<'a> Indices<'a> {
    fn from_u32(values: &'a [u32], width: IndexWidth) -> Self {
        match width {
            IndexWidth::Bits16 => Self::Bits16(convert(values).into()),
            IndexWidth::Bits32 => Self::Bits32(values.into()),
            IndexWidth::Bits64 => Self::Bits64(convert(values).into()),
        }
    }

    fn from_u64(values: &'a [u64], width: IndexWidth) -> Self {
        match width {
            IndexWidth::Bits16 => Self::Bits16(convert(values).into()),
            IndexWidth::Bits32 => Self::Bits32(convert(values).into()),
            IndexWidth::Bits64 => Self::Bits64(values.into()),
        }
    }

    fn owned(values: Vec<u32>, width: IndexWidth) -> Self {
        match width {
            IndexWidth::Bits32 => Self::Bits32(values.into()),
            _ => Self::converted(&values, width),
        }
    }

    fn converted<I: Index>(values: &[I], width: IndexWidth) -> Self {
        match width {
            IndexWidth::Bits16 => Self::Bits16(convert(values).into()),
            IndexWidth::Bits32 => Self::Bits32(convert(values).into()),
            IndexWidth::Bits64 => Self::Bits64(convert(values).into()),
        }
    }

    fn column(&self) -> Column<'_> {
        match self {
            Self::Bits16(values) => Column::U16(values),
            Self::Bits32(values) => Column::U32(values),
            Self::Bits64(values) => Column::U64(values),
        }
    }
}

/// The same numbers at another width that is known to hold them; stop codes stay stop codes.
///
/// The child offsets end with the number of simplices, which is one more than the largest id: where it does not fit
/// below the stop code, it *is* the stop code of that width, as a number.
fn convert<A: Index, B: Index>(values: &[A]) -> Vec<B> {
    let convert =
        |value: &A| if *value == A::STOP { B::STOP } else { B::from_usize(value.to_usize()).unwrap_or(B::STOP) };
    values.iter().map(convert).collect()
}

#[derive(Clone, Debug)]
pub(crate) enum EncodedLabels<'a> {
    Numbered,
    Integers(&'a [u64]),
    Text { offsets: Vec<u64>, text: String },
}

impl<'a> EncodedLabels<'a> {
    pub(crate) fn new(labels: &'a Labels) -> Self {
        match labels {
            Labels::Numbered(_) => Self::Numbered,
            Labels::Integers(labels) if labels.iter().copied().eq(0..labels.len() as u64) => Self::Numbered,
            Labels::Integers(labels) => Self::Integers(labels),
            Labels::Tokens(labels) => {
                let mut text = String::with_capacity(labels.iter().map(|label| label.len()).sum());
                let mut offsets = Vec::with_capacity(labels.len() + 1);
                for label in labels {
                    offsets.push(text.len() as u64);
                    text.push_str(label);
                }
                offsets.push(text.len() as u64);
                Self::Text { offsets, text }
            }
        }
    }
}

impl<'a> Encoding<'a> {
    /// Lays out a complex. Cost: nothing but bookkeeping where the width of the file is that of the arrays, else one
    /// copy of them.
    ///
    /// # Errors
    /// [`EncodeError::TooNarrow`] if a width is asked for that does not hold the complex.
    pub fn new(built: &'a Built, options: &EncodeOptions<'a>) -> Result<Self, EncodeError> {
        let mut encoding = match &built.arrays {
            Arrays::Narrow(arrays) => Self::of_arrays(arrays, options, Indices::from_u32),
            Arrays::Wide(arrays) => Self::of_arrays(arrays, options, Indices::from_u64),
        }?;
        encoding.labels = EncodedLabels::new(&built.labels);
        encoding.coordinates = built.coordinates.as_ref().map(coordinate_column);
        encoding.filtration = built.filtration.as_deref();
        encoding.attributes = &built.attributes;
        let tops = &built.report.top_simplices;
        let num_tops = tops.iter().sum();
        // A vertex alone has no orientation.
        let is_oriented = tops.iter().skip(1).any(|&count| count > 0);
        encoding.parity = built.parity.as_deref().filter(|_| is_oriented).map(|parity| (parity, num_tops));
        Ok(encoding)
    }

    /// Lays out a simplex tree as a file of kind *tree*: labels, child offsets and the lower neighbours of each vertex, no
    /// boundary, no co-boundary. Cost: as [`new`](Self::new), and two passes over the edges. [`EncodeOptions::tree`] has no
    /// meaning here.
    ///
    /// # Errors
    /// [`EncodeError::TooNarrow`] if a width is asked for that does not hold the complex.
    pub fn of_tree(tree: &'a FrozenTree, options: &EncodeOptions<'a>) -> Result<Self, EncodeError> {
        let largest = tree.num_simplices.saturating_sub(1) as u64;
        let mut encoding = Self::of_levels(Kind::Tree, &tree.first, tree.num_simplices, largest, options)?;
        let width = encoding.width;
        encoding.indices.push((SectionKind::ChildOffsets, Indices::from_u32(&tree.child_offsets, width)));
        encoding.add_lower_neighbours(tree.num_vertices(), |vertex| {
            tree.children(vertex).map(|edge| tree.last_vertices.at(edge) as usize)
        });
        encoding.last_vertices = Some(match &tree.last_vertices {
            LastVertices::Bits16(vertices) => Indices::Bits16(vertices.into()),
            LastVertices::Bits32(vertices) => Indices::from_u32(vertices, width_of_vertices(tree.num_vertices())),
        });
        encoding.labels = EncodedLabels::new(&tree.labels);
        encoding.coordinates = tree.coordinates.as_ref().map(coordinate_column);
        encoding.filtration = tree.filtration.as_deref();
        Ok(encoding)
    }

    fn of_arrays<I: Index>(
        arrays: &'a SigArrays<I>,
        options: &EncodeOptions<'a>,
        at_width: fn(&'a [I], IndexWidth) -> Indices<'a>,
    ) -> Result<Self, EncodeError> {
        // Beside pairs, pointers, lists and flags end where the (d−1)-simplices begin.
        let pairs = if options.pairs { pairs(arrays)? } else { None };
        let listed = if pairs.is_some() { arrays.ids(arrays.first.len() - 2).start } else { arrays.pointers.len() };
        let lists = arrays.pointers.get(listed).map_or(arrays.lists.len(), |offset| offset.to_usize());
        let (pointers, lists) = (&arrays.pointers[..listed], &arrays.lists[..lists]);
        let largest = largest(arrays, listed);
        let mut encoding = Self::of_levels(Kind::Sig, &arrays.first, arrays.num_simplices, largest, options)?;
        let width = encoding.width;
        encoding.indices.extend([
            (SectionKind::Boundary, at_width(&arrays.boundary, width)),
            (SectionKind::Pointers, at_width(pointers, width)),
            (SectionKind::Lists, at_width(lists, width)),
        ]);
        encoding.flags = Some((&arrays.flags[..listed.div_ceil(8)], listed));
        if let Some(pairs) = pairs {
            encoding.indices.push((SectionKind::Pairs, Indices::converted(&pairs, width)));
        }
        if options.tree {
            encoding.indices.push((SectionKind::ChildOffsets, at_width(&arrays.child_offsets, width)));
            let least = width_of_vertices(arrays.ids(0).len());
            encoding.last_vertices = Some(Indices::from_u32(&arrays.last_vertices, least));
            if options.lower_neighbours.unwrap_or(arrays.first.len() > LOWER_NEIGHBOURS_FROM) {
                // In dimension 0 there are no offsets of children, nor children.
                let end = arrays.num_simplices;
                let offset = |vertex: usize| arrays.child_offsets.get(vertex).map_or(end, |offset| offset.to_usize());
                encoding.add_lower_neighbours(arrays.ids(0).len(), |vertex| {
                    arrays.last_vertices[offset(vertex)..offset(vertex + 1)].iter().map(|&end| end as usize)
                });
            }
        }
        Ok(encoding)
    }

    /// The lookup table of a complex with numbers up to `largest`, and nothing else yet.
    fn of_levels(
        kind: Kind,
        first: &[usize],
        num_simplices: usize,
        largest: u64,
        options: &EncodeOptions<'a>,
    ) -> Result<Self, EncodeError> {
        let width = width_for(largest, options)?;
        let first = first.iter().map(|&first| first as u64).collect::<Vec<_>>();
        let lookup = match width {
            IndexWidth::Bits16 => Indices::Bits16(convert(&first).into()),
            IndexWidth::Bits32 => Indices::Bits32(convert(&first).into()),
            IndexWidth::Bits64 => Indices::Bits64(first.into()),
        };
        Ok(Self {
            kind,
            width,
            dims: lookup.column().len(),
            num_simplices,
            checksums: options.checksums,
            indices: vec![(SectionKind::Lookup, lookup)],
            flags: None,
            last_vertices: None,
            lower_neighbours: None,
            labels: EncodedLabels::Numbered,
            coordinates: None,
            parity: None,
            filtration: None,
            provenance: options.provenance,
            attributes: &[],
        })
    }

    /// Adds the lower neighbours of all vertices, increasing for each, and where those of each vertex start, given the
    /// upper ones.
    fn add_lower_neighbours<U: Iterator<Item = usize>>(&mut self, vertices: usize, upper: impl Fn(usize) -> U) {
        let mut offsets = vec![0_u32; vertices + 1];
        (0..vertices).flat_map(&upper).for_each(|end| offsets[end + 1] += 1);
        for vertex in 0..vertices {
            offsets[vertex + 1] += offsets[vertex];
        }
        let mut free = offsets.clone();
        let mut neighbours = vec![0; offsets[vertices] as usize];
        for (vertex, number) in (0..vertices).zip(0..) {
            for end in upper(vertex) {
                neighbours[free[end] as usize] = number;
                free[end] += 1;
            }
        }
        self.indices.push((SectionKind::LowerOffsets, Indices::owned(offsets, self.width)));
        self.lower_neighbours = Some(Indices::owned(neighbours, width_of_vertices(vertices)));
    }

    /// The width of the indices.
    #[must_use]
    pub const fn width(&self) -> IndexWidth {
        self.width
    }

    fn sections(&self) -> Vec<Section<'_>> {
        let bits = |(bytes, len)| Column::Bits { bytes, len };
        let mut sections: Vec<_> =
            self.indices.iter().map(|(kind, indices)| Section::new(*kind, indices.column())).collect();
        let mut add = |kind, column| sections.push(Section::new(kind, column));
        if let Some(flags) = self.flags {
            add(SectionKind::Flags, bits(flags));
        }
        if let Some(last_vertices) = &self.last_vertices {
            add(SectionKind::LastVertices, last_vertices.column());
        }
        if let Some(lower_neighbours) = &self.lower_neighbours {
            add(SectionKind::LowerNeighbours, lower_neighbours.column());
        }
        match &self.labels {
            EncodedLabels::Numbered => {}
            EncodedLabels::Integers(labels) => add(SectionKind::IntegerLabels, Column::U64(labels)),
            EncodedLabels::Text { offsets, text } => {
                add(SectionKind::LabelOffsets, Column::U64(offsets));
                add(SectionKind::LabelText, Column::U8(text.as_bytes()));
            }
        }
        if let Some(parity) = self.parity {
            add(SectionKind::Parity, bits(parity));
        }
        if let Some(filtration) = self.filtration {
            add(SectionKind::Filtration, Column::F64(filtration));
        }
        if let Some(provenance) = self.provenance {
            add(SectionKind::Provenance, Column::U8(provenance.as_bytes()));
        }
        if let Some((components, column)) = self.coordinates {
            sections.push(Section { components, ..Section::new(SectionKind::Coordinates, column) });
        }
        sections.extend(self.attributes.iter().map(|attribute| Section {
            kind: SectionKind::Attribute,
            dim: Some(attribute.dim),
            name: &attribute.name,
            components: u32::try_from(attribute.components).unwrap_or(u32::MAX),
            column: attribute.values.column(),
        }));
        sections.sort_by_key(|section| (section.kind, section.dim, section.name));
        sections
    }

    fn with_encoder<T>(&self, use_encoder: impl FnOnce(&Encoder<'_>) -> T) -> Result<T, EncodeError> {
        let sections = self.sections();
        let encoder = Encoder::new(self.kind, self.width, self.dims, self.num_simplices as u64, &sections)?;
        let encoder = if self.checksums { encoder.with_checksums()? } else { encoder };
        Ok(use_encoder(&encoder))
    }

    /// The length of the file.
    ///
    /// # Errors
    /// [`EncodeError::Format`].
    #[expect(
        clippy::redundant_closure_for_method_calls,
        reason = "the method is for one lifetime of the sections only"
    )]
    pub fn file_bytes(&self) -> Result<u64, EncodeError> {
        self.with_encoder(|encoder| encoder.file_bytes())
    }

    /// Writes the file, in large pieces: the writer need not be buffered for the arrays' sake.
    ///
    /// # Errors
    /// Those of the writer; [`EncodeError`] as an [`io::Error`] of kind `InvalidInput`.
    pub fn write_to(&self, out: &mut (impl Write + ?Sized)) -> io::Result<()> {
        self.with_encoder(|encoder| encoder.write_with(crc32, |piece| out.write_all(piece)))
            .map_err(|error| io::Error::new(io::ErrorKind::InvalidInput, error))?
    }

    /// The file in memory, in the byte order of a file.
    ///
    /// # Errors
    /// [`EncodeError::Format`].
    pub fn to_bytes(&self) -> Result<AlignedBytes, EncodeError> {
        let too_large = EncodeError::Format(format::EncodeError::TooLarge);
        self.with_encoder(|encoder| {
            let mut bytes = AlignedBytes::zeroed(usize::try_from(encoder.file_bytes()).map_err(|_| too_large)?);
            let mut written = 0;
            encoder.write_with(crc32, |piece| {
                let room = &mut bytes[written..written + piece.len()];
                // On all threads, as the first touch of the room takes longer than the copy.
                room.par_chunks_mut(COPY).zip(piece.par_chunks(COPY)).for_each(|(to, from)| to.copy_from_slice(from));
                written += piece.len();
                Ok::<(), EncodeError>(())
            })?;
            Ok(bytes)
        })?
    }
}

/// The coordinates as a column, and how many a vertex has.
pub(crate) fn coordinate_column(coordinates: &Coordinates) -> (u32, Column<'_>) {
    let column = match &coordinates.values {
        Scalars::F32(values) => Column::F32(values),
        Scalars::F64(values) => Column::F64(values),
    };
    (u32::try_from(coordinates.dim).unwrap_or(u32::MAX), column)
}

/// The width of a file with ids and list offsets up to `largest`.
pub(crate) fn width_for(largest: u64, options: &EncodeOptions<'_>) -> Result<IndexWidth, EncodeError> {
    let least = IndexWidth::least_for(largest).unwrap_or(IndexWidth::Bits64);
    let width = options.width.unwrap_or(least);
    if width < least { Err(EncodeError::TooNarrow { width, largest, least }) } else { Ok(width) }
}

/// The width of the ids of `count` vertices where they are labels of tree nodes.
pub(crate) fn width_of_vertices(count: usize) -> IndexWidth {
    IndexWidth::least_for(count as u64).unwrap_or(IndexWidth::Bits64)
}

/// The largest id or list offset, where the first `listed` simplices have pointers.
fn largest<I: Index>(arrays: &SigArrays<I>, listed: usize) -> u64 {
    let last_id = arrays.num_simplices.saturating_sub(1);
    // Lists are in id order, so the last pointer that is no id is the largest offset; ids are not larger than the last one.
    let is_offset = |&simplex: &usize| arrays.flags[simplex / 8] >> (simplex % 8) & 1 == 0;
    let last_list = (0..listed).rev().find(is_offset).map_or(0, |simplex| arrays.pointers[simplex].to_usize());
    last_id.max(last_list) as u64
}

/// The d-simplices of each (d−1)-simplex, two indices each; `None` in dimension 0 and of the empty complex.
fn pairs<I: Index>(arrays: &SigArrays<I>) -> Result<Option<Vec<I>>, EncodeError> {
    let Some(dim @ 1..) = arrays.dim() else { return Ok(None) };
    let mut pairs = Vec::with_capacity(2 * arrays.ids(dim - 1).len());
    for simplex in arrays.ids(dim - 1) {
        let list = &arrays.lists[arrays.pointers[simplex].to_usize()..];
        // Clusters of one dimension more are simplices: the list has them all.
        match *list {
            [one, ..] if one == I::STOP => pairs.extend([I::STOP, I::STOP]),
            // A stop code ends the pair as it ends the list.
            [one, other, ..] if other == I::STOP => pairs.extend([one, I::STOP]),
            [one, other, end, ..] if end == I::STOP => pairs.extend([one, other]),
            _ => {
                let cofaces = list.iter().take_while(|&&entry| entry != I::STOP).count();
                return Err(EncodeError::Crowded { simplex, dim, cofaces });
            }
        }
    }
    Ok(Some(pairs))
}

/// The CRC-32 of a file's checksums, at the speed of the hardware.
pub(crate) fn crc32(before: u32, bytes: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new_with_initial(before);
    hasher.update(bytes);
    hasher.finalize()
}
