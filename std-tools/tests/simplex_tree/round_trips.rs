//! Frozen, written to a file of kind *sig*, and thawed: nothing is lost.

use proptest::prelude::*;
use sig_core::{AnyComplex, with_complex};
use sig_tools::build::{BuildOptions, build};
use sig_tools::frozen::{FrozenTree, LastVertices};
use sig_tools::simplex_tree::{SimplexTree, ThawError};
use sig_tools::soup::{Coordinates, Labels, Scalars, Soup};
use sig_tools::store::{EncodeOptions, Encoding};

use crate::model::{Word, both};
use crate::operations::{LABELS, value, word};

fn small() -> FrozenTree {
    let mut tree = SimplexTree::new();
    tree.insert_with_faces(&[10, 20, 30], 2.0).unwrap();
    tree.insert_with_faces(&[30, 40], 1.0).unwrap();
    tree.freeze()
}

#[test]
fn a_frozen_tree_is_the_level_order() {
    let frozen = small();
    assert_eq!(frozen.first, [0, 4, 8]);
    assert_eq!(frozen.num_simplices, 9);
    // Edges 01 02 12 23, triangle 012.
    assert_eq!(frozen.child_offsets, [4, 6, 7, 8, 8, 9, 9, 9, 9]);
    assert_eq!(frozen.last_vertices, LastVertices::Bits16(vec![0, 1, 2, 3, 1, 2, 2, 3, 2]));
    assert_eq!(frozen.filtration, Some(vec![2.0, 2.0, 1.0, 1.0, 2.0, 2.0, 2.0, 1.0, 2.0]));
    assert_eq!(frozen.labels, Labels::Integers(vec![10, 20, 30, 40]));
}

#[test]
fn names_and_coordinates_come_back_for_the_vertices_that_are_left() {
    let mut frozen = small();
    frozen.labels = Labels::Tokens(["d", "b", "c", "a"].map(Box::from).to_vec());
    frozen.coordinates = Some(Coordinates { dim: 2, values: Scalars::F32((0..8_u8).map(f32::from).collect()) });
    let (mut tree, vertices) = SimplexTree::thaw(&frozen).unwrap();
    let mut again = tree.freeze();
    vertices.restore(&mut again);
    assert_eq!(again, frozen);
    assert_eq!(vertices.find("c"), Some(2));
    assert_eq!(vertices.name(2), "c");
    assert_eq!(vertices.find("e"), None);
    tree.remove(&[1]).unwrap();
    let mut again = tree.freeze();
    vertices.restore(&mut again);
    assert_eq!(again.labels, Labels::Tokens(["d", "c", "a"].map(Box::from).to_vec()));
    let left = Scalars::F32([0_u8, 1, 4, 5, 6, 7].map(f32::from).to_vec());
    assert_eq!(again.coordinates, Some(Coordinates { dim: 2, values: left }));
    // Integers that do not increase are names, others are the labels of the tree.
    for (names, in_tree) in [(vec![7, 5, 6, 8], 1), (vec![5, 7, u64::MAX, 9], 1), (vec![3, 5, 7, 9], 5)] {
        frozen.labels = Labels::Integers(names.clone());
        let (tree, vertices) = SimplexTree::thaw(&frozen).unwrap();
        let mut again = tree.freeze();
        vertices.restore(&mut again);
        assert_eq!(again, frozen);
        assert_eq!(vertices.find(&names[1].to_string()), Some(in_tree));
        assert_eq!(vertices.name(in_tree), names[1].to_string());
    }
}

#[test]
fn a_file_thaws_with_its_own_words() {
    let mut soup = Soup::new(Labels::Tokens(["x", "a", "m", "b"].map(Box::from).to_vec()), false);
    soup.push(&[0, 1, 2]);
    soup.push(&[3, 2]);
    let built = build(soup, &BuildOptions::default()).unwrap();
    for tree in [true, false] {
        let bytes =
            Encoding::new(&built, &EncodeOptions { tree, ..EncodeOptions::default() }).unwrap().to_bytes().unwrap();
        let complex = AnyComplex::from_bytes(&bytes).unwrap();
        let (tree, vertices) = with_complex!(complex, complex => SimplexTree::thaw_complex(&complex)).unwrap();
        assert!(!tree.has_filtration());
        // a b m x are vertices 0 1 2 3.
        let words: Vec<Word> = tree.maximal_simplices().into_iter().map(|simplex| simplex.word()).collect();
        assert_eq!(words, [vec![1, 2], vec![0, 2, 3]]);
        assert_eq!(words[1].iter().map(|&label| vertices.name(label)).collect::<String>(), "amx");
    }
}

#[test]
fn damaged_arrays_are_refused() {
    let good = small();
    let damages: [fn(&mut FrozenTree); 6] = [
        |tree| tree.child_offsets[0] = 0,
        |tree| tree.child_offsets[1] = 9,
        |tree| tree.last_vertices = LastVertices::Bits16(vec![0; 9]),
        |tree| tree.last_vertices = LastVertices::Bits16(Vec::new()),
        |tree| tree.filtration = Some(vec![f64::NAN; 9]),
        |tree| tree.num_simplices = 12,
    ];
    for damage in damages {
        let mut frozen = good.clone();
        damage(&mut frozen);
        assert!(matches!(SimplexTree::thaw(&frozen), Err(ThawError::Damaged(_))));
    }
}

proptest! {
    #[test]
    fn freezing_and_thawing_is_the_identity(words in prop::collection::vec((word(), value()), 0..10)) {
        let (model, tree) = both(&words);
        let frozen = tree.freeze();
        prop_assert_eq!(frozen.num_simplices, model.values.len());
        let (thawed, vertices) = SimplexTree::thaw(&frozen).unwrap();
        prop_assert_eq!(&thawed, &tree);
        let mut again = thawed.freeze();
        vertices.restore(&mut again);
        prop_assert_eq!(again, frozen);
        prop_assert!(LABELS.iter().all(|&label| vertices.find(&label.to_string()) == tree.find(&[label]).map(|_| label)));
    }
}
