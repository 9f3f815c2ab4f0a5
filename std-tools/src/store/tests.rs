//! Files of built complexes: what is in them, at every width, and what is wrong with damaged ones.

use std::fs;
use std::path::Path;

use sig_core::format::{self, Column, FormatError, SectionKind};
use sig_core::{AnyComplex, Complex, IndexWidth, ScratchError, SimplexId, VertexId, with_complex};

use super::verify::{self, RebuildError};
use super::*;
use crate::build::{BuildOptions, Built, build};
use crate::soup::{Coordinates, Labels, Scalars, Soup};

/// The complex of simplices written as digits, each the label of a vertex, separated by blanks.
fn built(simplices: &str) -> Built {
    build(soup(simplices), &BuildOptions::default()).unwrap()
}

fn soup(simplices: &str) -> Soup {
    let mut soup = Soup::new(Labels::Numbered(10), false);
    for simplex in simplices.split_whitespace() {
        soup.push(&simplex.bytes().map(|digit| u32::from(digit - b'0')).collect::<Vec<_>>());
    }
    soup
}

/// Figure 1(a) of sig-2004, and an isolated vertex.
const FIGURE: &str = "012 023 045 056 07 8";

fn bytes(built: &Built, options: &EncodeOptions<'_>) -> AlignedBytes {
    Encoding::new(built, options).unwrap().to_bytes().unwrap()
}

fn column(bytes: &[u8], kind: SectionKind) -> Option<Column<'_>> {
    let any = AnyComplex::from_bytes(bytes).unwrap();
    with_complex!(any, complex => complex.container().section(kind).map(|section| section.column))
}

#[test]
fn every_width_holds_the_same_complex() {
    let built = built(FIGURE);
    for width in IndexWidth::ALL {
        let file = bytes(&built, &EncodeOptions { width: Some(width), ..EncodeOptions::default() });
        let any = AnyComplex::from_bytes(&file).unwrap();
        with_complex!(any, complex => {
            assert_eq!(complex.container().header().width, width);
            complex.validate().unwrap();
            verify::rebuild(&complex, &BuildOptions::default()).unwrap();
            // The caption of the figure: C*(0) = {012, 045, 07}.
            let star: Vec<_> = complex.partial_coboundary(SimplexId::new(0)).collect();
            let find = |word: &[usize]| complex.find(&word.iter().map(|&v| VertexId::new(v)).collect::<Vec<_>>()).unwrap();
            assert_eq!(star, [find(&[0, 1, 2]), find(&[0, 4, 5]), find(&[0, 7])]);
            // The figure takes 82 integers beside the lookup table; an isolated vertex adds a pointer and a stop code.
            assert_eq!(complex.file_storage().sig().integers, 3 + 82 + 2);
        });
        assert_eq!(format::verify(&file), Ok(()));
        assert!(verify::checksums(&file).is_ok());
    }
}

#[test]
fn the_least_width_is_chosen_and_a_narrower_one_refused() {
    // Isolated vertices: the ids are the only numbers that grow. 65,535 of them have ids up to 65,534 = 2^16 − 2.
    for (vertices, width) in [(65_535, IndexWidth::Bits16), (65_536, IndexWidth::Bits32)] {
        let soup = Soup::new(Labels::Numbered(vertices), true);
        let built = build(soup, &BuildOptions::default()).unwrap();
        let encoding = Encoding::new(&built, &EncodeOptions::default()).unwrap();
        assert_eq!(encoding.width(), width);
        let file = encoding.to_bytes().unwrap();
        with_complex!(AnyComplex::from_bytes(&file).unwrap(), complex => {
            complex.validate().unwrap();
            assert_eq!(complex.children(SimplexId::new(vertices - 1)).len(), 0);
        });
        let narrow = EncodeOptions { width: Some(IndexWidth::Bits16), ..EncodeOptions::default() };
        assert_eq!(Encoding::new(&built, &narrow).is_err(), width == IndexWidth::Bits32);
    }
}

/// 60,243 simplices, but list offsets beyond 65,534: ids alone would fit 16 bits.
#[test]
fn list_offsets_count_for_the_width() {
    let n = 14;
    let at = |x: u32, y: u32, z: u32| (z * n + y) * n + x;
    let mut soup = Soup::new(Labels::Numbered(14 * 14 * 14), true);
    for (x, y, z) in (0..n - 1).flat_map(|z| (0..n - 1).flat_map(move |y| (0..n - 1).map(move |x| (x, y, z)))) {
        for [a, b, c] in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let mut corner = [x, y, z];
            let mut cell = vec![at(x, y, z)];
            for axis in [a, b, c] {
                corner[axis] += 1;
                cell.push(at(corner[0], corner[1], corner[2]));
            }
            soup.push(&cell);
        }
    }
    let built = build(soup, &BuildOptions::default()).unwrap();
    let encoding = Encoding::new(&built, &EncodeOptions::default()).unwrap();
    assert_eq!(encoding.width(), IndexWidth::Bits32);
    let narrow = EncodeOptions { width: Some(IndexWidth::Bits16), ..EncodeOptions::default() };
    let error = Encoding::new(&built, &narrow).unwrap_err();
    assert!(matches!(error, EncodeError::TooNarrow { least: IndexWidth::Bits32, .. }), "{error}");
    let file = encoding.to_bytes().unwrap();
    let complex = Complex::<u32>::from_bytes(&file).unwrap();
    assert_eq!(complex.num_simplices(), 60_243);
    assert!(column(&file, SectionKind::Lists).unwrap().len() > 65_534);
    // The last vertices take the width of the vertices.
    assert!(matches!(column(&file, SectionKind::LastVertices), Some(Column::U16(_))));
}

#[test]
fn streaming_gives_the_bytes_of_memory() {
    let built = built(FIGURE);
    for checksums in [false, true] {
        let encoding = Encoding::new(&built, &EncodeOptions { checksums, ..EncodeOptions::default() }).unwrap();
        let mut streamed = Vec::new();
        encoding.write_to(&mut streamed).unwrap();
        assert_eq!(*encoding.to_bytes().unwrap(), *streamed);
        assert_eq!(encoding.file_bytes().unwrap(), streamed.len() as u64);
    }
}

#[test]
fn options_leave_sections_out() {
    let built = built(FIGURE);
    let all = bytes(&built, &EncodeOptions { provenance: Some("here"), ..EncodeOptions::default() });
    let none = bytes(&built, &EncodeOptions { tree: false, checksums: false, ..EncodeOptions::default() });
    for kind in [SectionKind::ChildOffsets, SectionKind::LastVertices, SectionKind::Checksums, SectionKind::Provenance]
    {
        assert!(column(&all, kind).is_some());
        assert!(column(&none, kind).is_none());
    }
    assert_eq!(verify::checksums(&none), Err(FormatError::NoChecksums));
}

#[test]
fn parity_only_where_there_is_an_orientation() {
    let parity = |simplices: &str| {
        let file = bytes(&built(simplices), &EncodeOptions::default());
        let bits = column(&file, SectionKind::Parity)?;
        Some((0..bits.len()).map(|row| bits.bit_at(row).unwrap()).collect::<Vec<_>>())
    };
    assert_eq!(parity("0 1 2"), None);
    assert_eq!(parity("8 10 324"), Some(vec![false, true, true]));
}

#[test]
fn labels_are_stored_where_they_say_something() {
    let with = |labels: Labels| {
        let mut soup = Soup::new(labels, false);
        soup.push(&[0, 1]);
        soup.push(&[1, 2]);
        bytes(&build(soup, &BuildOptions::default()).unwrap(), &EncodeOptions::default())
    };
    let numbered = with(Labels::Integers(vec![2, 0, 1]));
    assert!(column(&numbered, SectionKind::IntegerLabels).is_none());
    let integers = with(Labels::Integers(vec![7, 5, u64::MAX]));
    assert_eq!(column(&integers, SectionKind::IntegerLabels), Some(Column::U64(&[5, 7, u64::MAX])));
    let text = with(Labels::Tokens(vec!["b".into(), "ä".into(), "a".into()]));
    assert_eq!(column(&text, SectionKind::LabelOffsets), Some(Column::U64(&[0, 1, 2, 4])));
    assert_eq!(column(&text, SectionKind::LabelText), Some(Column::U8("abä".as_bytes())));
}

#[test]
fn coordinates_keep_their_precision() {
    for values in [Scalars::F32(vec![0.5; 6]), Scalars::F64(vec![0.1; 6])] {
        let mut soup = soup("012");
        soup.labels = Labels::Numbered(3);
        soup.coordinates = Some(Coordinates { dim: 2, values: values.clone() });
        let file = bytes(&build(soup, &BuildOptions::default()).unwrap(), &EncodeOptions::default());
        match (values, column(&file, SectionKind::Coordinates).unwrap()) {
            (Scalars::F32(values), Column::F32(found)) => assert_eq!(values, found),
            (Scalars::F64(values), Column::F64(found)) => assert_eq!(values, found),
            (_, found) => panic!("{found:?}"),
        }
    }
}

fn write_file(directory: &Path, bytes: &[u8]) -> std::path::PathBuf {
    let path = directory.join("a.sigc");
    fs::write(&path, bytes).unwrap();
    path
}

#[test]
fn mapped_and_loaded_are_the_same() {
    let directory = tempfile::tempdir().unwrap();
    let file = bytes(&built(FIGURE), &EncodeOptions::default());
    let path = write_file(directory.path(), &file);
    let (mapped, loaded) = (Mapped::open(&path).unwrap(), Loaded::open(&path).unwrap());
    for access in [Access::Normal, Access::Random, Access::Sequential, Access::WillNeed] {
        mapped.advise(access).unwrap();
    }
    assert_eq!(mapped.bytes(), &*file);
    assert_eq!(*loaded.file_bytes(), *file);
    let count = |complex: AnyComplex<'_>| with_complex!(complex, complex => complex.num_simplices());
    assert_eq!(count(mapped.complex().unwrap()), count(loaded.complex().unwrap()));
}

#[test]
fn what_is_no_file_is_told_with_its_name() {
    let directory = tempfile::tempdir().unwrap();
    let file = bytes(&built(FIGURE), &EncodeOptions::default());
    for (content, expected) in [
        (&b""[..], "the file is empty"),
        (b"OFF\n3 1 0\n", "not a SIG file"),
        (&file[..40], "truncated"),
        (&file[..file.len() - 64], "cut off"),
    ] {
        let path = write_file(directory.path(), content);
        for error in [Mapped::open(&path).unwrap_err(), Loaded::open(&path).unwrap_err()] {
            let message = error.to_string();
            assert!(message.contains("a.sigc: ") && message.contains(expected), "{message}");
        }
    }
    let missing = Mapped::open(directory.path().join("missing")).unwrap_err();
    assert!(matches!(missing.kind, OpenErrorKind::Io(_)), "{missing}");
}

#[test]
fn a_changed_bit_is_found_where_it_is() {
    let file = bytes(&built(FIGURE), &EncodeOptions::default());
    for at in (0..file.len()).step_by(7) {
        let mut damaged = file.clone();
        damaged[at] ^= 4;
        let found = verify::checksums(&damaged);
        assert!(found.is_err(), "byte {at}");
        if let Err(FormatError::Checksum { offset, length, .. }) = found {
            assert!(offset <= at as u64 && (at as u64) < offset + length || at >= file.len() - 64, "byte {at}");
        }
    }
}

/// Lists that `validate` cannot know to be wrong.
#[test]
fn a_rebuild_finds_what_validate_cannot() {
    let no_checksums = EncodeOptions { checksums: false, ..EncodeOptions::default() };
    let good = bytes(&built(FIGURE), &no_checksums);
    let complex = Complex::<u16>::from_bytes(&good).unwrap();
    let find = |word: &[usize]| {
        let word: Vec<_> = word.iter().map(|&vertex| VertexId::new(vertex)).collect();
        u16::try_from(complex.find(&word).unwrap().index()).unwrap()
    };
    let span = complex.container().spans().find(|(kind, ..)| *kind == SectionKind::Lists).unwrap().2;
    // Vertex 0 has the first list, and 012 is its first entry; 023 is in the same cluster, but not the least of it.
    let mut bad = good.clone();
    assert_eq!(bad[span.start..][..2], find(&[0, 1, 2]).to_le_bytes());
    bad[span.start..][..2].copy_from_slice(&find(&[0, 2, 3]).to_le_bytes());
    let complex = Complex::<u16>::from_bytes(&bad).unwrap();
    complex.validate().unwrap();
    let error = verify::rebuild(&complex, &BuildOptions::default()).unwrap_err();
    let RebuildError::Coboundary { id, simplex, found, expected } = error else { panic!("{error}") };
    assert_eq!((id.index(), &*simplex), (0, "0"));
    assert_eq!((&*found, &*expected), ("{0,2,3 0,4,5 0,7}", "{0,1,2 0,4,5 0,7}"));
}

#[test]
fn a_rebuild_of_any_complex_agrees() {
    for simplices in ["", "0", "0 1 2", "01", "0123 0145 0156 017 018", "0123 014 025", "01234 45 56 46 7"] {
        let built = built(simplices);
        for tree in [false, true] {
            let file = bytes(&built, &EncodeOptions { tree, ..EncodeOptions::default() });
            let complex = Complex::<u16>::from_bytes(&file).unwrap();
            complex.validate().unwrap();
            verify::rebuild(&complex, &BuildOptions::default()).unwrap();
        }
    }
}

#[test]
fn a_scratch_grows_as_far_as_a_query_needs() {
    let file = bytes(&built("0123 1234 2345 3456"), &EncodeOptions::default());
    let complex = Complex::<u16>::from_bytes(&file).unwrap();
    let mut enough = OwnedScratch::new(&complex);
    let mut scratch = enough.scratch();
    let mut memory =
        OwnedScratch::new(&Complex::<u16>::from_bytes(&bytes(&built(""), &EncodeOptions::default())).unwrap());
    for simplex in complex.simplices() {
        let collect = |scratch: &mut sig_core::Scratch<'_, u16>| -> Result<Vec<_>, ScratchError> {
            let mut found: Vec<_> = complex.star(simplex, scratch)?.collect();
            found.extend(complex.adjacency(simplex, scratch)?);
            found.extend(complex.link(simplex, scratch)?);
            Ok(found)
        };
        assert_eq!(memory.run(collect), collect(&mut scratch).unwrap());
    }
}
