//! `Complex::validate`: every valid file passes, and every rule that is broken is found, with its name and place.

use proptest::prelude::*;
use sig_core::format::{Column, Container, Encoder, FormatError, Kind, Rule, Section, SectionKind, TableError};
use sig_core::{AnyComplex, Complex, IndexWidth, Tree, with_complex};
use sig_tests::encode::{Names, Options, encode, in_host_order};
use sig_tests::known;
use sig_tests::oracle::Oracle;
use sig_tests::strategies;
use sig_tools::store::AlignedBytes;

fn validate(bytes: &AlignedBytes) -> Result<(), FormatError> {
    let any = AnyComplex::from_bytes(bytes)?;
    with_complex!(any, complex => complex.validate())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn valid_files_pass(simplices in strategies::simplices(), width in 0..3usize) {
        let oracle = Oracle::new(&simplices);
        let bytes = encode(&oracle, &Options::everything(&oracle, IndexWidth::ALL[width]));
        prop_assert_eq!(validate(&bytes), Ok(()));
    }
}

/// Where the elements of a section lie, 16-bit.
fn section(bytes: &AlignedBytes, kind: SectionKind) -> std::ops::Range<usize> {
    let container = Container::from_bytes(bytes).unwrap();
    let (.., range) = container.spans().find(|(other, ..)| *other == kind).unwrap();
    range
}

fn get(bytes: &AlignedBytes, kind: SectionKind, element: usize) -> u16 {
    let at = section(bytes, kind).start + 2 * element;
    u16::from_ne_bytes([bytes[at], bytes[at + 1]])
}

fn set(bytes: &mut AlignedBytes, kind: SectionKind, element: usize, value: u16) {
    let at = section(bytes, kind).start + 2 * element;
    bytes[at..at + 2].copy_from_slice(&value.to_ne_bytes());
}

/// 0123 is two tetrahedra on a triangle, with a dangling triangle and an edge: every kind of pointer occurs.
fn example() -> (Oracle, AlignedBytes) {
    let oracle = Oracle::new(&known::words("0123 1234 045 56 7"));
    let bytes = encode(&oracle, &Options { tree: true, ..Options::bare(IndexWidth::Bits16) });
    (oracle, bytes)
}

fn broken(bytes: &AlignedBytes) -> (SectionKind, u64, Rule) {
    match validate(bytes) {
        Err(FormatError::Invalid { section, element, rule }) => (section, element, rule),
        other => panic!("{other:?}"),
    }
}

/// Where the facets of a simplex start among the boundary entries.
fn row(oracle: &Oracle, simplex: usize) -> usize {
    (0..simplex).map(|before| oracle.dim(before)).map(|dim| if dim > 0 { dim + 1 } else { 0 }).sum()
}

#[test]
fn lookup() {
    let (oracle, bytes) = example();
    for (element, value) in
        [(0, 1), (1, 0), (1, 7), (2, 8), (3, 100), (3, 0xFFFF), (2, get(&bytes, SectionKind::Lookup, 3))]
    {
        let mut damaged = bytes.clone();
        set(&mut damaged, SectionKind::Lookup, element, value);
        let refused = Complex::<u16>::from_bytes(&damaged).unwrap_err();
        let first_ids =
            matches!(refused, FormatError::Invalid { section: SectionKind::Lookup, rule: Rule::FirstIds, .. });
        assert!(first_ids || matches!(refused, FormatError::Table { .. }), "{element} set to {value}: {refused}");
    }
    assert_eq!(oracle.f_vector().len(), 4);
}

#[test]
fn boundary() {
    let (oracle, bytes) = example();
    let boundary = SectionKind::Boundary;
    let triangle = oracle.find(&[0, 1, 2]).unwrap();
    let at = row(&oracle, triangle);
    // A vertex, a triangle, a stop code in the place of an edge.
    for value in [0, u16::try_from(triangle).unwrap(), 0xFFFF] {
        let mut damaged = bytes.clone();
        set(&mut damaged, boundary, at + 1, value);
        assert_eq!(broken(&damaged), (boundary, at as u64 + 1, Rule::FacetRange));
    }
    // Another edge in the middle, where the order of the rows does not see it.
    let mut damaged = bytes.clone();
    set(&mut damaged, boundary, at + 1, u16::try_from(oracle.find(&[0, 4]).unwrap()).unwrap());
    let (section, element, rule) = broken(&damaged);
    assert_eq!((section, rule), (boundary, Rule::SemiSimplicial));
    assert!((at as u64..at as u64 + 3).contains(&element));
    // The ends of an edge exchanged; an edge with one end.
    let edge = row(&oracle, oracle.find(&[1, 2]).unwrap());
    let mut damaged = bytes.clone();
    set(&mut damaged, boundary, edge, 1);
    set(&mut damaged, boundary, edge + 1, 2);
    assert_eq!(broken(&damaged), (boundary, edge as u64, Rule::CanonicalOrder));
    // Two rows exchanged.
    let mut damaged = bytes.clone();
    for column in 0..2 {
        set(&mut damaged, boundary, edge + column, get(&bytes, boundary, edge + 2 + column));
        set(&mut damaged, boundary, edge + 2 + column, get(&bytes, boundary, edge + column));
    }
    assert_eq!(broken(&damaged), (boundary, edge as u64 + 2, Rule::CanonicalOrder));
}

#[test]
fn flags_and_flagged_pointers() {
    let (oracle, bytes) = example();
    // Vertex 0 has a tetrahedron and a triangle; vertex 1 one cluster of tetrahedra; an edge of both tetrahedra too.
    assert!(!oracle.is_single_cluster(0) && oracle.is_single_cluster(1));
    let far = u16::try_from(oracle.len() - 1).unwrap();
    assert_eq!(oracle.word(usize::from(far)), [1, 2, 3, 4]);
    for value in [0, far - 2, far + 1, 0xFFFF] {
        let mut damaged = bytes.clone();
        set(&mut damaged, SectionKind::Pointers, 1, value);
        assert_eq!(broken(&damaged), (SectionKind::Pointers, 1, Rule::FlaggedPointer));
    }
    // A tetrahedron that does not contain its owner, the edge 01.
    let edge = oracle.find(&[0, 1]).unwrap();
    assert!(oracle.is_single_cluster(edge));
    let mut damaged = bytes.clone();
    set(&mut damaged, SectionKind::Pointers, edge, far);
    assert_eq!(broken(&damaged), (SectionKind::Pointers, edge as u64, Rule::FlaggedPointer));
    // A flag at dimension d − 1, and in the padding.
    let flags = section(&bytes, SectionKind::Flags);
    let triangle = oracle.find(&[0, 1, 2]).unwrap();
    for bit in [triangle, 8 * flags.len() - 1] {
        let mut damaged = bytes.clone();
        damaged[flags.start + bit / 8] |= 1 << (bit % 8);
        assert_eq!(broken(&damaged), (SectionKind::Flags, bit as u64, Rule::FlagBits));
    }
}

#[test]
fn lists() {
    let (oracle, bytes) = example();
    let (pointers, lists) = (SectionKind::Pointers, SectionKind::Lists);
    let start = usize::from(get(&bytes, pointers, 0));
    assert_eq!(get(&bytes, lists, start + 2), 0xFFFF);
    let tetrahedron = get(&bytes, lists, start);
    let triangle = get(&bytes, lists, start + 1);
    let mut damaged = bytes.clone();
    set(&mut damaged, pointers, 0, 1);
    assert_eq!(broken(&damaged), (pointers, 0, Rule::ListOffset));
    // The entries exchanged; one of them twice.
    for entries in [[triangle, tetrahedron], [tetrahedron, tetrahedron]] {
        let mut damaged = bytes.clone();
        set(&mut damaged, lists, start, entries[0]);
        set(&mut damaged, lists, start + 1, entries[1]);
        assert_eq!(broken(&damaged), (lists, start as u64 + 1, Rule::ListOrder));
    }
    // Not a simplex; the owner; a triangle that is no top simplex; a tetrahedron that does not contain the owner.
    let covered = u16::try_from(oracle.find(&[0, 1, 2]).unwrap()).unwrap();
    for (position, value) in [(0, 0x7FFF), (0, 0), (1, covered), (0, tetrahedron + 1)] {
        let mut damaged = bytes.clone();
        set(&mut damaged, lists, start + position, value);
        assert_eq!(broken(&damaged), (lists, (start + position) as u64, Rule::ListEntry), "{value}");
    }
    // The last stop code overwritten: the list runs off the section.
    let last = section(&bytes, lists).len() / 2 - 1;
    let mut damaged = bytes.clone();
    set(&mut damaged, lists, last, tetrahedron);
    let (found, _, rule) = broken(&damaged);
    assert!(found == lists && [Rule::ListEnd, Rule::ListEntry, Rule::ListOrder].contains(&rule));
    // The triangle entry of vertex 0 gone: what is left must be a flagged pointer.
    let mut damaged = bytes.clone();
    set(&mut damaged, lists, start + 1, 0xFFFF);
    assert_eq!(broken(&damaged), (lists, start as u64 + 1, Rule::Unflagged));
    // No entry at all.
    let mut damaged = bytes.clone();
    set(&mut damaged, lists, start, 0xFFFF);
    assert!(validate(&damaged).is_err());
}

#[test]
fn a_missing_list_of_a_simplex_with_cofaces() {
    // One edge: its ends are at dimension d − 1 with one entry each. Drop both entries and shorten the lists.
    let oracle = Oracle::new(&known::words("01 02"));
    let bytes = encode(&oracle, &Options::bare(IndexWidth::Bits16));
    // Lists: 3, 4, stop; 3, stop; 4, stop. A stop code in the place of the second entry of vertex 0 moves all others.
    let mut damaged = bytes.clone();
    set(&mut damaged, SectionKind::Lists, 3, 0xFFFF);
    set(&mut damaged, SectionKind::Lists, 4, 4);
    set(&mut damaged, SectionKind::Lists, 5, 0xFFFF);
    set(&mut damaged, SectionKind::Pointers, 2, 4);
    // Vertex 1 has an empty list now, vertex 2 the entry 4; one stop code is left over.
    assert_eq!(broken(&damaged), (SectionKind::Lists, 6, Rule::ListEnd));
    let single = Oracle::new(&known::words("01 2"));
    let bytes = encode(&single, &Options::bare(IndexWidth::Bits16));
    // Lists: 3, stop; 3, stop; stop. Rearranged: 3, stop; stop; and a list of vertex 2 that is not one.
    let mut damaged = bytes;
    for (element, value) in [(2, 0xFFFF), (3, 3), (4, 0xFFFF)] {
        set(&mut damaged, SectionKind::Lists, element, value);
    }
    set(&mut damaged, SectionKind::Pointers, 2, 3);
    assert_eq!(broken(&damaged), (SectionKind::Lists, 3, Rule::ListEntry));
}

#[test]
fn optional_sections() {
    let oracle = Oracle::new(&known::words("0123 1234 045 56 7"));
    let everything = Options::everything(&oracle, IndexWidth::Bits16);
    let bytes = encode(&oracle, &everything);
    let damage = |kind, change: &dyn Fn(&mut [u8])| {
        let mut damaged = bytes.clone();
        let range = section(&bytes, kind);
        change(&mut damaged[range]);
        let (section, element, rule) = broken(&damaged);
        assert_eq!(section, kind);
        (element, rule)
    };
    assert_eq!(damage(SectionKind::ChildOffsets, &|bytes| bytes[4] += 1), (2, Rule::ChildOffset));
    assert_eq!(damage(SectionKind::LastVertices, &|bytes| bytes[20] += 1), (10, Rule::LastVertex));
    let mut damaged = bytes.clone();
    let text = section(&bytes, SectionKind::LabelText);
    damaged[text.start + 12] = 0xFF;
    // The text is cut by the offsets, so the label that is no UTF-8 is named by its end.
    assert_eq!(broken(&damaged), (SectionKind::LabelOffsets, 2, Rule::Labels));
    assert_eq!(damage(SectionKind::Provenance, &|bytes| bytes[3] = 0xFF), (3, Rule::Text));
    let value = |value: f64| move |bytes: &mut [u8]| bytes[..8].copy_from_slice(&value.to_ne_bytes());
    for bad in [f64::NAN, -0.0] {
        assert_eq!(damage(SectionKind::Filtration, &value(bad)), (0, Rule::Filtration));
    }
    assert_eq!(damage(SectionKind::Filtration, &value(5.0)).1, Rule::Filtration);
    let last = 8 * section(&bytes, SectionKind::Parity).len() as u64 - 1;
    assert_eq!(damage(SectionKind::Parity, &|bytes| *bytes.last_mut().unwrap() |= 128), (last, Rule::FlagBits));
    for (row, offset) in [(0, 1u64), (3, 0), (8, 7), (8, 1 << 40), (2, u64::MAX)] {
        let mut damaged = bytes.clone();
        let at = section(&bytes, SectionKind::LabelOffsets).start + 8 * row;
        damaged[at..at + 8].copy_from_slice(&offset.to_ne_bytes());
        let (section, _, rule) = broken(&damaged);
        assert_eq!((section, rule), (SectionKind::LabelOffsets, Rule::Labels), "offset {row} set to {offset}");
    }
    // As many orientations as top simplices, neither more nor fewer.
    for parity in [vec![false; 4], vec![false; 6]] {
        let bytes = encode(&oracle, &Options { parity: Some(parity), ..everything.clone() });
        let (section, _, rule) = broken(&bytes);
        assert_eq!((section, rule), (SectionKind::Parity, Rule::FlagBits));
    }
    // Filtration values below zero, and of −∞, are fine as long as they do not decrease.
    let filtration = (0..oracle.len()).map(|simplex| if simplex < 8 { f64::NEG_INFINITY } else { -1.0 }).collect();
    let bytes = encode(&oracle, &Options { filtration: Some(filtration), names: Names::Numbered, ..everything });
    assert_eq!(validate(&bytes), Ok(()));
}

/// Every element of every array of small files set to every value: what passes names another top simplex around the
/// same owner, which `validate` cannot know to be wrong, and nothing else.
#[test]
fn every_single_change_of_an_index_is_refused_but_those_that_the_documentation_names() {
    for words in ["012 023 045 056 07", "0123 014 025", "0123 1234 15 6", "01 02", "012 013 014", "0 1"] {
        let oracle = Oracle::new(&known::words(words));
        for tree in [false, true] {
            let bytes = encode(&oracle, &Options { tree, ..Options::bare(IndexWidth::Bits16) });
            every_single_change(&oracle, &bytes);
        }
    }
}

fn every_single_change(oracle: &Oracle, bytes: &AlignedBytes) {
    let spans: Vec<_> = Container::from_bytes(bytes).unwrap().spans().collect();
    for (kind, _, range) in spans {
        if kind == SectionKind::Flags {
            for bit in 0..8 * range.len() {
                let mut damaged = bytes.clone();
                damaged[range.start + bit / 8] ^= 1 << (bit % 8);
                assert!(validate(&damaged).is_err(), "flag {bit}");
            }
            continue;
        }
        for element in 0..range.len() / 2 {
            let original = get(bytes, kind, element);
            let mut damaged = bytes.clone();
            for value in (0..u16::try_from(oracle.len() + 3).unwrap()).chain([0x8000, 0xFFFE, 0xFFFF]) {
                set(&mut damaged, kind, element, value);
                if value != original && validate(&damaged).is_ok() {
                    let owner = owner(oracle, bytes, kind, element);
                    let around = owner.is_some_and(|owner| {
                        let value = usize::from(value);
                        oracle.restricted_star(owner).contains(&value) && oracle.is_top(value)
                    });
                    assert!(around, "{kind} {element}: {original} set to {value} of {owner:?}");
                }
            }
        }
    }
}

/// The simplex to whose partial co-boundary a list entry, or a flagged pointer, belongs.
fn owner(oracle: &Oracle, bytes: &AlignedBytes, kind: SectionKind, element: usize) -> Option<usize> {
    let stored = (0..oracle.len()).filter(|&simplex| oracle.dim(simplex) + 1 < oracle.dims());
    match kind {
        SectionKind::Pointers => Some(element).filter(|&simplex| oracle.is_single_cluster(simplex)),
        SectionKind::Lists => stored
            .filter(|&simplex| !oracle.is_single_cluster(simplex))
            .rfind(|&simplex| usize::from(get(bytes, SectionKind::Pointers, simplex)) <= element),
        _ => None,
    }
}

fn encode_sections(kind: Kind, dims: usize, num_simplices: u64, sections: &[Section<'_>]) -> AlignedBytes {
    let encoder = Encoder::new(kind, IndexWidth::Bits16, dims, num_simplices, sections).unwrap();
    let mut bytes = AlignedBytes::zeroed(usize::try_from(encoder.file_bytes()).unwrap());
    encoder.encode(&mut bytes).unwrap();
    in_host_order(bytes)
}

/// The least width for the vertices is never wider than an index, but where there are no edges.
#[test]
fn last_vertices_are_no_wider_than_indices() {
    let (oracle, bytes) = example();
    let wide: Vec<u32> = oracle.words().iter().map(|word| u32::try_from(*word.last().unwrap()).unwrap()).collect();
    let container = Container::from_bytes(&bytes).unwrap();
    let mut sections: Vec<_> = container.sections().collect();
    let entry = sections.iter().position(|section| section.kind == SectionKind::LastVertices).unwrap();
    sections[entry].column = Column::U32(&wide);
    let bytes = encode_sections(Kind::Sig, oracle.dims(), oracle.len() as u64, &sections);
    let error = FormatError::Table { entry: u32::try_from(entry).unwrap(), error: TableError::ElementType(3) };
    assert_eq!(Complex::<u16>::from_bytes(&bytes).unwrap_err(), error);
    assert_eq!(Tree::<u16>::from_bytes(&bytes).unwrap_err(), error);

    let vertices = u64::from(u16::MAX);
    let last: Vec<u32> = (0..u32::from(u16::MAX)).collect();
    let sections = [
        Section::new(SectionKind::Lookup, Column::U16(&[0])),
        Section::new(SectionKind::ChildOffsets, Column::U16(&[u16::MAX])),
        Section::new(SectionKind::LastVertices, Column::U32(&last)),
    ];
    let bytes = encode_sections(Kind::Tree, 1, vertices, &sections);
    let tree = Tree::<u16>::from_bytes(&bytes).unwrap();
    assert_eq!((tree.validate(), tree.num_vertices()), (Ok(()), 65_535));
}
