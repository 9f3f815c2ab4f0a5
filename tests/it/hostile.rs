//! Damaged files that get past the header: each is refused, or answers every query on every simplex, within bounds and
//! without a panic.
//!
//! The damage is drawn from SplitMix64 with the seeds below, so that a failure can be had again from its number.

use sig_core::format::{Container, ENTRY_BYTES, HEADER_BYTES, SectionKind};
use sig_core::{IndexWidth, with_complex, with_tree};
use sig_tests::encode::{Options, encode, encode_tree};
use sig_tests::known;
use sig_tests::oracle::Oracle;
use sig_tests::queries::{ask_everything, ask_tree, reseal};
use sig_tools::View;
use sig_tools::store::AlignedBytes;

/// The seed of the first mutant; mutant k has this plus k.
const SEED: u64 = 2004;

/// SplitMix64 (Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ mixed >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ mixed >> 31
    }

    fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.next() % bound.max(1) as u64).unwrap()
    }
}

fn originals() -> Vec<AlignedBytes> {
    let complexes =
        ["0123 0145 0156 027 078 09", "01234 1235 236 37 4 5", "012 023 045 056 07", "0 1 2 3", "012345", ""];
    let mut originals = Vec::new();
    for words in complexes {
        let oracle = Oracle::new(&known::words(words));
        for width in IndexWidth::ALL {
            originals.push(encode(&oracle, &Options::bare(width)));
            originals.push(encode(&oracle, &Options { tree: true, ..Options::bare(width) }));
            if oracle.is_thin() {
                originals.push(encode(&oracle, &Options { pairs: true, ..Options::bare(width) }));
            }
        }
        originals.push(encode(&oracle, &Options::everything(&oracle, IndexWidth::Bits16)));
        let everything = Options::everything(&oracle, IndexWidth::Bits16);
        originals.push(encode_tree(&oracle, &Options { parity: None, ..everything }));
        originals.push(encode_tree(&oracle, &Options::bare(IndexWidth::Bits32)));
        originals.push(encode_tree(&oracle, &Options { lower: true, ..Options::bare(IndexWidth::Bits64) }));
    }
    originals
}

fn ask(bytes: &AlignedBytes) -> bool {
    match View::from_bytes(bytes) {
        Ok(View::Complex(any)) => with_complex!(any, complex => { ask_everything(&complex, usize::MAX); }),
        Ok(View::Tree(any)) => with_tree!(any, tree => { ask_tree(&tree, usize::MAX); }),
        Err(_) => return false,
    }
    true
}

/// What queries read.
const ARRAYS: [SectionKind; 9] = [
    SectionKind::Lookup,
    SectionKind::Boundary,
    SectionKind::Pointers,
    SectionKind::Lists,
    SectionKind::Flags,
    SectionKind::ChildOffsets,
    SectionKind::LastVertices,
    SectionKind::LowerOffsets,
    SectionKind::LowerNeighbours,
];

/// Sets one element of one section of indices, or one bit, to something else.
fn damage_array(bytes: &mut AlignedBytes, random: &mut Random) {
    let container = Container::from_bytes(bytes).unwrap();
    let total = usize::try_from(container.header().num_simplices).unwrap();
    let sections: Vec<_> = container.sections().zip(container.spans()).collect();
    let sections: Vec<(usize, std::ops::Range<usize>)> = sections
        .into_iter()
        .filter(|(section, _)| ARRAYS.contains(&section.kind) && !section.column.is_empty())
        .map(|(section, (_, _, range))| (range.len() / section.column.len(), range))
        .collect();
    if sections.is_empty() {
        return;
    }
    let (size, range) = sections[random.below(sections.len())].clone();
    if size == 0 {
        bytes[range.start + random.below(range.len())] ^= 1 << random.below(8);
        return;
    }
    let at = range.start + size * random.below(range.len() / size);
    let value = match random.below(6) {
        0 => u64::MAX,
        1 => u64::MAX - 1,
        2 => random.next(),
        3 => total as u64,
        _ => random.below(total + 2) as u64,
    };
    bytes[at..at + size].copy_from_slice(&value.to_le_bytes()[..size]);
}

#[test]
fn damaged_arrays() {
    let originals = originals();
    let (mut opened, mut mutants) = (0, 0);
    for seed in SEED..SEED + 4000 {
        let mut random = Random(seed);
        let mut bytes = originals[random.below(originals.len())].clone();
        for _ in 0..=random.below(4) {
            if Container::from_bytes(&bytes).is_ok() {
                damage_array(&mut bytes, &mut random);
            }
        }
        opened += usize::from(ask(&bytes));
        mutants += 1;
    }
    assert!(opened > mutants / 2, "only {opened} of {mutants} got past the opening");
}

/// All elements of one section the same: the lists without an end, all pointers to one place, all facets one.
#[test]
fn arrays_of_one_value() {
    for original in originals() {
        let container = Container::from_bytes(&original).unwrap();
        let total = container.header().num_simplices;
        let sections: Vec<_> = container
            .sections()
            .zip(container.spans())
            .map(|(section, (.., range))| (range.len() / section.column.len().max(1), range))
            .collect();
        for (size, range) in sections {
            for value in [0, 1, total / 2, total.saturating_sub(1), total, u64::MAX - 1, u64::MAX] {
                let mut bytes = original.clone();
                for element in bytes[range.clone()].chunks_exact_mut(size.max(1)) {
                    element.copy_from_slice(&value.to_le_bytes()[..size.max(1)]);
                }
                ask(&bytes);
            }
        }
    }
}

/// Fields of header and table, the checksum of both made to fit.
#[test]
fn damaged_headers_and_tables() {
    let originals = originals();
    let mut opened = 0;
    for seed in SEED..SEED + 6000 {
        let mut random = Random(seed);
        let mut bytes = originals[random.below(originals.len())].clone();
        for _ in 0..=random.below(2) {
            let entries = Container::from_bytes(&bytes).map_or(5, |container| container.header().sections) as usize;
            let entries = entries.min((bytes.len() - HEADER_BYTES) / ENTRY_BYTES);
            let (at, size) = match random.below(3) {
                0 => [(14, 2), (18, 1), (20, 4), (24, 8), (32, 8), (32, 1), (44, 4)][random.below(7)],
                _ => {
                    let entry = HEADER_BYTES + ENTRY_BYTES * random.below(entries);
                    let (field, size) =
                        [(0, 2), (2, 1), (3, 1), (4, 2), (6, 2), (8, 8), (16, 8), (16, 1)][random.below(8)];
                    (entry + field, size)
                }
            };
            let old = bytes[at];
            let value = match random.below(4) {
                0 => u64::MAX,
                1 => random.next(),
                2 => u64::from(old) + 1,
                _ => random.below(80) as u64,
            };
            bytes[at..at + size].copy_from_slice(&value.to_le_bytes()[..size]);
        }
        reseal(&mut bytes);
        sig_tests::fuzz::open(&bytes);
        opened += usize::from(View::from_bytes(&bytes).is_ok());
    }
    assert!(opened > 20, "only {opened} got past the opening");
}

/// A handful of bytes that promise one simplex of dimension 31, and so 2^32 faces, are not opened.
#[test]
fn few_bytes_cannot_promise_many_faces() {
    use sig_core::format::{Column, Encoder, FormatError, Kind, Rule, Section};
    let lookup: Vec<u16> = (0..32).collect();
    let boundary: Vec<u16> = vec![0; (2..=32).sum()];
    let zeros = [0; 31];
    let sections = [
        Section::new(SectionKind::Lookup, Column::U16(&lookup)),
        Section::new(SectionKind::Boundary, Column::U16(&boundary)),
        Section::new(SectionKind::Pointers, Column::U16(&zeros)),
        Section::new(SectionKind::Lists, Column::U16(&[31])),
        Section::new(SectionKind::Flags, Column::Bits { bytes: &[0; 4], len: 31 }),
    ];
    let encoder = Encoder::new(Kind::Sig, IndexWidth::Bits16, 32, 32, &sections).unwrap();
    let mut bytes = AlignedBytes::zeroed(usize::try_from(encoder.file_bytes()).unwrap());
    encoder.encode(&mut bytes).unwrap();
    let expected = FormatError::Invalid { section: SectionKind::Lookup, element: 0, rule: Rule::FirstIds };
    assert_eq!(sig_core::Complex::<u16>::from_bytes(&bytes).err(), Some(expected));
}
