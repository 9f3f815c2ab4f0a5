//! Soups that are refused, and complexes that are too large.

use std::sync::atomic::{AtomicU64, Ordering};

use sig_tools::build::{BuildError, BuildOptions, Phase, build};
use sig_tools::incidence_graph::IncidenceGraph;
use sig_tools::soup::{Coordinates, Labels, Scalars, Soup};

use crate::samples::{kuhn_grid, soup_of};

fn refused(soup: &Soup, options: &BuildOptions<'_>) -> BuildError {
    let error = build(soup.clone(), options).expect_err("a bad soup");
    assert_eq!(IncidenceGraph::new(soup, options), Err(error));
    error
}

#[test]
fn malformed_soups() {
    let options = BuildOptions::default();
    let mut soup = soup_of(&["012", "134", "11", "34"]);
    assert_eq!(refused(&soup, &options), BuildError::RepeatedVertex { dim: 1, index: 0, vertex: 1 });
    soup.simplices[1].clear();
    soup.simplices[2][4] = 5;
    assert_eq!(refused(&soup, &options), BuildError::VertexOutOfRange { dim: 2, index: 1, vertex: 5, count: 5 });
    soup.simplices[2].pop();
    assert_eq!(refused(&soup, &options), BuildError::MalformedSoup { dim: 2, len: 5 });
    let mut soup = soup_of(&["012"]);
    soup.simplices.resize(33, Vec::new());
    soup.simplices[32] = vec![0; 33];
    assert_eq!(refused(&soup, &options), BuildError::MalformedSoup { dim: 32, len: 33 });
    let mut soup = soup_of(&["012"]);
    soup.coordinates = Some(Coordinates { dim: 2, values: Scalars::F32(vec![0.0; 5]) });
    assert_eq!(refused(&soup, &options), BuildError::MalformedCoordinates { values: 5, vertices: 3, dim: 2 });
}

#[test]
fn a_31_simplex_is_refused_at_once() {
    let mut soup = Soup::new(Labels::Numbered(32), false);
    soup.push(&(0..32).collect::<Vec<_>>());
    let options = BuildOptions { max_bytes: Some(1 << 34), ..BuildOptions::default() };
    let error = build(soup, &options).expect_err("too large");
    assert!(matches!(error, BuildError::TooLarge { at_least: 0xFFFF_FFFF, .. }), "{error:?}");
    assert!(error.to_string().contains("4294967295"), "{error}");
}

/// Counted exactly, not estimated: the tetrahedra alone would allow for 15 faces each.
#[test]
fn the_limit_is_the_number_of_simplices() {
    let soup = kuhn_grid(14, 14, 14);
    let limited = |max| BuildOptions { max_simplices: Some(max), ..BuildOptions::default() };
    assert!(build(soup.clone(), &limited(60_243)).is_ok());
    let error = build(soup, &limited(60_242)).expect_err("too large");
    assert_eq!(error, BuildError::TooLarge { at_least: 60_243, limit: 60_242 });
}

#[test]
fn progress_reaches_its_total() {
    let left = AtomicU64::new(u64::MAX);
    let progress = |phase: Phase, done: u64, total: u64| {
        if phase == Phase::Levels {
            left.fetch_min(total - done, Ordering::Relaxed);
        }
    };
    let options = BuildOptions { progress: Some(&progress), ..BuildOptions::default() };
    assert!(build(kuhn_grid(5, 5, 5), &options).is_ok());
    assert_eq!(left.load(Ordering::Relaxed), 0);
}
