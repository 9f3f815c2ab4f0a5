//! A simplex tree completed to a whole SIG is what the builder makes of the same simplices.

use proptest::prelude::*;
use sig_tools::build::{Arrays, BuildError, BuildOptions, Phase, complete};
use sig_tools::frozen::{FrozenTree, LastVertices};
use sig_tools::soup::{Labels, Soup};

use crate::agreement::built;
use crate::oracle::Oracle;
use crate::samples::{self, simplices, soup};

/// The tree in the arrays that the builder gives.
fn tree(soup: &Soup) -> FrozenTree {
    let arrays = built(soup).arrays.into_wide();
    let labels = arrays.last_vertices.clone();
    FrozenTree {
        first: arrays.first,
        num_simplices: arrays.num_simplices,
        child_offsets: arrays.child_offsets.into_iter().map(|child| child as u32).collect(),
        last_vertices: LastVertices::Bits16(labels.into_iter().map(|vertex| vertex as u16).collect()),
        filtration: Some((0..arrays.num_simplices).map(|id| id as f64).collect()),
        labels: Labels::Numbered(soup.labels.len()),
        coordinates: None,
    }
}

fn check(soup: &Soup) {
    let (tree, expected) = (tree(soup), built(soup));
    let wide_labels = (0..tree.num_simplices).map(|id| tree.last_vertices.at(id)).collect();
    let wide_tree = FrozenTree { last_vertices: LastVertices::Bits32(wide_labels), ..tree.clone() };
    let completed = complete(tree.clone(), &BuildOptions::default()).unwrap();
    assert_eq!(complete(wide_tree, &BuildOptions::default()).unwrap(), completed);
    assert_eq!(completed.arrays, expected.arrays);
    assert_eq!(completed.report.top_simplices, expected.report.top_simplices);
    assert_eq!(completed.parity, None);
    assert_eq!((completed.filtration, completed.labels), (tree.filtration, tree.labels));
}

/// So many overlapping simplices that the clusters are found by union-find.
fn overlapping() -> impl Strategy<Value = Vec<Vec<u32>>> {
    let simplex = prop::collection::btree_set(0_u32..13, 1..8).prop_map(|simplex| simplex.into_iter().collect());
    prop::collection::vec(simplex, 0..200)
}

proptest! {
    #[test]
    fn completed_trees_equal_built_soups(simplices in simplices()) {
        check(&soup(14, &simplices));
    }

    #[test]
    fn overlapping_simplices(simplices in overlapping()) {
        check(&soup(14, &simplices));
    }
}

/// Against the definition, on one thread and on several.
#[test]
fn a_complex_of_many_clusters() {
    let mut random = sig_tools::generate::SplitMix64::new(5);
    let mut simplices: Vec<Vec<u32>> = Vec::new();
    for number in 0..60 {
        let mut simplex: Vec<u32> = (0..5 + number % 2).map(|_| random.next_below(9) as u32).collect();
        simplex.sort_unstable();
        simplex.dedup();
        simplices.push(simplex);
    }
    let soup = soup(11, &simplices);
    let tree = tree(&soup);
    let expected = Oracle::new(&crate::agreement::listed(&soup)).arrays();
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let completed = pool.install(|| complete(tree.clone(), &BuildOptions::default())).unwrap();
        assert_eq!(completed.arrays.into_wide(), expected);
    }
}

#[test]
fn meshes_and_degenerate_complexes() {
    check(&samples::kuhn_grid(5, 6, 7));
    check(&samples::soup_of(&["0"]));
    check(&soup(5, &[]));
    check(&samples::soup_of(&["01", "12", "20", "34"]));
    let empty = complete(FrozenTree::default(), &BuildOptions::default()).unwrap();
    assert!(matches!(empty.arrays, Arrays::Narrow(arrays) if arrays == Default::default()));
}

#[test]
fn what_is_not_a_tree_is_refused() {
    let good = tree(&samples::soup_of(&["012", "23"]));
    let refused = |change: &dyn Fn(&mut FrozenTree)| {
        let mut tree = good.clone();
        change(&mut tree);
        matches!(complete(tree, &BuildOptions::default()), Err(BuildError::MalformedTree(_)))
    };
    assert!(refused(&|tree| tree.num_simplices -= 1));
    assert!(refused(&|tree| tree.child_offsets[2] = u32::MAX));
    assert!(refused(&|tree| tree.child_offsets.swap(1, 2)));
    assert!(refused(&|tree| tree.first[0] = 1));
    // Edge 12 becomes 13, so that triangle 012 lacks it.
    let edge = 6;
    assert_eq!(good.last_vertices.at(edge), 2);
    let rename = |tree: &mut FrozenTree, id: usize, vertex: u16| {
        if let LastVertices::Bits16(vertices) = &mut tree.last_vertices {
            vertices[id] = vertex;
        }
    };
    assert!(refused(&|tree| rename(tree, edge, 3)));
    assert!(refused(&|tree| rename(tree, edge, 9)));
    assert!(refused(&|tree| rename(tree, 0, 1)));
}

#[test]
fn limits_and_progress() {
    let tree = tree(&samples::soup_of(&["0123456"]));
    let limited = BuildOptions { max_simplices: Some(126), ..BuildOptions::default() };
    assert_eq!(complete(tree.clone(), &limited), Err(BuildError::TooLarge { at_least: 127, limit: 126 }));
    let limited = BuildOptions { max_bytes: Some(1000), ..BuildOptions::default() };
    assert!(matches!(complete(tree.clone(), &limited), Err(BuildError::TooLarge { at_least: 127, .. })));
    let seen = std::sync::Mutex::new(Vec::new());
    let progress = |phase, done, all| seen.lock().unwrap().push((phase, done, all));
    complete(tree, &BuildOptions { progress: Some(&progress), ..BuildOptions::default() }).unwrap();
    let seen = seen.into_inner().unwrap();
    assert!(seen.contains(&(Phase::Boundary, 6, 6)));
    assert!(seen.iter().any(|&(phase, _, _)| phase == Phase::Coboundary));
}
