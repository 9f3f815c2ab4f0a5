//! Inputs that no program wrote: lines of a gigabyte, cut off anywhere, quotes that stay open, numbers that are none.
//! Each is an error with its place, or is read, in memory that the limit of a line bounds.

use std::fs;
use std::io::{self, Read};
use std::path::Path;

use sig_tools::io::space::{SpaceFormat, SpaceOptions, read_space, read_space_bytes};
use sig_tools::io::{Format, ReadOptions, read, read_bytes};

/// An input that is made as it is read, and how much of it was.
struct Generated<'a> {
    head: &'a [u8],
    pattern: &'a [u8],
    given: u64,
    length: u64,
}

impl Read for Generated<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = usize::try_from(self.length - self.given).unwrap().min(buffer.len());
        for slot in &mut buffer[..left] {
            let at = usize::try_from(self.given).unwrap();
            *slot = self.head.get(at).copied().unwrap_or_else(|| self.pattern[at % self.pattern.len()]);
            self.given += 1;
        }
        Ok(left)
    }
}

const GIGABYTE: u64 = 1 << 30;

/// More than the longest line and the buffer around it, far less than the input.
const READ_AT_MOST: u64 = 64 << 20;

/// Blanks, digits, words: where a line is what the format is made of, it ends the reading.
#[test]
fn lines_of_a_gigabyte() {
    for pattern in [&b" "[..], b"7", b"0,"] {
        for (format, head) in [
            (Format::Off, &b"OFF 3 1 0\n"[..]),
            (Format::Obj, b"v 0 0 0\n"),
            (Format::Ply, b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n"),
            (Format::Stl, b"solid a\n"),
            (Format::Msh, b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n"),
            (Format::Vtk, b"# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"),
            (Format::Vtu, b"<VTKFile type='PolyData'><Piece NumberOfPoints='1'><Points><DataArray type='Int8'>"),
            (Format::Vtu, b"<VTKFile type='PolyData'><Piece "),
            (Format::Medit, b"MeshVersionFormatted 2 Dimension 3 Vertices 9 "),
            (Format::Mfem, b"MFEM mesh v1.0\nelements\n2\n"),
            (Format::Tetgen, b"3 3 0 0\n"),
            (Format::Abaqus, b"*NODE\n"),
            (Format::Nastran, b"GRID,1\n"),
            (Format::Tops, b"2 1\n0 0\n"),
            (Format::SimplexList, b"1 2\n"),
        ] {
            let mut input = Generated { head, pattern, given: 0, length: GIGABYTE };
            let options = ReadOptions { format: Some(format), ..ReadOptions::default() };
            let error = read(&mut input, "input", &options).unwrap_err().to_string();
            assert!(error.starts_with("input:") && error.len() < 500, "{format:?}: {error}");
            assert!(input.given <= READ_AT_MOST, "{format:?}: {} bytes were read", input.given);
        }
        for format in [
            SpaceFormat::Points,
            SpaceFormat::Full,
            SpaceFormat::Lower,
            SpaceFormat::Upper,
            SpaceFormat::Sparse,
            SpaceFormat::Edges,
            SpaceFormat::Dot,
            SpaceFormat::GraphMl,
            SpaceFormat::Gudhi,
        ] {
            let mut input = Generated { head: b"", pattern, given: 0, length: GIGABYTE };
            let options = SpaceOptions { format: Some(format), ..SpaceOptions::default() };
            let error = read_space(&mut input, None, "input", &options).unwrap_err().to_string();
            assert!(error.starts_with("input:") && error.len() < 500, "{format:?}: {error}");
            assert!(input.given <= READ_AT_MOST, "{format:?}: {} bytes were read", input.given);
        }
    }
}

/// The files of the corpus of the fuzz targets, whole and cut off after every byte, as every format.
#[test]
fn truncated_at_every_byte() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus");
    let mut tried = 0;
    for target in ["read_off", "read_obj", "read_ply", "read_stl", "read_msh", "read_simplices", "read_named", "space"]
    {
        for entry in fs::read_dir(corpus.join(target)).unwrap() {
            let path = entry.unwrap().path();
            let bytes = fs::read(&path).unwrap();
            for end in 0..=bytes.len() {
                let error = if target == "space" {
                    read_space_bytes(&bytes[..end], "input", &SpaceOptions::default()).err()
                } else if target == "read_named" {
                    let format = bytes[..end].split(|&byte| byte == b'\n').next();
                    let format = format.and_then(|name| Format::from_name(std::str::from_utf8(name).ok()?));
                    let start = bytes.iter().position(|&byte| byte == b'\n').map_or(end, |at| end.min(at + 1));
                    read_bytes(&bytes[start..end], "input", &ReadOptions { format, ..ReadOptions::default() }).err()
                } else {
                    read_bytes(&bytes[..end], "input", &ReadOptions::default()).err()
                };
                assert!(error.is_none_or(|error| error.to_string().starts_with("input")), "{}", path.display());
                tried += 1;
            }
        }
    }
    assert!(tried > 1000);
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
    ] {
        let options = ReadOptions { format: Some(format), ..ReadOptions::default() };
        let soup = |text: String| read_bytes(text.as_bytes(), "input", &options).map(|(soup, _)| soup);
        let plain = soup(text.to_owned()).unwrap();
        assert_eq!(soup(text.replacen('\n', "\r\n", 1)).unwrap(), plain, "{format:?}");
    }
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
    ] {
        let error = error(text, format).unwrap_or_else(|| panic!("{text:?} was read as {format:?}"));
        assert!(error.starts_with(place), "{text:?}: {error}");
    }
}
