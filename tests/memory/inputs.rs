//! Inputs in text and binary that lie about their length: lines of a gigabyte, and counts in the billions with nothing
//! behind them. All are refused, in memory that has nothing to do with what they promise.

use std::io::{self, Read};

use sig_tools::cells::read_cells;
use sig_tools::io::space::{SpaceFormat, SpaceOptions, read_space};
use sig_tools::io::{Format, ReadError, ReadOptions, read};

use crate::Alone;

/// Who reads an input.
#[derive(Clone, Copy, Debug)]
enum Reader {
    Mesh(Format),
    Space(SpaceFormat),
    Cells,
}

impl Reader {
    /// The message of the refusal, and what was allocated on the way to it.
    ///
    /// # Panics
    /// If the input is not refused, or without a place in it.
    fn refusal(self, alone: &Alone, input: impl Read) -> (String, usize) {
        let (peak, result) = alone.peak_of(|| self.read(input));
        let message = result.err().unwrap_or_else(|| panic!("{self:?} was read")).to_string();
        assert!(message.starts_with("input:") && message.len() < 500, "{self:?}: {message}");
        (message, peak)
    }

    fn read(self, input: impl Read) -> Result<(), ReadError> {
        match self {
            Self::Mesh(format) => {
                let options = ReadOptions { format: Some(format), ..ReadOptions::default() };
                read(input, "input", &options).map(|_| ())
            }
            Self::Space(format) => {
                let options = SpaceOptions { format: Some(format), ..SpaceOptions::default() };
                read_space(input, None, "input", &options).map(|_| ())
            }
            Self::Cells => read_cells(input, "input").map(|_| ()),
        }
    }
}

/// An input that is made as it is read, a head and a pattern without end, and how much of it was.
struct Generated<'a> {
    head: &'a [u8],
    pattern: &'a [u8],
    given: u64,
}

const GIGABYTE: u64 = 1 << 30;

impl Read for Generated<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = usize::try_from(GIGABYTE - self.given).unwrap().min(buffer.len());
        let at = usize::try_from(self.given).unwrap();
        let text = self.head.iter().skip(at).chain(self.pattern.iter().cycle());
        buffer[..left].iter_mut().zip(text).for_each(|(slot, &byte)| *slot = byte);
        self.given += left as u64;
        Ok(left)
    }
}

/// The longest line is of 16 MiB; the buffer around it doubles as it grows, and the old one is there meanwhile.
const OF_A_LINE: u64 = 64 << 20;

/// Blanks, digits, words: where a line is what the format is made of, it ends the reading.
#[test]
fn lines_of_a_gigabyte() {
    let alone = Alone::new();
    let mut most = 0;
    for (reader, head) in [
        (Reader::Mesh(Format::Off), &b"OFF 3 1 0\n"[..]),
        (Reader::Mesh(Format::Obj), b"v 0 0 0\n"),
        (Reader::Mesh(Format::Ply), b"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nend_header\n"),
        (Reader::Mesh(Format::Ply), b"ply\nformat ascii 1.0\ncomment "),
        (Reader::Mesh(Format::Stl), b"solid a\n"),
        (Reader::Mesh(Format::Msh), b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n"),
        (Reader::Mesh(Format::Vtk), b"# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"),
        (
            Reader::Mesh(Format::Vtu),
            b"<VTKFile type='PolyData'><Piece NumberOfPoints='1'><Points><DataArray type='Int8'>",
        ),
        (
            Reader::Mesh(Format::Vtu),
            b"<VTKFile type='UnstructuredGrid'><Piece NumberOfPoints='9' NumberOfCells='9'><Cells><DataArray Name='types' type='Int8'>",
        ),
        (Reader::Mesh(Format::Vtu), b"<VTKFile type='PolyData'><Piece "),
        (Reader::Mesh(Format::Medit), b"MeshVersionFormatted 2 Dimension 3 Vertices 9 "),
        (Reader::Mesh(Format::Mfem), b"MFEM mesh v1.0\nelements\n2\n"),
        (Reader::Mesh(Format::Tetgen), b"3 3 0 0\n"),
        (Reader::Mesh(Format::Abaqus), b"*NODE\n"),
        (Reader::Mesh(Format::Nastran), b"GRID,1\n"),
        (Reader::Mesh(Format::Tops), b"2 1\n0 0\n"),
        (Reader::Mesh(Format::SimplexList), b"1 2\n"),
        (Reader::Mesh(Format::SimplexList), b"[[1,2],["),
        (Reader::Space(SpaceFormat::Points), b""),
        (Reader::Space(SpaceFormat::Full), b""),
        (Reader::Space(SpaceFormat::Lower), b""),
        (Reader::Space(SpaceFormat::Upper), b""),
        (Reader::Space(SpaceFormat::Sparse), b""),
        (Reader::Space(SpaceFormat::Edges), b""),
        (Reader::Space(SpaceFormat::Dot), b""),
        (Reader::Space(SpaceFormat::GraphMl), b""),
        (Reader::Space(SpaceFormat::Gudhi), b""),
        (Reader::Cells, b""),
        (Reader::Cells, b"cells 1 1\n"),
    ] {
        for pattern in [&b" "[..], b"7", b"0,", b"0 "] {
            let mut input = Generated { head, pattern, given: 0 };
            let (message, peak) = reader.refusal(&alone, &mut input);
            assert!(input.given <= OF_A_LINE, "{reader:?}: {} bytes were read", input.given);
            assert!(peak as u64 <= OF_A_LINE, "{reader:?}: {peak} bytes for: {message}");
            most = most.max(peak);
        }
    }
    println!("at most {most} bytes");
}

/// What a reader may make room for on the word of a header: some tens of thousands of vertices.
const ON_ITS_WORD: usize = 8 << 20;

fn little<const N: usize>(magic: &[u8], numbers: [u64; N]) -> Vec<u8> {
    [magic, &numbers.map(u64::to_le_bytes).concat()].concat()
}

#[test]
fn counts_in_the_billions() {
    let alone = Alone::new();
    let text = |text: &str| text.as_bytes().to_vec();
    let msh = |rest: &str| text(&format!("$MeshFormat\n{rest}"));
    let npy = |shape: &str| {
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}");
        [&b"\x93NUMPY\x01\x00"[..], &[u8::try_from(header.len()).unwrap(), 0], header.as_bytes(), &[0; 16]].concat()
    };
    const DIPHA: u64 = 8_067_171_840;
    let cases = [
        (Reader::Mesh(Format::Off), text("OFF 4000000000 4000000000 0\n0 0 0\n")),
        (Reader::Mesh(Format::Off), text("OFF 1 1 0\n0 0 0\n4000000000 0\n")),
        (Reader::Mesh(Format::Obj), text("v 0 0 0\nv 1 0 0\nf 1 2 4000000000\n")),
        (Reader::Mesh(Format::Ply), text("ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nend_header\n0 0\n")),
        (Reader::Mesh(Format::Ply), [&b"ply\nformat binary_little_endian 1.0\nelement face 4000000000\nproperty list uint int vertex_indices\nend_header\n"[..], &[0xff; 8]].concat()),
        (Reader::Mesh(Format::Stl), [&[0; 80][..], &[0xff; 4], &[0; 50]].concat()),
        (Reader::Mesh(Format::Msh), msh("2.2 0 8\n$EndMeshFormat\n$Nodes\n4000000000\n1 0 0 0\n")),
        (Reader::Mesh(Format::Msh), msh("4.1 0 8\n$EndMeshFormat\n$Nodes\n4000000000 1 1 1\n0 0 0 4000000000\n1\n")),
        (Reader::Mesh(Format::Tetbin), [&b"TETB"[..], &[0xff; 8], &[0; 24]].concat()),
        (Reader::Mesh(Format::Tops), text("4000000000 4000000000\n0 0 0\n")),
        (Reader::Mesh(Format::Vtk), text("# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 4000000000 float\n0 0 0\n")),
        (Reader::Mesh(Format::Vtu), text("<VTKFile type='UnstructuredGrid'><UnstructuredGrid><Piece NumberOfPoints='4000000000' NumberOfCells='4000000000'><Points><DataArray type='Float32' NumberOfComponents='3' format='ascii'>0 0 0</DataArray></Points></Piece></UnstructuredGrid></VTKFile>")),
        (Reader::Mesh(Format::Medit), text("MeshVersionFormatted 2\nDimension 3\nVertices\n4000000000\n0 0 0 1\n")),
        (Reader::Mesh(Format::Mfem), text("MFEM mesh v1.0\ndimension\n2\nelements\n4000000000\n1 2 0 1 2\n")),
        (Reader::Mesh(Format::Tetgen), text("4000000000 3 0 0\n1 0 0 0\n")),
        (Reader::Space(SpaceFormat::Mesh), text("OFF 4000000000 4000000000 0\n0 0 0\n")),
        (Reader::Space(SpaceFormat::Npy), npy("4000000000, 3")),
        (Reader::Space(SpaceFormat::Npy), npy("3, 4000000000")),
        (Reader::Space(SpaceFormat::Pts), [&b"PTS1\x03\0\0\0"[..], &4_000_000_000_u64.to_le_bytes(), &[0; 24]].concat()),
        (Reader::Space(SpaceFormat::Pts), [&b"PTS1\xff\xff\xff\xff"[..], &4_000_000_000_u64.to_le_bytes(), &[0; 24]].concat()),
        (Reader::Space(SpaceFormat::Dipha), little(b"", [DIPHA, 7, 4_000_000_000, 0, 0])),
        (Reader::Space(SpaceFormat::Dipha), little(b"", [DIPHA, 8, 4_000_000_000, 0, 0])),
        (Reader::Space(SpaceFormat::Dipha), little(b"", [DIPHA, 8, 2, 4_000_000_000, 0, 1])),
        (Reader::Space(SpaceFormat::Sparse), text("0 4000000000 1\n")),
        (Reader::Space(SpaceFormat::Gudhi), text("31 0 1 2 3 4 5 6 7 0\n")),
        (Reader::Cells, text("cells 4000000000 1\n0 -1\n")),
        (Reader::Cells, text("cells 500000000 1\n0 -1\n")),
        (Reader::Cells, text("cells 2 500000000\n0 -1\n")),
    ];
    let mut most = 0;
    for (reader, bytes) in cases {
        let (message, peak) = reader.refusal(&alone, &bytes[..]);
        assert!(peak <= ON_ITS_WORD, "{reader:?}: {peak} bytes for: {message}");
        most = most.max(peak);
    }
    println!("at most {most} bytes");
}

/// A number is taken for that many points as long as no more than some millions are made of it.
#[test]
fn points_that_only_a_number_tells_of() {
    let alone = Alone::new();
    for (reader, bytes) in
        [(Reader::Space(SpaceFormat::Sparse), &b"0 4194303 1\n"[..]), (Reader::Cells, b"cells 4194304 1\n0 -4194303\n")]
    {
        let (peak, result) = alone.peak_of(|| reader.read(bytes));
        assert!(result.is_ok() && peak <= 256 << 20, "{reader:?}: {peak} bytes, {result:?}");
        println!("{reader:?}: {peak} bytes");
    }
}
