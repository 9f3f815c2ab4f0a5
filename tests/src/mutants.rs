//! Valid files, changed where it hurts: one index, one flag, a stop code, a whole section, a field of the header or the
//! table, a length. The header's checksum is made to fit, so that the damage gets past it.

use std::ops::Range;

use sig_core::format::{Column, Container, ENTRY_BYTES, Encoder, HEADER_BYTES, Section, SectionKind};
use sig_core::mcc::Mcc;
use sig_core::{IndexWidth, with_complex, with_tree};
use sig_tools::View;
use sig_tools::generate::SplitMix64;
use sig_tools::store::AlignedBytes;

use crate::encode::{Options, encode, encode_tree};
use crate::known;
use crate::mcc::{self, ask_mcc};
use crate::oracle::{Oracle, Word};
use crate::queries::{ask_everything, ask_tree, reseal};

/// Random numbers: the same mutant for the same seed, on every host.
#[derive(Clone, Debug)]
pub struct Random(SplitMix64);

impl Random {
    /// The generator whose state starts at `seed`.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(SplitMix64::new(seed))
    }

    fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// A number below `bound`; 0 if that is 0.
    pub fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.bits() % bound.max(1) as u64).unwrap_or(0)
    }

    fn of<T: Clone>(&mut self, choices: &[T]) -> Option<T> {
        choices.get(self.below(choices.len())).cloned()
    }
}

/// Small complexes as files of kind SIG and tree, at all widths, with and without the optional sections, and as multi-resolution
/// complexes.
#[must_use]
pub fn small_files() -> Vec<AlignedBytes> {
    let complexes =
        ["0123 0145 0156 027 078 09", "01234 1235 236 37 4 5", "012 023 045 056 07", "0 1 2 3", "012345", ""];
    complexes.into_iter().flat_map(|words| files_of(&known::words(words))).chain(mcc::small_files()).collect()
}

/// The same of complexes of some hundred simplices: surfaces and manifolds from the literature.
#[must_use]
pub fn medium_files() -> Vec<AlignedBytes> {
    let complexes =
        [known::seven_vertex_torus(), known::nine_vertex_complex_projective_plane(), known::cross_polytope(4)];
    complexes.iter().flat_map(|words| files_of(words)).collect()
}

fn files_of(words: &[Word]) -> Vec<AlignedBytes> {
    let oracle = Oracle::new(words);
    let mut files = Vec::new();
    for width in IndexWidth::ALL {
        files.push(encode(&oracle, &Options::bare(width)));
        files.push(encode(&oracle, &Options { tree: true, ..Options::bare(width) }));
        if oracle.is_thin() {
            files.push(encode(&oracle, &Options { pairs: true, ..Options::bare(width) }));
        }
    }
    let everything = Options::everything(&oracle, IndexWidth::Bits16);
    files.push(encode(&oracle, &everything));
    files.push(encode_tree(&oracle, &Options { parity: None, ..everything }));
    files.push(encode_tree(&oracle, &Options::bare(IndexWidth::Bits32)));
    files.push(encode_tree(&oracle, &Options { lower: true, ..Options::bare(IndexWidth::Bits64) }));
    files
}

/// A kind of damage.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Damage {
    /// One index, or one flag, becomes another.
    Element,
    /// A stop code becomes an index, or an index a stop code.
    StopCode,
    /// A section is filled with one value, reversed, or overwritten by a part of itself.
    Section,
    /// A section is left out, or has fewer elements, or those of another one; the table says so.
    Shape,
    /// A field of the header or the table.
    Field,
    /// The file ends early, or late, and its header agrees.
    Length,
}

impl Damage {
    /// All kinds.
    pub const ALL: [Self; 6] = [Self::Element, Self::StopCode, Self::Section, Self::Shape, Self::Field, Self::Length];

    /// Damages a file that can be opened; some damage may change nothing, where there is nothing to be damaged.
    #[must_use]
    pub fn applied(self, original: &AlignedBytes, random: &mut Random) -> AlignedBytes {
        if Container::from_bytes(original).is_err() {
            return original.clone();
        }
        let mut bytes = original.clone();
        match self {
            Self::Element => element(&mut bytes, random),
            Self::StopCode => stop_code(&mut bytes, random),
            Self::Section => section(&mut bytes, random),
            Self::Shape => return shape(original, random),
            Self::Field => field(&mut bytes, random),
            Self::Length => return length(original, random),
        }
        bytes
    }
}

/// What queries read.
const ARRAYS: [SectionKind; 20] = [
    SectionKind::Lookup,
    SectionKind::Boundary,
    SectionKind::Pointers,
    SectionKind::Lists,
    SectionKind::Flags,
    SectionKind::ChildOffsets,
    SectionKind::LastVertices,
    SectionKind::LowerOffsets,
    SectionKind::LowerNeighbours,
    SectionKind::Pairs,
    SectionKind::BaseOffsets,
    SectionKind::CellArcs,
    SectionKind::LargeIncidences,
    SectionKind::Origins,
    SectionKind::RefinementOffsets,
    SectionKind::RefinementShapes,
    SectionKind::RefinementSplits,
    SectionKind::RefinementErrors,
    SectionKind::RefinementSites,
    SectionKind::SiteTree,
];

/// The sections that are not empty, each with the bytes of an element (0 of one of bits) and where it lies.
fn sections_of(bytes: &AlignedBytes) -> Vec<(SectionKind, usize, Range<usize>)> {
    let Ok(container) = Container::from_bytes(bytes) else { return Vec::new() };
    let sections = container.sections().zip(container.spans()).filter(|(section, _)| !section.column.is_empty());
    sections.map(|(section, (kind, _, range))| (kind, range.len() / section.column.len(), range)).collect()
}

/// Where the elements of an array that queries read lie; of flags, a single byte.
fn arrays_of(bytes: &AlignedBytes) -> Vec<(SectionKind, usize, Range<usize>)> {
    sections_of(bytes).into_iter().filter(|(kind, ..)| ARRAYS.contains(kind)).collect()
}

fn total(bytes: &AlignedBytes) -> u64 {
    Container::from_bytes(bytes).map_or(0, |container| container.header().num_simplices)
}

/// An index that is special, or any one, or one that could be.
fn index(total: u64, random: &mut Random) -> u64 {
    match random.below(8) {
        0 => u64::MAX,
        1 => u64::MAX - 1,
        2 => random.bits(),
        3 => total,
        _ => random.bits() % total.saturating_add(2),
    }
}

fn element(bytes: &mut AlignedBytes, random: &mut Random) {
    let total = total(bytes);
    let Some((_, size, range)) = random.of(&arrays_of(bytes)) else { return };
    if size == 0 {
        bytes[range.start + random.below(range.len())] ^= 1 << random.below(8);
        return;
    }
    let at = range.start + size * random.below(range.len() / size);
    let value = index(total, random).to_le_bytes();
    bytes[at..at + size].copy_from_slice(&value[..size]);
}

fn stop_code(bytes: &mut AlignedBytes, random: &mut Random) {
    let total = total(bytes);
    let lists = sections_of(bytes).into_iter().find(|(kind, ..)| *kind == SectionKind::Lists);
    let Some((_, size, range)) = lists else { return element(bytes, random) };
    let (stops, entries): (Vec<_>, Vec<_>) =
        range.step_by(size).partition(|&at| bytes[at..at + size].iter().all(|&byte| byte == 0xFF));
    let (places, value) = match random.below(2) {
        0 => (stops, random.bits() % total.saturating_add(1)),
        _ => (entries, u64::MAX),
    };
    if let Some(at) = random.of(&places) {
        bytes[at..at + size].copy_from_slice(&value.to_le_bytes()[..size]);
    }
}

fn section(bytes: &mut AlignedBytes, random: &mut Random) {
    let total = total(bytes);
    let Some((_, size, range)) = random.of(&arrays_of(bytes)) else { return };
    let size = size.max(1);
    let part = |random: &mut Random| size * random.below(range.len() / size);
    match random.below(3) {
        0 => {
            let value = index(total, random).to_le_bytes();
            bytes[range].chunks_exact_mut(size).for_each(|element| element.copy_from_slice(&value[..size]));
        }
        1 => {
            let elements: Vec<u8> = bytes[range.clone()].chunks_exact(size).rev().flatten().copied().collect();
            bytes[range][..elements.len()].copy_from_slice(&elements);
        }
        _ => {
            let (from, to) = (part(random), part(random));
            let len = range.len() - from.max(to);
            bytes[range].copy_within(from..from + len, to);
        }
    }
}

/// A column without its last elements.
fn shortened(column: Column<'_>, rows: usize) -> Column<'_> {
    match column {
        Column::Bits { bytes, len } => {
            let len = rows.min(len);
            Column::Bits { bytes: &bytes[..len.div_ceil(8)], len }
        }
        Column::U8(values) => Column::U8(&values[..rows.min(values.len())]),
        Column::U16(values) => Column::U16(&values[..rows.min(values.len())]),
        Column::U32(values) => Column::U32(&values[..rows.min(values.len())]),
        Column::U64(values) => Column::U64(&values[..rows.min(values.len())]),
        Column::I32(values) => Column::I32(&values[..rows.min(values.len())]),
        Column::I64(values) => Column::I64(&values[..rows.min(values.len())]),
        Column::F32(values) => Column::F32(&values[..rows.min(values.len())]),
        Column::F64(values) => Column::F64(&values[..rows.min(values.len())]),
    }
}

fn shape(bytes: &AlignedBytes, random: &mut Random) -> AlignedBytes {
    let Ok(container) = Container::from_bytes(bytes) else { return bytes.clone() };
    let header = container.header();
    let mut sections: Vec<Section<'_>> =
        container.sections().filter(|section| section.kind != SectionKind::Checksums).collect();
    let (mut dims, mut count) = (header.dims, header.num_simplices);
    if !sections.is_empty() {
        let (at, other) = (random.below(sections.len()), random.below(sections.len()));
        match random.below(5) {
            0 => drop(sections.remove(at)),
            1 => sections[at].column = shortened(sections[at].column, sections[at].column.len().saturating_sub(1)),
            2 => sections[at].column = shortened(sections[at].column, random.below(sections[at].column.len())),
            3 => sections[at].column = sections[other].column,
            _ => sections[at].components = u32::try_from(random.below(4)).unwrap_or(0),
        }
    }
    match random.below(6) {
        0 => dims = random.below(33),
        1 => count = index(count, random),
        _ => {}
    }
    let Ok(encoder) = Encoder::new(header.kind, header.width, dims, count, &sections) else { return bytes.clone() };
    let Ok(length) = usize::try_from(encoder.file_bytes()) else { return bytes.clone() };
    let mut file = AlignedBytes::zeroed(length);
    match encoder.encode(&mut file) {
        Ok(_) => file,
        Err(_) => bytes.clone(),
    }
}

fn field(bytes: &mut AlignedBytes, random: &mut Random) {
    let entries = Container::from_bytes(bytes).map_or(5, |container| container.header().sections) as usize;
    let entries = entries.min(bytes.len().saturating_sub(HEADER_BYTES) / ENTRY_BYTES);
    let (at, size) = match random.below(3) {
        0 => [(14, 2), (16, 1), (17, 1), (18, 1), (20, 4), (24, 8), (32, 8), (32, 1), (44, 4)][random.below(9)],
        _ => {
            let entry = HEADER_BYTES + ENTRY_BYTES * random.below(entries);
            let (field, size) = [(0, 2), (2, 1), (3, 1), (4, 2), (6, 2), (8, 8), (16, 8), (16, 1)][random.below(8)];
            (entry + field, size)
        }
    };
    let old = bytes[at];
    let value = match random.below(4) {
        0 => u64::MAX,
        1 => random.bits(),
        2 => u64::from(old) + 1,
        _ => random.below(80) as u64,
    };
    bytes[at..at + size].copy_from_slice(&value.to_le_bytes()[..size]);
    reseal(bytes);
}

fn length(bytes: &AlignedBytes, random: &mut Random) -> AlignedBytes {
    let length = match random.below(3) {
        0 => random.below(bytes.len()),
        1 => 64 * random.below(bytes.len() / 64),
        _ => bytes.len() + 64 * (1 + random.below(4)),
    };
    let kept = length.min(bytes.len());
    let mut changed = AlignedBytes::zeroed(length);
    changed[..kept].copy_from_slice(&bytes[..kept]);
    if length >= HEADER_BYTES && random.below(4) > 0 {
        changed[24..32].copy_from_slice(&(length as u64).to_le_bytes());
        reseal(&mut changed);
    }
    changed
}

/// What came of a mutant.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fate {
    /// It was refused.
    Refused,
    /// It was opened, and answered with so many items in all.
    Answered(usize),
}

/// Opens a file and asks up to `simplices` of its simplices every query; a multi-resolution complex all.
///
/// # Panics
/// If a query panics, or gives more items than there can be; or if a file promises more simplices than its bytes can
/// hold, beside vertices, which take none.
#[must_use]
pub fn fate(bytes: &AlignedBytes, simplices: usize) -> Fate {
    let items = match View::from_bytes(bytes) {
        // Vertices alone take no bytes: there may be any number, and marks for all of them would not be made.
        Ok(view) if view_is_long(view, bytes.len()) => 0,
        Ok(View::Complex(any)) => with_complex!(any, complex => ask_everything(&complex, simplices)),
        Ok(View::Tree(any)) => with_tree!(any, tree => ask_tree(&tree, simplices)),
        Err(_) => match Mcc::from_bytes(bytes) {
            Ok(mcc) => ask_mcc(&mcc),
            Err(_) => return Fate::Refused,
        },
    };
    Fate::Answered(items)
}

/// Whether there are more simplices than bytes, which takes vertices without end.
fn view_is_long(view: View<'_>, bytes: usize) -> bool {
    let (total, vertices) = sig_tools::with_view!(view, complex => {
        (complex.num_simplices(), complex.num_simplices_of_dim(0))
    });
    assert!(total - vertices <= bytes, "{total} simplices, {vertices} of them vertices, in {bytes} bytes");
    vertices > bytes
}

/// A mutant by its number, of one of the files: one to four changes of one kind. The same for the same number.
///
/// # Panics
/// If there are no files.
#[must_use]
pub fn mutant(files: &[AlignedBytes], number: u64) -> (Damage, AlignedBytes) {
    let mut random = Random::new(number);
    let mut bytes = random.of(files).expect("some file");
    let damage = Damage::ALL[random.below(Damage::ALL.len())];
    for _ in 0..=random.below(4) {
        bytes = damage.applied(&bytes, &mut random);
    }
    (damage, bytes)
}
