//! The whole complex, as far as it is known when all pieces are counted: where in the file everything goes.

use std::fs::File;
use std::io;

use memmap2::MmapOptions;
use sig_core::format::{Column, Encoder, Kind, Section, SectionKind};
use sig_core::{Dim, IndexWidth};

use super::Error;
use super::output::{Output, Pen};
use super::piece::Counted;
use crate::soup::{Coordinates, Labels};
use crate::store::{
    EncodeError, EncodeOptions, EncodedLabels, LOWER_NEIGHBOURS_FROM, coordinate_column, width_for, width_of_vertices,
};

/// The first id of each dimension, and for each piece where what it owns starts.
pub(super) struct Whole {
    pub(super) first: Vec<usize>,
    pub(super) num_simplices: usize,
    /// By piece and dimension: the first id, the first entry in the lists, the first of the top simplices.
    pub(super) ids: Vec<Vec<usize>>,
    pub(super) lists: Vec<Vec<usize>>,
    pub(super) tops: Vec<Vec<usize>>,
    /// By piece: the first lower neighbour.
    pub(super) lower: Vec<usize>,
    num_entries: usize,
    num_tops: usize,
    is_oriented: bool,
    /// The largest id or list offset.
    largest: u64,
}

/// For each dimension and piece in this order the sum of what came before; by piece and dimension. And the sum of all.
fn sums(pieces: usize, dims: usize, count: impl Fn(usize, Dim) -> usize) -> (Vec<Vec<usize>>, usize) {
    let mut sums = vec![vec![0; dims]; pieces];
    let mut sum = 0;
    for dim in 0..dims {
        for (piece, sums) in sums.iter_mut().enumerate() {
            sums[dim] = sum;
            sum += count(piece, dim);
        }
    }
    (sums, sum)
}

impl Whole {
    pub(super) fn new(pieces: &[Counted]) -> Self {
        let dims = pieces.iter().map(|piece| piece.simplices.len()).max().unwrap_or(0);
        let (ids, num_simplices) = sums(pieces.len(), dims, |piece, dim| pieces[piece].num(dim));
        let first = ids.first().cloned().unwrap_or_default();
        let whole = dims.saturating_sub(1);
        let (lists, num_entries) = sums(pieces.len(), whole, |piece, dim| pieces[piece].entries(dim, whole));
        let tops_of = |piece: usize, dim: Dim| pieces[piece].report.top_simplices.get(dim).copied().unwrap_or(0);
        let (tops, num_tops) = sums(pieces.len(), dims, tops_of);
        let is_oriented = (0..pieces.len()).any(|piece| (1..dims).any(|dim| tops_of(piece, dim) > 0));
        let lower = sums(pieces.len(), 1, |piece, _| pieces[piece].lower).0.concat();
        let last = pieces.iter().rev().find(|piece| whole > 0 && piece.num(whole - 1) > 0);
        let last_list = last.map_or(0, |piece| num_entries - piece.last_entries(whole));
        let largest = num_simplices.saturating_sub(1).max(last_list) as u64;
        Self { first, num_simplices, ids, lists, tops, lower, num_entries, num_tops, is_oriented, largest }
    }

    /// The number of simplices of each dimension.
    pub(super) fn counts(&self) -> Vec<usize> {
        let ends = self.first.iter().skip(1).chain([&self.num_simplices]);
        self.first.iter().zip(ends).map(|(first, end)| end - first).collect()
    }

    /// Where the rows of dimension `dim` > 0 start in the boundary relations.
    pub(super) fn rows(&self, dim: Dim) -> usize {
        self.counts().iter().enumerate().take(dim).skip(1).map(|(p, count)| (p + 1) * count).sum()
    }

    /// Lays out the file and writes everything but what the pieces have: header, lookup table, labels, coordinates.
    pub(super) fn begin<'f>(
        &self,
        file: &'f File,
        labels: &Labels,
        coordinates: Option<&Coordinates>,
        options: &EncodeOptions<'_>,
    ) -> Result<(Output<'f>, IndexWidth, u64), Error> {
        let width = width_for(self.largest, options)?;
        let shapes = self.shapes(width, labels.len(), options);
        let below = self.first.last().copied().unwrap_or(0);
        // The encoder looks at the lengths of these columns only, so they are one and the same memory that is never
        // touched, hence never there.
        let bit_bytes = below.max(self.num_tops) / 8 + 1;
        let largest = shapes.iter().map(|&(_, width, count)| count * bytes(width)).fold(bit_bytes, usize::max);
        let room = MmapOptions::new().len(largest).no_reserve_swap().map_anon()?;
        let column = |width, count: usize| match width {
            IndexWidth::Bits16 => Column::U16(bytemuck::cast_slice(&room[..2 * count])),
            IndexWidth::Bits32 => Column::U32(bytemuck::cast_slice(&room[..4 * count])),
            IndexWidth::Bits64 => Column::U64(bytemuck::cast_slice(&room[..8 * count])),
        };
        let bits = |len: usize| Column::Bits { bytes: &room[..len.div_ceil(8)], len };
        let mut sections: Vec<_> =
            shapes.iter().map(|&(kind, width, count)| Section::new(kind, column(width, count))).collect();
        sections.push(Section::new(SectionKind::Flags, bits(below)));
        if self.is_oriented {
            sections.push(Section::new(SectionKind::Parity, bits(self.num_tops)));
        }
        let labels = EncodedLabels::new(labels);
        let known = known_sections(&labels, coordinates, options.provenance);
        sections.extend(known.iter().copied());
        sections.sort_by_key(|section| section.kind);
        let format = EncodeError::Format;
        let encoder = Encoder::new(Kind::Sig, width, self.first.len(), self.num_simplices as u64, &sections);
        let mut encoder = encoder.map_err(format)?;
        if options.checksums {
            encoder = encoder.with_checksums().map_err(format)?;
        }
        let element = |kind: SectionKind| {
            let section = sections.iter().find(|section| section.kind == kind);
            section.map_or(size_of::<u32>(), |section| element_bytes(&section.column))
        };
        let output = Output::new(file, &encoder, options.checksums, element)?;
        let lookup: Vec<u64> = self.first.iter().map(|&first| first as u64).collect();
        let pen = output.pen();
        pen.column(SectionKind::Lookup, &Column::U64(&lookup))?;
        known.iter().try_for_each(|section| pen.column(section.kind, &section.column))?;
        self.end_offsets(&pen)?;
        let written = pen.end();
        output.add(written);
        Ok((output, width, encoder.file_bytes()))
    }

    /// The sections of integers that the pieces fill, and the lookup table: the width of each and how many there are.
    fn shapes(
        &self,
        width: IndexWidth,
        num_vertices: usize,
        options: &EncodeOptions<'_>,
    ) -> Vec<(SectionKind, IndexWidth, usize)> {
        let counts = self.counts();
        let below = self.first.last().copied().unwrap_or(0);
        let mut shapes = vec![
            (SectionKind::Lookup, width, self.first.len()),
            (SectionKind::Boundary, width, self.rows(self.first.len())),
            (SectionKind::Pointers, width, below),
            (SectionKind::Lists, width, self.num_entries),
        ];
        if options.tree {
            let vertex_width = width_of_vertices(num_vertices);
            let child_offsets = if self.num_simplices > 0 { below + 1 } else { 0 };
            shapes.push((SectionKind::ChildOffsets, width, child_offsets));
            shapes.push((SectionKind::LastVertices, vertex_width, self.num_simplices));
            if options.lower_neighbours.unwrap_or(self.first.len() > LOWER_NEIGHBOURS_FROM) {
                shapes.push((SectionKind::LowerOffsets, width, num_vertices + 1));
                shapes.push((SectionKind::LowerNeighbours, vertex_width, counts.get(1).copied().unwrap_or(0)));
            }
        }
        shapes
    }

    /// Writes the last entries of the offsets, which are of no piece.
    fn end_offsets(&self, pen: &Pen<'_>) -> io::Result<()> {
        if let Some(&below) = self.first.last() {
            let mut run = pen.numbers(SectionKind::ChildOffsets, below);
            run.push(self.num_simplices as u64)?;
            run.finish()?;
        }
        let counts = self.counts();
        let mut run = pen.numbers(SectionKind::LowerOffsets, counts.first().copied().unwrap_or(0));
        run.push(counts.get(1).copied().unwrap_or(0) as u64)?;
        run.finish()
    }
}

/// The sections that are in memory.
fn known_sections<'a>(
    labels: &'a EncodedLabels<'_>,
    coordinates: Option<&'a Coordinates>,
    provenance: Option<&'a str>,
) -> Vec<Section<'a>> {
    let mut known = match labels {
        EncodedLabels::Numbered => Vec::new(),
        EncodedLabels::Integers(labels) => vec![Section::new(SectionKind::IntegerLabels, Column::U64(labels))],
        EncodedLabels::Text { offsets, text } => vec![
            Section::new(SectionKind::LabelOffsets, Column::U64(offsets)),
            Section::new(SectionKind::LabelText, Column::U8(text.as_bytes())),
        ],
    };
    if let Some((components, column)) = coordinates.map(coordinate_column) {
        known.push(Section { components, ..Section::new(SectionKind::Coordinates, column) });
    }
    if let Some(provenance) = provenance {
        known.push(Section::new(SectionKind::Provenance, Column::U8(provenance.as_bytes())));
    }
    known
}

fn bytes(width: IndexWidth) -> usize {
    width.bits() as usize / 8
}

/// The bytes of an element, 1 of bits.
fn element_bytes(column: &Column<'_>) -> usize {
    match column {
        Column::Bits { .. } | Column::U8(_) => 1,
        Column::U16(_) => 2,
        Column::U32(_) | Column::I32(_) | Column::F32(_) => 4,
        Column::U64(_) | Column::I64(_) | Column::F64(_) => 8,
    }
}
