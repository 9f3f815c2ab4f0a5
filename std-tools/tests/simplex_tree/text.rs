//! GUDHI's text: what GUDHI itself wrote, what it cannot read, and what is wrong where.

use proptest::prelude::*;
use sig_tools::simplex_tree::SimplexTree;

use crate::model::both;
use crate::operations::{value, word};

fn read(text: &str) -> Result<SimplexTree, String> {
    SimplexTree::read_text(text.as_bytes(), "a.txt", None).map_err(|error| error.to_string())
}

fn written(tree: &SimplexTree) -> String {
    let mut text = Vec::new();
    tree.write_text(&mut text).unwrap();
    String::from_utf8(text).unwrap()
}

/// The output of GUDHI 3.7.1 for a triangle, an edge and a vertex: vertices decrease, lines end with the value.
#[test]
fn what_gudhi_writes_is_read() {
    let text = "0 1 0\n0 2 0\n0 3 0\n0 7 0.25\n1 2 1 0.5\n1 3 1 0.5\n1 3 2 0.5\n1 7 3 0.75\n2 3 2 1 1.5\n";
    let tree = read(text).unwrap();
    assert_eq!(tree.counts(), [4, 4, 1]);
    assert_eq!(tree.find(&[1, 2, 3]).unwrap().value(), 1.5);
    assert_eq!(tree.find(&[3, 7]).unwrap().value(), 0.75);
    let own = "0 1 0\n0 2 0\n0 3 0\n0 7 0.25\n1 1 2 0.5\n1 1 3 0.5\n1 2 3 0.5\n1 3 7 0.75\n2 1 2 3 1.5\n";
    assert_eq!(written(&tree), own);
    // In any order, with blank lines, tabs, and line ends of two bytes.
    let mut lines: Vec<&str> = text.lines().rev().collect();
    lines.insert(3, " \t");
    assert_eq!(read(&lines.join("\r\n")).unwrap(), tree);
    assert_eq!(read("").unwrap(), SimplexTree::new());
}

#[test]
fn faults_have_their_place() {
    let faults = [
        ("0 1\n", "a.txt:1:4: expected the filtration value, but the line ends here"),
        ("0 1 0\n\n0 x 0\n", "a.txt:3:3: expected a vertex: an integer from 0 to 4294967294, found `x`"),
        ("0 -1 0", "a.txt:1:3: expected a vertex: an integer from 0 to 4294967294, found `-1`"),
        ("0 4294967295 0", "a.txt:1:3: expected a vertex: an integer from 0 to 4294967294, found `4294967295`"),
        ("-1 0", "a.txt:1:1: expected the dimension of a simplex, found `-1`"),
        ("0 1 nan", "a.txt:1:5: expected the filtration value, a number, found `nan`"),
        ("0 1 0 2", "a.txt:1:7: expected the end of the line, found `2`"),
        ("  1 4 4 0", "a.txt:1:3: the simplex repeats vertex 4; --drop-degenerate drops such cells and counts them"),
        ("32 0", "a.txt:1:1: a simplex of 33 vertices; at most 32 are possible (dimension 31)"),
        ("0 1 0\n1 1 2 0", "a.txt:2:1: the facet [2] is not in the complex"),
        ("1 1 2 0\n0 2 0.5\n0 1 0", "a.txt:1:1: the filtration value 0 is below 0.5, that of the facet [2]"),
    ];
    for (text, error) in faults {
        assert_eq!(read(text).unwrap_err(), error, "{text:?}");
    }
}

proptest! {
    #[test]
    fn writing_and_reading_is_the_identity(words in prop::collection::vec((word(), value()), 0..10), scale in -300..300) {
        let words: Vec<_> = words.into_iter().map(|(word, value)| (word, value * 10.0_f64.powi(scale) / 3.0)).collect();
        let (_, tree) = both(&words);
        prop_assert_eq!(read(&written(&tree)).unwrap(), tree);
    }
}
