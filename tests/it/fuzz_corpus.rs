//! The corpus of the fuzz targets, replayed: seeds that mean something, and the inputs of bugs that fuzzing found.

use std::fs;
use std::path::Path;

use sig_tests::fuzz::{self, Format};

fn replay(target: &str, body: impl Fn(&[u8])) {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus").join(target);
    let entries = fs::read_dir(&corpus).unwrap_or_else(|error| panic!("{}: {error}", corpus.display()));
    let mut files: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    files.sort();
    assert!(!files.is_empty(), "no seeds for {target}");
    for file in files {
        let bytes = fs::read(&file).unwrap();
        println!("{}", file.display());
        body(&bytes);
    }
}

#[test]
fn open() {
    replay("open", fuzz::open);
}

#[test]
fn tree() {
    replay("tree", fuzz::tree);
}

#[test]
fn mcc() {
    replay("mcc", fuzz::mcc);
}

#[test]
fn roundtrip() {
    replay("roundtrip", fuzz::roundtrip);
}

#[test]
fn read() {
    replay("read", |bytes| fuzz::read(None, bytes));
}

#[test]
fn read_of_each_format() {
    for (target, format) in [
        ("read_off", Format::Off),
        ("read_obj", Format::Obj),
        ("read_ply", Format::Ply),
        ("read_stl", Format::Stl),
        ("read_msh", Format::Msh),
        ("read_simplices", Format::SimplexList),
    ] {
        replay(target, |bytes| fuzz::read(Some(format), bytes));
    }
}

#[test]
fn read_named() {
    replay("read_named", fuzz::read_named);
}

#[test]
fn cells() {
    replay("read_cells", fuzz::cells);
}

#[test]
fn space() {
    replay("space", |bytes| fuzz::space(None, bytes));
}

#[test]
fn space_of_each_format() {
    replay("space_of_each_format", fuzz::space_of_each_format);
}
