use super::super::Format;
use super::{doubles, listed, read_as, read_dropping, refused};
use crate::soup::Labels;

#[test]
fn faces_lines_points_and_all_spellings_of_a_reference() {
    let text = "# a comment\nmtllib a.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 .1 .2 .3\nv 0 1 0\nvt 0 0\nvn 0 0 1\n\
                g side\nusemtl red\ns off\nf 1 2 3\nf 1/1 2/1 4/1\nf 1//1 3//1 4//1\nf 1/1/1 2/1/1 3/1/1 4/1/1\n\
                l 1 2 3/1\np 4 -1\nf -4/-1/-1 -3 -2 # relative\nf 1 2 \\\n  4\n";
    let (soup, report) = read_as(Format::Obj, text).unwrap();
    assert_eq!(soup.labels, Labels::Integers(vec![1, 2, 3, 4]));
    assert_eq!(listed(&soup, 0), [[3], [3]]);
    assert_eq!(listed(&soup, 1), [[0, 1], [1, 2]]);
    let triangles = [[0, 1, 2], [0, 1, 3], [0, 2, 3], [0, 1, 2], [0, 2, 3], [0, 1, 2], [0, 1, 3]];
    assert_eq!(listed(&soup, 2), triangles);
    assert_eq!(doubles(&soup)[3..9], [1., 0., 0., 1., 1., 0.]);
    assert_eq!((report.polygons, report.ignored.count), (1, 0));
}

#[test]
fn unknown_keywords_are_counted_and_named_once() {
    let (_, report) = read_as(Format::Obj, "v 0 0 0\nfoo 1\nfoo 2\n bar\nv 1 1 1\n").unwrap();
    assert_eq!(report.ignored.count, 3);
    assert_eq!(report.ignored.names, ["foo", "bar"]);
}

#[test]
fn a_face_may_come_before_its_vertices() {
    let (soup, _) = read_as(Format::Obj, "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 1 1 0\n").unwrap();
    assert_eq!(listed(&soup, 2), [[0, 1, 2]]);
}

#[test]
fn errors_and_their_places() {
    refused(
        Format::Obj,
        &[
            ("v 0 0\n", "test:1:6: expected a coordinate of the vertex, but the line ends here"),
            ("v 0 0 a\n", "test:1:7: expected a coordinate of the vertex, found `a`"),
            ("v 0 0 inf\n", "test:1:7: the coordinate `inf` is not a finite number"),
            ("v 0 0 0 1 1 1 1 9\n", "test:1:17: expected the end of the line, found `9`"),
            ("v 0 0 0\nf 1 1/ x\n", "test:2:8: expected a vertex number, as in 7, 7/8, 7//9 or 7/8/9, found `x`"),
            ("v 0 0 0\nf 1/a 1 1\n", "test:2:3: expected a vertex number, as in 7, 7/8, 7//9 or 7/8/9, found `1/a`"),
            ("v 0 0 0\nf 1 1\n", "test:2:6: expected at least three vertices of the face, but the line ends here"),
            ("v 0 0 0\nl 1\n", "test:2:4: expected at least two vertices of the line, but the line ends here"),
            ("v 0 0 0\np\n", "test:2:2: expected at least one point, but the line ends here"),
            ("v 0 0 0\np 0\n", "test:2:3: vertex 0 is out of range: there are 1 vertices, numbered from 1"),
            ("v 0 0 0\np -2\n", "test:2:3: vertex -2 is out of range: there are 1 vertices, numbered from 1"),
            ("v 0 0 0\nv 0 0 0\nf 1 2 3\n", "test:3:7: vertex 3 is out of range: there are 2 vertices"),
            ("v 0 0 0\np 9 \\\n 10 1\nf 3 4 5\n", "test:3:2: vertex 10 is out of range: there are 1 vertices"),
            ("p 4294967297\n", "test:1:3: vertex 4294967297 is out of range"),
            ("p 99999999999999999999\n", "test:1:3: expected a vertex number"),
            ("v 0 0 0\nv 0 0 0\n f 1 2 -1\n", "test:3:2: the simplex repeats vertex 2; --drop-degenerate"),
            ("v 0 0 0\nv 0 0 0\nl 1 2 2\n", "test:3:1: the simplex repeats vertex 2; --drop-degenerate"),
            ("v 0 0 0\nv 0 0 0\nf 1 2 1 2\n", "test:3:1: the polygon repeats vertex 1; --drop-degenerate"),
            ("v 0 0 0\nf 1 \\\n\\\n  1 5x\n", "test:4:5: expected a vertex number"),
        ],
    );
}

#[test]
fn degenerate_pieces_are_dropped_and_counted() {
    let text = "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 2\nl 1 2 2 3\nf 1 2 3 2\n";
    let (soup, report) = read_dropping(Format::Obj, text);
    assert_eq!(listed(&soup, 1), [[0, 1], [1, 2]]);
    assert_eq!(listed(&soup, 2), [[0, 1, 2], [0, 2, 1]]);
    assert_eq!(report.degenerate_dropped, 2);
}
