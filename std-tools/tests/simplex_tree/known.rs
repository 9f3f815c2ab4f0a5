//! Complexes of which it is known what they collapse to.

use std::sync::Mutex;

use sig_tools::frozen::FrozenTree;
use sig_tools::generate::sphere4;
use sig_tools::graph::Graph;
use sig_tools::points::Metric;
use sig_tools::proximity::{RadiusOptions, radius_graph};
use sig_tools::simplex_tree::{
    ContractError, ExpandError, InsertError, LinkCondition, RelabelError, SimplexTree, WordError,
};

use crate::model::{Model, Word, faces, tree_of};
use crate::operations::replay;

/// The faces of the simplices that a file in the tests' data lists.
fn triangulation(name: &str) -> SimplexTree {
    let path = format!("{}/../tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    let (soup, _) = sig_tools::io::read_path(path, &sig_tools::io::ReadOptions::default()).unwrap();
    let mut tree = SimplexTree::without_filtration();
    for dim in 0..soup.simplices.len() {
        for simplex in soup.of_dim(dim) {
            let mut word = simplex.to_vec();
            word.sort_unstable();
            tree.insert_with_faces(&word, 0.0).unwrap();
        }
    }
    tree
}

fn model_of(tree: &SimplexTree) -> Model {
    Model { values: tree.iter().map(|simplex| (simplex.word(), simplex.value())).collect() }
}

#[test]
fn simplices_and_cones_collapse_to_a_point() {
    for dim in 1..=9 {
        let mut simplex = tree_of(&[&Vec::from_iter(0..=dim)]);
        let mut model = model_of(&simplex);
        let collapses = simplex.collapse_all(None).unwrap();
        assert_eq!((simplex.counts(), collapses.len()), (&[1][..], (1 << dim) - 1));
        if dim < 7 {
            replay(&mut model, &collapses);
        }
    }
    // Cones over the circle, over the 7-vertex torus, over two points; the apex first, last and in between.
    let torus: Vec<Word> =
        (0..7).flat_map(|i| [vec![i, (i + 1) % 7, (i + 3) % 7], vec![i, (i + 2) % 7, (i + 3) % 7]]).collect();
    let bases = [vec![vec![0, 1], vec![1, 2], vec![0, 2]], torus, vec![vec![0], vec![6]]];
    for base in bases {
        for apex in [0, 50, 7] {
            let mut cone = SimplexTree::new();
            for facet in &base {
                let mut word: Word = facet.iter().map(|&label| 10 * label + 3).chain([10 * apex]).collect();
                word.sort_unstable();
                cone.insert_with_faces(&word, 1.0).unwrap();
            }
            cone.collapse_all(None).unwrap();
            assert_eq!(cone.counts(), [1], "{base:?}");
        }
    }
}

/// Bing's house with two rooms, of squares with a diagonal: a box of 5 × 3 × 2, a floor between its storeys, and for each
/// storey a shaft through the other one, which a wall joins to the outside.
fn bings_house() -> SimplexTree {
    let (sides, holes) = ([5, 3, 2], [([1, 1, 2], 2), ([1, 1, 1], 2), ([3, 1, 0], 2), ([3, 1, 1], 2)]);
    // A square is its least corner and the axis that it is orthogonal to.
    let mut squares: Vec<([u32; 3], usize)> = Vec::new();
    for x in 0..=sides[0] {
        for y in 0..=sides[1] {
            for z in 0..=sides[2] {
                let at = [x, y, z];
                let outside = |axis: usize| at[axis] == 0 || at[axis] == sides[axis];
                let fits = |axis: usize| (0..3).all(|other| other == axis || at[other] < sides[other]);
                let stands = |axis: usize| outside(axis) || axis == 2;
                squares.extend((0..3).filter(|&axis| fits(axis) && stands(axis)).map(|axis| (at, axis)));
            }
        }
    }
    squares.retain(|square| !holes.contains(square));
    for (x, z) in [(1, 1), (3, 0)] {
        squares.extend([([x, 1, z], 0), ([x + 1, 1, z], 0), ([x, 1, z], 1), ([x, 2, z], 1)]);
    }
    squares.extend([([0, 1, 1], 1), ([4, 1, 0], 1)]);
    let mut house = SimplexTree::without_filtration();
    for (corner, axis) in squares {
        let number = |[x, y, z]: [u32; 3]| x + 6 * (y + 4 * z);
        let mut step = [corner, corner];
        step[0][(axis + 1) % 3] += 1;
        step[1][(axis + 2) % 3] += 1;
        let mut far = step[0];
        far[(axis + 2) % 3] += 1;
        for middle in step {
            let mut word = [corner, middle, far].map(number);
            word.sort_unstable();
            house.insert_with_faces(&word, 0.0).unwrap();
        }
    }
    house
}

#[test]
fn what_has_no_free_face_stays() {
    // Contractible, but with no free face: the dunce hat and Bing's house; and a sphere.
    for mut tree in [triangulation("dunce_hat"), bings_house()] {
        assert_eq!(tree.euler_characteristic(), 1);
        let before = tree.clone();
        assert!(tree.iter().all(|simplex| tree.free_coface(&simplex.word()).is_none()));
        assert!(tree.collapse_all(None).unwrap().is_empty());
        assert_eq!(tree, before);
    }
    let mut sphere = tree_of(&[&[0, 1, 2], &[0, 1, 3], &[0, 2, 3], &[1, 2, 3]]);
    assert!(sphere.collapse_all(None).unwrap().is_empty());
    // A sphere without a triangle is a disk.
    assert_eq!(sphere.remove(&[1, 2, 3]), Ok(1));
    sphere.collapse_all(None).unwrap();
    assert_eq!(sphere.counts(), [1]);
}

#[test]
fn a_torus_without_a_triangle_collapses_to_two_circles() {
    let mut torus = SimplexTree::new();
    for i in 0..7 {
        for mut word in [vec![i, (i + 1) % 7, (i + 3) % 7], vec![i, (i + 2) % 7, (i + 3) % 7]] {
            word.sort_unstable();
            torus.insert_with_faces(&word, 0.0).unwrap();
        }
    }
    assert_eq!(torus.counts(), [7, 21, 14]);
    torus.remove(&[0, 1, 3]).unwrap();
    let mut model = model_of(&torus);
    let collapses = torus.collapse_all(None).unwrap();
    replay(&mut model, &collapses);
    model.assert_is(&torus);
    // A graph without a vertex of degree one, of the Euler characteristic of two circles that meet.
    assert_eq!((torus.dim(), torus.euler_characteristic()), (Some(1), -1));
    assert!(model.words().filter(|word| word.len() == 1).all(|word| torus.neighbours(word[0]).len() > 1));
}

/// Known by hand: the contraction of an edge of a triangle is an edge, of an edge of a hollow one closes nothing.
#[test]
fn the_link_condition_tells_apart_full_and_hollow() {
    let full = tree_of(&[&[1, 2, 3]]);
    assert!(full.link_condition(1, 2) && full.link_condition(3, 1));
    let hollow = tree_of(&[&[1, 2], &[2, 3], &[1, 3]]);
    assert!(!hollow.link_condition(1, 2));
    assert!(!hollow.link_condition(1, 1) && !hollow.link_condition(1, 7));
    // The boundary of a tetrahedron: 34 is in both links, 1234 is not there.
    let sphere = tree_of(&[&[1, 2, 3], &[1, 2, 4], &[1, 3, 4], &[2, 3, 4]]);
    assert!(!sphere.link_condition(1, 2));
    // The octahedron: every edge may be contracted.
    let mut octahedron =
        tree_of(&[&[0, 2, 4], &[0, 2, 5], &[0, 3, 4], &[0, 3, 5], &[1, 2, 4], &[1, 2, 5], &[1, 3, 4], &[1, 3, 5]]);
    assert!(octahedron.link_condition(0, 2));
    octahedron.contract_all(1, LinkCondition::Required, None).unwrap();
    assert_eq!(octahedron.counts(), [4, 6, 4]);
    let told = Mutex::new(Vec::new());
    let tell = |done, total| told.lock().unwrap().push((done, total));
    octahedron.contract_all(1, LinkCondition::Ignored, Some(&tell)).unwrap();
    assert_eq!(octahedron.counts(), [1]);
    assert_eq!(told.into_inner().unwrap(), [(1, 3), (2, 3), (3, 3)]);
    assert_eq!(octahedron.contract(0, 1), Err(ContractError::NoEdge(0, 1)));
}

#[test]
fn faults_are_told_and_change_nothing() {
    let mut tree = tree_of(&[&[1, 2], &[2, 3], &[1, 3]]);
    let before = tree.clone();
    let word = |error| Err(InsertError::Word(error));
    assert_eq!(tree.insert(&[], 0.0), word(WordError::Empty));
    assert_eq!(tree.insert(&[2, 1], 0.0), word(WordError::NotIncreasing(1)));
    assert_eq!(tree.insert(&[2, 2], 0.0), word(WordError::NotIncreasing(2)));
    assert_eq!(tree.insert(&[2, u32::MAX], 0.0), word(WordError::ReservedLabel));
    let long: Word = (0..33).collect();
    assert_eq!(tree.insert_with_faces(&long, 0.0), Err(WordError::TooManyVertices { vertices: 33 }.into()));
    assert_eq!(tree.insert_with_prefixes(&[1], f64::NAN), Err(InsertError::NotANumber));
    assert_eq!(tree.insert(&[1, 2, 4], 0.0), Err(InsertError::MissingFacet { facet: vec![2, 4] }));
    let below = InsertError::BelowFacet { value: -1.0, facet: vec![2, 3], facet_value: 0.0 };
    assert_eq!(tree.insert(&[1, 2, 3], -1.0), Err(below));
    assert!(tree.collapse(&[1], &[1, 2]).unwrap_err().to_string().contains("no free pair"));
    assert_eq!(tree.relabel(|label| label / 2), Err(RelabelError::Collision(2, 3, 1)));
    assert_eq!(tree.relabel(|_| u32::MAX), Err(RelabelError::ReservedLabel));
    assert_eq!(tree.set_value(&[1, 4], 0.0), None);
    assert_eq!(tree.insert_flag_edge(1, 4, 0.0, 2), Err(ExpandError::NotAnEdge(1, 4)));
    assert_eq!(tree.remove(&[4]), Ok(0));
    assert_eq!(tree, before);
    tree.insert(&[1, 2, 3], 0.5).unwrap();
    assert_eq!(tree.expand(3), Err(ExpandError::NotAGraph(2)));
    assert_eq!(tree.expand(32), Err(ExpandError::TooManyDimensions(32)));
    // −0 is 0, an infinity is a number.
    tree.insert(&[9], -0.0).unwrap();
    assert!(tree.find(&[9]).unwrap().value().is_sign_positive());
    assert!(tree.insert(&[10], f64::INFINITY).unwrap());
    // A path of the largest dimension.
    let mut deep = SimplexTree::new();
    assert_eq!(deep.insert_with_prefixes(&Vec::from_iter(0..32), 0.0), Ok(true));
    assert_eq!((deep.dim(), deep.num_simplices(), deep.is_closed()), (Some(31), 32, false));
    assert_eq!(deep.find(&Vec::from_iter(0..32)).unwrap().facets().flatten().count(), 1);
    assert_eq!(SimplexTree::new().freeze(), FrozenTree { filtration: Some(Vec::new()), ..FrozenTree::default() });
}

/// The flag complex of a weighted graph by its definition: all cliques of up to so many vertices.
fn cliques(graph: &[(u32, u32)], weights: &[f64], vertices: u32, max_dim: usize) -> Model {
    let weight = |pair: &[u32]| graph.iter().position(|&(a, b)| pair == [a, b]).map(|edge| weights[edge]);
    let all = faces(&Vec::from_iter(0..vertices)).into_iter().filter(|word| word.len() <= max_dim + 1);
    let value = |word: &Word| -> Option<f64> {
        let pairs = faces(word).into_iter().filter(|face| face.len() == 2);
        pairs.map(|pair| weight(&pair)).try_fold(0.0_f64, |most, weight| Some(most.max(weight?)))
    };
    Model { values: all.filter_map(|word| value(&word).map(|value| (word, value))).collect() }
}

fn random_graph(vertices: u32, seed: u64) -> (Vec<(u32, u32)>, Vec<f64>) {
    let mut random = sig_tools::generate::SplitMix64::new(seed);
    let pairs = (0..vertices).flat_map(|a| (a + 1..vertices).map(move |b| (a, b)));
    let edges: Vec<(u32, u32)> = pairs.filter(|_| random.next_below(10) < 7).collect();
    let weights = edges.iter().map(|_| random.next_below(5) as f64 + 1.0).collect();
    (edges, weights)
}

#[test]
fn every_way_of_expanding_gives_all_cliques() {
    for seed in 0..20 {
        let (edges, weights) = random_graph(9, seed);
        let graph = Graph::from_edges(9, &edges, Some(&weights)).unwrap();
        for max_dim in [1, 2, 3, 8] {
            let expected = cliques(&edges, &weights, 9, max_dim);
            let skeleton = SimplexTree::from_graph(&graph).unwrap();
            let mut whole = skeleton.clone();
            whole.expand(max_dim).unwrap();
            expected.assert_is(&whole);
            let mut asked = skeleton.clone();
            asked.expand_with_blocker(max_dim, |_, _| false).unwrap();
            assert_eq!(asked, whole);
            let mut grown = SimplexTree::new();
            (0..9).for_each(|vertex| assert_eq!(grown.insert(&[vertex], 0.0), Ok(true)));
            if seed % 2 == 0 {
                grown.keep_label_lists().unwrap();
            }
            let mut order: Vec<usize> = (0..edges.len()).collect();
            order.sort_by(|&a, &b| weights[a].total_cmp(&weights[b]));
            for edge in order {
                grown.insert_flag_edge(edges[edge].0, edges[edge].1, weights[edge], max_dim).unwrap();
                assert!(grown.is_monotone());
            }
            assert_eq!(grown, whole);
        }
    }
}

#[test]
fn what_is_blocked_does_not_enter_nor_do_its_cofaces() {
    for seed in 0..20 {
        let (edges, weights) = random_graph(9, seed);
        let all = cliques(&edges, &weights, 9, 8);
        let is_blocked = |word: &[u32]| word.iter().sum::<u32>() % 7 == 3;
        let mut tree = SimplexTree::from_graph(&Graph::from_edges(9, &edges, Some(&weights)).unwrap()).unwrap();
        let mut asked = Vec::new();
        tree.expand_with_blocker(8, |word, value| {
            asked.push((word.to_vec(), value));
            is_blocked(word)
        })
        .unwrap();
        let enters = |word: &Word| faces(word).iter().all(|face| face.len() < 3 || !is_blocked(face));
        let values = all.values.iter().filter(|(word, _)| enters(word)).map(|(word, &value)| (word.clone(), value));
        Model { values: values.collect() }.assert_is(&tree);
        // Asked once each, about what has all its facets, with the right value.
        let questions: std::collections::BTreeSet<&Word> = asked.iter().map(|(word, _)| word).collect();
        assert_eq!(questions.len(), asked.len());
        assert!(
            asked.iter().all(|(word, value)| Model::facets(word).iter().all(|facet| facet.len() < 3 || enters(facet))
                && all.values[word] == *value)
        );
    }
}

/// With filtration values; a Rips complex like those that are measured.
#[test]
fn a_simplex_takes_at_most_24_bytes() {
    let options = RadiusOptions { weighted: true, ..RadiusOptions::default() };
    let graph = radius_graph(&sphere4(3000, 1), Metric::Euclidean, 0.4, &options).unwrap();
    let mut tree = SimplexTree::from_graph(&graph).unwrap();
    tree.expand(5).unwrap();
    assert!(tree.num_simplices() > 10_000, "{:?}", tree.counts());
    let (bytes, most) = (tree.bytes(), 24 * tree.num_simplices());
    assert!(bytes <= most, "{bytes} bytes of {most}, {:?}", tree.counts());
}
