//! The oracle: a complex as a sorted map from words to filtration values, every question by its definition.

use std::collections::{BTreeMap, BTreeSet};

use sig_tools::simplex_tree::SimplexTree;

pub(crate) type Word = Vec<u32>;

/// A complex as all its words.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct Model {
    pub(crate) values: BTreeMap<Word, f64>,
}

/// The words whose vertices are among those of a word, itself among them.
pub(crate) fn faces(word: &[u32]) -> Vec<Word> {
    let subsets = 1_u64..1 << word.len();
    let pick = |mask: u64| word.iter().enumerate().filter(move |(at, _)| mask >> at & 1 == 1).map(|(_, &label)| label);
    subsets.map(|mask| pick(mask).collect()).collect()
}

pub(crate) fn is_face(face: &[u32], of: &[u32]) -> bool {
    face.iter().all(|label| of.contains(label))
}

/// The facet without the vertex at a place.
pub(crate) fn facet(word: &[u32], omitted: usize) -> Word {
    let mut facet = word.to_vec();
    facet.remove(omitted);
    facet
}

pub(crate) fn union(a: &[u32], b: &[u32]) -> Word {
    a.iter().chain(b).copied().collect::<BTreeSet<_>>().into_iter().collect()
}

impl Model {
    pub(crate) fn has(&self, word: &[u32]) -> bool {
        self.values.contains_key(word)
    }

    pub(crate) fn words(&self) -> impl Iterator<Item = &Word> {
        self.values.keys()
    }

    /// The proper faces one dimension lower.
    pub(crate) fn facets(word: &[u32]) -> Vec<Word> {
        if word.len() == 1 { Vec::new() } else { (0..word.len()).map(|omitted| facet(word, omitted)).collect() }
    }

    pub(crate) fn star(&self, word: &[u32]) -> BTreeSet<Word> {
        let cofaces = self.words().filter(|other| is_face(word, other)).cloned().collect();
        if self.has(word) { cofaces } else { BTreeSet::new() }
    }

    pub(crate) fn link(&self, word: &[u32]) -> BTreeSet<Word> {
        let apart = |other: &&Word| other.iter().all(|label| !word.contains(label));
        let joined = |other: &&Word| self.has(&union(word, other));
        self.words().filter(apart).filter(joined).cloned().collect()
    }

    pub(crate) fn maximal(&self) -> BTreeSet<Word> {
        self.words().filter(|word| self.star(word).len() == 1).cloned().collect()
    }

    pub(crate) fn is_monotone(&self) -> bool {
        self.values.iter().all(|(word, value)| faces(word).iter().all(|face| self.values[face] <= *value))
    }

    pub(crate) fn insert_with_faces(&mut self, word: &[u32], value: f64) -> usize {
        let before = self.values.len();
        for face in faces(word) {
            let least = self.values.entry(face).or_insert(value);
            *least = least.min(value);
        }
        self.values.len() - before
    }

    pub(crate) fn remove(&mut self, word: &[u32]) -> usize {
        let star = self.star(word);
        self.values.retain(|other, _| !star.contains(other));
        star.len()
    }

    /// The image under b ↦ a, with the least values over the preimages.
    pub(crate) fn contract(&mut self, a: u32, b: u32) {
        let mut image = BTreeMap::new();
        for (word, &value) in &self.values {
            let renamed: Word = word.iter().map(|&label| if label == b { a } else { label }).collect();
            let least = image.entry(union(&renamed, &[])).or_insert(value);
            *least = value.min(*least);
        }
        self.values = image;
    }

    pub(crate) fn counts(&self) -> Vec<usize> {
        let dims = self.words().map(Vec::len).max().unwrap_or(0);
        (1..=dims).map(|len| self.words().filter(|word| word.len() == len).count()).collect()
    }

    pub(crate) fn euler(&self) -> i64 {
        self.words().map(|word| if word.len() % 2 == 1 { 1 } else { -1 }).sum()
    }

    /// The same simplices and values as a tree's, in depth-first order.
    pub(crate) fn assert_is(&self, tree: &SimplexTree) {
        let found: Vec<(Word, f64)> = tree.iter().map(|simplex| (simplex.word(), simplex.value())).collect();
        let expected: Vec<(Word, f64)> = self.values.iter().map(|(word, &value)| (word.clone(), value)).collect();
        assert_eq!(found, expected);
        assert_eq!(tree.counts(), self.counts());
        assert_eq!(tree.euler_characteristic(), self.euler());
    }
}

/// The model and the tree of the faces of some words, each with a value.
pub(crate) fn both(words: &[(Word, f64)]) -> (Model, SimplexTree) {
    let (mut model, mut tree) = (Model::default(), SimplexTree::new());
    for (word, value) in words {
        let new = model.insert_with_faces(word, *value);
        assert_eq!(tree.insert_with_faces(word, *value), Ok(new));
    }
    (model, tree)
}

/// The tree of the faces of some words.
pub(crate) fn tree_of(words: &[&[u32]]) -> SimplexTree {
    let mut tree = SimplexTree::new();
    for word in words {
        tree.insert_with_faces(word, 0.0).expect("a word");
    }
    tree
}
