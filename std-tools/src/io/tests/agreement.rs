//! One random mesh written in every format that can hold it: all readers must give the same simplices.

use std::fmt::Write;

use super::super::{Format, read_bytes};
use super::{Random, doubles, read_as};
use crate::soup::{Labels, Scalars, Soup};

/// Points with coordinates of single precision, and cells of 1 to 6 of them.
struct Mesh {
    points: Vec<[f32; 3]>,
    cells: Vec<Vec<usize>>,
}

fn random_mesh(random: &mut Random) -> Mesh {
    let count = 6 + random.below(40);
    let mut value = || [0.5f32, -0.25, 0.1, 3e-7, 1e20, -7.0, 123.456][random.below(7)];
    let points = (0..count).map(|_| [value(), value(), value()]).collect();
    let mut cells = Vec::new();
    for _ in 0..random.below(60) {
        let (size, start) = (1 + random.below(6), random.below(100));
        // Steps of 1 do not come back within 6 of at least 6 points.
        let mut cell: Vec<usize> = (0..size).map(|at| (start + at) % count).collect();
        let turn = random.below(6) % size;
        cell.rotate_left(turn);
        if random.below(2) == 0 {
            cell.reverse();
        }
        cells.push(cell);
    }
    Mesh { points, cells }
}

fn join(numbers: impl Iterator<Item = impl ToString>) -> String {
    numbers.map(|number| number.to_string()).collect::<Vec<_>>().join(" ")
}

fn off(mesh: &Mesh) -> String {
    let mut text = format!("OFF\n{} {} 0\n", mesh.points.len(), mesh.cells.len());
    for point in &mesh.points {
        writeln!(text, "{}", join(point.iter())).unwrap();
    }
    for cell in &mesh.cells {
        writeln!(text, "{} {}", cell.len(), join(cell.iter())).unwrap();
    }
    text
}

fn obj(mesh: &Mesh) -> String {
    let mut text = String::new();
    for point in &mesh.points {
        writeln!(text, "v {}", join(point.iter())).unwrap();
    }
    for (number, cell) in mesh.cells.iter().enumerate() {
        let keyword = ["p", "l", "f"][cell.len().min(3) - 1];
        let back = mesh.points.len();
        let reference =
            |&vertex: &usize| if number % 2 == 0 { format!("{}", vertex + 1) } else { format!("-{}", back - vertex) };
        writeln!(text, "{keyword} {}", join(cell.iter().map(reference))).unwrap();
    }
    text
}

fn ply(mesh: &Mesh, encoding: &str) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat {encoding} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list ushort uint vertex_indices\nend_header\n",
        mesh.points.len(),
        mesh.cells.len()
    )
    .into_bytes();
    if encoding == "ascii" {
        bytes.extend(off(mesh).lines().skip(2).flat_map(|line| [line.as_bytes(), b"\n"].concat()));
        return bytes;
    }
    let mut put = |mut little: Vec<u8>| {
        if encoding == "binary_big_endian" {
            little.reverse();
        }
        bytes.extend(little);
    };
    mesh.points.iter().flatten().for_each(|value| put(value.to_le_bytes().to_vec()));
    for cell in &mesh.cells {
        put(u16::try_from(cell.len()).unwrap().to_le_bytes().to_vec());
        cell.iter().for_each(|&vertex| put(u32::try_from(vertex).unwrap().to_le_bytes().to_vec()));
    }
    bytes
}

/// Without its polygons of more than four vertices, which Gmsh does not have.
fn msh(mesh: &Mesh) -> String {
    let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", mesh.points.len());
    for (tag, point) in mesh.points.iter().enumerate() {
        writeln!(text, "{tag} {}", join(point.iter())).unwrap();
    }
    writeln!(text, "$EndNodes\n$Elements\n{}", mesh.cells.len()).unwrap();
    for cell in &mesh.cells {
        writeln!(text, "1 {} 2 0 0 {}", [15, 1, 2, 3][cell.len() - 1], join(cell.iter())).unwrap();
    }
    text + "$EndElements\n"
}

/// A soup with what formats differ in made equal: labels, and the precision of coordinates.
fn levelled(mut soup: Soup) -> Soup {
    soup.labels = Labels::Numbered(soup.labels.len());
    if let Some(coordinates) = &mut soup.coordinates
        && let Scalars::F32(values) = &coordinates.values
    {
        coordinates.values = Scalars::F64(values.iter().map(|&value| value.into()).collect());
    }
    soup
}

/// Text holds the shortest decimals of single-precision numbers; rounding makes them those numbers again.
#[allow(clippy::cast_possible_truncation)]
fn rounded(soup: Soup) -> Soup {
    let values = doubles(&soup).iter().map(|&value| f64::from(value as f32)).collect();
    let mut soup = levelled(soup);
    soup.coordinates.as_mut().unwrap().values = Scalars::F64(values);
    soup
}

#[test]
fn all_formats_give_the_same_simplices() {
    for seed in 0..200 {
        let mut mesh = random_mesh(&mut Random(seed));
        let expected = rounded(read_as(Format::Off, off(&mesh)).unwrap().0);
        assert_eq!(expected.labels.len(), mesh.points.len());
        let triangles: usize = mesh.cells.iter().map(|cell| cell.len().saturating_sub(2)).sum();
        assert_eq!(expected.of_dim(2).len(), triangles);
        assert_eq!(rounded(read_as(Format::Obj, obj(&mesh)).unwrap().0), expected);
        for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
            assert_eq!(levelled(read_as(Format::Ply, ply(&mesh, encoding)).unwrap().0), expected);
        }
        mesh.cells.retain(|cell| cell.len() <= 4);
        let expected = rounded(read_as(Format::Off, off(&mesh)).unwrap().0);
        assert_eq!(rounded(read_as(Format::Msh, msh(&mesh)).unwrap().0), expected);
    }
}

/// Bytes that are no file of any format: whatever happens, nothing panics.
#[test]
fn random_bytes_in_every_format() {
    const PIECES: [&[u8]; 24] = [
        b"OFF\n",
        b"nOFF 2\n",
        b"ply\n",
        b"format ascii 1.0\n",
        b"element face 3\n",
        b"property list uchar int vertex_index\n",
        b"end_header\n",
        b"solid\n",
        b"facet\n",
        b"$MeshFormat\n4.1 1 8\n",
        b"$Nodes\n",
        b"\x01\0\0\0",
        b"$EndMeshFormat\n",
        b"v 1 2 3\n",
        b"f 1 1 -1\n",
        b"[[1,2],",
        b"]",
        b"3 0 1 2\n",
        b"1e9 ",
        b"-1 ",
        b"\n",
        b"\\\n",
        b"\xff\xfe",
        b"4294967295 ",
    ];
    let mut random = Random(7);
    for _ in 0..20_000 {
        let bytes: Vec<u8> = (0..random.below(12)).flat_map(|_| PIECES[random.below(24)]).copied().collect();
        for &format in Format::ALL {
            let _ = read_as(format, &bytes);
        }
        let _ = read_bytes(&bytes, "x.off", &super::ReadOptions { drop_degenerate: true, ..Default::default() });
    }
}
