//! KiC(i+1)C and MiC(i+1)C: the definition, the rules, the exact inverse, homology.

use proptest::prelude::*;
use sig_core::{Arc, CellId, Incidence};
use sig_tools::build::{BuildOptions, build};
use sig_tools::cells::{
    CellComplex, Infeasible, Instance, OperatorKind, OperatorType, Refinement, read_cells, write_cells,
};
use sig_tools::soup::Soup;

use crate::betti::both;
use crate::model::Model;
use crate::samples::{cone, kuhn_grid, simplices, soup, soup_of, torus};

pub(crate) fn complex(soup: Soup) -> CellComplex {
    CellComplex::from_built(&build(soup, &BuildOptions::default()).unwrap()).unwrap()
}

fn text(complex: &CellComplex) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_cells(complex, &mut bytes).unwrap();
    bytes
}

/// Kills pairs that the picks choose among those that some rule allows, of the first type only or of both.
fn simplify(complex: &mut CellComplex, picks: &[prop::sample::Index], both: bool) -> Vec<(CellComplex, Refinement)> {
    let mut steps = Vec::new();
    for pick in picks {
        let feasible = Model::of(complex).feasible();
        let feasible: Vec<_> = feasible.into_iter().filter(|pair| both || pair.2).collect();
        if feasible.is_empty() {
            break;
        }
        let (low, high, ..) = feasible[pick.index(feasible.len())];
        let before = complex.clone();
        steps.push((before, complex.kill(low, high).unwrap()));
    }
    steps
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Every step is the paper's formula, keeps the invariants and the homology, and is undone to the byte.
    #[test]
    fn killing_follows_the_definition_and_making_undoes_it(
        simplices in simplices(),
        picks in prop::collection::vec(any::<prop::sample::Index>(), 60),
        both_types in any::<bool>(),
    ) {
        let mut complex = complex(soup(14, &simplices));
        prop_assume!(complex.num_cells() < 600);
        complex.check().unwrap();
        let homology = both(&complex);
        let steps = simplify(&mut complex, &picks, both_types);
        complex.check().unwrap();
        let dims = complex.counts().len();
        for (before, after) in homology.iter().zip(both(&complex)) {
            prop_assert_eq!(&before[..dims], &after[..]);
            prop_assert!(before[dims..].iter().all(|&betti| betti == 0));
        }
        for (before, step) in steps.into_iter().rev() {
            let mut model = Model::of(&before);
            model.kill(step.low, step.high);
            prop_assert_eq!(&model, &Model::of(&complex));
            prop_assert_eq!(complex.euler_characteristic(), before.euler_characteristic());
            complex.make(&step).unwrap();
            prop_assert!(complex == before);
            prop_assert_eq!(text(&complex), text(&before));
            complex.check().unwrap();
        }
    }

    /// Whatever pair one asks for, the rules decide, and a refusal changes nothing.
    #[test]
    fn infeasible_calls_change_nothing(
        simplices in simplices(),
        picks in prop::collection::vec(any::<prop::sample::Index>(), 20),
        pairs in prop::collection::vec((0_u32..80, 0_u32..80), 40),
    ) {
        let mut complex = complex(soup(14, &simplices));
        prop_assume!(complex.num_cells() < 300);
        simplify(&mut complex, &picks, true);
        let model = Model::of(&complex);
        let feasible = model.feasible();
        for (low, high) in pairs {
            let (low, high) = (CellId::new(low), CellId::new(high));
            let expected = feasible.iter().find(|pair| (pair.0, pair.1) == (low, high));
            let mut changed = complex.clone();
            match changed.kill(low, high) {
                Ok(step) => {
                    let (_, _, first, second) = *expected.expect("a rule that allows it");
                    let has = |operator_type| step.kinds().any(|kind| kind.operator_type == operator_type);
                    prop_assert_eq!((first, second), (has(OperatorType::First), has(OperatorType::Second)));
                    prop_assert!(changed.kill(low, high) == Err(Infeasible::NoSuchCell(low)));
                }
                Err(_) => {
                    prop_assert!(expected.is_none());
                    prop_assert!(changed == complex);
                }
            }
        }
    }
}

#[test]
fn the_rules_that_failed_are_named() {
    // A triangle with a wire edge: 012, 23. Cells: vertices 0 to 3, edges 01, 02, 12, 23 = 4 to 7, triangle 8.
    let mut complex = complex(soup_of(&["012", "23"]));
    let [v2, v3, e01, e23, triangle] = [2, 3, 4, 7, 8].map(CellId::new);
    let nobody = CellId::new(99);
    assert_eq!(complex.kill(nobody, e01), Err(Infeasible::NoSuchCell(nobody)));
    assert_eq!(complex.kill(v3, e01), Err(Infeasible::NotIncident { low: v3, high: e01 }));
    assert_eq!(complex.kill(v3, triangle), Err(Infeasible::NotIncident { low: v3, high: triangle }));
    let kinds: Vec<_> = complex.kinds(v3, e23).unwrap().collect();
    let pendant = OperatorKind { operator_type: OperatorType::Second, instance: Instance::Second };
    assert_eq!(kinds, [pendant], "the paper's Figure 1 calls it so, though edge 23 has two vertices");
    complex.kill(v3, e23).unwrap();
    complex.kill(v2, CellId::new(5)).unwrap();
    complex.kill(CellId::new(1), e01).unwrap();
    // What is left: vertex 0, the edge 12 as a loop there, the triangle.
    let (v0, e12) = (CellId::new(0), CellId::new(6));
    assert_eq!(complex.counts(), [1, 1, 1]);
    assert_eq!(complex.kill(v0, e12), Err(Infeasible::Multiplicity { low: v0, high: e12, multiplicity: 2 }));
    assert_eq!(complex.incidence(v0, e12), Incidence { multiplicity: 2, sign: 0 });
    let refinement = complex.kill(e12, triangle).unwrap();
    assert_eq!(complex.counts(), [1], "a disk is a point by operators of both types");
    // MiC(i+1)C: the same again, and what it asks for.
    let arc = |cell, incidence| Arc { cell, incidence };
    let twice = Incidence { multiplicity: 2, sign: 0 };
    assert_eq!(refinement, Refinement::new(e12, triangle, 1, refinement.sign, [&[arc(v0, twice)], &[], &[], &[]]));
    let odd = Incidence { multiplicity: 2, sign: 1 };
    for wrong in [arc(nobody, twice), arc(v0, odd), arc(v0, Incidence::NONE)] {
        let refused = complex.make(&Refinement::new(e12, triangle, 1, 1, [&[wrong], &[], &[], &[]]));
        assert_eq!(refused, Err(Infeasible::CannotJoin(wrong.cell)));
    }
    let refused = complex.make(&Refinement::new(v0, e12, 0, 1, [&[]; 4]));
    assert_eq!(refused, Err(Infeasible::CannotMake(v0)));
    complex.make(&refinement).unwrap();
    assert_eq!(complex.make(&refinement), Err(Infeasible::CannotMake(e12)));
    // A new edge and a new vertex on the loop: M0C1C of the first type, which parts one of the two ends of the loop.
    let (vertex, edge) = (CellId::new(9), CellId::new(10));
    let once = Incidence::once(1);
    let lists: [&[Arc]; 4] = [&[], &[arc(v0, Incidence::once(-1))], &[arc(e12, once)], &[arc(triangle, once)]];
    complex.make(&Refinement::new(vertex, edge, 0, 1, lists)).unwrap();
    assert_eq!(complex.counts(), [2, 2, 1]);
    assert_eq!(complex.incidence(v0, e12), Incidence::once(-1));
    let again: [&[Arc]; 4] = [&[], &[arc(v0, once)], &[arc(e12, Incidence { multiplicity: 2, sign: 2 })], &[]];
    let refused = complex.make(&Refinement::new(CellId::new(11), CellId::new(12), 0, 1, again));
    assert_eq!(refused, Err(Infeasible::TooFew { low: v0, high: e12 }));
}

#[test]
fn the_four_sums_of_neighbours_decide() {
    let mut complex = complex(soup_of(&["0123", "1234"]));
    // An edge of a triangle in two tetrahedra: three faces around it or more, and two other edges.
    let (low, high) = complex
        .cells()
        .filter(|&cell| complex.dim_of(cell) == Some(2) && complex.num_coboundary(cell) == 2)
        .map(|high| (complex.boundary(high).next().unwrap().cell, high))
        .next()
        .unwrap();
    assert_eq!(complex.kill(low, high), Err(Infeasible::Neighbours { low, high, below: 2, above: 2 }));
    // The algebra allows it all the same, and takes it back.
    let before = complex.clone();
    let homology = both(&complex);
    let pair = complex.cancel(low, high).unwrap();
    complex.check().unwrap();
    assert_eq!(both(&complex), homology);
    complex.make(&pair).unwrap();
    assert!(complex == before);
}

/// Kills whatever pair of the least numbers is feasible until none is.
fn base(complex: &mut CellComplex, both_types: bool) -> Vec<usize> {
    loop {
        let allowed = Model::of(complex).feasible().into_iter().find(|pair| both_types || pair.2);
        let Some((low, high, ..)) = allowed else { return complex.counts().to_vec() };
        complex.kill(low, high).unwrap();
    }
}

#[test]
fn bases_of_known_complexes() {
    // The figures are known-answers: by operators of the first type, and by those of both.
    let mut torus = complex(soup(7, &torus()));
    assert_eq!(base(&mut torus, false), [1, 2, 1]);
    let mut plane = complex(soup_of(&["012", "023", "034", "045", "051", "124", "235", "341", "452", "513"]));
    assert_eq!(base(&mut plane, false), [1, 1, 1]);
    assert_eq!(both(&plane), [vec![1, 1, 1], vec![1, 0, 0]]);
    let sphere = ["0123", "0124", "0134", "0234", "1234"];
    let counts = base(&mut complex(soup_of(&sphere)), false);
    // How many pairs are left in between depends on the order; two cells it never is.
    assert!(matches!(counts[..], [1, k, l, 1] if k == l && k > 0), "{counts:?}");
    let mut moebius = complex(soup_of(&["012", "123", "234", "340", "401"]));
    assert_eq!(both(&moebius)[0], [1, 1, 0], "a Möbius strip");
    assert_eq!(base(&mut moebius, true), [1, 1]);
    let mut disk = complex(soup(4, &cone(&[vec![0, 1], vec![1, 2]])));
    assert_eq!(base(&mut disk, true), [1]);
    let mut ball = complex(kuhn_grid(3, 3, 3));
    let counts = base(&mut ball, true);
    assert_eq!(both(&ball)[0][0], 1);
    assert!(counts.iter().sum::<usize>() <= 3, "a ball: {counts:?}");
}

#[test]
fn incidences_grow_large_and_come_back() {
    // A circle of which each of the edges winds round twice: incidences 2, 4, 8 … in the boundary of the last cell.
    let chain = "cells 1 8 8\n".to_owned()
        + &"+0 -0\n".repeat(8)
        + &(0..7).map(|k| format!("+{k} 2*-{}\n", k + 1)).collect::<String>()
        + "+0 2*+7\n";
    let mut complex = read_cells(chain.as_bytes(), "chain").unwrap();
    let before = complex.clone();
    let homology = both(&complex);
    let mut steps = Vec::new();
    for k in 0..7 {
        steps.push(complex.kill(CellId::new(1 + k), CellId::new(9 + k)).unwrap());
    }
    assert_eq!(complex.counts(), [1, 1, 1]);
    let (edge, face) = (CellId::new(8), CellId::new(16));
    assert_eq!(complex.incidence(edge, face), Incidence { multiplicity: 130, sign: 130 });
    complex.check().unwrap();
    assert_eq!(both(&complex), homology);
    steps.iter().rev().for_each(|step| complex.make(step).unwrap());
    assert!(complex == before);
}
