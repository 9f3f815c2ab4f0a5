//! The order of the vertices: decided by labels, coordinates or edges, not by the order of the input.

use proptest::prelude::*;
use sig_tools::build::{BuildError, BuildOptions, Built, VertexOrder, build};
use sig_tools::soup::{Coordinates, Labels, Scalars, Soup};

use crate::samples::{self, simplices};

const ORDERS: [VertexOrder; 3] = [VertexOrder::Input, VertexOrder::Hilbert, VertexOrder::Rcm];

fn with(soup: &Soup, order: VertexOrder) -> Built {
    build(soup.clone(), &BuildOptions { order, ..BuildOptions::default() }).expect("a good soup")
}

/// An undeclared soup with labels and coordinates, its vertices numbered as `numbers` says.
fn labelled(simplices: &[Vec<u32>], numbers: &[u32], tokens: bool) -> Soup {
    let mut names = vec![0_u32; numbers.len()];
    for (vertex, &number) in (0..).zip(numbers) {
        names[number as usize] = vertex;
    }
    let labels = if tokens {
        Labels::Tokens(names.iter().map(|name| format!("v{name}").into()).collect())
    } else {
        Labels::Integers(names.iter().map(|&name| u64::from(name) * 10 + 3).collect())
    };
    let mut soup = Soup::new(labels, false);
    let point = |name: u32| [f64::from(name * 7 % 5), f64::from(name * 11 % 3), 0.5, f64::from(name)];
    let values = names.iter().flat_map(|&name| point(name)).collect();
    soup.coordinates = Some(Coordinates { dim: 4, values: Scalars::F64(values) });
    for simplex in simplices {
        soup.push(&simplex.iter().map(|&vertex| numbers[vertex as usize]).collect::<Vec<_>>());
    }
    soup
}

proptest! {
    #[test]
    fn the_numbers_of_the_vertices_do_not_matter(
        simplices in simplices(),
        numbers in Just((0..14).collect::<Vec<u32>>()).prop_shuffle(),
        tokens in any::<bool>(),
    ) {
        let plain = labelled(&simplices, &(0..14).collect::<Vec<u32>>(), tokens);
        let shuffled = labelled(&simplices, &numbers, tokens);
        for order in ORDERS {
            prop_assert_eq!(with(&shuffled, order), with(&plain, order));
        }
    }
}

#[test]
fn labels_decide() {
    let mut soup = samples::soup_of(&["01", "23"]);
    soup.labels = Labels::Integers(vec![10, 9, 100, 1]);
    assert_eq!(with(&soup, VertexOrder::Input).labels, Labels::Integers(vec![1, 9, 10, 100]));
    let tokens = |names: &[&str]| Labels::Tokens(names.iter().map(|&name| name.into()).collect());
    soup.labels = tokens(&["10", "9", "é", "Z"]);
    assert_eq!(with(&soup, VertexOrder::Input).labels, tokens(&["10", "9", "Z", "é"]));
    soup.labels = Labels::Integers(vec![3, 2, 1, 0]);
    assert_eq!(with(&soup, VertexOrder::Input).labels, Labels::Numbered(4));
}

/// Consecutive cells of a grid of 2^k a side are neighbours along the curve, and every cell is met.
#[test]
fn hilbert_order_walks_a_grid() {
    for (dim, side) in [(2, 16_usize), (3, 8)] {
        let count = side.pow(dim as u32);
        let cell = |index: usize| (0..dim).map(move |axis| index / side.pow(axis as u32) % side);
        // The last coordinate sets the scale so that each cell of the grid is a cell of the curve.
        let values = (0..count).flat_map(cell).map(|x| x as f64).collect();
        let mut soup = samples::soup(count, &[]);
        soup.coordinates = Some(Coordinates { dim, values: Scalars::F64(values) });
        let Some(Coordinates { values: Scalars::F64(values), .. }) = with(&soup, VertexOrder::Hilbert).coordinates
        else {
            panic!("coordinates in the same precision");
        };
        let points: Vec<&[f64]> = values.chunks(dim).collect();
        for pair in points.windows(2) {
            let distance: f64 = pair[0].iter().zip(pair[1]).map(|(a, b)| (a - b).abs()).sum();
            assert_eq!(distance, 1.0, "{pair:?}");
        }
    }
}

#[test]
fn points_that_are_nowhere_are_ordered_too() {
    let mut soup = samples::soup_of(&["0123"]);
    let values = vec![f32::NAN, 0.0, f32::INFINITY, -1e38, 3e38, 3e38, -3e38, 1.0];
    soup.coordinates = Some(Coordinates { dim: 2, values: Scalars::F32(values) });
    assert_eq!(with(&soup, VertexOrder::Hilbert).report.top_simplices, [0, 0, 0, 1]);
    soup.coordinates = Some(Coordinates { dim: 0, values: Scalars::F32(Vec::new()) });
    assert_eq!(with(&soup, VertexOrder::Hilbert).labels, Labels::Numbered(4));
}

/// A path in any order has bandwidth 1 in reverse Cuthill–McKee order.
#[test]
fn rcm_straightens_a_path() {
    let path: Vec<Vec<u32>> = (0..99).map(|i| vec![i * 37 % 100, (i + 1) * 37 % 100]).collect();
    let built = with(&samples::soup(100, &path), VertexOrder::Rcm);
    let arrays = built.arrays.into_wide();
    assert!(arrays.boundary.chunks(2).all(|edge| edge[0] == edge[1] + 1));
}

#[test]
fn hilbert_order_needs_coordinates() {
    let options = BuildOptions { order: VertexOrder::Hilbert, ..BuildOptions::default() };
    assert_eq!(build(samples::soup_of(&["01"]), &options), Err(BuildError::NoCoordinates));
}
