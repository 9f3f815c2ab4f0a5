//! Cells and vertices that cannot be part of a complex: refused, or dropped, counted and named.

use super::super::{Format, OnBad, ReadOptions, ReadReport, Weld, read_bytes};
use super::listed;
use crate::soup::{Labels, Soup};

fn dropping(format: Format, bytes: impl AsRef<[u8]>) -> (Soup, ReadReport) {
    let options = ReadOptions { format: Some(format), on_bad: OnBad::Drop, ..Default::default() };
    read_bytes(bytes.as_ref(), "test", &options).unwrap()
}

/// Five points of which number 3, by any count, is nowhere, and four triangles: a good one, one at that point, one that
/// repeats a vertex, and one that names a sixth.
fn files() -> Vec<(Format, String, &'static str)> {
    let points = ["0 0 0", "1 0 0", "0 1 0", "0 nan 1", "1 1 0"];
    let numbered = |first: usize| {
        let triangles = [[0, 1, 2], [1, 2, 3], [4, 4, 1], [0, 1, 5]];
        triangles.map(|triangle| triangle.map(|vertex| (vertex + first).to_string()).join(" "))
    };
    let [zero, one] = [numbered(0), numbered(1)];
    let rows = |before: &str, after: &str, rows: &[String]| {
        rows.iter().map(|row| format!("{before}{row}{after}\n")).collect::<String>()
    };
    let listed =
        |from: usize| points.iter().zip(from..).map(|(point, tag)| format!("{tag} {point}\n")).collect::<String>();
    let lines = points.map(|point| format!("{point}\n")).concat();
    let elements = one.iter().zip(1..).map(|(row, tag)| format!("{tag} 2 2 7 7 {row}\n")).collect::<String>();
    vec![
        (Format::Off, format!("OFF\n5 4 0\n{lines}{}", rows("3 ", "", &zero)), ":11:7: vertex 5"),
        (
            Format::Obj,
            points.map(|point| format!("v {point}\n")).concat() + &rows("f ", "", &one).replace("f 1 2 6", "f 1 2 -6"),
            ":9:7: vertex -6",
        ),
        (
            Format::Ply,
            format!(
                "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\nproperty double \
                 z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n{lines}{}",
                rows("3 ", "", &zero)
            ),
            ":18:7: vertex 5",
        ),
        (
            Format::Vtk,
            format!(
                "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\nPOINTS 5 double\n{lines}POLYGONS 4 16\n{}",
                rows("3 ", "", &zero)
            ),
            ": cell 3 names a vertex",
        ),
        (
            Format::Medit,
            format!(
                "MeshVersionFormatted 2\nDimension 3\nVertices\n5\n{}Triangles\n4\n{}End\n",
                lines.replace('\n', " 0\n"),
                rows("", " 0", &one)
            ),
            ":15:5: vertex 6",
        ),
        (
            Format::Msh,
            format!(
                "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n{}$EndNodes\n$Elements\n4\n{elements}$EndElements\n",
                listed(1)
            ),
            ":17:15: there is no node with tag 6",
        ),
        (Format::Tops, format!("5 4\n{lines}{}", rows("3 ", "", &zero)), ":10:7: vertex 5"),
        (
            Format::Mfem,
            format!("MFEM mesh v1.0\ndimension\n2\nelements\n4\n{}vertices\n5\n3\n{lines}", rows("1 2 ", "", &zero)),
            "",
        ),
        (
            Format::Abaqus,
            format!(
                "*NODE\n{}*ELEMENT, TYPE=S3\n{}",
                listed(1).replace(' ', ","),
                one.iter().zip(1..).map(|(row, tag)| format!("{tag} {row}\n").replace(' ', ",")).collect::<String>()
            ),
            "",
        ),
    ]
}

#[test]
fn what_is_bad_is_dropped_and_named() {
    for (format, text, missing) in files() {
        let refused = read_bytes(text.as_bytes(), "test", &ReadOptions { format: Some(format), ..Default::default() });
        assert!(refused.is_err(), "{format}");
        let (soup, report) = dropping(format, &text);
        assert_eq!(listed(&soup, 2), [[0, 1, 2]], "{format}");
        assert_eq!(soup.labels.len(), 4, "{format}");
        // A node that is not declared is a vertex all the same.
        let bad_vertices = if format == Format::Abaqus { 2 } else { 1 };
        let counts = (report.bad_vertices_dropped, report.degenerate_dropped, report.vertices, &*report.simplices);
        assert_eq!(counts, (bad_vertices, 1, 4, &[0, 0, 1][..]), "{format}");
        assert_eq!(report.bad_cells_dropped, 2, "{format}: {:?}", report.bad);
        let named = |start: &str| report.bad.iter().any(|what| what.starts_with(start));
        assert!(named(missing), "{format}: {:?}", report.bad);
        assert!(named(": vertex "), "{format}: {:?}", report.bad);
        assert!(report.bad.iter().any(|what| what.contains("repeats a vertex")), "{format}: {:?}", report.bad);
    }
}

#[test]
fn attributes_of_the_others_stay() {
    let text = "MeshVersionFormatted 2\nDimension 2\nVertices\n4\n0 inf 1\n1 0 2\n1 1 3\n0 1 4\nTriangles\n3\n1 2 3 5\n2 3 4 \
                6\n2 3 9 7\nEnd\n";
    let (soup, report) = dropping(Format::Medit, text);
    assert_eq!(soup.labels, Labels::Integers(vec![2, 3, 4]));
    assert_eq!(
        report.bad,
        [
            ":13:5: vertex 9 is out of range: there are 4 vertices, numbered from 1",
            ": vertex 1 has no finite coordinates",
        ]
    );
    let values: Vec<_> = soup.attributes.iter().map(|attribute| format!("{:?}", attribute.values)).collect();
    assert_eq!(values, ["I32([2, 3, 4])", "I32([6])"]);
}

#[test]
fn the_first_few_that_are_dropped_are_named() {
    let text = format!("OFF 2 {} 0\n0 0 0\n1 0 0\n{}", 20, "3 0 1 1\n".repeat(20));
    let options = ReadOptions { drop_degenerate: true, ..Default::default() };
    let (_, report) = read_bytes(text.as_bytes(), "a.off", &options).unwrap();
    assert_eq!((report.degenerate_dropped, report.bad.len()), (20, 8));
    assert_eq!(report.bad[0], ": the simplex 0,1,1 repeats a vertex");
    let text = "OFF 3 1 0\n0 0 0\n1 0 0\n1 0 0\n3 0 1 2\n";
    let options = ReadOptions { on_bad: OnBad::Drop, weld: Some(Weld::Exact), ..Default::default() };
    let (_, report) = read_bytes(text.as_bytes(), "a.off", &options).unwrap();
    assert_eq!(report.bad, [": the simplex 0,1,2 repeats a vertex once vertices are welded"]);
}
