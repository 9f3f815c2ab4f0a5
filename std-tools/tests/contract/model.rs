//! Contraction by its definition, on lists of words: slow and obvious.

use std::collections::{BTreeMap, BTreeSet};

use sig_core::VertexId;
use sig_tools::build::{BuildOptions, Built, VertexOrder, build};
use sig_tools::contract::Edge;
use sig_tools::soup::{Coordinates, Labels, Scalars, Soup};

/// A complex as the oriented words of its top simplices, the labels of its vertices in their order, and a value for each
/// simplex.
#[derive(Clone, Debug)]
pub(crate) struct Model {
    pub(crate) tops: Vec<Vec<u32>>,
    pub(crate) labels: Vec<u32>,
    pub(crate) values: BTreeMap<Vec<u32>, u32>,
}

pub(crate) fn edge(kept: u32, removed: u32) -> Edge {
    Edge { kept: VertexId::new(kept as usize), removed: VertexId::new(removed as usize) }
}

pub(crate) fn sorted(word: &[u32]) -> Vec<u32> {
    word.iter().copied().collect::<BTreeSet<_>>().into_iter().collect()
}

/// All nonempty subsets, each in increasing order.
pub(crate) fn faces(word: &[u32]) -> Vec<Vec<u32>> {
    let word = sorted(word);
    let chosen = |subset: u32| word.iter().enumerate().filter(move |&(k, _)| subset >> k & 1 == 1).map(|(_, &v)| v);
    (1_u32..1 << word.len()).map(|subset| chosen(subset).collect()).collect()
}

impl Model {
    /// All faces of the given simplices, and the vertices 0..`count`. The value of a simplex is the sum over its faces of
    /// numbers that the seed makes up, so that it grows along faces.
    pub(crate) fn new(count: u32, simplices: &[Vec<u32>], seed: u32) -> Self {
        let listed: Vec<Vec<u32>> = simplices.iter().cloned().chain((0..count).map(|vertex| vec![vertex])).collect();
        let is_face = |a: &[u32], b: &[u32]| a.len() < b.len() && a.iter().all(|vertex| b.contains(vertex));
        let mut tops: Vec<Vec<u32>> =
            listed.iter().filter(|a| !listed.iter().any(|b| is_face(a, b))).cloned().collect();
        // The first of those on the same vertices decides.
        let mut seen = BTreeSet::new();
        tops.retain(|top| seen.insert(sorted(top)));
        let noise = |word: &[u32]| {
            word.iter().fold(seed, |sum, &vertex| sum.wrapping_mul(31).wrapping_add(vertex + 7).rotate_left(9)) % 50
        };
        let all: BTreeSet<Vec<u32>> = tops.iter().flat_map(|top| faces(top)).collect();
        let values = all.into_iter().map(|word| (faces(&word).iter().map(|face| noise(face)).sum(), word));
        Self { values: values.map(|(value, word)| (word, value)).collect(), tops, labels: (0..count).collect() }
    }

    pub(crate) fn edges(&self) -> Vec<(u32, u32)> {
        let edges = self.values.keys().filter(|word| word.len() == 2);
        edges.flat_map(|word| [(word[0], word[1]), (word[1], word[0])]).collect()
    }

    pub(crate) fn contracted(&self, kept: u32, removed: u32) -> Self {
        let id = |vertex: u32| if vertex > removed { vertex - 1 } else { vertex };
        let image = |word: &Vec<u32>| -> Vec<u32> {
            if word.contains(&kept) && word.contains(&removed) {
                // A face of the simplex: it has no orientation of its own.
                return sorted(
                    &word.iter().filter(|&&vertex| vertex != removed).map(|&vertex| id(vertex)).collect::<Vec<_>>(),
                );
            }
            word.iter().map(|&vertex| id(if vertex == removed { kept } else { vertex })).collect()
        };
        let mut labels = self.labels.clone();
        labels.remove(removed as usize);
        let mut values: BTreeMap<Vec<u32>, u32> = BTreeMap::new();
        for (word, &value) in &self.values {
            let least = values.entry(sorted(&image(word))).or_insert(value);
            *least = value.min(*least);
        }
        Self { tops: self.tops.iter().map(image).collect(), labels, values }
    }

    /// What the builder makes of it: the images of the top simplices, with labels, coordinates and values.
    pub(crate) fn built(&self) -> Built {
        let labels = Labels::Integers(self.labels.iter().map(|&label| label.into()).collect());
        let mut soup = Soup::new(labels, true);
        let coordinates = self.labels.iter().flat_map(|&label| [label as f32, 0.5 * label as f32]).collect();
        soup.coordinates = Some(Coordinates { dim: 2, values: Scalars::F32(coordinates) });
        self.tops.iter().for_each(|top| soup.push(top));
        let options = BuildOptions { order: VertexOrder::Input, ..BuildOptions::default() };
        let mut built = build(soup, &options).expect("a good soup");
        let mut words: Vec<&Vec<u32>> = self.values.keys().collect();
        words.sort_by_key(|word| (word.len(), (*word).clone()));
        built.filtration = Some(words.into_iter().map(|word| f64::from(self.values[word])).collect());
        built
    }
}

/// The sign of a word as a permutation of its vertices in increasing order.
fn is_odd(word: &[u32]) -> bool {
    let inversions = word.iter().enumerate().flat_map(|(k, a)| word[k..].iter().filter(move |b| *b < a));
    inversions.count() % 2 == 1
}

impl Model {
    /// The same complex by its top simplices alone, each once: increasing if they come in both orientations.
    pub(crate) fn cleaned(self) -> Self {
        let is_face = |a: &[u32], b: &[u32]| a.len() < b.len() && a.iter().all(|vertex| b.contains(vertex));
        let mut signs: BTreeMap<Vec<u32>, (bool, bool)> = BTreeMap::new();
        for top in self.tops.iter().filter(|a| !self.tops.iter().any(|b| is_face(a, b))) {
            let (even, odd) = signs.entry(sorted(top)).or_default();
            *(if is_odd(top) { odd } else { even }) = true;
        }
        let oriented = |(mut word, (even, _)): (Vec<u32>, (bool, bool))| {
            if let ([.., a, b], false) = (word.as_mut_slice(), even) {
                std::mem::swap(a, b);
            }
            word
        };
        Self { tops: signs.into_iter().map(oriented).collect(), ..self }
    }
}
