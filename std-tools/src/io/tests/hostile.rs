//! Inputs cut off anywhere, headers that lie, lines without end, readers that give a byte at a time.

use std::io::{self, Read};

use super::super::{Format, ReadOptions, read, read_bytes};
use super::{message, msh, ply, read_as, stl};

/// A small whole file of each format and variant.
fn samples() -> Vec<(Format, Vec<u8>)> {
    let mut samples = vec![
        (Format::Off, b"COFF\n3 2 0\n0 0 0 1 1 1 1\n1.5 0 0 1 1 1 1\n-1e3 1 0 1 1 1 1\n3 0 1 2 #c\n2 1 0\n".to_vec()),
        (Format::Obj, b"v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 1 1\nf 1/1 2//1 -1\nl 1 2 \\\n 3\np 1\n".to_vec()),
        (Format::SimplexList, b"# c\xe9\n1 2, 3\nx y\n".to_vec()),
        (Format::SimplexList, b"facets:=[ [ 1, 2 ],\n [ 2, 3, 4 ] ];\n".to_vec()),
        (Format::Stl, stl::TEXT.into()),
        (Format::Stl, stl::binary("solid", &[[[0.; 3], [1.; 3], [2.; 3]]])),
        (Format::Ply, ply::TEXT.into()),
        (Format::Msh, msh::TEXT_2.into()),
        (Format::Msh, msh::TEXT_4.into()),
        (Format::Tops, super::tops::TEXT.into()),
        (Format::Tetbin, super::tops::tetbin(&[[0.0; 3], [1.0; 3], [2.0; 3], [-1.5; 3]], &[[0, 1, 2, 3]])),
    ];
    samples.extend(super::foreign::samples());
    for big_endian in [false, true] {
        samples.push((Format::Ply, ply::binary(big_endian)));
        samples.push((Format::Msh, msh::binary_2(big_endian)));
        samples.push((Format::Msh, msh::binary_4(4, big_endian)));
        samples.push((Format::Msh, msh::binary_4(8, big_endian)));
    }
    samples
}

#[test]
fn truncation_at_every_byte_is_an_error_or_a_soup() {
    for (format, bytes) in samples() {
        let whole = read_as(format, &bytes).unwrap().0;
        for end in 0..bytes.len() {
            if let Ok((soup, _)) = read_as(format, &bytes[..end]) {
                assert!(soup.num_listed() <= whole.num_listed());
            }
            // Without a format too: detection must stand it.
            let _ = read_bytes(&bytes[..end], "-", &ReadOptions::default());
        }
    }
}

#[test]
fn every_single_wrong_byte_is_an_error_or_a_soup() {
    for (format, bytes) in samples() {
        for at in 0..bytes.len() {
            for wrong in [0, b' ', b'\n', b'-', b'9', b'\\', b'[', 0x7f, 0xff] {
                let mut changed = bytes.clone();
                changed[at] = wrong;
                let _ = read_as(format, &changed);
                for other in Format::ALL.iter().filter(|_| at == 0) {
                    let _ = read_as(*other, &changed);
                }
            }
        }
    }
}

/// Gives one byte a time, and an interruption before each.
struct Slow<'a> {
    bytes: &'a [u8],
    interrupted: bool,
}

impl Read for Slow<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.interrupted = !self.interrupted;
        if self.interrupted {
            return Err(io::ErrorKind::Interrupted.into());
        }
        let (Some((&first, rest)), Some(slot)) = (self.bytes.split_first(), buffer.first_mut()) else { return Ok(0) };
        *slot = first;
        self.bytes = rest;
        Ok(1)
    }
}

#[test]
fn the_size_of_reads_does_not_matter() {
    for (format, bytes) in samples() {
        let options = ReadOptions { format: Some(format), ..Default::default() };
        let slow = read(Slow { bytes: &bytes, interrupted: false }, "test", &options).unwrap();
        assert_eq!(slow, read_as(format, &bytes).unwrap());
    }
}

/// Billions are declared and nothing follows: an error, at once and in little memory.
#[test]
fn counts_are_not_trusted() {
    let huge = u64::from(u32::MAX);
    for (format, text) in [
        (Format::Off, format!("OFF {huge} {huge} 0\n0 0 0\n")),
        (Format::Off, "OFF 1 9000000000000 0\n0 0 0\n1 0\n".into()),
        (Format::Medit, format!("MeshVersionFormatted 2 Dimension 3 Vertices {huge}\n0 0 0\n")),
        (Format::Mfem, "MFEM mesh v1.0\nelements\n9000000000000000000\n1 0 0\n".into()),
        (Format::Tetgen, format!("{huge} 3 0 0\n1 0 0 0\n")),
        (Format::Vtk, format!("# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS {huge} float\n0 0 0\n")),
        (Format::Vtk, format!("# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS {huge} float\n0 0 0\n")),
        (Format::Tops, format!("{huge} {huge}\n0 0 0\n")),
        (Format::Tops, "1 1\n0 0 0\n9000000000000000000 0\n".into()),
        (Format::Off, "OFF 1 1 0\n0 0 0\n9000000000000000000 0\n".into()),
        (
            Format::Ply,
            format!("ply\nformat ascii 1.0\nelement vertex {huge}\nproperty float x\nproperty float y\nend_header\n"),
        ),
        (Format::Msh, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n9000000000000000000\n1 0 0 0\n".into()),
        (
            Format::Msh,
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n9000000000000000000 1 1 1\n0 0 0 9000000000000000000\n"
                .into(),
        ),
    ] {
        assert!(message(format, text).contains("ends here"));
    }
    let mut list = b"ply\nformat binary_little_endian 1.0\nelement face 4000000000\nproperty list uint int other\n\
                     property list uint int vertex_indices\nend_header\n"
        .to_vec();
    list.extend([0xff; 4]);
    assert!(message(Format::Ply, &list).contains("ends here"));
    list.truncate(list.len() - 4);
    list.extend([0, 0, 0, 0, 0xff, 0xff, 0xff, 0xff, 1]);
    assert!(message(Format::Ply, list).contains("ends here"));
    assert!(message(Format::Tetbin, b"TETB\xff\xff\xff\xff\xff\xff\xff\xff").contains("ends here"));
    let mut stl = stl::binary("", &[]);
    stl[80..].fill(0xff);
    assert!(message(Format::Stl, stl).contains("ends here"));
    for at in 0..4 {
        let mut msh = msh::binary_4(8, false);
        let totals = msh.windows(7).position(|bytes| bytes == b"$Nodes\n").unwrap() + 7 + 8 * at;
        msh[totals..totals + 8].fill(0xff);
        let _ = read_as(Format::Msh, msh);
    }
}

/// An endless line of blanks, which no reader may wait for.
#[test]
fn a_line_without_end_is_refused() {
    let blanks = io::repeat(b' ').take(1 << 40);
    let options = ReadOptions { format: Some(Format::Obj), ..Default::default() };
    let error = read(b"v 0 0 0\n".chain(blanks), "test", &options).unwrap_err().to_string();
    assert_eq!(error, "test:2:16777217: a line of more than 16777216 bytes; is this a text file with line ends?");
}

#[test]
fn a_line_may_have_the_limit_but_no_more() {
    let line = |length: usize| {
        let mut text = vec![b' '; length];
        text[length - 1] = b'7';
        text.push(b'\n');
        read_as(Format::SimplexList, text)
    };
    let limit = 16 * 1024 * 1024;
    assert_eq!(line(limit).unwrap().0.num_listed(), 1);
    assert!(line(limit + 1).unwrap_err().to_string().starts_with("test:1:16777217: a line of more than 16777216"));
}

/// Text is longer than the buffer, lines fall across its end.
#[test]
fn lines_across_the_end_of_the_buffer() {
    let (mut text, n) = (String::from("OFF\n50000 49998 0\n"), 50_000);
    for vertex in 0..n {
        text += &format!("{vertex}.25 -{vertex} 1e-{}\n", vertex % 300);
    }
    for vertex in 0..n - 2 {
        text += &format!("3 {vertex} {} {}\n", vertex + 1, vertex + 2);
    }
    let (soup, _) = read_as(Format::Off, &text).unwrap();
    let values = super::doubles(&soup);
    for vertex in 0..n {
        let small: f64 = format!("1e-{}", vertex % 300).parse().unwrap();
        assert_eq!(values[3 * vertex..3 * vertex + 3], [vertex as f64 + 0.25, -(vertex as f64), small]);
    }
    assert!(soup.of_dim(2).zip(0u32..).all(|(triangle, at)| triangle == [at, at + 1, at + 2]));
    let error = message(Format::Off, text + "\nmore");
    assert_eq!(error, "test:100002:1: expected the end of the file after the last face, found `more`");
}
