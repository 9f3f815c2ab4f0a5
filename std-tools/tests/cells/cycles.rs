//! KiCiCycle and MiCiCycle: the one Betti number that they name, the rules, the exact inverse.

use proptest::prelude::*;
use sig_core::{Arc, CellId, Incidence};
use sig_tools::cells::{CellComplex, CellWithCycle, Infeasible, read_cells};

use crate::betti::both;
use crate::operators::complex;
use crate::samples::{simplices, soup, soup_of};

/// A second cell with the boundary of another: the two are a cycle.
fn copy_of(complex: &CellComplex, cell: CellId) -> CellWithCycle {
    let copy = CellId::new(complex.num_ids() as u32);
    let dim = complex.dim_of(cell).unwrap();
    let boundary = complex.boundary(cell).collect();
    CellWithCycle { cell: copy, dim, boundary, cycle: vec![(copy, 1), (cell, -1)] }
}

/// The Betti numbers with one more in a dimension.
fn with_one_more(mut betti: [Vec<usize>; 2], dim: usize) -> [Vec<usize>; 2] {
    betti.iter_mut().for_each(|betti| betti[dim] += 1);
    betti
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Copies of cells are made, each with a cycle, and killed again in the reverse order; a vertex is a copy without the other.
    #[test]
    fn one_betti_number_changes(simplices in simplices(), picks in prop::collection::vec(any::<prop::sample::Index>(), 1..6)) {
        let mut complex = complex(soup(14, &simplices));
        prop_assume!(complex.num_cells() > 0 && complex.num_cells() < 300);
        let mut steps = Vec::new();
        for pick in picks {
            let cells: Vec<CellId> = complex.cells().collect();
            let mut made = copy_of(&complex, cells[pick.index(cells.len())]);
            if made.dim == 0 {
                made.cycle.pop();
            }
            let (before, betti) = (complex.clone(), both(&complex));
            complex.make_with_cycle(&made).unwrap();
            complex.check().unwrap();
            prop_assert_eq!(both(&complex), with_one_more(betti, made.dim));
            prop_assert_eq!(complex.make_with_cycle(&made), Err(Infeasible::CannotMake(made.cell)));
            steps.push((before, made));
        }
        for (before, made) in steps.into_iter().rev() {
            let after = complex.clone();
            let killed = complex.kill_with_cycle(made.cell, &made.cycle).unwrap();
            prop_assert!(complex == before);
            prop_assert_eq!(&killed, &made);
            complex.make_with_cycle(&killed).unwrap();
            prop_assert!(complex == after);
            complex.kill_with_cycle(made.cell, &made.cycle).unwrap();
        }
    }
}

#[test]
fn a_sphere_is_opened_and_a_circle_cut() {
    // The boundary of a tetrahedron: the four triangles, signed as the boundary has them, are a cycle.
    let mut sphere = complex(soup_of(&["012", "013", "023", "123"]));
    let triangles: Vec<(CellId, i64)> = (10..14).map(CellId::new).zip([1, -1, 1, -1]).collect();
    assert_eq!(both(&sphere)[0], [1, 0, 1]);
    let triangle = sphere.kill_with_cycle(CellId::new(10), &triangles).unwrap();
    assert_eq!((both(&sphere)[0].clone(), triangle.dim), (vec![1, 0, 0], 2));
    // Edges 01, 02, 12 are a cycle around the hole, but bound triangles.
    let edges = [4, 5, 7].map(CellId::new).into_iter().zip([1, -1, 1]).collect::<Vec<_>>();
    let refused = sphere.kill_with_cycle(edges[0].0, &edges);
    assert!(matches!(refused, Err(Infeasible::Bounds { cell, .. }) if cell == edges[0].0), "{refused:?}");
    // A circle of three edges is cut, then an isolated vertex killed with its component.
    let mut circle = complex(soup_of(&["01", "02", "12", "3"]));
    let edges: Vec<(CellId, i64)> = [4, 5, 6].map(CellId::new).into_iter().zip([1, -1, 1]).collect();
    assert_eq!(both(&circle)[0], [2, 1]);
    circle.kill_with_cycle(CellId::new(6), &edges).unwrap();
    assert_eq!(both(&circle)[0], [2, 0]);
    circle.kill_with_cycle(CellId::new(3), &[(CellId::new(3), 1)]).unwrap();
    assert_eq!(both(&circle)[0], [1, 0]);
}

#[test]
fn the_rules_that_failed_are_named() {
    let mut complex = complex(soup_of(&["01", "02", "12", "23"]));
    let before = complex.clone();
    let [v0, v3, e01, e02, e12, e23] = [0, 3, 4, 5, 6, 7].map(CellId::new);
    let nobody = CellId::new(20);
    let mut refuse = |cell, cycle: &[(CellId, i64)]| {
        let refused = complex.kill_with_cycle(cell, cycle).unwrap_err();
        assert!(complex == before, "{refused}");
        refused
    };
    assert_eq!(refuse(nobody, &[]), Infeasible::NoSuchCell(nobody));
    assert_eq!(refuse(v3, &[(v3, 1)]), Infeasible::Bounds { cell: v3, high: e23 });
    assert_eq!(refuse(e01, &[(e01, 1), (v0, 1)]), Infeasible::NotInCycle { cell: v0, dim: 1 });
    assert_eq!(refuse(e01, &[(e02, 1)]), Infeasible::NotOnCycle { cell: e01, coefficient: 0 });
    assert_eq!(refuse(e01, &[(e01, 2), (e02, -2), (e12, 2)]), Infeasible::NotOnCycle { cell: e01, coefficient: 2 });
    assert!(matches!(refuse(e23, &[(e23, 1)]), Infeasible::NoCycle { .. }), "a bridge lies on no cycle");
    assert!(matches!(refuse(e01, &[(e01, 1), (e02, 1), (e12, 1)]), Infeasible::NoCycle { .. }));
    // An edge between two components makes no cycle; a face that is not there cannot be joined.
    let made =
        |boundary: Vec<Arc>| CellWithCycle { cell: CellId::new(8), dim: 1, boundary, cycle: vec![(CellId::new(8), 1)] };
    let end = |cell, sign| Arc { cell, incidence: Incidence::once(sign) };
    let refused = complex.make_with_cycle(&made(vec![end(v0, 1), end(v3, -1)]));
    assert!(matches!(refused, Err(Infeasible::NoCycle { .. })));
    let refused = complex.make_with_cycle(&made(vec![end(nobody, 1)]));
    assert_eq!(refused, Err(Infeasible::CannotJoin(nobody)));
    assert!(complex == before);
}

/// A cell of which each face appears in both directions is a cycle alone, whatever its multiplicities.
#[test]
fn incidences_of_any_size_are_kept() {
    let mut complex = read_cells(&b"cells 1 1 1\n+0 -0\n300*+0 300*-0\n"[..], "twice").unwrap();
    let (before, betti) = (complex.clone(), both(&complex));
    let killed = complex.kill_with_cycle(CellId::new(2), &[(CellId::new(2), -1)]).unwrap();
    assert_eq!(killed.boundary[0].incidence, Incidence { multiplicity: 600, sign: 0 });
    assert_eq!((both(&complex)[0].clone(), betti[0].clone()), (vec![1, 1], vec![1, 1, 1]));
    complex.make_with_cycle(&killed).unwrap();
    assert!(complex == before);
}
