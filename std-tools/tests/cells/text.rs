//! Cell complexes in text.

use proptest::prelude::*;
use sig_core::{CellId, Incidence};
use sig_tools::cells::{read_cells, write_cells};

use crate::betti::both;
use crate::operators::complex;
use crate::samples::{simplices, soup};

#[test]
fn a_lens_space() {
    let text = "# L(3,1)\ncells 1 1 1 1\n+0 -0\n3*+0 # three times\n\n+0 -0\n";
    let lens = read_cells(text.as_bytes(), "lens").unwrap();
    assert_eq!(lens.counts(), [1, 1, 1, 1]);
    assert_eq!(lens.euler_characteristic(), 0);
    assert_eq!(lens.incidence(CellId::new(1), CellId::new(2)), Incidence { multiplicity: 3, sign: 3 });
    // H = (Z, Z_3, 0, Z).
    assert_eq!(both(&lens), [vec![1, 0, 0, 1], vec![1, 1, 1, 1]]);
    let mut out = Vec::new();
    write_cells(&lens, &mut out).unwrap();
    assert_eq!(String::from_utf8(out).unwrap(), "cells 1 1 1 1\n+0 -0\n3*+0\n+0 -0\n");
}

#[test]
fn cells_without_boundary() {
    let sphere = read_cells(&b"cells 1 0 1\n.\n"[..], "sphere").unwrap();
    assert_eq!(sphere.counts(), [1, 0, 1]);
    assert_eq!(both(&sphere)[0], [1, 0, 1]);
    let empty = read_cells(&b"cells\n"[..], "empty").unwrap();
    assert_eq!((empty.dim(), empty.num_cells()), (None, 0));
}

#[test]
fn errors_name_the_place() {
    let cases = [
        ("", "x:1:1: "),
        ("cell 1\n", "x:1:1: expected `cells`"),
        ("cells 2 1\n+0 -2\n", "x:2:4: there is no cell 2"),
        ("cells 2 1\n+0 -1x\n", "x:2:4: expected a cell of the dimension below"),
        ("cells 2 1\n0*0 1\n", "x:2:1: expected a cell of the dimension below"),
        ("cells 2 1\n. 1\n", "x:2:3: expected a boundary, or `.` alone"),
        ("cells 2 2\n+0 -1\n", "x:3:1: "),
        ("cells 2 1\n+0 -1\n0\n", "x:3:1: "),
        ("cells 2 1 1\n+0 -1\n\n +0\n", "x:4:2: cell c3: the boundary of its boundary is"),
        ("cells 2 1\n2147483647*0 1 0\n", "x:2:1: a cell appears too often"),
        ("cells 536870912 1\n", "x:1:17: more than"),
        ("#\ncells 500000000 1\n+0 -1\n", "x:2:7: 500000000 vertices, but the boundaries have only 2 cells in all"),
    ];
    for (text, expected) in cases {
        let error = read_cells(text.as_bytes(), "x").unwrap_err().to_string();
        assert!(error.starts_with(expected), "{text:?}: {error}");
    }
}

proptest! {
    #[test]
    fn what_is_written_is_read(simplices in simplices()) {
        let complex = complex(soup(14, &simplices));
        let mut text = Vec::new();
        write_cells(&complex, &mut text).unwrap();
        prop_assert!(read_cells(&text[..], "x").unwrap() == complex);
    }
}
