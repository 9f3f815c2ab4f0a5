//! Pyramids against the maps that the operators make, level by level.

use proptest::prelude::*;
use sig_core::SimplexId;
use sig_tools::combinatorial_map::{CombinatorialMap, OperatorError, Pyramid, Walk, kernels, map_integers};

use crate::model::{assert_is_map, closed, map_of, sphere, torus};

/// Everything that can be asked of a map but which dart stands for a cell.
fn facts(map: &CombinatorialMap) -> Vec<(usize, Vec<usize>)> {
    let numbers = |dart| {
        let betas = (1..=2).map(|i| map.beta(i, dart).unwrap().index());
        betas.chain((0..=2).map(|dim| map.cell(dart, dim).unwrap().index())).collect()
    };
    map.darts().map(|dart| (dart.index(), numbers(dart))).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_level_is_what_the_kernels_make(words in closed(2..=2)) {
        let base = map_of(&words).unwrap();
        let pyramid = Pyramid::new(base.clone(), kernels::contraction, kernels::removal).unwrap();
        let mut map = base.clone();
        let mut walk = Walk::new();
        prop_assert_eq!(pyramid.base(), &base);
        for level in 0..pyramid.num_levels() {
            let found = pyramid.level(level);
            prop_assert_eq!(facts(&found), facts(&map), "level {}", level);
            prop_assert_eq!(pyramid.num_darts()[level], map.num_darts());
            assert_is_map(&found);
            let contraction = kernels::contraction(&map);
            let joined = map.cells(0).filter(|&vertex| !map.adjacency(vertex, &mut walk).is_empty()).count();
            prop_assert!(2 * contraction.len() >= joined, "half of the vertices that can go");
            for (edge, vertex) in contraction {
                let done = map.contract(edge, vertex, &mut walk);
                prop_assert!(done.is_ok() || done == Err(OperatorError::LastEdge(edge)));
            }
            for (edge, face) in kernels::removal(&map) {
                let done = map.remove(edge, face, &mut walk);
                prop_assert!(done.is_ok() || done == Err(OperatorError::LastEdge(edge)));
            }
        }
        prop_assert_eq!(facts(&pyramid.level(usize::MAX)), facts(&map));
        let integers: usize = pyramid.num_darts().iter().map(|&darts| map_integers(2, darts)).sum();
        prop_assert_eq!(pyramid.integers_of_levels(), integers);
        let cells: usize = (0..=2).map(|dim| base.num_cells(dim)).sum();
        prop_assert_eq!(pyramid.num_integers(), base.num_integers() + cells);
    }
}

/// The least maps: 2g edges at one vertex, and for a sphere, which has none without an edge, one edge.
#[test]
fn the_top_of_a_pyramid() {
    for (words, top) in [(torus(), [1, 2, 1]), (sphere(0, 4), [1, 1, 2])] {
        let pyramid = Pyramid::new(map_of(&words).unwrap(), kernels::contraction, kernels::removal).unwrap();
        let map = pyramid.level(pyramid.num_levels() - 1);
        let cells = [0, 1, 2].map(|dim| map.num_cells(dim));
        assert!(cells == top || (cells == [2, 1, 1] && top == [1, 1, 2]), "{cells:?}");
    }
}

#[test]
fn kernels_that_are_none() {
    let base = map_of(&sphere(0, 4)).unwrap();
    // The edges 01, 02, 12 are a circle: the third leads from a vertex to itself when the others are contracted.
    let circle = [(4, 1), (5, 2), (7, 0)].map(|(edge, vertex)| (SimplexId::new(edge), SimplexId::new(vertex)));
    let found = Pyramid::new(base.clone(), |_| circle.to_vec(), |_| Vec::new());
    let [edge, cell] = [7, 0].map(SimplexId::new);
    assert_eq!(found.err(), Some(OperatorError::Twice { edge, cell }));
    let found = Pyramid::new(map_of(&sphere(0, 5)).unwrap(), kernels::contraction, kernels::removal);
    assert_eq!(found.err(), Some(OperatorError::Dimension(3)));
}
