use super::super::Format;
use super::{listed, message, read_as, read_dropping, refused};
use crate::soup::Labels;

fn tokens(labels: &[&str]) -> Labels {
    Labels::Tokens(labels.iter().map(|&label| label.into()).collect())
}

#[test]
fn lines_of_any_dimension() {
    let text = "# a comment \u{e9}\n7 3 5\n\n 3,5 , 9\t12 # tetrahedron\r\n12\n5 , 7";
    let (soup, report) = read_as(Format::SimplexList, text).unwrap();
    assert_eq!(soup.labels, Labels::Integers(vec![7, 3, 5, 9, 12]));
    assert!(!soup.declared && soup.coordinates.is_none());
    assert_eq!(listed(&soup, 0), [[4]]);
    assert_eq!(listed(&soup, 1), [[2, 0]]);
    assert_eq!(listed(&soup, 2), [[0, 1, 2]]);
    assert_eq!(listed(&soup, 3), [[1, 2, 3, 4]]);
    assert_eq!(report.simplices, [1, 1, 1, 1]);
}

#[test]
fn integers_are_kept_as_such_only_if_all_are_canonical() {
    for (text, labels) in [
        ("0 18446744073709551615\n", Labels::Integers(vec![0, u64::MAX])),
        ("1048575 1048576 1048575x\n", tokens(&["1048575", "1048576", "1048575x"])),
        ("7 07\n", tokens(&["7", "07"])),
        ("1 -1\n", tokens(&["1", "-1"])),
        ("+1 1\n", tokens(&["+1", "1"])),
        ("18446744073709551616\n", tokens(&["18446744073709551616"])),
        ("a b\nβ a\n1\n", tokens(&["a", "b", "β", "1"])),
        ("[[1,a],[1,2]]", tokens(&["1", "a", "2"])),
        ("", Labels::Integers(vec![])),
    ] {
        assert_eq!(read_as(Format::SimplexList, text).unwrap().0.labels, labels, "{text}");
    }
    let (soup, _) = read_as(Format::SimplexList, "3 4\n4 5\n5 x\n3 x\n4 x").unwrap();
    assert_eq!(listed(&soup, 1), [[0, 1], [1, 2], [2, 3], [0, 3], [1, 3]]);
}

#[test]
fn lists_in_brackets() {
    for text in [
        "[[1,2,3],[2,4]]",
        "[ [ 1, 2, 3 ],\n  [ 2,\n 4 ] ] ;\n",
        "### Poincar\u{e9}\n\nfacets:=[ [ 1, 2, 3 ], # one\n[2,4]];# done\n",
        "a_1 = \n [[1,2,3],[2,4]]",
        "facets:=\n\n[[1,2,3],[2,4]]",
    ] {
        let (soup, _) = read_as(Format::SimplexList, text).unwrap();
        assert_eq!(soup.labels, Labels::Integers(vec![1, 2, 3, 4]), "{text}");
        assert_eq!(listed(&soup, 2), [[0, 1, 2]], "{text}");
        assert_eq!(listed(&soup, 1), [[1, 3]], "{text}");
    }
    assert_eq!(read_as(Format::SimplexList, "[]").unwrap().0.num_listed(), 0);
}

#[test]
fn comments_in_any_encoding() {
    let (soup, _) = read_as(Format::SimplexList, b"# Poincar\xe9\n1 2 # \xff\n").unwrap();
    assert_eq!(listed(&soup, 1), [[0, 1]]);
    assert_eq!(
        message(Format::SimplexList, b"1 2\n3 caf\xe9\n"),
        "test:2:3: expected a vertex label in UTF-8, found `caf\\xe9`"
    );
}

#[test]
fn errors_and_their_places() {
    let many = (0..33).map(|label| label.to_string()).collect::<Vec<_>>().join(" ");
    refused(
        Format::SimplexList,
        &[
            ("1 2\n 4 5 4\n", "test:2:2: the simplex repeats vertex 4; --drop-degenerate"),
            ("a b a\n", "test:1:1: the simplex repeats vertex a; --drop-degenerate"),
            (&many, "test:1:1: a simplex of 33 vertices; at most 32 are possible (dimension 31)"),
            (",1 2\n", "test:1:1: expected a vertex label before the comma, found `,`"),
            ("1,,2\n", "test:1:2: expected a vertex label before the comma, found `,`"),
            ("[", "test:1:2: expected `[`, which opens a simplex, or `]`, which ends the list, but the file ends"),
            ("[[1,2],[3,4]\n", "test:2:1: expected `,` and a simplex, or `]`, which ends the list, but the file ends"),
            ("[[1,2],\n[3,", "test:2:4: expected a vertex label, but the file ends here"),
            ("[[1,2],\n []]", "test:2:3: expected a vertex label, found `]`"),
            ("[[1,2],]", "test:1:8: expected `[`, which opens a simplex, found `]`"),
            ("[[1,2][3]]", "test:1:7: expected `,` and a simplex, or `]`, which ends the list, found `[`"),
            ("[[1 2]]", "test:1:5: expected `,` and a vertex label, or `]`, which ends the simplex, found `2`"),
            ("[1,2,3]", "test:1:2: expected `[`, which opens a simplex, or `]`, which ends the list, found `1`"),
            ("[[1,2]];\n[[3]]", "test:2:1: expected the end of the file after the list, found `[[3]]`"),
            ("[[1,2],\n[1,3,1]]", "test:2:7: the simplex repeats vertex 1; --drop-degenerate"),
            ("facets:=\nx[[1]]", "test:2:1: expected `[`, which opens the list, found `x`"),
        ],
    );
}

#[test]
fn degenerate_simplices_are_dropped_and_counted_with_the_labels_that_only_they_use() {
    let (soup, report) = read_dropping(Format::SimplexList, "1 2 1\n2 3\n4 4\n5 3\n");
    assert_eq!(report.degenerate_dropped, 2);
    assert_eq!(soup.labels, Labels::Integers(vec![2, 3, 5]));
    assert_eq!(listed(&soup, 1), [[0, 1], [2, 1]]);
    assert_eq!((report.vertices, report.simplices), (3, vec![0, 2]));
    let (soup, _) = read_dropping(Format::SimplexList, "[[a,b,a],[b,c]]");
    assert_eq!(soup.labels, tokens(&["b", "c"]));
    assert_eq!(listed(&soup, 1), [[0, 1]]);
}
