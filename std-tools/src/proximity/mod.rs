//! Which points are near each other: the graph of all pairs up to a radius, from which Rips complexes are expanded.
//!
//! `grid` finds the pairs, on blocks of points (`lanes`) whose distances are exact: an edge is a pair whose
//! [`Metric::distance`] is at most the radius, to the last bit, whatever was skipped on the way.

mod grid;
pub(crate) mod lanes;

use crate::build::available_memory;
use crate::graph::{Graph, GraphError, check_vertices};
use crate::points::{Metric, Points};

/// What a radius graph is to hold. The default: edges without weights, as many as memory holds.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct RadiusOptions {
    /// Whether each edge has its length as weight.
    pub weighted: bool,
    /// The most edges that the graph may have; as many as the system's available memory holds if `None` and the system
    /// tells it.
    pub max_edges: Option<usize>,
}

/// Why there is no radius graph.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ProximityError {
    /// The radius is not a distance.
    #[error("a radius of {0}: it must be a number, and not negative")]
    Radius(f64),
    /// The graph would have more edges than the options allow.
    #[error("at least {at_least} edges, and there is room for {limit}; take a smaller radius or fewer points")]
    TooManyEdges {
        /// Edges found before the search stopped.
        at_least: usize,
        /// The most allowed.
        limit: usize,
    },
    /// The points do not make a graph: there are too many.
    #[error(transparent)]
    Graph(#[from] GraphError),
}

/// Bytes that an edge takes while edges are sorted.
const EDGE_BYTES: u64 = 12;

/// The graph of all pairs of points at a distance of at most `radius`; points at one place are joined for any radius.
///
/// The edges are exactly those that [`Metric::distance`] gives, for any number of threads. An infinite radius joins all
/// pairs. Time: what it takes to look at the pairs in neighbouring cells of a grid over a few coordinates of wide
/// spread, O(n²) distances where no coordinate tells points apart; in rayon's current pool. Memory: two copies of the
/// points, 12 bytes an edge, and the graph.
///
/// # Errors
/// [`ProximityError`].
pub fn radius_graph(
    points: &Points,
    metric: Metric,
    radius: f64,
    options: &RadiusOptions,
) -> Result<Graph, ProximityError> {
    if radius.is_nan() || radius < 0.0 {
        return Err(ProximityError::Radius(radius));
    }
    let fitting = || available_memory().and_then(|bytes| usize::try_from(bytes / EDGE_BYTES).ok());
    let limit = options.max_edges.or_else(fitting).unwrap_or(usize::MAX);
    // The search numbers points with 32 bits.
    check_vertices(points.len())?;
    let edges = grid::pairs_within(points, metric, radius, limit)
        .map_err(|at_least| ProximityError::TooManyEdges { at_least, limit })?;
    let distance = |a: u32, b: u32| metric.distance(points.point(a as usize), points.point(b as usize));
    Ok(Graph::from_pairs(points.len(), edges, options.weighted.then_some(&distance)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{cube, klein_bottle_grid, sphere4, veronese};
    use proptest::prelude::*;

    const METRICS: [Metric; 4] = [Metric::Euclidean, Metric::Maximum, Metric::Manhattan, Metric::Cosine];

    const WEIGHTED: RadiusOptions = RadiusOptions { weighted: true, max_edges: None };

    /// The definition: every pair is looked at.
    fn by_definition(points: &Points, metric: Metric, radius: f64) -> Graph {
        let (mut edges, mut weights) = (Vec::new(), Vec::new());
        for i in 0..points.len() {
            for j in i + 1..points.len() {
                let distance = metric.distance(points.point(i), points.point(j));
                if distance <= radius {
                    edges.push((i as u32, j as u32));
                    weights.push(distance);
                }
            }
        }
        Graph::from_edges(points.len(), &edges, Some(&weights)).unwrap()
    }

    fn check(points: &Points, metric: Metric, radius: f64) {
        let found = radius_graph(points, metric, radius, &WEIGHTED).unwrap();
        assert_eq!(found, by_definition(points, metric, radius), "{metric:?} {radius}");
    }

    proptest! {
        /// Small whole coordinates give points at one place, and many pairs at exactly the radius.
        #[test]
        fn edges_are_those_of_the_definition_on_lattices(
            values in proptest::collection::vec(-4i8..5, 0..900), dim in 1usize..8, radius in 0u8..6, scale in 0..5usize
        ) {
            let scale = [1.0, 0.1, 1e-160, 1e160, 1.0 / 3.0][scale];
            let whole = values.len() / dim * dim;
            let values = values[..whole].iter().map(|&value| scale * f64::from(value)).collect();
            let points = Points::new(dim, values).unwrap();
            for metric in METRICS {
                check(&points, metric, scale * f64::from(radius));
                check(&points, metric, f64::from(radius) / 8.0);
            }
        }

        /// The radius is the distance of a pair, which then is an edge.
        #[test]
        fn a_pair_at_exactly_the_radius_is_an_edge(
            count in 2usize..200, dim in 1usize..30, seed: u64, pair: (usize, usize), shift in 0..3usize
        ) {
            let cloud = cube(count, dim, seed);
            let shift = [0.0, -0.5, 1e9][shift];
            let points = Points::new(dim, cloud.values().iter().map(|value| value + shift).collect()).unwrap();
            let (i, j) = (pair.0 % count, pair.1 % count);
            for metric in METRICS {
                let radius = metric.distance(points.point(i), points.point(j));
                check(&points, metric, radius);
                check(&points, metric, radius.next_down().max(0.0));
            }
        }
    }

    #[test]
    fn clouds_of_every_kind_have_the_edges_of_the_definition() {
        for (points, radius) in
            [(sphere4(3000, 1), 0.4), (klein_bottle_grid(50), 0.3), (veronese(1500, 5), 0.3), (cube(1200, 25, 4), 1.4)]
        {
            for metric in METRICS {
                check(&points, metric, radius / if metric == Metric::Cosine { 20.0 } else { 1.0 });
            }
        }
    }

    /// The counts of GUDHI, by brute force.
    #[test]
    fn edge_counts_are_those_of_another_program() {
        let count = |points: &Points, radius: f64| {
            radius_graph(points, Metric::Euclidean, radius, &RadiusOptions::default()).unwrap().num_edges()
        };
        let sphere = sphere4(50_000, 1);
        let counts = [0.21, 0.253, 0.28].map(|radius| count(&sphere, radius));
        assert_eq!(counts, [452_726, 949_358, 1_420_694]);
        if cfg!(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64")) {
            let bottle = klein_bottle_grid(300);
            assert_eq!([0.064, 0.075].map(|radius| count(&bottle, radius)), [815_493, 1_118_047]);
        }
    }

    #[test]
    fn few_points_and_extreme_radii() {
        let none = radius_graph(&Points::default(), Metric::Euclidean, 1.0, &WEIGHTED).unwrap();
        assert_eq!((none.num_vertices(), none.num_edges()), (0, 0));
        let one = Points::new(2, vec![1.0, 2.0]).unwrap();
        let four = Points::new(1, vec![0.0, 1e308, -1e308, 0.0]).unwrap();
        for metric in METRICS {
            for radius in [0.0, 1.0, f64::MAX, f64::INFINITY] {
                check(&one, metric, radius);
                check(&four, metric, radius);
            }
        }
    }

    #[test]
    fn what_is_no_radius_is_refused_and_so_are_too_many_edges() {
        let points = cube(100, 3, 1);
        let graph = |radius, options| radius_graph(&points, Metric::Euclidean, radius, &options);
        assert_eq!(graph(-1.0, WEIGHTED), Err(ProximityError::Radius(-1.0)));
        assert!(matches!(graph(f64::NAN, WEIGHTED), Err(ProximityError::Radius(_))));
        let limited = |limit| graph(2.0, RadiusOptions { weighted: false, max_edges: Some(limit) });
        assert_eq!(limited(4950).unwrap().num_edges(), 4950);
        assert!(matches!(limited(4949), Err(ProximityError::TooManyEdges { at_least: 4950, limit: 4949 })));
    }
}
