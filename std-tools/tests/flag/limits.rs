//! Complexes that are too large are refused before anything is allocated for them.

use std::sync::atomic::{AtomicU64, Ordering};

use sig_tools::flag::{Accuracy, FlagError, FlagOptions, Phase, estimate, expand};
use sig_tools::graph::Graph;

fn complete_graph(num_vertices: u32) -> Graph {
    let edges: Vec<_> = (0..num_vertices).flat_map(|b| (0..b).map(move |a| (a, b))).collect();
    Graph::from_edges(num_vertices as usize, &edges, None).unwrap()
}

/// 2^10 − 1 simplices, 1022 of them below the largest dimension.
#[test]
fn limits_are_kept_to_the_simplex_and_to_the_byte() {
    let graph = complete_graph(10);
    let with = |max_simplices, max_bytes| {
        expand(&graph, &FlagOptions { max_simplices, max_bytes, ..FlagOptions::default() })
            .map(|tree| tree.num_simplices)
    };
    assert_eq!(with(Some(1023), None), Ok(1023));
    assert_eq!(with(Some(1022), None), Err(FlagError::TooManySimplices { at_least: 1023, limit: 1022 }));
    let bytes = 2 * 1023 + 4 * 1022;
    assert_eq!(with(None, Some(bytes)), Ok(1023));
    let error = FlagError::TooManyBytes { at_least: 1023, bytes, budget: bytes - 1 };
    assert_eq!(with(None, Some(bytes - 1)), Err(error));
    assert_eq!(
        error.to_string(),
        "the complex has at least 1023 simplices, which take at least 6134 bytes, and the budget is 6133 bytes: take a \
         smaller radius, fewer points or a smaller dimension, or raise the budget"
    );
}

/// 2^50 − 1 simplices are more than can be counted, in one subtree.
#[test]
fn counting_stops() {
    let graph = complete_graph(50);
    let options = FlagOptions { max_bytes: Some(1 << 30), ..FlagOptions::default() };
    let Err(FlagError::TooManyBytes { at_least, .. }) = expand(&graph, &options) else { panic!("too large") };
    assert!((1 << 28..1 << 31).contains(&at_least));
    let options = FlagOptions { max_simplices: Some(1 << 20), ..options };
    let Err(FlagError::TooManySimplices { at_least, .. }) = expand(&graph, &options) else { panic!("too large") };
    assert!((1 << 20..1 << 23).contains(&at_least));
}

/// A graph whose simplices are too many to be counted in the time of a test, but easy to count by hand: disjoint cliques.
#[test]
fn estimates_from_a_sample_lie_within_their_error() {
    let mut edges = Vec::new();
    for clique in 0..300_u32 {
        // Of 12 to 23 vertices.
        let (start, size) = (24 * clique, 12 + clique * 7 % 12);
        edges.extend((start..start + size).flat_map(|b| (start..b).map(move |a| (a, b))));
    }
    let graph = Graph::from_edges(24 * 300, &edges, None).unwrap();
    let exact: f64 = (0..300_u32)
        .map(|clique| {
            let size = 12 + clique * 7 % 12;
            f64::from((1 << size) - 1 + (24 - size))
        })
        .sum();
    let estimate = estimate(&graph, 31, 7);
    let Accuracy::Sampled { vertices, standard_error } = estimate.accuracy else { panic!("{estimate:?}") };
    assert_eq!(vertices, 1024);
    assert!((estimate.num_simplices() as f64 - exact).abs() < 3.0 * standard_error, "{estimate:?}, exactly {exact}");
}

#[test]
fn progress_ends_where_it_should() {
    let graph = Graph::from_edges(3, &[(0, 1), (1, 2)], Some(&[1.0, 2.0])).unwrap();
    let done = [const { AtomicU64::new(0) }; 3];
    let progress = |phase, steps, all| {
        let number = [Phase::Counting, Phase::Writing, Phase::Values].iter().position(|&other| other == phase);
        assert_eq!(all, 3);
        done[number.unwrap()].fetch_max(steps, Ordering::Relaxed);
    };
    expand(&graph, &FlagOptions { progress: Some(&progress), ..FlagOptions::default() }).unwrap();
    assert_eq!(done.map(AtomicU64::into_inner), [3, 3, 3]);
}
