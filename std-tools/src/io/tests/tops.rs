//! The formats of points and top simplices, in text and in binary.

use super::super::Format;
use super::{doubles, listed, message, read_as, read_dropping, refused, singles};
use crate::soup::Labels;

/// A triangle, an edge and a point in the plane.
pub(super) const TEXT: &str = "# c\n4 3\n0 0\n1 0.5\n0 1e3 # end\n-1 -1\n3 0 1 2\n\n2 3 0\n1 3\n";

/// Tetrahedra in binary.
pub(super) fn tetbin(points: &[[f32; 3]], tetrahedra: &[[u32; 4]]) -> Vec<u8> {
    let count = |len: usize| u32::try_from(len).unwrap().to_le_bytes();
    let mut bytes = [&b"TETB"[..], &count(points.len()), &count(tetrahedra.len())].concat();
    bytes.extend(points.iter().flatten().flat_map(|value| value.to_le_bytes()));
    bytes.extend(tetrahedra.iter().flatten().flat_map(|vertex| vertex.to_le_bytes()));
    bytes
}

#[test]
fn points_of_any_dimension_and_simplices_of_any_dimension() {
    let (soup, report) = read_as(Format::Tops, TEXT).unwrap();
    assert_eq!(soup.labels, Labels::Numbered(4));
    assert_eq!(soup.coordinates.as_ref().unwrap().dim, 2);
    assert_eq!(doubles(&soup), [0.0, 0.0, 1.0, 0.5, 0.0, 1e3, -1.0, -1.0]);
    assert_eq!(
        (listed(&soup, 0), listed(&soup, 1), listed(&soup, 2)),
        (vec![vec![3]], vec![vec![3, 0]], vec![vec![0, 1, 2]])
    );
    assert_eq!(report.simplices, [1, 1, 1]);
    assert_eq!(read_as(Format::Tops, "0 0\n").unwrap().0.labels, Labels::Numbered(0));
}

#[test]
fn what_is_no_list_of_points_and_simplices() {
    refused(
        Format::Tops,
        &[
            ("", "test:1:1: expected the numbers of points (below 2^32) and simplices, but the file ends here"),
            ("3\n", "test:1:2: expected the numbers of points (below 2^32) and simplices, but the line ends here"),
            ("1 1 1\n", "test:1:5: expected the end of the line, found `1`"),
            (
                "2 0\n1 2\n1\n",
                "test:3:2: expected a coordinate of the point, as many as the first point has, but the line",
            ),
            ("2 0\n1 2\n1 2 3\n", "test:3:5: expected the end of the line, found `3`"),
            ("1 0\n1 nan\n", "test:2:3: the coordinate `nan` is not a finite number"),
            ("1 1\n1\n0\n", "test:3:1: a simplex of 0 vertices"),
            (
                "1 1\n1\n2 0\n",
                "test:3:4: expected as many vertices of the simplex as its first number says, but the line",
            ),
            ("1 1\n1\n1 1\n", "test:3:3: vertex 1 is out of range: there are 1 vertices, numbered from 0"),
            ("2 1\n1\n2\n2 1 1\n", "test:4:1: the simplex repeats vertex 1; --drop-degenerate"),
            ("1 0\n1\n1 0\n", "test:3:1: expected the end of the file after the last simplex, found `1`"),
        ],
    );
    assert_eq!(read_dropping(Format::Tops, "2 1\n1\n2\n2 1 1\n").1.degenerate_dropped, 1);
}

#[test]
fn tetrahedra_in_binary() {
    let points = [[0.0; 3], [1.0, 0.25, 0.0], [0.0, 1.0, -7.5], [0.0, 0.0, 1.0]];
    let (soup, _) = read_as(Format::Tetbin, tetbin(&points, &[[3, 1, 0, 2]])).unwrap();
    assert_eq!((soup.labels.len(), listed(&soup, 3)), (4, vec![vec![3, 1, 0, 2]]));
    assert_eq!(singles(&soup), points.as_flattened());

    let refusal = |bytes: &[u8]| message(Format::Tetbin, bytes);
    assert_eq!(refusal(b"TETA\0\0\0\0"), "test: byte 0: expected TETB, found `TETA`");
    let found = refusal(&tetbin(&points, &[[0, 1, 2, 4]]));
    assert_eq!(found, "test: byte 60: vertex 4 is out of range: there are 4 vertices, numbered from 0");
    let found = refusal(&tetbin(&points, &[[0, 1, 2, 3], [0, 1, 1, 3]]));
    assert!(found.starts_with("test: byte 76: the simplex repeats vertex 1"), "{found}");
    let found = refusal(&tetbin(&[[0.0, f32::NAN, 0.0]], &[]));
    assert_eq!(found, "test: byte 16: the coordinate NaN is not a finite number");
    let found = refusal(&[tetbin(&points, &[]), b"more".into()].concat());
    assert_eq!(found, "test: byte 60: expected the end of the file after the last tetrahedron, found `more`");
}
