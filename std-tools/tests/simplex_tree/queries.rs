//! Every question about every subset of the labels, by its definition.

use std::collections::BTreeSet;

use sig_tools::simplex_tree::{Simplex, SimplexTree};

use crate::model::{Model, Word, faces};
use crate::operations::LABELS;

/// Lk(a) ∩ Lk(b) = Lk(ab), for an edge.
pub(crate) fn link_condition(model: &Model, a: u32, b: u32) -> bool {
    let (a, b) = (a.min(b), a.max(b));
    let common: BTreeSet<Word> = model.link(&[a]).intersection(&model.link(&[b])).cloned().collect();
    a != b && model.has(&[a, b]) && common == model.link(&[a, b])
}

fn words<'a>(simplices: impl Iterator<Item = Simplex<'a>>) -> BTreeSet<Word> {
    simplices.map(Simplex::word).collect()
}

pub(crate) fn check(model: &Model, tree: &SimplexTree) {
    for word in faces(&LABELS) {
        check_word(model, tree, &word);
    }
    for &a in &LABELS {
        let edges = model.star(&[a]).into_iter().filter(|word| word.len() == 2);
        let neighbours: BTreeSet<u32> = edges.flatten().filter(|&label| label != a).collect();
        assert_eq!(tree.neighbours(a), Vec::from_iter(neighbours));
        for &b in &LABELS {
            assert_eq!(tree.link_condition(a, b), link_condition(model, a, b), "{a} {b}");
        }
    }
    assert_eq!(words(tree.maximal_simplices().into_iter()), model.maximal());
    for dim in 0..4 {
        let skeleton = model.words().filter(|word| word.len() <= dim + 1).cloned().collect();
        assert_eq!(words(tree.skeleton(dim)), skeleton);
    }
    let mut expected: Vec<(&Word, &f64)> = model.values.iter().collect();
    expected.sort_by_key(|(word, _)| (word.len(), *word));
    let by_dimension: Vec<Word> = tree.by_dimension().map(Simplex::word).collect();
    assert!(by_dimension.iter().eq(expected.iter().map(|&(word, _)| word)));
    expected.sort_by(|a, b| a.1.total_cmp(b.1));
    let by_filtration: Vec<Word> = tree.by_filtration().map(Simplex::word).collect();
    assert!(by_filtration.iter().eq(expected.iter().map(|&(word, _)| word)));
    assert_eq!(tree.is_monotone(), model.is_monotone());
}

fn check_word(model: &Model, tree: &SimplexTree, word: &[u32]) {
    let found = tree.find(word);
    assert_eq!(found.is_some(), model.has(word), "{word:?}");
    assert_eq!(words(tree.star(word)), model.star(word));
    for codim in 0..3 {
        let expected = model.star(word).into_iter().filter(|coface| coface.len() == word.len() + codim).collect();
        assert_eq!(words(tree.cofaces(word, codim)), expected);
    }
    let link = tree.link(word);
    let expected = if model.has(word) { model.link(word) } else { BTreeSet::new() };
    assert_eq!(words(link.iter()), expected, "the link of {word:?}");
    assert!(link.iter().all(|simplex| simplex.value() == model.values[&simplex.word()]));
    let mut proper = model.star(word);
    proper.remove(word);
    let free = if proper.len() == 1 { proper.pop_first() } else { None };
    assert_eq!(tree.free_coface(word).map(Simplex::word), free);
    let Some(simplex) = found else { return };
    assert_eq!((simplex.word(), simplex.dim()), (word.to_vec(), word.len() - 1));
    assert_eq!((Some(&simplex.label()), simplex.value()), (word.last(), model.values[word]));
    let facets: Vec<Word> = simplex.facets().map(|facet| facet.expect("a complex").word()).collect();
    assert_eq!(facets, Model::facets(word));
    assert_eq!(simplex.parent().map_or(Vec::new(), Simplex::word), word[..word.len() - 1]);
    let with_parent = |parent: &[u32]| -> BTreeSet<Word> {
        let is_child = |other: &&Word| other.len() == parent.len() + 1 && other.starts_with(parent);
        model.words().filter(is_child).cloned().collect()
    };
    assert_eq!(words(simplex.children()), with_parent(word));
    assert_eq!(words(simplex.siblings()), with_parent(&word[..word.len() - 1]));
    let below: BTreeSet<Word> = model.words().filter(|other| other.starts_with(word)).cloned().collect();
    assert_eq!(words(simplex.descendants()), below);
}
