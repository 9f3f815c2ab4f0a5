use super::super::Format;
use super::{listed, message, read_as, read_dropping, refused, singles};
use crate::soup::Labels;

/// A binary file of these facets.
pub(super) fn binary(header: &str, facets: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend(u32::try_from(facets.len()).unwrap().to_le_bytes());
    for facet in facets {
        bytes.extend([0; 12]);
        bytes.extend(facet.iter().flatten().flat_map(|value| value.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

const FACETS: [[[f32; 3]; 3]; 2] =
    [[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.]], [[0., -0., 0.], [1., 1., 0.], [0., 1., 0.]]];

pub(super) const TEXT: &str = "solid a square\n facet normal 0 0 nan\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   \
    vertex 1 1 0\n  endloop\n endfacet\n FACET NORMAL 0 0 1\n  OUTER LOOP\n   VERTEX 0 -0 0.0\n   VERTEX 1e0 1 0\n   \
    VERTEX 0 1 0\n  ENDLOOP\n ENDFACET\nendsolid a square\n";

#[test]
fn text_and_binary_give_the_same_soup() {
    let text = read_as(Format::Stl, TEXT).unwrap();
    for header in ["", "solid that is none"] {
        assert_eq!(read_as(Format::Stl, binary(header, &FACETS)).unwrap(), text);
    }
    let (soup, report) = text;
    assert_eq!(soup.labels, Labels::Numbered(4));
    assert_eq!(listed(&soup, 2), [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(singles(&soup), [0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.]);
    assert!(singles(&soup).iter().all(|value| value.is_sign_positive()));
    assert_eq!(report.welded, 2);
}

#[test]
fn several_solids_and_none() {
    let twice = [TEXT, TEXT].concat();
    let (soup, report) = read_as(Format::Stl, twice).unwrap();
    assert_eq!((soup.labels.len(), report.simplices[2]), (4, 4));
    assert_eq!(read_as(Format::Stl, "solid\nendsolid\n").unwrap().0.num_listed(), 0);
    assert_eq!(read_as(Format::Stl, binary("", &[])).unwrap().0.num_listed(), 0);
}

#[test]
fn facets_whose_corners_weld_are_degenerate() {
    let facets = [[[0., 0., 0.], [1., 0., 0.5], [0., 0., -0.]], FACETS[0]];
    let bytes = binary("", &facets);
    assert_eq!(
        message(Format::Stl, &bytes),
        "test: byte 84: the simplex repeats vertex (0 0 0); --drop-degenerate drops such cells and counts them"
    );
    let (soup, report) = read_dropping(Format::Stl, &bytes);
    assert_eq!((soup.num_listed(), report.degenerate_dropped), (1, 1));
}

#[test]
fn errors_and_their_places_in_text() {
    let solid = |facet: &str| format!("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n{facet}");
    refused(
        Format::Stl,
        &[
            ("solid\n", "test:2:1: expected a facet or endsolid, but the file ends here"),
            ("solid\n fact\n", "test:2:2: expected a facet or endsolid, found `fact`"),
            ("solid\nfacet\nloop\n", "test:3:1: expected outer, found `loop`"),
            (&solid("vertex 0 1\n"), "test:5:11: expected a coordinate of the corner, but the line ends here"),
            (&solid("vertex 0 1 x\n"), "test:5:12: expected a coordinate of the corner, found `x`"),
            (&solid("vertex 0 1 1e39\n"), "test:5:12: the coordinate `1e39` is not a finite number"),
            (&solid("vertex 0 1 2 3\n"), "test:5:14: expected the end of the line, found `3`"),
            (&solid("endloop\n"), "test:5:1: expected vertex, found `endloop`"),
            (&solid("vertex 0 1 0\nvertex 1 1 0\nvertex 1 0 0\n"), "test:7:1: expected endloop, found `vertex`"),
            (&solid("vertex 0 1 0\nvertex 0 0 0\nendloop\nendfacet\n"), "test:2:1: the simplex repeats vertex (0 0 0)"),
            ("solid\nendsolid\nmore\n", "test:3:1: expected the end of the file after endsolid, found `more`"),
        ],
    );
}

#[test]
fn errors_and_their_places_in_binary() {
    let whole = binary("", &FACETS);
    let cut = "test: byte 183: expected as many facets as the header says, but the file ends here; it seems truncated";
    assert_eq!(message(Format::Stl, &whole[..183]), cut);
    assert_eq!(
        message(Format::Stl, [0; 3]),
        "test: byte 3: expected 84 bytes of header, but the file ends here; it seems truncated"
    );
    let longer = [&whole[..], b"more"].concat();
    assert_eq!(
        message(Format::Stl, longer),
        "test: byte 184: expected the end of the file after the last facet, found `more`"
    );
    let mut infinite = FACETS;
    infinite[1][2][1] = f32::INFINITY;
    assert_eq!(
        message(Format::Stl, binary("", &infinite)),
        "test: byte 174: the coordinate inf is not a finite number"
    );
}
