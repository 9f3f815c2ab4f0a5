//! Contraction equals a rebuild, in every array.

use proptest::prelude::*;
use sig_tools::build::{Arrays, Built};
use sig_tools::contract::{ContractError, ContractReport, contract};
use sig_tools::soup::{Labels, Soup};

use crate::model::{Model, edge, sorted};
use crate::samples::{kuhn_grid, simplices};

/// All but what the report says of the input.
fn check(contracted: &Built, expected: &Built) {
    assert_eq!(contracted.arrays, expected.arrays);
    assert_eq!(contracted.labels, expected.labels);
    assert_eq!(contracted.coordinates, expected.coordinates);
    assert_eq!(contracted.parity, expected.parity);
    assert_eq!(contracted.filtration, expected.filtration);
    assert_eq!(contracted.report.top_simplices, expected.report.top_simplices);
}

proptest! {
    // Of each complex some hundred edges.
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_edge_of_a_complex(simplices in simplices(), seed in any::<u32>()) {
        let model = Model::new(14, &simplices, seed);
        let before = model.built();
        for (kept, removed) in model.edges() {
            let mut built = before.clone();
            let report = contract(&mut built, &[edge(kept, removed)]).expect("an edge");
            prop_assert_eq!((report.contracted, report.passes), (1, 1));
            let expected = model.contracted(kept, removed);
            check(&built, &expected.built());
            prop_assert_eq!(built.report.conflicting, expected.built().report.conflicting);
        }
    }
}

proptest! {
    /// One edge after the other, until none is left.
    #[test]
    fn until_no_edge_is_left(simplices in simplices(), seed in any::<u32>(), picks in prop::collection::vec(any::<prop::sample::Index>(), 14)) {
        let mut model = Model::new(14, &simplices, seed);
        let mut built = model.built();
        for pick in picks {
            let edges = model.edges();
            if edges.is_empty() {
                break;
            }
            let (kept, removed) = edges[pick.index(edges.len())];
            contract(&mut built, &[edge(kept, removed)]).expect("an edge");
            // From its own top simplices, so that orientations that cancelled do not come back.
            model = model.contracted(kept, removed).cleaned();
            check(&built, &model.built());
        }
    }

    /// A list of edges at once, by the vertices of the complex as it was.
    #[test]
    fn a_list_of_edges(simplices in simplices(), picks in prop::collection::vec(any::<prop::sample::Index>(), 1..6)) {
        let mut model = Model::new(14, &simplices, 1);
        let edges = model.edges();
        prop_assume!(!edges.is_empty());
        let mut built = model.built();
        let listed: Vec<(u32, u32)> = picks.iter().map(|pick| edges[pick.index(edges.len())]).collect();
        let list: Vec<_> = listed.iter().map(|&(kept, removed)| edge(kept, removed)).collect();
        let mut wide = Built { arrays: Arrays::Wide(built.arrays.clone().into_wide()), ..built.clone() };
        let report = contract(&mut built, &list).expect("edges stay edges or become vertices");
        prop_assert_eq!(contract(&mut wide, &list), Ok(report));
        prop_assert_eq!(wide.arrays, Arrays::Wide(built.arrays.clone().into_wide()));
        let mut stands_for: Vec<u32> = (0..14).collect();
        for (kept, removed) in listed {
            let (kept, removed) = (stands_for[kept as usize], stands_for[removed as usize]);
            if kept != removed {
                model = model.contracted(kept, removed).cleaned();
                for vertex in &mut stands_for {
                    let image = if *vertex == removed { kept } else { *vertex };
                    *vertex = if image > removed { image - 1 } else { image };
                }
            }
        }
        check(&built, &model.built());
        prop_assert_eq!(report.contracted, 14 - model.labels.len());
        prop_assert_eq!(report.contracted + report.merged, list.len());
    }
}

/// Edges far from each other share one pass, and it comes to the same as one pass each.
#[test]
fn independent_edges_share_a_pass() {
    let soup = kuhn_grid(9, 9, 9);
    let number = |x: u32, y: u32, z: u32| 81 * x + 9 * y + z;
    let spots = [0, 4, 8].into_iter().flat_map(|x| [0, 4, 8].into_iter().flat_map(move |y| [0, 4].map(|z| [x, y, z])));
    // To the lower and to the higher end.
    let edges: Vec<_> = spots
        .enumerate()
        .map(|(k, [x, y, z])| (k, number(x, y, z), number(x, y, z + 1)))
        .map(|(k, low, high)| if k % 2 == 0 { edge(low, high) } else { edge(high, low) })
        .collect();
    let build =
        || sig_tools::build::build(soup.clone(), &sig_tools::build::BuildOptions::default()).expect("a good soup");
    let mut together = build();
    let report = contract(&mut together, &edges).expect("edges");
    assert_eq!((report.contracted, report.passes), (18, 1));
    let mut apart = build();
    let mut gone: Vec<usize> = Vec::new();
    for edge in &edges {
        let now = |vertex: sig_core::VertexId| {
            sig_core::VertexId::new(vertex.index() - gone.iter().filter(|&&gone| gone < vertex.index()).count())
        };
        let edge_now = sig_tools::contract::Edge { kept: now(edge.kept), removed: now(edge.removed) };
        contract(&mut apart, &[edge_now]).expect("an edge");
        gone.push(edge.removed.index());
    }
    assert_eq!(together.arrays, apart.arrays);
    assert_eq!((together.labels, together.parity), (apart.labels, apart.parity));
}

/// A grid so large that its lists are written in several pieces, against a rebuild from the images of the tetrahedra.
#[test]
fn a_large_grid_equals_a_rebuild() {
    let soup = kuhn_grid(14, 14, 14);
    // Removed: 2, 1404 and 2743, each a neighbour of the vertex kept.
    let pairs = [(3, 2), (1403, 1404), (2742, 2743)];
    let mut built = sig_tools::build::build(soup.clone(), &sig_tools::build::BuildOptions::default()).expect("good");
    let report = contract(&mut built, &pairs.map(|(kept, removed)| edge(kept, removed))).expect("edges");
    assert_eq!((report.contracted, report.passes), (3, 1));
    let image = |vertex: u32| {
        let image = pairs.iter().find(|&&(_, removed)| removed == vertex).map_or(vertex, |&(kept, _)| kept);
        image - pairs.iter().filter(|&&(_, removed)| removed < image).count() as u32
    };
    let mut images = Soup::new(Labels::Numbered(14 * 14 * 14 - 3), true);
    for tetrahedron in soup.of_dim(3) {
        images.push(&sorted(&tetrahedron.iter().map(|&vertex| image(vertex)).collect::<Vec<_>>()));
    }
    let expected = sig_tools::build::build(images, &sig_tools::build::BuildOptions::default()).expect("good");
    assert_eq!(built.arrays, expected.arrays);
}

/// The part that is found anew is the same in a larger grid.
#[test]
fn local_work_does_not_grow() {
    let reports: Vec<ContractReport> = [9, 14, 19]
        .into_iter()
        .map(|side| {
            let soup = kuhn_grid(side, side, side);
            let mut built =
                sig_tools::build::build(soup, &sig_tools::build::BuildOptions::default()).expect("a good soup");
            let middle = (side / 2) * (side * side + side + 1);
            contract(&mut built, &[edge(middle, middle + 1)]).expect("an edge")
        })
        .collect();
    assert_eq!(reports[0], reports[1]);
    assert_eq!(reports[0], reports[2]);
}

#[test]
fn what_is_no_edge_is_refused() {
    let model = Model::new(6, &[vec![0, 1, 2], vec![2, 3]], 0);
    let before = model.built();
    for (kept, removed) in [(0, 3), (0, 5), (1, 1), (0, 6), (9, 0)] {
        let mut built = before.clone();
        let bad = edge(kept, removed);
        let expected = ContractError::NotAnEdge { index: 0, edge: bad };
        assert_eq!(contract(&mut built, &[bad]), Err(expected));
        assert_eq!(built, before);
    }
    // What comes before it is done.
    let mut built = before.clone();
    let error = contract(&mut built, &[edge(0, 1), edge(5, 4)]);
    assert_eq!(error, Err(ContractError::NotAnEdge { index: 1, edge: edge(5, 4) }));
    check(&built, &model.contracted(0, 1).built());
    assert_eq!(contract(&mut built, &[]), Ok(ContractReport::default()));
}
