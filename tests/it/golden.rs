//! Golden files: the bytes of small complexes, as they were when the format was settled. `tests/data/golden/README.md`
//! has the commands that made them.

use std::fs;
use std::path::{Path, PathBuf};

use sig_core::format;
use sig_core::{IndexWidth, Tree, with_complex};
use sig_tests::conformance::{assert_conforms, assert_tree_conforms};
use sig_tests::encode::{Names, Options, encode_file, encode_tree_file, in_host_order, least_width};
use sig_tests::known;
use sig_tests::oracle::Oracle;
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
