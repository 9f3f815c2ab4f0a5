//! Files that other programs wrote, in `tests/data/formats`: the counts are those of the script that made them, which lists
//! all faces of all pieces by itself.

use super::super::{Compression, Format, ReadOptions, read_bytes, read_path};
use super::{doubles, f_vector, message, refused};
use crate::soup::{Labels, Soup};

fn path(name: &str) -> String {
    format!("{}/../tests/data/formats/{name}", env!("CARGO_MANIFEST_DIR"))
}

/// A hexahedron, a prism, a pyramid, a tetrahedron, a triangle, a quadrangle, an edge and a point, some of them with common
/// faces.
const MIXED: [usize; 4] = [18, 41, 37, 12];

#[track_caller]
fn read(name: &str, format: Format) -> Soup {
    let (soup, report) = read_path(path(name), &ReadOptions::default()).unwrap();
    assert_eq!(report.format, format, "{name}");
    // By content, whatever the name.
    if format != Format::Tetgen {
        let bytes = std::fs::read(path(name)).unwrap();
        assert_eq!(read_bytes(&bytes, "x", &ReadOptions::default()).unwrap().0, soup, "{name}");
    }
    soup
}

#[test]
fn vtk_in_every_encoding_gives_the_same_soup() {
    let expected = read("ascii.vtu", Format::Vtu);
    assert_eq!(f_vector(&expected), MIXED);
    assert_eq!(expected.labels, Labels::Numbered(18));
    assert_eq!(doubles(&expected)[3 * 11..3 * 12], [3.0, 0.5, 0.25]);
    for name in [
        "base64.vtu",
        "zlib.vtu",
        "appended-raw.vtu",
        "appended-raw-zlib.vtu",
        "appended-base64.vtu",
        "appended-base64-zlib.vtu",
    ] {
        assert_eq!(read(name, Format::Vtu), expected, "{name}");
    }
    for name in ["ascii42.vtk", "binary42.vtk", "ascii51.vtk", "binary51.vtk"] {
        assert_eq!(read(name, Format::Vtk), expected, "{name}");
    }
}

#[test]
fn vtk_cells_of_second_order_stand_for_their_corners() {
    let (soup, report) = read_path(path("tetra10.vtu"), &ReadOptions::default()).unwrap();
    assert_eq!(f_vector(&soup), [5, 9, 7, 2]);
    // Nine edges, a node on each.
    assert_eq!((report.vertices, report.inner_nodes_dropped), (5, 9));
}

#[test]
fn meshes_of_finite_elements() {
    // These formats have no cell of one vertex; meshio has no pyramid for Abaqus.
    let medit = read("mixed.mesh", Format::Medit);
    assert_eq!(f_vector(&medit), [17, 41, 37, 12]);
    assert_eq!(medit.labels, Labels::Integers((1..=18).collect()));
    let nastran = read("mixed.bdf", Format::Nastran);
    assert_eq!((f_vector(&nastran), &nastran.labels), (vec![17, 41, 37, 12], &medit.labels));
    assert_eq!(
        nastran.simplices.iter().map(Vec::len).collect::<Vec<_>>(),
        medit.simplices.iter().map(Vec::len).collect::<Vec<_>>()
    );
    assert_eq!(doubles(&nastran), doubles(&medit));
    let abaqus = read("mixed.inp", Format::Abaqus);
    assert_eq!(f_vector(&abaqus), [16, 37, 32, 10]);
    assert_eq!(doubles(&abaqus), doubles(&medit));
    let second = read("tetra10.inp", Format::Abaqus);
    assert_eq!((f_vector(&second), second.labels.len()), (vec![5, 9, 7, 2], 5));
}

#[test]
fn tetgen_reads_the_files_that_lie_beside() {
    for name in ["tet.node", "tet.ele"] {
        let soup = read(name, Format::Tetgen);
        assert_eq!((soup.labels.len(), f_vector(&soup)), (18, vec![4, 6, 4, 1]), "{name}");
    }
    let alone = read_bytes(&std::fs::read(path("tet.node")).unwrap(), "x.node", &ReadOptions::default()).unwrap();
    assert_eq!((alone.0.labels.len(), alone.0.num_listed()), (18, 0));
    let missing = read_path(path("no.ele"), &ReadOptions::default()).unwrap_err().to_string();
    assert!(missing.contains("no.node: cannot read"), "{missing}");
}

#[test]
fn mfem_meshes_by_their_table() {
    for (name, counts) in [
        ("mobius-strip.mesh", &[24, 56, 32][..]),
        ("klein-bottle.mesh", &[128, 384, 256]),
        ("periodic-cube.mesh", &[27, 189, 324, 162]),
    ] {
        let file = format!("{}/../tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
        let (soup, report) = read_path(file, &ReadOptions::default()).unwrap();
        assert_eq!((report.format, f_vector(&soup)), (Format::Mfem, counts.to_vec()), "{name}");
    }
}

#[test]
fn compressed_files_are_read_the_same() {
    let plain = read("ascii.vtu", Format::Vtu);
    let (soup, report) = read_path(path("ascii.vtu.zst"), &ReadOptions::default()).unwrap();
    assert_eq!((soup, report.compression), (plain, Some(Compression::Zstd)));
}

#[test]
fn errors_and_their_places() {
    let refuse = |name: &str, format: Format, from: &str, to: &str| {
        let text = String::from_utf8_lossy(&std::fs::read(path(name)).unwrap()).into_owned();
        assert!(text.contains(from), "{name}");
        message(format, text.replacen(from, to, 1))
    };
    for (name, format, from, to, expected) in [
        (
            "mixed.mesh",
            Format::Medit,
            "Dimension 3",
            "Dimension 4",
            "test:2:11: expected the dimension, 2 or 3, found `4`",
        ),
        (
            "mixed.mesh",
            Format::Medit,
            "12 13 14",
            "12 13 99",
            "test:43:7: vertex 99 is out of range: there are 18 vertices, numbered from 1",
        ),
        ("mixed.mesh", Format::Medit, "12 13 14", "12 13 12", "test:43:1: the simplex repeats vertex 12"),
        ("mixed.inp", Format::Abaqus, "4,12,13,14", "4,12,13,99", "test:30:9: there is no node with tag 99"),
        ("mixed.inp", Format::Abaqus, "4,12,13,14", "4,12,13", "test:30:1: nodes of the element: 3 declared, 2 found"),
        ("mixed.inp", Format::Abaqus, "\n2, ", "\n1, ", "test:6:1: node 1 is declared more than once"),
        (
            "mixed.bdf",
            Format::Nastran,
            "12      13      14",
            "12      13      99",
            "test:44:41: there is no node with tag 99",
        ),
        (
            "mixed.bdf",
            Format::Nastran,
            "          5.E-1\n*",
            "          5.F-1\n*",
            "test:19:68: expected a coordinate of the node, found `5.F-1`",
        ),
        ("ascii42.vtk", Format::Vtk, "DATASET UN", "DATASET IN", "test:4:9: expected UNSTRUCTURED_GRID or POLYDATA"),
        ("ascii.vtu", Format::Vtu, "format=\"ascii\"", "format=\"octal\"", "test:7:1: an array whose format is not"),
    ] {
        let found = refuse(name, format, from, to);
        assert!(found.starts_with(expected), "{name} {from}\n   found {found}\nexpected {expected}");
    }
}

const POLY_DATA: &str = "# vtk DataFile Version 3.0

ASCII
DATASET POLYDATA
POINTS 5 float
0 0 0 1 0 0 1 1 0
0 1 0 2.5 2 2
VERTICES 1 2
1 4
LINES 1 4
3 0 1 2
POLYGONS 1 5
4 0 1 2 3
TRIANGLE_STRIPS 1 5
4 0 1 2 4
POINT_DATA 5
SCALARS a float
LOOKUP_TABLE default
1 2 3 4 5
";

/// The same in XML, in text, with labels.
const POLY_DATA_XML: &str = "<?xml version='1.0'?>
<VTKFile type='PolyData' version='0.1'>
<PolyData><Piece NumberOfPoints='5' NumberOfVerts='1' NumberOfLines='1' NumberOfStrips='1' NumberOfPolys='1'>
<PointData><DataArray type='Int32' Name='label' format='ascii'>7 8 9 10 3</DataArray>
<DataArray type='Float32' Name='other' format='ascii'>1 2 3 4 5</DataArray></PointData>
<Points><DataArray type='Float32' NumberOfComponents='3' format='ascii'>
0 0 0 1 0 0 1 1 0 0 1 0 2.5 2 2</DataArray></Points>
<Verts><DataArray type='Int32' Name='connectivity'>4</DataArray><DataArray type='Int32' Name='offsets'>1</DataArray></Verts>
<Lines><DataArray type='Int32' Name='connectivity'>0 1 2</DataArray><DataArray type='Int32' Name='offsets'>3</DataArray></Lines>
<Strips><DataArray type='Int32' Name='connectivity'>0 1 2 4</DataArray><DataArray type='Int32' Name='offsets'>4</DataArray></Strips>
<Polys><DataArray type='Int32' Name='connectivity'>0 1 2 3</DataArray><DataArray type='Int32' Name='offsets'>4</DataArray></Polys>
</Piece></PolyData></VTKFile>
";

#[test]
fn poly_data_in_text_and_xml() {
    let (soup, report) = super::read_as(Format::Vtk, POLY_DATA).unwrap();
    assert_eq!(super::listed(&soup, 0), [[4]]);
    assert_eq!(super::listed(&soup, 1), [[0, 1], [1, 2]]);
    let mut triangles = super::listed(&soup, 2);
    triangles.sort();
    assert_eq!(triangles, [[0, 1, 2], [0, 1, 2], [0, 2, 3], [2, 1, 4]]);
    assert_eq!((report.polygons, report.ignored.count, soup.attributes.len()), (1, 0, 1));
    let (xml, report) = super::read_as(Format::Vtu, POLY_DATA_XML).unwrap();
    assert_eq!(xml.labels, Labels::Integers(vec![7, 8, 9, 10, 3]));
    assert_eq!(xml.coordinates, soup.coordinates);
    assert_eq!(f_vector(&xml), f_vector(&soup));
    assert_eq!((report.ignored.count, &*xml.attributes[0].name), (0, "other"));
    assert_eq!(xml.attributes[0].values, soup.attributes[0].values);
}

const MFEM: &str = "MFEM mesh v1.0\n# c\ndimension\n2\n\nelements\n2\n1 2 0 1 2\n1 3 1 3 4 2\n\nboundary\n1\n7 1 0 1\n\n\
                    vertices\n5\n2\n0 0\n1 0\n0.5 1\n2 0\n2 1\n";

const NASTRAN: &str = "SOL 101\nBEGIN BULK\n$ c\nGRID,1,,0.,0.,1.5-3\nGRID,2,0,1.,,\nGRID           3      5      0.      1. -2.D+1\n\
                       GRID*                  4                              1.              1.\n*                     0.\n\
                       CTRIA6,1,1,1,2,3\nCBAR,9,1,3,4,,,1.\nCTETRA         2       1       1       2       3       4\nPSHELL,1\n";

const ABAQUS: &str = "*Heading\n t\n** c\n*ELEMENT, TYPE=S4R5\n1, 10, 20,\n 30, 40\n*Node, nset=all\n10, 0., 0.\n20, 1.d0\n30, 1., 1.\n\
                      40, 0., 1., 0.\n*Element, type=B31\n2, 40, 10, 20\n*element,type=U1\n3, 10\n*Material, name=a\n1., 2.\n";

#[test]
fn small_files_of_finite_elements() {
    let (soup, _) = super::read_as(Format::Mfem, MFEM).unwrap();
    assert_eq!(super::listed(&soup, 2), [[0, 1, 2], [1, 3, 4], [1, 4, 2]]);
    assert_eq!((super::listed(&soup, 1), soup.coordinates.as_ref().unwrap().dim), (vec![vec![0, 1]], 2));
    let (soup, report) = super::read_as(Format::Nastran, NASTRAN).unwrap();
    assert_eq!(soup.labels, Labels::Integers(vec![1, 2, 3, 4]));
    assert_eq!(doubles(&soup), [0.0, 0.0, 1.5e-3, 1.0, 0.0, 0.0, 0.0, 1.0, -20.0, 1.0, 1.0, 0.0]);
    assert_eq!(soup.simplices, [vec![], vec![2, 3], vec![0, 1, 2], vec![0, 1, 2, 3]]);
    assert_eq!(report.ignored.names, ["coordinate systems of nodes", "PSHELL"]);
    let (soup, report) = super::read_as(Format::Abaqus, ABAQUS).unwrap();
    assert_eq!(soup.labels, Labels::Integers(vec![10, 20, 30, 40]));
    assert_eq!(doubles(&soup), [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0]);
    assert_eq!(
        (super::listed(&soup, 2), super::listed(&soup, 1)),
        (vec![vec![0, 1, 2], vec![0, 2, 3]], vec![vec![3, 0]])
    );
    assert_eq!(report.ignored.names, ["elements of type U1", "*MATERIAL"]);
}

/// Vertices that nothing vouches for would take memory by their number alone.
#[test]
fn vertices_without_coordinates_are_in_elements() {
    let mesh =
        |element: &str, vertices: &str| format!("MFEM mesh v1.0\nelements\n1\n{element}\nvertices\n{vertices}\n");
    assert!(super::read_as(Format::Mfem, mesh("1 1 0 1", "2\nnodes\nany")).is_ok());
    refused(
        Format::Mfem,
        &[
            (
                &mesh("1 1 0 1", "4000000000\nnodes"),
                "test:7:1: vertices without coordinates that an element has: 4000000000",
            ),
            (&mesh("1 1 0 3999999999", "4000000000"), "test:7:1: vertices without coordinates that an element has"),
            (
                &mesh("1 1 0 1", "4000000000\n0"),
                "test:7:1: expected the dimension of the space, from 1 to 255, found `0`",
            ),
            (&mesh("1 1 0 2", "2\nnodes"), "test:4:7: vertex 2 is out of range: there are 2 vertices, numbered from 0"),
        ],
    );
}

/// For tests of hostile input.
pub(super) fn samples() -> Vec<(Format, Vec<u8>)> {
    let mut samples: Vec<(Format, Vec<u8>)> = [
        (Format::Vtk, POLY_DATA),
        (Format::Vtu, POLY_DATA_XML),
        (Format::Mfem, MFEM),
        (Format::Nastran, NASTRAN),
        (Format::Abaqus, ABAQUS),
        (Format::Tetgen, "# c\n3 2 1 0\n1 0 0 5\n2 1 0 5\n3 0 1e3 5\n"),
        (Format::Medit, "MeshVersionFormatted 2\nDimension\n2\nVertices 3\n0 0 1\n1 0 1\n0 1 1\nCorners 1\n1\nTriangles 1\n1 2 3 0\nEnd\n"),
    ]
    .map(|(format, text)| (format, text.as_bytes().to_vec()))
    .into();
    for (name, format) in [
        ("zlib.vtu", Format::Vtu),
        ("appended-raw-zlib.vtu", Format::Vtu),
        ("appended-base64.vtu", Format::Vtu),
        ("binary42.vtk", Format::Vtk),
        ("binary51.vtk", Format::Vtk),
    ] {
        samples.push((format, std::fs::read(path(name)).unwrap()));
    }
    samples
}
