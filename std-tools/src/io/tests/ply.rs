use super::super::Format;
use super::{doubles, listed, message, read_as, read_dropping, refused, singles};
use crate::attribute::Values;
use crate::soup::Labels;

pub(super) const TEXT: &str = "ply\nformat ascii 1.0\ncomment a square\nobj_info none\nelement vertex 4\nproperty float x\n\
    property float y\nproperty float z\nproperty uchar red\nelement face 2\nproperty list uchar int vertex_indices\n\
    property list uchar float texcoord\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nelement camera 1\n\
    property float view\nend_header\n0 0 0 255\n1 0 0 0\n1 1 0.1 0\n0 1 0 0\n4 0 1 2 3 2 0.5 0.5\n2 3 1 0\n3 0\nnan\n";

/// The file of `TEXT` in binary.
pub(super) fn binary(big_endian: bool) -> Vec<u8> {
    let order = if big_endian { "binary_big_endian" } else { "binary_little_endian" };
    let end = TEXT.find("end_header\n").unwrap() + "end_header\n".len();
    let mut bytes = TEXT[..end].replace("ascii", order).into_bytes();
    let float = |value: f32| if big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
    let int = |value: i32| if big_endian { value.to_be_bytes() } else { value.to_le_bytes() };
    for (point, red) in [([0., 0., 0.], 255), ([1., 0., 0.], 0), ([1., 1., 0.1], 0), ([0., 1., 0.], 0)] {
        bytes.extend(point.into_iter().flat_map(float));
        bytes.push(red);
    }
    for (face, texture) in [(&[0, 1, 2, 3][..], &[0.5, 0.5][..]), (&[3, 1], &[])] {
        bytes.push(u8::try_from(face.len()).unwrap());
        bytes.extend(face.iter().copied().flat_map(int));
        bytes.push(u8::try_from(texture.len()).unwrap());
        bytes.extend(texture.iter().copied().flat_map(float));
    }
    bytes.extend([3, 0].into_iter().flat_map(int));
    bytes.extend(float(f32::NAN));
    bytes
}

#[test]
fn text_and_both_byte_orders_give_the_same_soup() {
    let text = read_as(Format::Ply, TEXT).unwrap();
    assert_eq!(read_as(Format::Ply, binary(false)).unwrap(), text);
    assert_eq!(read_as(Format::Ply, binary(true)).unwrap(), text);
    let (soup, report) = text;
    assert_eq!(soup.labels, Labels::Numbered(4));
    assert_eq!(singles(&soup), [0., 0., 0., 1., 0., 0., 1., 1., 0.1, 0., 1., 0.]);
    assert_eq!(listed(&soup, 1), [[3, 1], [3, 0]]);
    assert_eq!(listed(&soup, 2), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(report.ignored.names, ["face texcoord", "camera"]);
    assert_eq!(soup.attributes[0].values, Values::U8(vec![255, 0, 0, 0]));
    assert_eq!((report.polygons, report.split_into), (1, 2));
}

/// A header in text, of the given elements.
fn header(elements: &str) -> String {
    format!("ply\nformat ascii 1.0\n{elements}\nend_header\n")
}

const POINT: &str = "property float x\nproperty float y\nproperty float z";
const FACE: &str = "property list uchar int vertex_index";

#[test]
fn precision_and_dimension_follow_the_types() {
    let read = |types: [&str; 2], row| {
        let elements = format!("element vertex 1\nproperty {} x\nproperty {} y", types[0], types[1]);
        read_as(Format::Ply, header(&elements) + row).unwrap().0
    };
    assert_eq!(singles(&read(["float32", "int16"], "0.1 -3")), [0.1, -3.]);
    assert_eq!(doubles(&read(["float", "double"], "0.1 0.1")), [f64::from(0.1f32), 0.1]);
    assert_eq!(doubles(&read(["int", "float"], "16777217 1")), [16_777_217., 1.]);
    assert_eq!(read(["float", "float"], "1 2").coordinates.unwrap().dim, 2);
}

#[test]
fn faces_before_vertices_and_triangle_strips() {
    let elements = format!(
        "element tristrips 1\nproperty list int int vertex_indices\nelement face 1\n{FACE}\nelement nothing 9999999999\n\
         element vertex 5\n{POINT}"
    );
    let rows = "10 0 1 2 3 3 4 -1 2 3 4\n3 4 3 2\n".to_string() + &"0 0 0\n".repeat(5);
    let (soup, report) = read_as(Format::Ply, header(&elements) + &rows).unwrap();
    assert_eq!(listed(&soup, 2), [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 2]]);
    assert_eq!(report.degenerate_dropped, 2);
    assert_eq!(report.ignored.names, ["nothing"]);
}

#[test]
fn errors_in_the_header() {
    refused(
        Format::Ply,
        &[
            ("plx\n", "test:1:1: expected ply, found `plx`"),
            ("ply\n", "test:2:1: expected end_header, but the file ends here"),
            ("ply\nend_header\n", "test:2:1: the header lacks a line `format`"),
            ("ply\nformat binary 1.0\n", "test:2:8: expected ascii, binary_little_endian or binary_big_endian"),
            ("ply\nformat ascii 2.0\n", "test:2:14: expected version 1.0, found `2.0`"),
            (
                "ply\nelement vertex 3\n",
                "test:2:1: expected format, element, property, comment or end_header, in order",
            ),
            ("ply\nformat ascii 1.0\nfoo\n", "test:3:1: expected format, element"),
            ("ply\nformat ascii 1.0\nelement vertex -3\n", "test:3:16: expected the number of elements, found `-3`"),
            ("ply\nformat ascii 1.0\nelement vertex 3 4\n", "test:3:18: expected the end of the line, found `4`"),
            (&header("element vertex 1\nproperty real x"), "test:4:10: expected a type"),
            (&header("element vertex 1\nproperty list float int x"), "test:4:15: expected an integer type"),
            (&header("element vertex 1\nproperty float x"), "test:3:1: the element vertex lacks a property x or y"),
            (&header("element face 1\nproperty int vertex_indices"), "test:3:1: this element lacks a list"),
            (&header("element face 1\nproperty list int float vertex_indices"), "test:3:1: this element lacks a list"),
            (&header("element edge 1\nproperty int vertex1"), "test:3:1: the element edge lacks integers"),
            (&header(&format!("element vertex 5000000000\n{POINT}")), "test:3:1: more than 4294967295 vertices"),
            (
                &header(&format!("element vertex 1\n{POINT}\nelement vertex 1\n{POINT}")),
                "test:7:1: a second element vertex",
            ),
        ],
    );
}

#[test]
fn errors_in_rows_of_text() {
    let head = header(&format!("element vertex 2\n{POINT}\nelement face 1\n{FACE}"));
    let cases = [
        ("0 0 0\n0 0\n", "test:11:4: expected a coordinate, but the line ends here"),
        ("0 0 0\n0 x 0\n", "test:11:3: expected a coordinate, found `x`"),
        ("0 0 0\n0 0 -inf\n", "test:11:5: the coordinate `-inf` is not a finite number"),
        ("0 0 0\n0 0 0 0\n", "test:11:7: expected the end of the line, found `0`"),
        ("0 0 0\n", "test:11:1: expected as many rows of the element as the header says, but the file ends here"),
        ("0 0 0\n0 0 0\n3 0 1\n", "test:12:6: expected a vertex number, as many as the length of the list says"),
        ("0 0 0\n0 0 0\n0\n", "test:12:1: a face without vertices"),
        ("0 0 0\n0 0 0\n -1 0\n", "test:12:2: expected the length of a list, found `-1`"),
        ("0 0 0\n0 0 0\n 3 0 1 2\n", "test:12:8: vertex 2 is out of range: there are 2 vertices, numbered from 0"),
        ("0 0 0\n0 0 0\n 3 0 1 1\n", "test:12:2: the simplex repeats vertex 1; --drop-degenerate"),
        ("0 0 0\n0 0 0\n1 0\n 9\n", "test:13:2: expected the end of the file after the last element, found `9`"),
    ];
    let cases: Vec<_> = cases.iter().map(|(rows, expected)| (head.clone() + rows, *expected)).collect();
    refused(Format::Ply, &cases.iter().map(|(text, expected)| (text.as_str(), *expected)).collect::<Vec<_>>());
    let (soup, report) = read_dropping(Format::Ply, head + "0 0 0\n0 0 0\n3 0 1 1\n");
    assert_eq!((soup.num_listed(), report.degenerate_dropped), (0, 1));
}

#[test]
fn errors_in_binary_rows() {
    let whole = binary(true);
    let data = whole.windows(11).position(|bytes| bytes == b"end_header\n").unwrap() + 11;
    let changed = |at: usize, bytes: &[u8]| {
        let mut changed = whole.clone();
        changed[data + at..data + at + bytes.len()].copy_from_slice(bytes);
        message(Format::Ply, changed)
    };
    // Vertices of 13 bytes; the first face has its length at 52, its vertices from 53, a texture list at 69.
    let at = |byte: usize, rest: &str| format!("test: byte {}: {rest}", data + byte);
    assert_eq!(changed(17, &f32::NAN.to_be_bytes()), at(17, "the coordinate NaN is not a finite number"));
    let range = "vertex 4 is out of range: there are 4 vertices, numbered from 0";
    assert_eq!(changed(57, &4i32.to_be_bytes()), at(57, range));
    let repeats = "the polygon repeats vertex 0; --drop-degenerate drops such cells and counts them";
    assert_eq!(changed(57, &0i32.to_be_bytes()), at(52, repeats));
    let longer = [&whole[..], b"!"].concat();
    let trailing = at(whole.len() - data, "expected the end of the file after the last element, found `!`");
    assert_eq!(message(Format::Ply, longer), trailing);
    let cut =
        at(60, "expected as many rows of the element as the header says, but the file ends here; it seems truncated");
    assert_eq!(message(Format::Ply, &whole[..data + 60]), cut);
}
