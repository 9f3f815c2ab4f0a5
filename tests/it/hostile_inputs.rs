//! Inputs that no program wrote: cut off anywhere, line ends of two kinds, quotes that stay open, numbers that are none. Each
//! is an error with its place, or is read. What memory it takes is measured in a binary of its own, `memory`.

use std::fs;
use std::path::Path;

use sig_tools::cells::read_cells;
use sig_tools::io::space::{SpaceFormat, SpaceOptions, read_space_bytes};
use sig_tools::io::{Format, ReadError, ReadOptions, read_bytes};

/// The files of the corpus of the fuzz targets, whole and cut off after every byte, in every format.
#[test]
fn truncated_at_every_byte() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus");
    let of = |target: &str, read: &dyn Fn(&[u8]) -> Option<ReadError>| {
        let (mut tried, mut refused) = (0, 0);
        for entry in fs::read_dir(corpus.join(target)).unwrap() {
            let path = entry.unwrap().path();
            let bytes = fs::read(&path).unwrap();
            // All of a small file; of one that fuzzing made long, some four hundred places.
            for end in (0..bytes.len()).step_by(bytes.len() / 400 + 1).chain([bytes.len()]) {
                let error = read(&bytes[..end]);
                refused += usize::from(error.is_some());
                assert!(error.is_none_or(|error| error.to_string().starts_with("input")), "{}", path.display());
                tried += 1;
            }
        }
        assert!(refused > 0 && refused < tried, "{target}: {refused} of {tried} refused");
    };
    for target in ["read", "read_off", "read_obj", "read_ply", "read_stl", "read_msh", "read_simplices"] {
        of(target, &|bytes| read_bytes(bytes, "input", &ReadOptions::default()).err());
    }
    of("space", &|bytes| read_space_bytes(bytes, "input", &SpaceOptions::default()).err());
    of("space_of_each_format", &|bytes| {
        let (first, rest) = bytes.split_first()?;
        let format = Some(SpaceFormat::ALL[usize::from(*first) % SpaceFormat::ALL.len()]);
        read_space_bytes(rest, "input", &SpaceOptions { format, ..SpaceOptions::default() }).err()
    });
    of("read_named", &|bytes| {
        let end = bytes.iter().position(|&byte| byte == b'\n')?;
        let format = Format::from_name(std::str::from_utf8(&bytes[..end]).ok()?);
        read_bytes(&bytes[end + 1..], "input", &ReadOptions { format, ..ReadOptions::default() }).err()
    });
    of("read_cells", &|bytes| read_cells(bytes, "input").err());
}

/// Line ends of Unix and DOS in one file are line ends.
#[test]
fn mixed_line_ends() {
    let of_space = |text: &str, format| {
        let options = SpaceOptions { format: Some(format), ..SpaceOptions::default() };
        read_space_bytes(text.as_bytes(), "input", &options).map(|(space, _)| space)
    };
    for (format, text) in [
        (SpaceFormat::Points, "0 0\n1 0\n0 1\n"),
        (SpaceFormat::Full, "0 1\n1 0\n"),
        (SpaceFormat::Lower, "1\n2 3\n"),
        (SpaceFormat::Sparse, "0 1 2\n1 2 1\n"),
        (SpaceFormat::Edges, "a b 1\nb c 2\n"),
        (SpaceFormat::Gudhi, "0 0 0\n0 1 0\n1 0 1 2\n"),
    ] {
        let plain = of_space(text, format).unwrap();
        assert_eq!(of_space(&text.replace('\n', "\r\n"), format).unwrap(), plain, "{format:?}");
        assert_eq!(of_space(&text.replacen('\n', "\r\n", 1), format).unwrap(), plain, "{format:?}");
    }
    for (format, text) in [
        (Format::Off, "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        (Format::Obj, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        (Format::SimplexList, "1 2\n2 3\n"),
        (Format::SimplexList, "[[1,2],\n[2,3]]\n"),
        (
            Format::Ply,
            "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nelement face 0\n\
             property list uchar int vertex_indices\nend_header\n0 0\n1 0\n",
        ),
        (
            Format::Stl,
            "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
             endsolid a\n",
        ),
        (
            Format::Msh,
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n2 1 0 0\n$EndNodes\n$Elements\n1\n\
             1 1 0 1 2\n$EndElements\n",
        ),
    ] {
        let options = ReadOptions { format: Some(format), ..ReadOptions::default() };
        let soup = |text: String| read_bytes(text.as_bytes(), "input", &options).map(|(soup, _)| soup);
        let plain = soup(text.to_owned()).unwrap();
        assert_eq!(soup(text.replace('\n', "\r\n")).unwrap(), plain, "{format:?}");
        assert_eq!(soup(text.replacen('\n', "\r\n", 1)).unwrap(), plain, "{format:?}");
    }
    let cells = |text: String| read_cells(text.as_bytes(), "input");
    let text = "cells 1 1\n+0 -0\n";
    let plain = cells(text.to_owned()).unwrap();
    assert!(cells(text.replacen('\n', "\r\n", 1)).unwrap() == plain);
    assert!(cells(text.replace('\n', "\r\n")).unwrap() == plain);
}

/// Numbers that are none, billions that are declared, a quote without its end: the line and the column are told.
#[test]
fn slips_are_told_with_their_place() {
    let error = |text: &str, format| {
        let options = SpaceOptions { format: Some(format), ..SpaceOptions::default() };
        read_space_bytes(text.as_bytes(), "input", &options).err().map(|error| error.to_string())
    };
    for (text, format, place) in [
        ("0 0\n1 nan\n", SpaceFormat::Points, "input:2:3: "),
        ("0 0\ninf 1\n", SpaceFormat::Points, "input:2:1: "),
        ("0 NaN\n1 0\n", SpaceFormat::Full, "input:1:3: "),
        ("1\nNaN 3\n", SpaceFormat::Lower, "input:2:1: "),
        ("0 1 nan\n", SpaceFormat::Sparse, "input:1:5: "),
        ("a b nan\n", SpaceFormat::Edges, "input:1:5: "),
        ("0 4000000000 1\n", SpaceFormat::Sparse, "input:1:3: "),
        ("0,1\n1,\"2\n", SpaceFormat::Points, "input:2:3: "),
        ("0,1\n\"1,0\n", SpaceFormat::Full, "input:2:1: "),
        ("a b\nb \"c\n", SpaceFormat::Edges, "input:2:3: "),
        ("a \"New York\" 3\n", SpaceFormat::Edges, "input:1:3: "),
        ("0 0 0\n0 1 0\n1 0 1 nan\n", SpaceFormat::Gudhi, "input:3:"),
    ] {
        let error = error(text, format).unwrap_or_else(|| panic!("{text:?} was read as {format:?}"));
        assert!(error.starts_with(place), "{text:?}: {error}");
    }
}
