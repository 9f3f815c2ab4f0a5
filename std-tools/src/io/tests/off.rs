use super::super::Format;
use super::{doubles, listed, read_as, read_dropping, refused};
use crate::soup::Labels;

const SQUARE: &str = "OFF\n4 2 5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

#[test]
fn a_square() {
    let (soup, report) = read_as(Format::Off, SQUARE).unwrap();
    assert_eq!(soup.labels, Labels::Numbered(4));
    assert!(soup.declared);
    assert_eq!(listed(&soup, 2), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(doubles(&soup), [0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.]);
    assert_eq!(report.simplices, [0, 0, 2]);
    assert_eq!((report.vertices, report.polygons), (4, 0));
}

#[test]
fn faces_of_every_size_with_colours_and_comments() {
    let text = "OFF # kind\n#a comment\n\n 5 4 # no edges\n0 0 0\n1 0 0 #x\n1 1 0\n0 1 0\n2 2 2\r\n\
                1 4 0.5 0.5 0.5\n2 0 3\n3 0 1 2 7\n# before the last\n4 3 2 1 0 255 0 0 255\n\n# end\n";
    let (soup, report) = read_as(Format::Off, text).unwrap();
    assert_eq!(listed(&soup, 0), [[4]]);
    assert_eq!(listed(&soup, 1), [[0, 3]]);
    // The last is coned from vertex 0, in its own direction.
    assert_eq!(listed(&soup, 2), [[0, 1, 2], [0, 3, 2], [0, 2, 1]]);
    assert_eq!((report.polygons, report.split_into), (1, 2));
}

#[test]
fn keywords_and_what_they_add_to_a_vertex() {
    for (text, dim, values) in [
        ("OFF 1 0 0\n1 2 3\n", 3, &[1., 2., 3.][..]),
        ("1 0 0\n1 2 3\n", 3, &[1., 2., 3.]),
        ("OFF 1 0 0\n1 2 3 255 0 0\n", 3, &[1., 2., 3.]),
        ("COFF\n1 0 0\n1 2 3 255 0 0 255\n", 3, &[1., 2., 3.]),
        ("NOFF\n1 0 0\n1 2 3 0 0 1\n", 3, &[1., 2., 3.]),
        ("STCNOFF\n1 0 0\n1 2 3 0 0 1 1 1 1 1 .5 .5\n", 3, &[1., 2., 3.]),
        ("4OFF\n1 0 0\n2 4 6 2\n", 3, &[1., 2., 3.]),
        ("nOFF 5 1 0 0\n1 2 3 4 5\n", 5, &[1., 2., 3., 4., 5.]),
        ("nOFF\n2\n1 0\n1 -2e3\n", 2, &[1., -2000.]),
        ("nOFF 1\n1 0 0\n7\n", 1, &[7.]),
    ] {
        let (soup, _) = read_as(Format::Off, text).unwrap();
        assert_eq!(soup.coordinates.as_ref().unwrap().dim, dim, "{text}");
        assert_eq!(doubles(&soup), values, "{text}");
    }
}

#[test]
fn errors_and_their_places() {
    refused(
        Format::Off,
        &[
            ("", "test:1:1: expected the keyword OFF, but the file ends here"),
            ("\n# only\n", "test:1:1: expected the keyword OFF, but the file ends here"),
            ("POFF\n", "test:1:1: expected the keyword OFF, found `POFF`"),
            ("OFF BINARY\n", "test:1:5: binary OFF is not read"),
            ("OFF\n", "test:2:1: expected the numbers of vertices"),
            ("OFF\n3\n", "test:2:2: expected the numbers of vertices"),
            ("OFF\n3 x\n", "test:2:3: expected the numbers of vertices (below 2^32), faces and edges, found `x`"),
            ("OFF\n4294967296 1\n", "test:2:1: expected the numbers of vertices (below 2^32)"),
            ("OFF\n-1 1\n", "test:2:1: expected the numbers of vertices"),
            ("OFF\n1 0 0 0\n0 0 0\n", "test:2:7: expected the end of the line, found `0`"),
            ("nOFF 0 1 1\n", "test:1:6: expected the dimension of the points"),
            ("OFF 1 0 0\n0 0\n", "test:2:4: expected a coordinate of the vertex, but the line ends here"),
            ("OFF 1 0 0\n0 0 zero\n", "test:2:5: expected a coordinate of the vertex, found `zero`"),
            ("OFF 1 0 0\n0 0 nan\n", "test:2:5: the coordinate `nan` is not a finite number"),
            ("OFF 1 0 0\n0 -inf 0\n", "test:2:3: the coordinate `-inf` is not a finite number"),
            ("OFF 1 0 0\n1e999 0 0\n", "test:2:1: the coordinate `1e999` is not a finite number"),
            ("OFF 1 0 0\n0 0 0 5\n", "test:2:7: expected the end of the line, found `5`"),
            ("OFF 1 0 0\n0 0 0 1 2\n", "test:2:7: expected the end of the line, found `1`"),
            ("COFF 1 0 0\n0 0 0 red\n", "test:2:7: expected a number (a colour or a normal), found `red`"),
            ("4OFF 1 0 0\n1 1 1 0\n", "test:2:6: a vertex at infinity"),
            ("OFF 2 0 0\n0 0 0\n", "test:3:1: expected as many vertices as the header says, but the file ends here"),
            ("OFF 2 0 0\n0 0 0", "test:2:6: expected as many vertices as the header says, but the file ends here"),
            ("OFF 1 1 0\n0 0 0\n", "test:3:1: expected as many faces as the header says, but the file ends here"),
            ("OFF 1 1 0\n0 0 0\n0\n", "test:3:1: expected a face of at least one vertex, found `0`"),
            ("OFF 1 1 0\n0 0 0\n-3 0\n", "test:3:1: expected the number of vertices of the face, found `-3`"),
            ("OFF 1 1 0\n0 0 0\n 2 0 \n", "test:3:5: expected as many vertices of the face as its first number says"),
            ("OFF 1 1 0\n0 0 0\n2 0 1.5\n", "test:3:5: expected the number of a vertex, found `1.5`"),
            (
                "OFF 2 1 0\n0 0 0\n1 1 1\n2 0 2\n",
                "test:4:5: vertex 2 is out of range: there are 2 vertices, numbered from 0",
            ),
            ("OFF 1 1 0\n0 0 0\n1 -1\n", "test:3:3: vertex -1 is out of range: there are 1 vertices"),
            ("OFF 2 1 0\n0 0 0\n1 1 1\n 3 0 1 0\n", "test:4:2: the simplex repeats vertex 0; --drop-degenerate"),
            ("OFF 2 1 0\n0 0 0\n1 1 1\n4 0 1 0 1\n", "test:4:1: the polygon repeats vertex 0; --drop-degenerate"),
            ("OFF 1 0 0\n0 0 0\n# fine\n 7\n", "test:4:2: expected the end of the file after the last face, found `7`"),
        ],
    );
}

#[test]
fn degenerate_faces_are_dropped_and_counted() {
    let text = "OFF\n4 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 0\n5 0 1 1 2 3\n2 2 2\n";
    let (soup, report) = read_dropping(Format::Off, text);
    assert_eq!(listed(&soup, 2), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(report.degenerate_dropped, 3);
    assert_eq!((report.polygons, report.split_into), (1, 2));
}

#[test]
fn a_polygon_of_many_vertices_is_coned_from_the_least() {
    let n = 1000;
    let mut text = format!("OFF\n{n} 1 0\n");
    for _ in 0..n {
        text.push_str("0 0 0\n");
    }
    text.push_str(&n.to_string());
    for vertex in (0..n).map(|at| (at + 600) % n) {
        text.push_str(&format!(" {vertex}"));
    }
    let (soup, report) = read_as(Format::Off, text).unwrap();
    assert_eq!(listed(&soup, 2), (1..n - 1).map(|at| vec![0, at, at + 1]).collect::<Vec<_>>());
    assert_eq!(report.split_into, n as usize - 2);
}
