//! Sequences of operations, each compared with the same on the plain set.

use std::collections::BTreeSet;

use proptest::prelude::*;
use sig_tools::simplex_tree::{InsertError, LinkCondition, Simplex, SimplexTree};

use crate::model::{Model, Word, faces, union};

/// Labels near each other and far apart.
pub(crate) const LABELS: [u32; 8] = [0, 1, 2, 5, 900, 5_000, 1 << 30, u32::MAX - 1];

pub(crate) fn word() -> impl Strategy<Value = Word> {
    prop::sample::subsequence(LABELS.to_vec(), 1..=5)
}

pub(crate) fn value() -> impl Strategy<Value = f64> {
    (-2..6).prop_map(|halves| f64::from(halves) / 2.0)
}

#[derive(Clone, Debug)]
enum Operation {
    Insert(Word, f64),
    InsertWithFaces(Word, f64),
    Remove(Word),
    Contract(u32, u32),
    CollapseFirst,
    CollapseAll,
    SetValue(Word, f64),
    Relabel(usize),
    PruneValue(f64),
    PruneDim(usize),
    MakeCompact,
    Lists(bool),
    FreezeAndThaw,
    FlagEdge(u32, u32, f64),
}

fn operation() -> impl Strategy<Value = Operation> {
    let label = || prop::sample::select(LABELS.to_vec());
    prop_oneof![
        4 => (word(), value()).prop_map(|(word, value)| Operation::Insert(word, value)),
        8 => (word(), value()).prop_map(|(word, value)| Operation::InsertWithFaces(word, value)),
        4 => word().prop_map(Operation::Remove),
        2 => (label(), label()).prop_map(|(a, b)| Operation::Contract(a, b)),
        2 => Just(Operation::CollapseFirst),
        1 => Just(Operation::CollapseAll),
        2 => (word(), value()).prop_map(|(word, value)| Operation::SetValue(word, value)),
        1 => (0..LABELS.len()).prop_map(Operation::Relabel),
        1 => value().prop_map(Operation::PruneValue),
        1 => (0..4_usize).prop_map(Operation::PruneDim),
        1 => Just(Operation::MakeCompact),
        2 => any::<bool>().prop_map(Operation::Lists),
        1 => Just(Operation::FreezeAndThaw),
        2 => (label(), label(), value()).prop_map(|(a, b, value)| Operation::FlagEdge(a, b, value)),
    ]
}

fn insert(model: &mut Model, tree: &mut SimplexTree, word: &[u32], value: f64) {
    let facets = Model::facets(word);
    let result = tree.insert(word, value);
    if let Some(missing) = facets.iter().find(|&facet| !model.has(facet)) {
        // The facets are looked at in order, for both faults.
        let first = facets.iter().find(|&facet| !model.has(facet) || model.values[facet] > value);
        match result {
            Err(InsertError::MissingFacet { facet }) => {
                assert_eq!(Some(&facet), first.filter(|&first| first == missing));
            }
            Err(InsertError::BelowFacet { facet, .. }) => assert_eq!(Some(&facet), first),
            other => panic!("{other:?}"),
        }
    } else if let Some(larger) = facets.iter().find(|&facet| model.values[facet] > value) {
        let (facet, facet_value) = (larger.clone(), model.values[larger]);
        assert_eq!(result, Err(InsertError::BelowFacet { value, facet, facet_value }));
    } else {
        assert_eq!(result, Ok(!model.has(word)));
        let least = model.values.entry(word.to_vec()).or_insert(value);
        *least = least.min(value);
    }
}

/// Every free pair by the definition, by face.
pub(crate) fn free_pairs(model: &Model) -> Vec<(Word, Word)> {
    let pair = |face: &Word| {
        let mut star = model.star(face);
        star.remove(face);
        if star.len() == 1 { star.pop_first().map(|coface| (face.clone(), coface)) } else { None }
    };
    model.words().filter_map(pair).collect()
}

/// Replays collapses on the model, each of which must be one.
pub(crate) fn replay(model: &mut Model, collapses: &sig_tools::simplex_tree::Collapses) {
    for collapse in collapses.iter() {
        let star = model.star(&collapse.face);
        assert_eq!(star, BTreeSet::from([collapse.face.clone(), collapse.coface.clone()]));
        assert_eq!(model.remove(&collapse.face), 2);
    }
}

fn flag_edge(model: &mut Model, tree: &mut SimplexTree, a: u32, b: u32, value: f64) {
    let edge = union(&[a], &[b]);
    let ends_are_there = model.values.get(&vec![a]).is_some_and(|&end| end <= value)
        && model.values.get(&vec![b]).is_some_and(|&end| end <= value);
    let result = tree.insert_flag_edge(a, b, value, 3);
    if model.has(&edge) && a != b {
        assert_eq!(result, Ok(0));
        return;
    }
    if a == b || !ends_are_there {
        assert!(result.is_err(), "{result:?}");
        return;
    }
    // The new cliques: subsets of all vertices, of up to four, that contain the edge and whose edges are there.
    model.values.insert(edge.clone(), value);
    let vertices: Word = model.words().filter(|word| word.len() == 1).map(|word| word[0]).collect();
    let mut cliques: Vec<Word> = faces(&vertices).into_iter().filter(|word| (3..=4).contains(&word.len())).collect();
    cliques.retain(|word| word.contains(&a) && word.contains(&b));
    let edges = |word: &Word| faces(word).into_iter().filter(|face| face.len() == 2).collect::<Vec<_>>();
    cliques.retain(|word| edges(word).iter().all(|edge| model.has(edge)));
    cliques.sort_by_key(Vec::len);
    assert_eq!(result, Ok(cliques.len() + 1));
    for clique in cliques {
        let value = edges(&clique).iter().map(|edge| model.values[edge]).fold(f64::NEG_INFINITY, f64::max);
        model.values.insert(clique, value);
    }
}

/// Whether the complex is the flag complex of its graph up to dimension 3, each with the largest value of its edges.
fn is_flag(model: &Model) -> bool {
    let vertices: Word = model.words().filter(|word| word.len() == 1).map(|word| word[0]).collect();
    faces(&vertices).into_iter().filter(|word| word.len() > 2).all(|word| {
        let edges: Vec<Word> = faces(&word).into_iter().filter(|face| face.len() == 2).collect();
        let is_clique = edges.iter().all(|edge| model.has(edge));
        let value = edges.iter().filter_map(|edge| model.values.get(edge)).copied().fold(f64::NEG_INFINITY, f64::max);
        match model.values.get(&word) {
            Some(&other) => word.len() <= 4 && other == value,
            None => word.len() > 4 || !is_clique,
        }
    })
}

fn apply(operation: Operation, model: &mut Model, tree: &mut SimplexTree) {
    match operation {
        Operation::Insert(word, value) => insert(model, tree, &word, value),
        Operation::InsertWithFaces(word, value) => {
            assert_eq!(tree.insert_with_faces(&word, value), Ok(model.insert_with_faces(&word, value)));
        }
        Operation::Remove(word) => assert_eq!(tree.remove(&word), Ok(model.remove(&word))),
        Operation::Contract(a, b) => {
            let is_edge = a != b && model.has(&union(&[a], &[b]));
            assert_eq!(tree.contract(a, b).is_ok(), is_edge);
            if is_edge {
                model.contract(a, b);
            }
        }
        Operation::CollapseFirst => {
            if let Some((face, coface)) = free_pairs(model).first() {
                let before = model.euler();
                assert_eq!(tree.collapse(face, coface), Ok(()));
                assert_eq!(model.remove(face), 2);
                assert_eq!(tree.euler_characteristic(), before);
            }
        }
        Operation::CollapseAll => {
            let collapses = tree.collapse_all(None).unwrap();
            replay(model, &collapses);
            assert_eq!(free_pairs(model), []);
        }
        Operation::SetValue(word, value) => {
            let before = model.values.get(&word).copied();
            assert_eq!(tree.set_value(&word, value), before);
            if before.is_some() {
                model.values.insert(word, value);
            }
            assert_eq!(tree.is_monotone(), model.is_monotone());
            // The least values that are monotone: the largest over all faces.
            let most = |word: &Word| faces(word).iter().map(|face| model.values[face]).fold(f64::MIN, f64::max);
            let monotone = model.values.keys().map(|word| (word.clone(), most(word))).collect();
            let raised = model.values.iter().filter(|&(word, &value)| most(word) > value).count();
            assert_eq!(tree.make_monotone(), raised);
            model.values = monotone;
        }
        Operation::Relabel(rotation) => {
            let rotate = |label: u32| {
                let at = LABELS.iter().position(|&other| other == label).unwrap();
                LABELS[(at + rotation) % LABELS.len()]
            };
            tree.relabel(rotate).unwrap();
            let rename = |word: &Word| union(&word.iter().map(|&label| rotate(label)).collect::<Word>(), &[]);
            model.values = model.values.iter().map(|(word, &value)| (rename(word), value)).collect();
        }
        Operation::PruneValue(value) => {
            let before = model.values.len();
            model.values.retain(|_, other| *other <= value);
            assert_eq!(tree.prune_above_value(value), Ok(before - model.values.len()));
        }
        Operation::PruneDim(dim) => {
            let before = model.values.len();
            model.values.retain(|word, _| word.len() <= dim + 1);
            assert_eq!(tree.prune_above_dim(dim), Ok(before - model.values.len()));
        }
        Operation::MakeCompact => tree.make_compact().unwrap(),
        Operation::Lists(true) => tree.keep_label_lists().unwrap(),
        Operation::Lists(false) => tree.drop_label_lists().unwrap(),
        Operation::FreezeAndThaw => {
            let (thawed, _) = SimplexTree::thaw(&tree.freeze()).unwrap();
            assert_eq!(&thawed, tree);
            let listed = tree.has_label_lists();
            *tree = thawed;
            if listed {
                tree.keep_label_lists().unwrap();
            }
        }
        Operation::FlagEdge(a, b, value) => {
            if is_flag(model) {
                flag_edge(model, tree, a, b, value);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn sequences_of_operations_do_what_they_do_to_a_set_of_words(
        operations in prop::collection::vec(operation(), 1..40)
    ) {
        let (mut model, mut tree) = (Model::default(), SimplexTree::new());
        for operation in operations {
            apply(operation, &mut model, &mut tree);
            model.assert_is(&tree);
            assert!(tree.is_closed());
            for &label in &LABELS {
                let star: BTreeSet<Word> = tree.star(&[label]).map(Simplex::word).collect();
                assert_eq!(star, model.star(&[label]));
            }
        }
        // Lists or none, compact or not, it is the same tree.
        let mut other = tree.clone();
        other.keep_label_lists().unwrap();
        assert_eq!(other, tree);
        crate::queries::check(&model, &other);
        crate::queries::check(&model, &tree);
    }

    /// Simplices in any order, with nothing but the prefixes of their words.
    #[test]
    fn words_in_any_order_make_the_complex_in_the_end(words in prop::collection::vec((word(), value()), 1..6), seed in any::<u64>()) {
        let (model, _) = crate::model::both(&words);
        let mut shuffled: Vec<(Word, f64)> = model.values.clone().into_iter().collect();
        let mut random = sig_tools::generate::SplitMix64::new(seed);
        for last in (1..shuffled.len()).rev() {
            shuffled.swap(last, random.next_below(last + 1));
        }
        let mut tree = SimplexTree::new();
        for (word, value) in &shuffled {
            tree.insert_with_prefixes(word, *value).unwrap();
        }
        model.assert_is(&tree);
    }

    #[test]
    fn contractions_that_ask_for_the_link_condition_keep_the_euler_characteristic(
        words in prop::collection::vec((word(), value()), 1..12)
    ) {
        let (mut model, mut tree) = crate::model::both(&words);
        let before = model.euler();
        for contraction in tree.contract_all(1, LinkCondition::Required, None).unwrap() {
            model.contract(contraction.kept, contraction.removed);
        }
        model.assert_is(&tree);
        assert_eq!(model.euler(), before);
        for edge in model.words().filter(|word| word.len() == 2) {
            assert!(model.counts()[0] == 1 || !crate::queries::link_condition(&model, edge[0], edge[1]), "{edge:?}");
        }
    }
}
