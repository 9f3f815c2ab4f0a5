//! Attributes: what each format has, and what becomes of it where cells are split, dropped, welded and merged.

use super::super::{Format, ReadOptions, Weld, merge, read_bytes};
use super::{message, read_as};
use crate::attribute::{Attribute, Values};
use crate::soup::Soup;
use crate::spool::Spill;

/// An attribute as it is expected.
fn one(name: &str, dim: usize, components: usize, values: Values) -> Attribute {
    Attribute { name: name.into(), dim, components, values }
}

/// The attributes of an input in which nothing is passed over.
#[track_caller]
fn attributes(format: Format, bytes: impl AsRef<[u8]>) -> Vec<Attribute> {
    let (soup, report) = read_as(format, bytes).unwrap();
    assert_eq!(report.ignored.names, Vec::<String>::new());
    soup.attributes
}

/// A quadrangle, a triangle and a wire.
const GRID: &str = "# vtk DataFile Version 3.0\na plate\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 float\n0 0 0 1 0 0 1 1 0 \
                    0 1 0 2 0 0 3 0 0\nCELLS 3 12\n4 0 1 2 3\n3 1 4 2\n2 4 5\nCELL_TYPES 3\n9 5 3\n";

#[test]
fn pieces_of_a_cell_have_its_values() {
    let data = "CELL_DATA 3\nSCALARS part int 1\nLOOKUP_TABLE default\n7 -8 9\nVECTORS flow double\n1 2 3 4 5 6 7 8 9\n\
                POINT_DATA 6\nSCALARS t%20mean float\n0.5 1 nan 2 -inf 1e-3\nCOLOR_SCALARS tint 2\n0 1 0 1 0 1 0 1 0 1 0 .5\n";
    let expected = [
        one("t mean", 0, 1, Values::F32(vec![0.5, 1.0, f32::NAN, 2.0, f32::NEG_INFINITY, 1e-3])),
        one("tint", 0, 2, Values::F32(vec![0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 0.5])),
        one("flow", 1, 3, Values::F64(vec![7.0, 8.0, 9.0])),
        one("part", 1, 1, Values::I32(vec![9])),
        one("flow", 2, 3, Values::F64(vec![1.0, 2.0, 3.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0])),
        one("part", 2, 1, Values::I32(vec![7, 7, -8])),
    ];
    let found = attributes(Format::Vtk, format!("{GRID}{data}"));
    // NaN is not itself.
    assert_eq!(format!("{found:?}"), format!("{expected:?}"));
}

#[test]
fn fields_and_binary_data() {
    let data = "POINT_DATA 6\nFIELD FieldData 2\nsmall 1 6 unsigned_char\n1 2 3 4 5 255\nMETADATA\nINFORMATION 0\n\nlong 2 6 \
                vtktypeint64\n1 2 3 4 5 6 7 8 9 10 11 -9223372036854775808\nNORMALS n float\n";
    let normals = "0 0 1 ".repeat(6);
    let found = attributes(Format::Vtk, format!("{GRID}{data}{normals}\n"));
    let mut long: Vec<i64> = (1..12).collect();
    long.push(i64::MIN);
    let up = Values::F32([0.0, 0.0, 1.0].repeat(6));
    let small = Values::U8(vec![1, 2, 3, 4, 5, 255]);
    assert_eq!(found, [one("long", 0, 2, Values::I64(long)), one("n", 0, 3, up), one("small", 0, 1, small)]);

    let mut binary = b"# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 3 float\n".to_vec();
    binary.extend([0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|value| value.to_be_bytes()));
    // Cells are numbered lines first, whatever comes first.
    binary.extend(b"\nPOLYGONS 1 4\n");
    binary.extend([3_i32, 0, 1, 2].iter().flat_map(|value| value.to_be_bytes()));
    binary.extend(b"\nLINES 1 4\n");
    binary.extend([3_i32, 2, 1, 0].iter().flat_map(|value| value.to_be_bytes()));
    binary.extend(b"\nCELL_DATA 2\nSCALARS part unsigned_short\nLOOKUP_TABLE default\n");
    binary.extend([300_u16, 65_535].iter().flat_map(|value| value.to_be_bytes()));
    binary.extend(b"\nPOINT_DATA 3\nSCALARS is bit\nLOOKUP_TABLE default\n\x60\nLOOKUP_TABLE default 2\n01234567\n");
    let (soup, report) = read_as(Format::Vtk, binary).unwrap();
    assert_eq!(report.ignored.names, ["is", "LOOKUP_TABLE"]);
    let expected = [one("part", 1, 1, Values::U16(vec![300, 300])), one("part", 2, 1, Values::U16(vec![65_535]))];
    assert_eq!(soup.attributes, expected);
}

#[test]
fn what_is_wrong_with_data_in_legacy_files() {
    let found = |data: &str| message(Format::Vtk, format!("{GRID}{data}"));
    assert_eq!(found("POINT_DATA 5\n"), "test:13:1: points with data: 5 declared, 6 found");
    assert_eq!(found("CELL_DATA 4\n"), "test:13:1: cells with data: 4 declared, 3 found");
    let expected = "test:14:17: expected the type of the array, found `integer`";
    assert_eq!(found("CELL_DATA 3\nSCALARS a       integer\n"), expected);
    assert_eq!(found("CELL_DATA 3\nSCALARS a int\n1 2 x\n"), "test:15:5: expected an integer, found `x`");
    let expected = "test:15:1: expected an integer of the type of the array, found -1";
    assert_eq!(found("CELL_DATA 3\nSCALARS a unsigned_char\n-1 2 3\n"), expected);
    let expected = "test:15:3: rows of the array: 3 declared, 2 found";
    assert_eq!(found("CELL_DATA 3\nFIELD f 1\n  a 1 2 int\n1 2\n"), expected);
    assert!(found("CELL_DATA 3\nVECTORS a int\n1 2 3\n").contains("as many numbers as the array has"));
    let (_, report) = read_as(Format::Vtk, format!("{GRID}CELL_DATA 3\nFIELD f 1\na 1 3 string\nb\n")).unwrap();
    assert_eq!(report.ignored.names, ["a, which holds no numbers, and what follows it"]);
}

#[test]
fn pieces_of_a_grid_are_put_together() {
    let piece = |shift: u32, data: &str| {
        format!(
            "<Piece NumberOfPoints=\"3\" NumberOfCells=\"1\">{data}<Points><DataArray type=\"Float32\" \
             NumberOfComponents=\"3\">0 0 {shift} 1 0 0 0 1 0</DataArray></Points><Cells><DataArray type=\"Int8\" \
             Name=\"connectivity\">0 1 2</DataArray><DataArray type=\"Int8\" Name=\"offsets\">3</DataArray>\
             <DataArray type=\"UInt8\" Name=\"types\">5</DataArray></Cells></Piece>"
        )
    };
    let grid = |pieces: &[String]| {
        format!("<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>{}</UnstructuredGrid></VTKFile>", pieces.concat())
    };
    let array = |name: &str, scalar: &str, values: &str| {
        format!("<DataArray type=\"{scalar}\" Name=\"{name}\">{values}</DataArray>")
    };
    let points = |arrays: &str| format!("<PointData>{arrays}</PointData>");
    let cells = |arrays: &str| format!("<CellData>{arrays}</CellData>");
    let first = points(&array("a &lt; b", "Int16", "-1 2 3"))
        + &cells(&(array("c", "UInt64", "18446744073709551615") + &array("dimension", "UInt8", "2")));
    let second = cells(&(array("c", "UInt64", "1") + &array("dimension", "UInt8", "2")));
    let found = attributes(Format::Vtu, grid(&[piece(0, &first), piece(1, &second)]));
    let expected =
        [one("a < b", 0, 1, Values::I32(vec![-1, 2, 3, 0, 0, 0])), one("c", 2, 1, Values::U64(vec![u64::MAX, 1]))];
    assert_eq!(found, expected);
    let other = cells(&array("c", "Float32", "1"));
    let (soup, report) = read_as(Format::Vtu, grid(&[piece(0, &second), piece(1, &other)])).unwrap();
    assert_eq!(
        (soup.attributes.len(), report.ignored.names),
        (1, vec!["c".to_owned()]),
        "the dimension of one piece is left"
    );
    let short = points(&array("a", "Int16", "-1 2"));
    let expected = "numbers of the attribute: 3 declared, 2 found";
    assert!(message(Format::Vtu, grid(&[piece(0, &short)])).ends_with(expected));
    // Labels that are not all different are no labels.
    let found = attributes(Format::Vtu, grid(&[piece(0, &points(&array("label", "Int8", "4 4 5")))]));
    assert_eq!(found, [one("label", 0, 1, Values::U64(vec![4, 4, 5]))]);
}

#[test]
fn properties_of_ply() {
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty uchar red\n\
                  property float uv_0\nproperty float uv_1\nproperty double uv_2\nproperty list uchar int near\nelement face \
                  2\nproperty short group\nproperty list uchar int vertex_indices\nelement edge 1\nproperty int \
                  vertex1\nproperty int vertex2\nproperty short group\nend_header\n";
    let rows = "0 0 255 .1 .2 3 0\n1 0 1 1 2 3 1 7\n1 1 2 1 2 3 0\n0 1 3 1 2 nan 0\n-5 4 0 1 2 3\n6 2 0 2\n3 0 1\n";
    let (soup, report) = read_as(Format::Ply, format!("{header}{}", rows.replace("3 0 1\n", "3 0 -7\n")))
        .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(report.ignored.names, ["vertex near"]);
    let named = |dim: usize, name: &str| {
        soup.attributes.iter().find(|found| found.dim == dim && *found.name == *name).map(|found| found.values.clone())
    };
    assert_eq!(named(0, "red"), Some(Values::U8(vec![255, 1, 2, 3])));
    assert_eq!(named(0, "uv"), Some(Values::F32(vec![0.1, 0.2, 1.0, 2.0, 1.0, 2.0, 1.0, 2.0])));
    assert_eq!(format!("{:?}", named(0, "uv_2")), "Some(F64([3.0, 3.0, 3.0, NaN]))");
    assert_eq!(named(2, "group"), Some(Values::I32(vec![-5, -5])));
    // A face of two vertices is an edge, as the edge is.
    assert_eq!(named(1, "group"), Some(Values::I32(vec![6, -7])));
    let wrong = format!("{header}{}", rows.replace("255", "256"));
    let expected = "test:19:5: expected an integer of the type of the property, found `256`";
    assert_eq!(message(Format::Ply, wrong), expected);
}

#[test]
fn groups_and_data_of_gmsh() {
    let start = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n10 0 0 0\n20 1 0 0\n30 0 1 0\n40 0 0 1\n$EndNodes\n$Elements\n3\n5 \
                 2 2 1 8 10 20 30\n7 4 2 -2 9 10 20 30 40\n6 15 0 40\n$EndElements\n";
    let data = "$NodeData\n1\n\"heat\"\n1\n0.0\n3\n0\n1\n2\n20 1.5\n40 -2\n$EndNodeData\n$ElementData\n2\n\"flow \
                field\"\n\"scheme\"\n0\n4\n0\n3\n2\n0\n6 1 2 3\n7 4 5 6\n$EndElementData\n";
    let found = attributes(Format::Msh, format!("{start}{data}"));
    let nan = f64::NAN;
    let expected = [
        one("flow field", 0, 3, Values::F64(vec![nan, nan, nan, nan, nan, nan, nan, nan, nan, 1.0, 2.0, 3.0])),
        one("heat", 0, 1, Values::F64(vec![nan, 1.5, nan, -2.0])),
        one("ref", 2, 1, Values::I32(vec![1])),
        one("flow field", 3, 3, Values::F64(vec![4.0, 5.0, 6.0])),
        one("ref", 3, 1, Values::I32(vec![-2])),
    ];
    assert_eq!(format!("{found:?}"), format!("{expected:?}"));
    let unknown = data.replace("40 -2", "41 -2");
    assert_eq!(message(Format::Msh, format!("{start}{unknown}")), "test:27:1: there is no node with tag 41");
    let four = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n1 0 1 0\n1 0 0 0 0\n3 0 0 0 1 1 0 2 12 13 \
                1 1\n$EndEntities\n$Nodes\n1 3 1 3\n2 3 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n$EndNodes\n$Elements\n2 2 1 2\n2 3 2 1\n1 1 2 \
                3\n0 1 15 1\n2 1\n$EndElements\n";
    assert_eq!(attributes(Format::Msh, four), [one("ref", 2, 1, Values::I32(vec![12]))]);
}

#[test]
fn references_of_medit_and_mfem() {
    let medit = "MeshVersionFormatted 2\nDimension 2\nVertices\n4\n0 0 0\n1 0 0\n1 1 -3\n0 1 0\nQuadrilaterals\n1\n1 2 3 4 \
                 5000000000\nEdges\n2\n1 2 0\n2 3 0\nEnd\n";
    let expected = [
        one("ref", 0, 1, Values::I32(vec![0, 0, -3, 0])),
        one("ref", 2, 1, Values::I64(vec![5_000_000_000, 5_000_000_000])),
    ];
    assert_eq!(attributes(Format::Medit, medit), expected);
    let none = medit.replace("-3", "0").replace("5000000000", "0");
    assert_eq!(attributes(Format::Medit, none), []);
    let mfem = "MFEM mesh v1.0\ndimension\n2\nelements\n1\n1 2 0 1 2\nboundary\n2\n4 1 0 1\n1 1 1 2\nvertices\n3\n2\n0 0\n1 \
                0\n0 1\n";
    assert_eq!(attributes(Format::Mfem, mfem), [one("ref", 1, 1, Values::I32(vec![4, 1]))]);
}

/// Two triangles with a corner twice, the second of which has another temperature.
const TORN: &str = "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 6 float\n0 0 0 1 0 0 0 1 0 1 0 0 0 1 0 1 1 \
                    0\nPOLYGONS 3 12\n3 0 1 2\n3 3 5 4\n3 1 3 5\nCELL_DATA 3\nSCALARS part int\n1 2 3\nPOINT_DATA 6\nSCALARS t \
                    int\n1 2 3 2 4 5\n";

#[test]
fn welded_vertices_have_the_values_of_the_first() {
    let options = ReadOptions { weld: Some(Weld::Exact), drop_degenerate: true, ..Default::default() };
    let (soup, report) = read_bytes(TORN.as_bytes(), "a.vtk", &options).unwrap();
    assert_eq!((report.welded, report.welded_differing, report.degenerate_dropped), (2, 1, 1));
    let expected = [one("t", 0, 1, Values::I32(vec![1, 2, 3, 5])), one("part", 2, 1, Values::I32(vec![1, 2]))];
    assert_eq!(soup.attributes, expected);
}

#[test]
fn they_can_be_left_out_and_are_refused_out_of_core() {
    let options = ReadOptions { drop_attributes: true, ..Default::default() };
    let (soup, report) = read_bytes(TORN.as_bytes(), "a.vtk", &options).unwrap();
    assert_eq!((soup.attributes, report.ignored.names), (Vec::new(), vec!["CELL_DATA".to_owned()]));
    let spill = Spill::new_in(&std::env::temp_dir()).unwrap();
    let options = ReadOptions { spill: Some(&spill), ..Default::default() };
    let medit = "MeshVersionFormatted 2\nDimension 2\nVertices\n2\n0 0 0\n1 0 0\nEdges\n1\n1 2 3\nEnd\n";
    let error = read_bytes(medit.as_bytes(), "a.mesh", &options).unwrap_err();
    let expected = "a.mesh: the attributes ref are kept in memory alone; --drop-attributes leaves them out";
    assert_eq!(error.to_string(), expected);
    let plain = medit.replace("1 2 3", "1 2 0");
    assert!(read_bytes(plain.as_bytes(), "a.mesh", &options).is_ok());
}

#[test]
fn meshes_beside_each_other_have_the_attributes_of_both() {
    let read = |text: &str| -> Soup { read_as(Format::Vtk, text).unwrap().0 };
    let other = TORN.replace("SCALARS t int", "SCALARS t float").replace("SCALARS part int", "SCALARS other int");
    let (soup, report) = merge(vec![read(TORN), read(&other)]).unwrap();
    assert_eq!(report.attributes_left_out, ["t".into()]);
    let expected = [
        one("other", 2, 1, Values::I32(vec![0, 0, 0, 1, 2, 3])),
        one("part", 2, 1, Values::I32(vec![1, 2, 3, 0, 0, 0])),
    ];
    assert_eq!(soup.attributes, expected);
    let (soup, _) = merge(vec![read(TORN), read(TORN)]).unwrap();
    assert_eq!(soup.attributes[0], one("t", 0, 1, Values::I32(vec![1, 2, 3, 2, 4, 5, 1, 2, 3, 2, 4, 5])));
}
