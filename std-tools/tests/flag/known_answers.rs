//! Complexes whose numbers of simplices are known otherwise.

use sig_tools::flag::{Accuracy, FlagOptions, estimate, expand};
use sig_tools::generate::sphere4;
use sig_tools::graph::Graph;
use sig_tools::points::{Metric, Points};

/// The graph of all pairs of points up to a distance, by looking at all.
pub(crate) fn radius_graph(points: &Points, radius: f64) -> Graph {
    let mut edges = Vec::new();
    for b in 0..points.len() {
        for a in 0..b {
            if Metric::Euclidean.distance(points.point(a), points.point(b)) <= radius {
                edges.push((a as u32, b as u32));
            }
        }
    }
    Graph::from_edges(points.len(), &edges, None).unwrap()
}

fn complete_graph(num_vertices: u32) -> Graph {
    let edges: Vec<_> = (0..num_vertices).flat_map(|b| (0..b).map(move |a| (a, b))).collect();
    Graph::from_edges(num_vertices as usize, &edges, None).unwrap()
}

fn binomials(n: usize, max_dim: usize) -> Vec<usize> {
    (0..=max_dim.min(n - 1)).map(|dim| (0..=dim).fold(1, |count, k| count * (n - k) / (k + 1))).collect()
}

fn counts(graph: &Graph, max_dim: usize) -> Vec<usize> {
    let counts = expand(graph, &FlagOptions { max_dim, ..FlagOptions::default() }).unwrap().counts();
    let estimate = estimate(graph, max_dim, 1);
    assert_eq!(estimate.accuracy, Accuracy::Exact);
    assert_eq!(estimate.counts, counts.iter().map(|&count| count as u64).collect::<Vec<_>>());
    counts
}

#[test]
fn complete_graphs_are_simplices() {
    for (n, max_dim) in [(1, 5), (2, 1), (20, 31), (64, 3), (65, 3), (66, 3), (130, 3), (200, 2)] {
        assert_eq!(counts(&complete_graph(n), max_dim), binomials(n as usize, max_dim), "{n} vertices");
    }
}

#[test]
fn degenerate_graphs() {
    let empty = expand(&Graph::default(), &FlagOptions::default()).unwrap();
    assert_eq!(empty, sig_tools::frozen::FrozenTree::default());
    assert!(counts(&Graph::default(), 3).is_empty());
    let edgeless = Graph::from_edges(5, &[], None).unwrap();
    assert_eq!(counts(&edgeless, 31), [5]);
    assert_eq!(counts(&complete_graph(5), 0), [5]);
    assert_eq!(counts(&complete_graph(5), 1), [5, 10]);
    assert_eq!(counts(&complete_graph(5), usize::MAX), [5, 10, 10, 5, 1]);
}

/// Points, radius, largest dimension, and the simplices of each dimension as counted by GUDHI 3.7.1 from the same points.
/// In the second, vertices have up to 100 neighbours.
const RIPS: [(usize, f64, usize, &[usize]); 2] = [
    (2000, 0.5, 6, &[2000, 22207, 65560, 94932, 84318, 50844, 21894]),
    (500, 0.9, 5, &[500, 13227, 107_114, 443_491, 1_172_211, 2_225_555]),
];

#[test]
fn rips_complexes_of_a_sphere() {
    for (num_points, radius, max_dim, expected) in RIPS {
        let graph = radius_graph(&sphere4(num_points, 1), radius);
        assert_eq!(counts(&graph, max_dim), expected);
    }
}
