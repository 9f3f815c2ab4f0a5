//! The readers of spaces: every format on small inputs, what they refuse and where, detection, hostile bytes.

use std::io::Write;
use std::path::Path;

use proptest::prelude::*;

use super::super::Compression;
use super::*;

fn read(bytes: &[u8], format: SpaceFormat) -> Result<Space, String> {
    let options = SpaceOptions { format: Some(format), ..SpaceOptions::default() };
    read_space_bytes(bytes, "in", &options).map(|(space, _)| space).map_err(|error| error.to_string())
}

fn points_of(text: &str) -> Points {
    match read(text.as_bytes(), SpaceFormat::Points) {
        Ok(Space::Points(points)) => points,
        other => panic!("{other:?}"),
    }
}

fn refusal(text: &str, format: SpaceFormat) -> String {
    read(text.as_bytes(), format).unwrap_err()
}

fn detected(bytes: &[u8], name: &str) -> SpaceFormat {
    read_space_bytes(bytes, name, &SpaceOptions::default()).unwrap().1.format
}

#[test]
fn tables_of_every_separator_are_the_same_points() {
    let points = Points::new(2, vec![1.0, -2.5, 3.0, 4e-3]).unwrap();
    let tables = [
        "1 -2.5\n3 4e-3\n",
        "1,-2.5\n3,0.004",
        "# a comment\n\n1;-2.5\r\n3;4e-3\r\n",
        "1\t-2.5\n 3\t4e-3 # and so on\n",
        "x,y\n1,-2.5,\n3,4e-3,\n",
        "\"x\",\"a name\"\n\"1\",\"-2.5\"\n\"3\",\"4e-3\"\n",
    ];
    for table in tables {
        assert_eq!(points_of(table), points, "{table:?}");
    }
    assert!(points_of("").is_empty() && points_of("x,y\n").is_empty());
}

#[test]
fn tables_are_refused_with_the_place() {
    let refused = [
        ("1 2\n3\n", "in:2:2: expected 2 coordinates, as in the rows above, but the line ends here"),
        ("1,2\n3,4,5\n", "in:2:5: expected the end of a row of 2 coordinates, as in the rows above, found `5`"),
        ("1,2\n3,nan\n", "in:2:3: the coordinate `nan` is not a finite number"),
        ("1,-inf\n", "in:1:3: the coordinate `-inf` is not a finite number"),
        ("1,2\n3,1e999\n", "in:2:3: the coordinate `1e999` is not a finite number"),
        ("1,2\n3,x\n", "in:2:3: expected a coordinate: a number, found `x`"),
        ("1,2\n3,,4\n", "in:2:3: expected a field between the separators, found `,`"),
        ("1,2\n,4\n", "in:2:1: expected a field before the separator, found `,`"),
    ];
    for (table, message) in refused {
        assert_eq!(refusal(table, SpaceFormat::Points), message, "{table:?}");
    }
}

/// An NPY file.
fn npy(version: u8, header: &str, data: &[u8]) -> Vec<u8> {
    let length = header.len() + 1;
    let mut file = [b"\x93NUMPY", &[version, 0][..]].concat();
    match version {
        1 => file.extend(u16::try_from(length).unwrap().to_le_bytes()),
        _ => file.extend(u32::try_from(length).unwrap().to_le_bytes()),
    }
    file.extend(header.as_bytes());
    file.push(b'\n');
    file.extend(data);
    file
}

fn array(descr: &str, fortran: &str, shape: &str) -> String {
    format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': {shape}, }}")
}

#[test]
fn arrays_of_every_type_and_order_are_the_same_points() {
    let rows = Space::Points(Points::new(3, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap());
    fn bytes<const N: usize>(to_bytes: impl Fn(u8) -> [u8; N]) -> Vec<u8> {
        (1..=6).flat_map(to_bytes).collect()
    }
    let arrays = [
        ("<f8", bytes(|x| f64::from(x).to_le_bytes())),
        (">f8", bytes(|x| f64::from(x).to_be_bytes())),
        ("<f4", bytes(|x| f32::from(x).to_le_bytes())),
        ("<i8", bytes(|x| i64::from(x).to_le_bytes())),
        (">i4", bytes(|x| i32::from(x).to_be_bytes())),
        ("<u2", bytes(|x| u16::from(x).to_le_bytes())),
        ("|u1", bytes(|x| [x])),
    ];
    for (version, (descr, data)) in [1, 2, 3].into_iter().flat_map(|v| arrays.iter().map(move |array| (v, array))) {
        assert_eq!(read(&npy(version, &array(descr, "False", "(2, 3)"), data), SpaceFormat::Npy).unwrap(), rows);
    }
    let columns = npy(1, &array("|u1", "True", "(2, 3)"), &[1, 4, 2, 5, 3, 6]);
    assert_eq!(read(&columns, SpaceFormat::Npy).unwrap(), rows);
    assert_eq!(detected(&columns, "x"), SpaceFormat::Npy);
}

#[test]
fn arrays_are_refused_with_the_byte() {
    let one = 1f64.to_le_bytes();
    let good = array("<f8", "False", "(1, 2)");
    let start = 10 + good.len() + 1;
    let truncated = npy(1, &good, &one);
    let expected = format!(
        "in: byte {}: expected as many elements as the header says, but the file ends here; it seems truncated",
        start + 8
    );
    assert_eq!(read(&truncated, SpaceFormat::Npy).unwrap_err(), expected);
    let nan = npy(1, &good, &[one, f64::NAN.to_le_bytes()].concat());
    let expected = format!("in: byte {}: the coordinate NaN is not a finite number", start + 8);
    assert_eq!(read(&nan, SpaceFormat::Npy).unwrap_err(), expected);
    assert!(read(&npy(1, &good, &[0; 17]), SpaceFormat::Npy).unwrap_err().contains("expected the end of the file"));
    let huge = "(18446744073709551615, 18446744073709551615)";
    for (header, message) in [
        (array("<f8", "False", "(2,)"), "an array of shape [2]; points are the rows of a two-dimensional one"),
        (array("<c16", "False", "(1, 1)"), "an array of type '<c16'"),
        (array("<f8", "False", huge), "more elements than 64 bits can count"),
        ("nothing".to_owned(), "not the header of an NPY file"),
        ("{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (1,2)}".to_owned(), "an array of records;"),
        // Parsed, this would take longer than anybody lives.
        (format!("{{'descr': {}", "{".repeat(60)), "an array of records, or no array"),
        (array("<f8", "False", &"(".repeat(9000)), "an array of records, or no array"),
    ] {
        let refused = read(&npy(1, &header, &one), SpaceFormat::Npy).unwrap_err();
        assert!(refused.contains(message), "{refused}");
    }
    // What the header promises costs nothing.
    let lying = npy(1, &array("<f8", "False", "(1000000000, 1000)"), &one);
    assert!(read(&lying, SpaceFormat::Npy).unwrap_err().contains("truncated"));
}

#[test]
fn points_in_binary_and_vertices_of_meshes() {
    let mut file = b"PTS1\x02\0\0\0\x01\0\0\0\0\0\0\0".to_vec();
    file.extend([1.5f64, -2.0].into_iter().flat_map(f64::to_le_bytes));
    assert_eq!(read(&file, SpaceFormat::Pts), Ok(Space::Points(Points::new(2, vec![1.5, -2.0]).unwrap())));
    assert_eq!(detected(&file, "x.csv"), SpaceFormat::Pts);
    file.pop();
    assert!(read(&file, SpaceFormat::Pts).unwrap_err().starts_with("in: byte 31: expected as many coordinates"));
    let off = b"nOFF 4\n2 0 0\n1 2 3 4\n5 6 7 8\n";
    let points = Points::new(4, (1..=8).map(f64::from).collect()).unwrap();
    assert_eq!(read(off, SpaceFormat::Mesh), Ok(Space::Points(points)));
    assert_eq!(detected(off, "x"), SpaceFormat::Mesh);
    assert_eq!(detected(b"v 1 2 3\nv 4 5 6\n", "x.obj"), SpaceFormat::Mesh);
    assert!(refusal("1 2 3\n", SpaceFormat::Mesh).contains("no coordinates"));
}

/// Of four points.
fn matrix() -> Space {
    Space::Distances(Distances::new(4, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]).unwrap())
}

#[test]
fn a_matrix_is_the_same_in_every_form() {
    let full = "0 1 2 4\n1 0 3 5\n2 3 0 6\n4 5 6 0\n";
    let lower = ["\n1\n2,3\n4,5,6\n", "1\n2 3\n4 5 6", "0\n1,0\n2,3,0\n4,5,6,0\n", "1,\n2,3,\n4,5,6,\n"];
    let upper = ["1,2,4\n3,5\n6\n", "0 1 2 4\n0 3 5\n0 6\n0\n"];
    let forms = [(SpaceFormat::Full, full)]
        .into_iter()
        .chain(lower.map(|text| (SpaceFormat::Lower, text)))
        .chain(upper.map(|text| (SpaceFormat::Upper, text)));
    for (format, text) in forms {
        assert_eq!(read(text.as_bytes(), format), Ok(matrix()), "{text:?}");
        assert_eq!(detected(text.as_bytes(), "x.txt"), format, "{text:?}");
    }
    let floats: Vec<u8> = (1..=6u8).flat_map(|x| f32::from(x).to_le_bytes()).collect();
    assert_eq!(read(&floats, SpaceFormat::LowerBinary), Ok(matrix()));
    let entries = full.split_whitespace().map(|entry| entry.parse::<f64>().unwrap().to_bits());
    let dipha: Vec<u8> = [8_067_171_840, 7, 4].into_iter().chain(entries).flat_map(u64::to_le_bytes).collect();
    assert_eq!(read(&dipha, SpaceFormat::Dipha), Ok(matrix()));
    assert_eq!(detected(&dipha, "x"), SpaceFormat::Dipha);
}

#[test]
fn matrices_of_no_and_of_one_point() {
    let of = |len| Ok(Space::Distances(Distances::new(len, Vec::new()).unwrap()));
    for format in [SpaceFormat::Full, SpaceFormat::Lower, SpaceFormat::Upper] {
        assert_eq!(read(b"", format), of(0));
        assert_eq!(read(b"0\n", format), of(1));
    }
    assert_eq!(read(b"\n", SpaceFormat::Lower), of(1));
    // Two points at one place: the empty first row says that there is no diagonal.
    let two = Distances::new(2, vec![0.0]).unwrap();
    assert_eq!(read(b"\n0\n", SpaceFormat::Lower), Ok(Space::Distances(two)));
}

#[test]
fn what_is_no_distance_matrix_is_refused_with_the_place() {
    use SpaceFormat::{Full, Lower, Upper};
    let a_distance = "expected a distance: a finite number, not negative, found";
    let refused = [
        (
            Full,
            "0 1\n2 0\n",
            "in:2:1: expected 1, the entry of row 1 and column 2, for distances are symmetric, found `2`",
        ),
        (Full, "0 1\n1 3\n", "in:2:3: expected 0, the distance of a point and itself, found `3`"),
        (Full, "0 -1\n-1 0\n", &format!("in:1:3: {a_distance} `-1`")),
        (Full, "0 1\n1 0 5\n", "in:2:5: expected the end of a row of 2 distances, found `5`"),
        (Full, "0 1\n1\n", "in:2:2: expected 2 distances, as in the first row, but the line ends here"),
        (Full, "0 1\n", "in:2:1: expected 2 rows, as many as columns, but the file ends here; it seems truncated"),
        (Full, "0 1\n1 0\n0 0\n", "in:3:1: expected the end of the file after as many rows as columns, found `0`"),
        (Lower, "1\n2,inf\n", &format!("in:2:3: {a_distance} `inf`")),
        (Lower, "1\n2,nan\n", &format!("in:2:3: {a_distance} `nan`")),
        (Lower, "1\n2,3,4\n", "in:2:5: expected the end of a row of 2 distances, found `4`"),
        (Lower, "1\n2\n", "in:2:2: expected 2 distances in this row of the triangle, but the line ends here"),
        (Upper, "1,2\n3,4\n", "in:2:3: expected the end of a row of 1 distances, found `4`"),
        (
            Upper,
            "1,2,3\n4,5\n",
            "in:3:1: expected rows down to a single distance, but the file ends here; it seems truncated",
        ),
    ];
    for (format, text, message) in refused {
        assert_eq!(refusal(text, format), message, "{text:?}");
    }
    let four = [1f32; 4].map(f32::to_le_bytes).concat();
    assert!(read(&four, SpaceFormat::LowerBinary).unwrap_err().contains("as points have pairs"));
}

#[test]
fn some_distances_are_a_graph() {
    let edges = [(0, 1), (1, 3)];
    let graph = Graph::from_edges(4, &edges, Some(&[0.5, 2.0])).unwrap();
    let expected = Ok(Space::Graph { graph, labels: Labels::Numbered(4) });
    assert_eq!(read(b"0 1 0.5\n# none of 2\n3,1,2\n1 3 2.0\n2 2 0\n", SpaceFormat::Sparse), expected);
    let columns = [1, 0, 3, 1].into_iter();
    let distances = [0.5f64, 0.5, 2.0, 2.0].map(f64::to_bits);
    let numbers = [8_067_171_840, 8, 4, 1, 2, 0, 1].into_iter().chain(columns).chain(distances);
    assert_eq!(read(&numbers.flat_map(u64::to_le_bytes).collect::<Vec<_>>(), SpaceFormat::Dipha), expected);
    let refused = [
        (
            "0 1 0.5\n1 0 0.6\n",
            "in:2:5: expected 0.5, the weight of this edge where it was given before, in either direction, found `0.6`",
        ),
        ("0 1 -1\n", "in:1:5: expected a distance: a finite number, not negative, found `-1`"),
        ("1 1 2\n", "in:1:5: expected 0, the distance of a point and itself, found `2`"),
        ("0 x 1\n", "in:1:3: expected the number of a point, from 0 and below 4294967294, found `x`"),
        ("0 1\n", "in:1:4: expected a distance: a finite number, not negative, but the line ends here"),
        ("0 1 2 3\n", "in:1:7: expected the end of the line, found `3`"),
    ];
    for (text, message) in refused {
        assert_eq!(refusal(text, SpaceFormat::Sparse), message, "{text:?}");
    }
    assert!(refusal("0 4000000000 1\n", SpaceFormat::Sparse).starts_with("in:1:3: 4000000001 points"));
}

#[test]
fn edges_keep_the_labels_of_their_vertices_in_order() {
    let graph =
        |count, edges: &[(u32, u32)], weights: Option<&[f64]>| Graph::from_edges(count, edges, weights).unwrap();
    let cases: [(&str, Space); 3] = [
        (
            "b a 0.5\nc,b,1\nlonely\n",
            Space::Graph {
                graph: graph(4, &[(0, 1), (1, 2)], Some(&[0.5, 1.0])),
                labels: Labels::Tokens(["a", "b", "c", "lonely"].map(Into::into).to_vec()),
            },
        ),
        (
            "100 7\n7 100\n9 7\n",
            Space::Graph { graph: graph(3, &[(0, 2), (0, 1)], None), labels: Labels::Integers(vec![7, 9, 100]) },
        ),
        ("2 1\n0 1\n", Space::Graph { graph: graph(3, &[(1, 2), (0, 1)], None), labels: Labels::Numbered(3) }),
    ];
    for (text, space) in cases {
        assert_eq!(read(text.as_bytes(), SpaceFormat::Edges), Ok(space), "{text:?}");
    }
    let refused = [
        ("a b 1\nb c\n", "in:2:4: expected the weight of the edge, as other edges have one, but the line ends here"),
        ("a b\nb c 1\n", "in:2:5: expected no weight, as other edges have none, found `1`"),
        ("a a\n", "in:1:3: expected another vertex: an edge must not join a vertex to itself, found `a`"),
        ("a b nan\n", "in:1:5: expected a distance: a finite number, not negative, found `nan`"),
        (
            "a b 1\nb a 2\n",
            "in:2:1: expected 1, the weight of this edge where it was given before, in either direction, found `2`",
        ),
    ];
    for (text, message) in refused {
        assert_eq!(refusal(text, SpaceFormat::Edges), message, "{text:?}");
    }
}

#[test]
fn the_format_is_found_by_content_then_by_name_then_by_shape() {
    let cases: [(&[u8], &str, SpaceFormat); 11] = [
        (b"0 1 0.5\n1 2 0.5\n", "x.txt", SpaceFormat::Points),
        (b"0 1 2\n1 0 3\n2 3 0\n", "x.txt", SpaceFormat::Full),
        (b"0 1 2\n1 0 3\n2 3 1\n", "x.txt", SpaceFormat::Points),
        (b"0 1 0.5\n1 2 0.5\n", "x.sparse", SpaceFormat::Sparse),
        (b"0 1 0.5\n1 2 0.5\n", "dir.npy/x.edges.gz", SpaceFormat::Edges),
        (b"a b 0.5\nb c 0.5\n", "x", SpaceFormat::Edges),
        (b"x y z\n1 2 3\n", "x.txt", SpaceFormat::Points),
        (b"1\n2 3\n", "a.lower_distance_matrix.csv", SpaceFormat::Lower),
        (b"0 1\n1 0\n", "x.csv", SpaceFormat::Points),
        (b"0 1\n1 0\n", "x.distance_matrix", SpaceFormat::Full),
        (b"OFF\n1 0 0\n1 2 3\n", "x.sparse", SpaceFormat::Mesh),
    ];
    for (bytes, name, format) in cases {
        assert_eq!(detected(bytes, name), format, "{name}");
    }
    let unknown = read_space_bytes(b"one two three four\n", "x", &SpaceOptions::default()).unwrap_err();
    assert!(unknown.to_string().contains("name it (--format), one of: points, mesh, npy"), "{unknown}");
}

/// A slip does not make an input one of no format, or of another: the place is told.
#[test]
fn a_slip_is_told_with_its_place_by_shape_too() {
    let refused = |text: &str, is_graph| {
        let options = SpaceOptions { is_graph, ..SpaceOptions::default() };
        read_space_bytes(text.as_bytes(), "in.txt", &options).unwrap_err().to_string()
    };
    let coordinate = "expected a coordinate: a number";
    for (text, is_graph, message) in [
        ("0,1,2\n1,2,zz\n3,4,5\n", false, format!("in.txt:2:5: {coordinate}, found `zz`")),
        ("x,y,z\n0,1,2\n1,zz,2\n", false, format!("in.txt:3:3: {coordinate}, found `zz`")),
        ("0.5 1\n1.5 zz\n", false, format!("in.txt:2:5: {coordinate}, found `zz`")),
        (
            "0 1 0.5\n1 2 zz\n",
            true,
            "in.txt:2:5: expected a distance: a finite number, not negative, found `zz`".into(),
        ),
        (
            "0 1 2\n1 0 3\n2 4 0\n",
            false,
            "in.txt:3:3: expected 3, the entry of row 2 and column 3, for distances are symmetric, found `4`".into(),
        ),
    ] {
        assert_eq!(refused(text, is_graph), message, "{text}");
    }
}

#[test]
fn compressed_input_is_read_as_it_is() {
    let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    encoder.write_all(b"1,2\n3,4\n").unwrap();
    let (space, report) = read_space_bytes(&encoder.finish().unwrap(), "x.csv.gz", &SpaceOptions::default()).unwrap();
    assert_eq!(space, Space::Points(points_of("1,2\n3,4\n")));
    assert_eq!(report.compression, Some(Compression::Gzip));
}

#[test]
fn real_files_have_the_points_that_they_should() {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data");
    let len = |name: &str| match read_space_path(data.join(name), &SpaceOptions::default()).unwrap().0 {
        Space::Points(points) => points.len(),
        Space::Distances(distances) => distances.len(),
        Space::Graph { graph, .. } => graph.num_vertices(),
    };
    assert_eq!(len("projective_plane.lower_distance_matrix"), 13);
    assert_eq!(len("random16.lower_distance_matrix"), 16);
    assert_eq!(len("sphere_3_192.lower_distance_matrix"), 192);
    assert_eq!(len("tore3D_1307.off"), 1307);
    let error = read_points_path(data.join("random16.lower_distance_matrix"), &SpaceOptions::default()).unwrap_err();
    assert!(error.to_string().contains("this was read as `lower`, but points are needed"), "{error}");
}

proptest! {
    /// Whatever the bytes: an answer, and no panic.
    #[test]
    fn any_bytes_are_read_or_refused(
        bytes in proptest::collection::vec(any::<u8>(), 0..200),
        text in "[0-9 ,;.eE+\\-\"a#\r\n]{0,120}",
        cut in 0usize..200
    ) {
        let headers: [&[u8]; 6] = [b"", b"PTS1", b"\x93NUMPY\x01\0v\0", b"\x93NUMPY\x02\0", b"\0\xf2\xd7\xe0\x01\0\0\0\x07\0\0\0\0\0\0\0",
            b"\0\xf2\xd7\xe0\x01\0\0\0\x08\0\0\0\0\0\0\0\x02\0\0\0\0\0\0\0"];
        let array = npy(1, &array("<f8", "False", "(3, 2)"), &[0; 48]);
        for format in SpaceFormat::ALL {
            for header in headers {
                let _ = read(&[header, &bytes].concat(), *format);
            }
            let _ = read(text.as_bytes(), *format);
            let _ = read(&array[..cut.min(array.len())], *format);
        }
        let _ = read_space_bytes(text.as_bytes(), "x", &SpaceOptions::default());
        let _ = read_space_bytes(&bytes, "x", &SpaceOptions::default());
    }
}

#[test]
fn the_graph_of_a_complex_in_the_text_of_gudhi() {
    let text = "0 4 0\n0 2 0.25\n1 2 4 0.5\n0 9 1\n1 4 9 1\n1 2 9 2\n2 2 4 9 3\n1 4 2 0.75\n";
    assert_eq!(detected(text.as_bytes(), "x.txt"), SpaceFormat::Gudhi);
    let graph = Graph::from_edges(3, &[(0, 1), (1, 2), (0, 2)], Some(&[0.5, 1.0, 2.0])).unwrap();
    let graph = graph.with_vertex_weights(vec![0.25, 0.0, 1.0]).unwrap();
    let expected = Space::Graph { graph, labels: Labels::Integers(vec![2, 4, 9]) };
    assert_eq!(read(text.as_bytes(), SpaceFormat::Gudhi), Ok(expected));
    let refused = [
        ("0 1 0\n1 1 2 0\n", "in:2:1: the vertex 2 of this edge is not in the input"),
        ("0 1 0\n1 1 2 1\n0 2 3\n", "in:2:1: the value 1 is below 3, that of a vertex of this edge"),
        ("0 1 0\n1 1 2\n", "in:2:6: expected the filtration value, but the line ends here"),
    ];
    for (text, message) in refused {
        assert_eq!(refusal(text, SpaceFormat::Gudhi), message);
    }
}

#[test]
fn rows_that_could_be_points_are_a_graph_if_one_is_expected() {
    let of_graph = |text: &str| {
        let options = SpaceOptions { is_graph: true, ..SpaceOptions::default() };
        read_space_bytes(text.as_bytes(), "x.txt", &options).unwrap().1.format
    };
    let cases = [("0 0 0\n0 1 0\n0 2 0\n", SpaceFormat::Gudhi), ("0 1\n1 2\n", SpaceFormat::Edges)];
    for (text, format) in cases {
        assert_eq!((of_graph(text), detected(text.as_bytes(), "x.txt")), (format, SpaceFormat::Points), "{text}");
    }
    assert_eq!(of_graph("1 2 0.5\n2 3 0.25\n"), SpaceFormat::Edges);
}

const DOT: &str = "/* c */ strict graph g {
  node [shape=box]; rankdir = LR
  a -- b -- \"c d\" [weight=2.5, color=red]  # c
  subgraph s { b:p:n -- 7 [weight=0.5]; e } // c
  a -- 7
}
";

#[test]
fn graphs_in_dot() {
    for name in ["-", "x.txt", "x.gv"] {
        let (space, report) = read_space_bytes(DOT.as_bytes(), name, &SpaceOptions::default()).unwrap();
        assert_eq!(report.format, SpaceFormat::Dot, "{name}");
        let Space::Graph { graph, labels } = space else { panic!("a graph") };
        assert_eq!(labels, Labels::Tokens(["7", "a", "b", "c d", "e"].map(Into::into).into()));
        let edges: Vec<_> = (0..5)
            .flat_map(|v| graph.upper_neighbours(v).iter().zip(graph.edges_of(v)).map(move |(&w, e)| (v, w, e)))
            .map(|(v, w, e)| (v, w, graph.weight(e)))
            .collect();
        assert_eq!(edges, [(0, 1, 1.0), (0, 2, 0.5), (1, 2, 2.5), (2, 3, 2.5)]);
    }
    let refusal = |text: &str| {
        let options = SpaceOptions { format: Some(SpaceFormat::Dot), ..SpaceOptions::default() };
        read_space_bytes(text.as_bytes(), "test", &options).unwrap_err().to_string()
    };
    assert!(refusal("graph {\n a -- a\n}").starts_with("test:2:7: this edge joins a vertex to itself"));
    assert!(refusal("graph {\n a -- {b c}\n}").starts_with("test:2:7: expected a node; edges to and from"));
    assert!(refusal("graph {\n a -- b [weight=-1]\n}").starts_with("test:2:17: expected a distance"));
    assert!(refusal("graph {\n a -- b").starts_with("test:2:8: expected a node, an edge, or `}`"));
    assert!(refusal("tree {}").starts_with("test:1:1: expected graph or digraph, found `tree`"));
}

const GRAPHML: &str = "<?xml version='1.0'?>
<graphml xmlns='x'><key id='d0' for='edge' attr.name='weight' attr.type='double'/>
<graph edgedefault='undirected'>
<node id='n&amp;1'/><node id='n2'><data key='d9'>7</data></node><node id='n3'/>
<edge source='n&amp;1' target='n2'><data key='d0'>1.5</data></edge>
<edge source='n3' target='n2'/>
</graph></graphml>
";

#[test]
fn graphs_in_graphml() {
    let (space, report) = read_space_bytes(GRAPHML.as_bytes(), "-", &SpaceOptions::default()).unwrap();
    assert_eq!(report.format, SpaceFormat::GraphMl);
    let Space::Graph { graph, labels } = space else { panic!("a graph") };
    assert_eq!(labels, Labels::Tokens(["n&1", "n2", "n3"].map(Into::into).into()));
    assert_eq!((graph.upper_neighbours(0), graph.upper_neighbours(1)), (&[1][..], &[2][..]));
    assert_eq!((graph.weight(0), graph.weight(1)), (1.5, 1.0));
    let unweighted = GRAPHML.replace("'weight'", "'length'");
    let (space, _) = read_space_bytes(unweighted.as_bytes(), "-", &SpaceOptions::default()).unwrap();
    assert!(matches!(space, Space::Graph { graph, .. } if !graph.is_weighted()));
    let wrong = GRAPHML.replace("1.5", "-1.5");
    let error = read_space_bytes(wrong.as_bytes(), "test", &SpaceOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("test:5:51: expected a distance"), "{error}");
}
