//! Golden files: the bytes of small complexes, as they were when the format was settled. `tests/data/golden/README.md`
//! has the commands that made them.

use std::fs;
use std::path::{Path, PathBuf};

use sig_core::format::{self, Column, Encoder, Kind, Section, SectionKind};
use sig_core::{IndexWidth, Tree, with_complex};
use sig_tests::conformance::{assert_conforms, assert_tree_conforms};
use sig_tests::encode::{Names, Options, encode_file, encode_tree_file, in_host_order, least_width};
use sig_tests::known;
use sig_tests::oracle::Oracle;
use sig_tools::mcc::{MccFile, verify};
use sig_tools::store::AlignedBytes;
use sig_tools::{Loaded, with_view};

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("data/golden").join(name)
}

/// The complex of Figure 1(a) of sig-2004 and things beside it, in one word a line.
fn figure() -> Oracle {
    Oracle::new(&known::words("012 023 045 056 07 8"))
}

/// What `sig build` writes of a list of simplices with the labels 0, 1, …: tree sections, orientations, checksums.
fn as_built(oracle: &Oracle, width: Option<IndexWidth>) -> Options {
    let parity = (oracle.dims() > 1).then(|| vec![false; oracle.tops().len()]);
    Options { width, tree: true, checksums: true, names: Names::Numbered, parity, ..Options::default() }
}

#[test]
fn files_are_what_the_format_says() {
    for (name, width) in [
        ("figure-16.sigc", IndexWidth::Bits16),
        ("figure-32.sigc", IndexWidth::Bits32),
        ("figure-64.sigc", IndexWidth::Bits64),
    ] {
        let expected = encode_file(&figure(), &as_built(&figure(), Some(width)));
        assert_golden(&golden(name), &expected);
        assert_eq!(format::verify(&expected), Ok(()));
    }
    assert_eq!(least_width(&figure()), IndexWidth::Bits16);
    assert_golden(
        &golden("empty-16.sigc"),
        &encode_file(&Oracle::new::<[usize; 0]>(&[]), &Options { tree: true, checksums: true, ..Options::default() }),
    );
}

/// The same complex as a file of kind tree, as `sig tree convert` writes it.
#[test]
fn trees_are_what_the_format_says() {
    let empty = Oracle::new::<[usize; 0]>(&[]);
    for (name, oracle, width) in
        [("figure-tree-16.sigc", &figure(), IndexWidth::Bits16), ("empty-tree-16.sigc", &empty, IndexWidth::Bits16)]
    {
        let options = Options { width: Some(width), lower: true, checksums: true, ..Options::default() };
        let expected = encode_tree_file(oracle, &options);
        assert_golden(&golden(name), &expected);
        assert_eq!(format::verify(&expected), Ok(()));
        let buffer = in_host_order(expected);
        let tree = Tree::<u16>::from_bytes(&buffer).unwrap();
        assert_eq!(tree.validate(), Ok(()));
        assert_tree_conforms(&tree, oracle);
    }
}

/// A triangle whose vertices 0, 1 and 2 are at (0, 0), (0, 3) and (4, 0), simplified by the extent of what goes: vertex 0 is
/// merged with 1 by edge 01, then 1 with 2 by edge 12, then edge 02, which is a loop by now, goes with the triangle. Every number
/// is worked out from `core/FORMAT.md`. The edges 01, 02, 12 are cells 3, 4, 5 of the full complex, the triangle is cell 6.
#[test]
fn multi_resolution_complexes_are_what_the_format_says() {
    let arc = |cell: u32, code: u32| 8 * cell + code;
    let (plus, minus, loop_of_two) = (0, 1, 2);
    let words = |kind, words| Section::new(kind, Column::U32(words));
    let coordinates = Column::F64(&[0.0, 0.0, 0.0, 0.0, 3.0, 0.0, 4.0, 0.0, 0.0]);
    let arcs = [
        // Edge 02 and the triangle, which has no other edge by then: the edge begins and ends in vertex 2.
        arc(0, loop_of_two),
        // Vertex 1 and edge 12: the edge ends in 2, edge 02 began in 1, the triangle goes along the edge.
        arc(0, plus),
        arc(1, minus),
        arc(2, plus),
        // Vertex 0 and edge 01: the edge ends in 1, edge 02 began in 0, the triangle goes along the edge.
        arc(3, plus),
        arc(1, minus),
        arc(2, plus),
    ];
    let lengths = |first: u32, second: u32, third: u32| first | second << 10 | third << 20;
    let splits = [lengths(1, 0, 0), lengths(0, 1, 1), lengths(0, 1, 1)];
    let sections = [
        words(SectionKind::Lookup, &[0, 1, 1]),
        Section { components: 3, ..Section::new(SectionKind::Coordinates, coordinates) },
        words(SectionKind::BaseOffsets, &[0, 0]),
        words(SectionKind::CellArcs, &arcs),
        words(SectionKind::Origins, &[2, 4, 6, 1, 5, 0, 3]),
        words(SectionKind::RefinementOffsets, &[0, 1, 4, 7]),
        // All signs are −1: edge 02 in 12 − 02 + 01, and the vertices in which edges begin.
        Section::new(SectionKind::RefinementShapes, Column::U8(&[128 + 1, 128, 128])),
        words(SectionKind::RefinementSplits, &splits),
        Section::new(SectionKind::RefinementErrors, Column::F32(&[5.0, 5.0, 3.0])),
        words(SectionKind::RefinementSites, &[0, 1, 0]),
        // Sites are at x = 0, all three: by number.
        words(SectionKind::SiteTree, &[0, 1, 2]),
    ];
    let encoder = Encoder::new(Kind::MultiResolution, IndexWidth::Bits32, 3, 7, &sections).unwrap();
    let encoder = encoder.with_checksums().unwrap();
    let mut expected = AlignedBytes::zeroed(usize::try_from(encoder.file_bytes()).unwrap());
    encoder.encode(&mut expected).unwrap();
    let file = MccFile::from_file_bytes(in_host_order(expected.clone())).unwrap();
    assert_eq!(file.view().validate(), Ok(()));
    assert_eq!(verify(file.view()), Ok(1));
    assert_golden(&golden("triangle.mcc"), &in_host_order(expected));
}

/// The file that the documentation of `sig-core` opens: two tetrahedra on a common triangle, with a dangling edge.
#[test]
fn the_file_of_the_core_documentation() {
    let oracle = Oracle::new(&known::words("0123 1234 45"));
    let expected = encode_file(&oracle, &as_built(&oracle, None));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../core/tests/two-tetrahedra.sigc");
    assert_golden(&path, &expected);
}

/// With `SIG_BLESS` in the environment the files are written instead, for a reviewed change of the format.
fn assert_golden(path: &Path, expected: &AlignedBytes) {
    if std::env::var_os("SIG_BLESS").is_some() {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, &expected[..]).unwrap();
    }
    let found = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    assert!(found == expected[..], "{} differs from the definition of the format", path.display());
}

/// On a big-endian host by turning them round.
#[test]
fn files_are_loaded_on_any_host() {
    for width in [16, 32, 64] {
        let file = Loaded::open(golden(&format!("figure-{width}.sigc"))).unwrap();
        with_complex!(file.complex().unwrap(), complex => assert_conforms(&complex, &figure()));
    }
    let file = Loaded::open(golden("figure-tree-16.sigc")).unwrap();
    with_view!(file.view(), tree => assert_eq!(tree.num_simplices(), figure().len()));
}

/// Embedded at compile time, at the alignment that a view needs.
#[test]
#[cfg(target_endian = "little")]
fn an_embedded_file_is_opened_where_it_lies() {
    static FIGURE: &[u8] = sig_core::include_aligned!("../data/golden/figure-64.sigc");
    let complex = sig_core::Complex::<u64>::from_bytes(FIGURE).unwrap();
    assert_eq!(complex.container().bytes().as_ptr(), FIGURE.as_ptr());
    assert_eq!(FIGURE.as_ptr().align_offset(64), 0);
    assert_conforms(&complex, &figure());
}
