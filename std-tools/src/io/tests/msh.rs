use super::super::{Format, ReadReport, cone};
use super::{doubles, f_vector, listed, message, read_as, read_dropping, refused};
use crate::attribute::Values;
use crate::soup::{Labels, Soup};

pub(super) const TEXT_2: &str = "$Comments\n$Nodes\n$EndComments\n$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n\
    2 1 \"a\"\n$EndPhysicalNames\n$Nodes\n5\n10 0 0 0\n11 1 0 0\n12 0 1 0\n13 0 0 1\n20 1 1 1\n$EndNodes\n$Elements\n4\n\
    1 15 2 1 1 20\n2 1 2 1 1 10 11\n3 2 0 10 12 11\n4 4 2 1 1 10 11 12 13\n$EndElements\n$ElementNodeData\n1\n$EndElementNodeData\n";

pub(super) const TEXT_4: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 0\n$EndEntities\n$Nodes\n2 5 10 20\n\
    1 1 1 2\n10\n11\n0 0 0 0.5\n1 0 0 0.5\n3 1 0 3\n12 13\n20\n0 1 0\n0 0 1\n1 1 1\n$EndNodes\n$Elements\n4 4 1 4\n\
    0 1 15 1\n1 20\n1 1 1 1\n2 10 11\n2 1 2 1\n3 10 12 11\n3 1 4 1\n4 10 11 12 13\n$EndElements\n";

/// Numbers as bytes of one order.
struct Bytes {
    bytes: Vec<u8>,
    big_endian: bool,
}

impl Bytes {
    fn new(version: &str, size: usize, big_endian: bool) -> Self {
        let mut bytes = Self { bytes: Vec::new(), big_endian };
        bytes.text(&format!("$MeshFormat\n{version} 1 {size}\n"));
        bytes.ints(&[1]);
        bytes.text("\n$EndMeshFormat\n");
        bytes
    }

    fn text(&mut self, text: &str) {
        self.bytes.extend(text.as_bytes());
    }

    fn ints(&mut self, values: &[i32]) {
        for value in values {
            self.bytes.extend(if self.big_endian { value.to_be_bytes() } else { value.to_le_bytes() });
        }
    }

    fn sizes(&mut self, size: usize, values: &[u64]) {
        for value in values {
            match (size, self.big_endian) {
                (8, true) => self.bytes.extend(value.to_be_bytes()),
                (8, false) => self.bytes.extend(value.to_le_bytes()),
                _ => self.ints(&[i32::try_from(*value).unwrap()]),
            }
        }
    }

    fn floats(&mut self, values: &[f64]) {
        for value in values {
            self.bytes.extend(if self.big_endian { value.to_be_bytes() } else { value.to_le_bytes() });
        }
    }
}

const POINTS: [[f64; 3]; 5] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.], [1., 1., 1.]];

/// The mesh of `TEXT_2` in binary.
pub(super) fn binary_2(big_endian: bool) -> Vec<u8> {
    let mut file = Bytes::new("2.2", 8, big_endian);
    file.text("$Nodes\n5\n");
    for (tag, point) in [10, 11, 12, 13, 20].into_iter().zip(POINTS) {
        file.ints(&[tag]);
        file.floats(&point);
    }
    file.text("\n$EndNodes\n$Elements\n4\n");
    file.ints(&[15, 1, 2, 1, 1, 1, 20]);
    file.ints(&[1, 1, 2, 2, 1, 1, 10, 11]);
    file.ints(&[2, 1, 0, 3, 10, 12, 11]);
    file.ints(&[4, 1, 2, 4, 1, 1, 10, 11, 12, 13]);
    file.text("\n$EndElements\n$ElementNodeData\nsome\n");
    file.ints(&[0x0a24_0a24]);
    file.text("\n$EndElementNodeData\n");
    file.bytes
}

/// The mesh of `TEXT_4` in binary.
pub(super) fn binary_4(size: usize, big_endian: bool) -> Vec<u8> {
    let mut file = Bytes::new("4.1", size, big_endian);
    file.text("$Nodes\n");
    file.sizes(size, &[2, 5, 10, 20]);
    file.ints(&[1, 1, 1]);
    file.sizes(size, &[2, 10, 11]);
    file.floats(&[0., 0., 0., 0.5, 1., 0., 0., 0.5]);
    file.ints(&[3, 1, 0]);
    file.sizes(size, &[3, 12, 13, 20]);
    file.floats(&POINTS[2..].concat());
    file.text("\n$EndNodes\n$Elements\n");
    file.sizes(size, &[4, 4, 1, 4]);
    for (kind, words) in [(15, &[1, 20][..]), (1, &[2, 10, 11]), (2, &[3, 10, 12, 11]), (4, &[4, 10, 11, 12, 13])] {
        file.ints(&[0, 1, kind]);
        file.sizes(size, &[1]);
        file.sizes(size, words);
    }
    file.text("\n$EndElements\n");
    file.bytes
}

#[test]
fn versions_and_encodings_give_the_same_soup() {
    let (soup, report) = read_as(Format::Msh, TEXT_2).unwrap();
    assert_eq!(soup.labels, Labels::Integers(vec![10, 11, 12, 13, 20]));
    assert!(soup.declared);
    assert_eq!(doubles(&soup), POINTS.concat());
    assert_eq!(listed(&soup, 0), [[4]]);
    assert_eq!(listed(&soup, 1), [[0, 1]]);
    assert_eq!(listed(&soup, 2), [[0, 2, 1]]);
    assert_eq!(listed(&soup, 3), [[0, 1, 2, 3]]);
    assert_eq!(report.ignored.names, ["$ElementNodeData"]);
    // Only one of the files tells of physical groups.
    let of_dim = |dim| soup.attributes.iter().find(|found| found.dim == dim).map(|found| found.values.clone());
    let groups = [0, 1, 2, 3].map(of_dim);
    let group = |values: &[i32]| Some(Values::I32(values.to_vec()));
    assert_eq!(groups, [group(&[0, 0, 0, 0, 1]), group(&[1]), None, group(&[1])]);
    let without = |(soup, _): (Soup, ReadReport)| Soup { attributes: Vec::new(), ..soup };
    let soup = without((soup, report));
    assert_eq!(without(read_as(Format::Msh, TEXT_4).unwrap()), soup);
    for big_endian in [false, true] {
        assert_eq!(without(read_as(Format::Msh, binary_2(big_endian)).unwrap()), soup);
        for size in [4, 8] {
            assert_eq!(without(read_as(Format::Msh, binary_4(size, big_endian)).unwrap()), soup);
        }
    }
}

/// A mesh in text with nodes of the given tags.
fn mesh(tags: &[u64], elements: &[&str]) -> String {
    let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", tags.len());
    for tag in tags {
        text += &format!("{tag} {tag} 0 0\n");
    }
    text += &format!("$EndNodes\n$Elements\n{}\n", elements.len());
    for (number, element) in elements.iter().enumerate() {
        text += &format!("{number} {element}\n");
    }
    text + "$EndElements\n"
}

#[test]
fn tags_in_any_order_and_with_gaps() {
    for (tags, labels) in [
        (vec![0, 1, 2], Labels::Numbered(3)),
        (vec![1, 2, 3], Labels::Integers(vec![1, 2, 3])),
        (vec![2, 0, 1], Labels::Integers(vec![2, 0, 1])),
        (vec![900, 7, 1 << 40], Labels::Integers(vec![900, 7, 1 << 40])),
    ] {
        let element = format!("2 0 {} {} {}", tags[1], tags[2], tags[0]);
        let (soup, _) = read_as(Format::Msh, mesh(&tags, &[&element])).unwrap();
        assert_eq!(soup.labels, labels);
        assert_eq!(listed(&soup, 2), [[1, 2, 0]]);
    }
}

#[test]
fn elements_of_second_order_stand_for_their_corners() {
    // A triangle with its three inner nodes, one of which is also a corner of an edge.
    let text = mesh(&[1, 2, 3, 4, 5, 6, 7], &["9 0 1 3 5 2 4 6", "1 0 6 1"]);
    let (soup, report) = read_as(Format::Msh, text).unwrap();
    // Node 7 is declared and unused, which is not the same.
    assert_eq!(soup.labels, Labels::Integers(vec![1, 3, 5, 6, 7]));
    assert_eq!(doubles(&soup), [1., 0., 0., 3., 0., 0., 5., 0., 0., 6., 0., 0., 7., 0., 0.]);
    assert_eq!(listed(&soup, 2), [[0, 1, 2]]);
    assert_eq!(listed(&soup, 1), [[3, 0]]);
    assert_eq!(report.inner_nodes_dropped, 2);
}

/// Six times the volume of a tetrahedron.
fn volume(points: &[[f64; 3]], simplex: &[u32]) -> f64 {
    let [o, a, b, c] = [0, 1, 2, 3].map(|at| points[simplex[at] as usize]);
    let [a, b, c] = [a, b, c].map(|p| [p[0] - o[0], p[1] - o[1], p[2] - o[2]]);
    a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

/// Polyhedra of unit base and height in every numbering that puts another corner first: the tetrahedra are positive
/// and fill the polyhedron.
#[test]
fn polyhedra_are_filled_by_positive_tetrahedra() {
    let cube: Vec<[f64; 3]> = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
        .map(|point| point.map(f64::from))
        .to_vec();
    let prism = [0, 1, 3, 4, 5, 7].map(|at| cube[at]).to_vec();
    let pyramid = [0, 1, 2, 3, 4].map(|at| cube[at]).to_vec();
    for (shape, points, six_volumes) in [
        (cone::Polyhedron::Hexahedron, cube, 6.),
        (cone::Polyhedron::Prism, prism, 3.),
        (cone::Polyhedron::Pyramid, pyramid, 2.),
    ] {
        let corners: Vec<u32> = (0..).take(points.len()).collect();
        for shift in 0..corners.len() as u64 {
            for step in [1, 3, 5, 7] {
                let label = |corner: u32| (u64::from(corner) * step + shift) % 11;
                let mut volumes = Vec::new();
                shape.split(&corners, label, |tetrahedron| volumes.push(volume(&points, &tetrahedron)));
                assert!(volumes.iter().all(|&volume| volume > 0.), "{shape:?} {shift} {step} {volumes:?}");
                assert_eq!(volumes.iter().sum::<f64>(), six_volumes, "{shape:?} {shift} {step}");
            }
        }
    }
}

/// Two by two by two hexahedra with shuffled tags: if neighbours split a common face alike, the complex has the faces
/// of a cube filled by tetrahedra, its boundary is a sphere and every inner triangle lies in two tetrahedra.
#[test]
fn neighbouring_hexahedra_agree() {
    let tag = |x: u64, y: u64, z: u64| (x + 3 * y + 9 * z) * 10 % 27 + 1;
    let mut elements = Vec::new();
    for (x, y, z) in (0..8u64).map(|at| (at & 1, at >> 1 & 1, at >> 2)) {
        let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
        let tags = corners.map(|[dx, dy, dz]| tag(x + dx, y + dy, z + dz).to_string());
        elements.push(format!("5 0 {}", tags.join(" ")));
    }
    let tags: Vec<u64> = (1..=27).collect();
    let text = mesh(&tags, &elements.iter().map(String::as_str).collect::<Vec<_>>());
    let (soup, report) = read_as(Format::Msh, text).unwrap();
    let f = f_vector(&soup);
    assert_eq!(report.polyhedra, 8);
    // A ball: Euler characteristic 1. On its boundary 24 squares, so 48 triangles: 4 n_3 = 2 n_2 − 48.
    assert_eq!(f[0] + f[2], f[1] + f[3] + 1);
    assert_eq!(f[0], 27);
    assert_eq!(4 * f[3] + 48, 2 * f[2]);
}

#[test]
fn degenerate_elements() {
    let text = mesh(&[1, 2, 3, 4, 5, 6], &["3 0 1 2 3 3", "5 0 1 2 3 3 4 5 6 6", "2 0 1 1 2"]);
    assert!(message(Format::Msh, &text).starts_with("test:15:1: the polygon repeats vertex 3; --drop-degenerate"));
    let (soup, report) = read_dropping(Format::Msh, text);
    // The quadrangle is the triangle 1 2 3, the hexahedron the prism 1 2 3 4 5 6.
    assert_eq!(listed(&soup, 2), [[0, 1, 2]]);
    assert_eq!(f_vector(&soup), [6, 12, 10, 3]);
    assert_eq!((report.polygons, report.polyhedra), (1, 1));
}

#[test]
fn errors_and_their_places_in_text() {
    let head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    let nodes = "$Nodes\n2\n1 0 0 0\n2 1 0 0\n$EndNodes\n";
    let after = |rest: &str| format!("{head}{rest}");
    let elements = |rest: &str| format!("{head}{nodes}$Elements\n{rest}");
    refused(
        Format::Msh,
        &[
            ("", "test:1:1: expected the section $MeshFormat, but the file ends here"),
            ("Mesh\n", "test:1:1: expected a line that opens a section, like $Nodes, found `Mesh`"),
            ("$NOD\n", "test:1:1: version 1 of the format is not read"),
            ("$MeshFormat\n3.0 0 8\n", "test:2:1: expected version 2.2 or 4.1"),
            ("$MeshFormat\n2.2 2 8\n", "test:2:5: expected 0 for text or 1 for binary, found `2`"),
            ("$MeshFormat\n2.2 0 4\n", "test:2:7: expected 8, the size of numbers in bytes, found `4`"),
            ("$MeshFormat\n2.2 0 8\n$Nodes\n", "test:3:1: expected $EndMeshFormat, found `$Nodes`"),
            ("$Comments\nfoo", "test:2:4: expected $EndComments, but the file ends here"),
            (head, "test:4:1: expected the section $Nodes, but the file ends here"),
            (&after(nodes), "test:9:1: expected the section $Elements, but the file ends here"),
            (&after("$Elements\n"), "test:4:1: expected the sections $MeshFormat, $Nodes and $Elements, in this order"),
            (&after("$Nodes\n-1\n"), "test:5:1: expected the number of nodes, found `-1`"),
            (&after("$Nodes\n1\n1 0 0\n"), "test:6:6: expected a coordinate of the node, but the line ends here"),
            (&after("$Nodes\n1\n1 0 0 nan\n"), "test:6:7: the coordinate `nan` is not a finite number"),
            (&after("$Nodes\n2\n1 0 0 0\n$EndNodes\n"), "test:7:1: expected the tag of the node, found `$EndNodes`"),
            (&after("$Nodes\n2\n1 0 0 0\n"), "test:7:1: expected as many nodes as the section says, but the file ends"),
            (&after("$Nodes\n0\n1 0 0 0\n"), "test:6:1: expected $EndNodes, found `1`"),
            (&after("$Nodes\n2\n7 0 0 0\n7 0 0 0\n$EndNodes\n"), "test:8:1: node 7 is declared more than once"),
            (&after("$Nodes\n2\n7777777 0 0 0\n7777777 0 0 0\n"), "test:8:1: node 7777777 is declared more than once"),
            (&elements("1\n1 99 0 1\n"), "test:11:3: expected an element type of Gmsh"),
            (&elements("1\n1 1 0 1 3\n"), "test:11:9: there is no node with tag 3; the input declares 2 nodes"),
            (&elements("1\n1 1 2 1 1 1\n"), "test:11:12: expected as many node tags as the type of the element asks"),
            (&elements("1\n1 1 0 1 2 1\n"), "test:11:11: expected the end of the line, found `1`"),
            (&elements("1\n 1 1 0 2 2\n"), "test:11:2: the simplex repeats vertex 2; --drop-degenerate"),
            (&elements("1\n1 1 0 1 2\n"), "test:12:1: expected $EndElements, but the file ends here"),
        ],
    );
    let head = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n";
    let cases = [
        ("1 2 1 2\n0 1 0 1\n1\n0 0 0\n", "test:9:1: nodes: 2 declared, 1 found"),
        ("1 1 1\n", "test:5:6: expected the numbers of blocks and items"),
        ("1 1 1 1\n0 1 0 1\n1 2\n", "test:7:3: expected the end of the tags of the block, found `2`"),
        ("1 2 1 2\n0 1 0 2\n1\n2\n0 0 0\n", "test:10:1: expected as many nodes as the block says, but the file ends"),
    ];
    let cases: Vec<_> = cases.iter().map(|(rest, expected)| (format!("{head}{rest}"), *expected)).collect();
    refused(Format::Msh, &cases.iter().map(|(text, expected)| (text.as_str(), *expected)).collect::<Vec<_>>());
}

#[test]
fn errors_and_their_places_in_binary() {
    let whole = binary_4(8, true);
    let find = |mark: &[u8]| whole.windows(mark.len()).position(|bytes| bytes == mark).unwrap();
    let changed = |at: usize, bytes: &[u8]| {
        let mut changed = whole.clone();
        changed[at..at + bytes.len()].copy_from_slice(bytes);
        message(Format::Msh, changed)
    };
    let one = "$MeshFormat\n4.1 1 8\n".len();
    assert!(changed(one, &[2]).starts_with(&format!("test: byte {one}: expected the number 1 in binary")));
    // Four totals, three ints, a count and two tags come before the first coordinates.
    let point = find(b"$Nodes\n") + 7 + 4 * 8 + 3 * 4 + 3 * 8;
    let expected = format!("test: byte {}: the coordinate NaN is not a finite number", point + 8);
    assert_eq!(changed(point + 8, &f64::NAN.to_be_bytes()), expected);
    let ends = find(b"$EndNodes");
    assert_eq!(changed(ends, b"$E_d"), format!("test: byte {ends}: expected $EndNodes, found `$E_dNodes`"));
    // The block of the point: three ints, a count, the element's tag, then the node.
    let block = find(b"$Elements\n") + 10 + 4 * 8;
    let node = block + 3 * 4 + 2 * 8;
    let expected = format!("test: byte {node}: there is no node with tag 21; the input declares 5 nodes");
    assert_eq!(changed(node, &21u64.to_be_bytes()), expected);
    let expected = format!("test: byte {}: elements of type 77 are not read", block + 8);
    assert_eq!(changed(block + 8, &77i32.to_be_bytes()), expected);
    let cut = message(Format::Msh, &whole[..point + 3]);
    assert!(cut.starts_with(&format!("test: byte {}: expected a coordinate of the node", point + 3)), "{cut}");
}
