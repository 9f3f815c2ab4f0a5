//! The expansion equals the definition: all subsets of vertices that are cliques, in canonical order.

use proptest::prelude::*;
use sig_tools::flag::{FlagOptions, expand};
use sig_tools::frozen::{FrozenTree, LastVertices};
use sig_tools::graph::Graph;
use sig_tools::soup::Labels;

/// All sorted words of the simplices, read off the tree by its children.
pub(crate) fn words(tree: &FrozenTree) -> Vec<Vec<u32>> {
    let mut words: Vec<Vec<u32>> = (0..tree.num_vertices()).map(|id| vec![tree.last_vertices.at(id)]).collect();
    for parent in 0..tree.num_simplices {
        for child in tree.children(parent) {
            assert_eq!(child, words.len(), "children have consecutive numbers");
            let word = [words[parent].as_slice(), &[tree.last_vertices.at(child)]].concat();
            words.push(word);
        }
    }
    words
}

/// A graph as its edges with weights, and the weights of its vertices.
#[derive(Clone, Debug)]
struct Sample {
    num_vertices: usize,
    edges: Vec<(u32, u32)>,
    weights: Vec<f64>,
    vertex_weights: Vec<f64>,
}

impl Sample {
    fn weight(&self, a: u32, b: u32) -> Option<f64> {
        let of_edge = self.edges.iter().zip(&self.weights).filter(|(edge, _)| **edge == (a, b) || **edge == (b, a));
        of_edge.map(|(_, &weight)| weight).reduce(f64::min)
    }

    /// The value of a clique; nothing if it is none.
    fn value(&self, word: &[u32]) -> Option<f64> {
        let mut value = word.iter().map(|&vertex| self.vertex_weights[vertex as usize]).fold(f64::MIN, f64::max);
        for (k, &b) in word.iter().enumerate() {
            for &a in &word[..k] {
                value = value.max(self.weight(a, b)?);
            }
        }
        Some(value)
    }

    /// All cliques of up to `max_dim` + 1 vertices, by dimension, then lexicographically, with their values.
    fn cliques(&self, max_dim: usize) -> Vec<(Vec<u32>, f64)> {
        let subsets = (1_u32..1 << self.num_vertices).filter(|subset| subset.count_ones() as usize <= max_dim + 1);
        let words = subsets.map(|subset| (0..32).filter(|vertex| subset >> vertex & 1 == 1).collect::<Vec<u32>>());
        let mut cliques: Vec<_> = words.filter_map(|word| Some((self.value(&word)?, word))).collect();
        cliques.sort_by(|a, b| (a.1.len(), &a.1).cmp(&(b.1.len(), &b.1)));
        cliques.into_iter().map(|(value, word)| (word, value)).collect()
    }

    fn graph(&self) -> Graph {
        let graph = Graph::from_edges(self.num_vertices, &self.edges, Some(&self.weights)).unwrap();
        graph.with_vertex_weights(self.vertex_weights.clone()).unwrap()
    }
}

fn samples() -> impl Strategy<Value = Sample> {
    (0_usize..11).prop_flat_map(|num_vertices| {
        let pairs = (0..num_vertices as u32).flat_map(|b| (0..b).map(move |a| (a, b))).collect::<Vec<_>>();
        let most = pairs.len();
        let edges = prop::sample::subsequence(pairs, 0..=most);
        let vertex_weights = prop::collection::vec(-2_i32..2, num_vertices);
        (edges, vertex_weights).prop_flat_map(move |(edges, vertex_weights)| {
            let count = edges.len();
            let vertex_weights: Vec<f64> = vertex_weights.into_iter().map(f64::from).collect();
            prop::collection::vec(1_i32..9, count).prop_map(move |weights| Sample {
                num_vertices,
                edges: edges.clone(),
                weights: weights.into_iter().map(|weight| f64::from(weight) / 2.0 + 0.5).collect(),
                vertex_weights: vertex_weights.clone(),
            })
        })
    })
}

fn options(max_dim: usize) -> FlagOptions<'static> {
    FlagOptions { max_dim, ..FlagOptions::default() }
}

proptest! {
    #[test]
    fn all_cliques_and_their_values(sample in samples(), max_dim in 0_usize..12) {
        let tree = expand(&sample.graph(), &options(max_dim)).unwrap();
        let (expected, values): (Vec<_>, Vec<_>) = sample.cliques(max_dim).into_iter().unzip();
        prop_assert_eq!(words(&tree), expected);
        prop_assert_eq!(tree.filtration, Some(values));
        prop_assert_eq!(tree.labels, Labels::Numbered(sample.num_vertices));
        prop_assert_eq!(tree.coordinates, None);
        prop_assert!(matches!(tree.last_vertices, LastVertices::Bits16(_)));
    }

    /// The same complex among so many isolated vertices that the ids of vertices take 32 bits.
    #[test]
    fn wide_vertex_ids(sample in samples(), offset in 0_u32..70_000) {
        let edges: Vec<_> = sample.edges.iter().map(|&(a, b)| (a + offset, b + offset)).collect();
        let narrow = expand(&sample.graph(), &options(12)).unwrap();
        let wide = expand(&Graph::from_edges(80_000, &edges, None).unwrap(), &options(12)).unwrap();
        prop_assert!(matches!(wide.last_vertices, LastVertices::Bits32(_)));
        prop_assert_eq!(wide.filtration.as_ref(), None);
        let shifted = |word: &Vec<u32>| word.iter().map(|vertex| vertex + offset).collect::<Vec<_>>();
        let expected: Vec<_> = words(&narrow).iter().filter(|word| word.len() > 1).map(shifted).collect();
        prop_assert_eq!(&words(&wide)[80_000..], expected);
    }
}

/// Random graphs with more neighbours than a row has bits, against plain recursion over sorted sets.
#[test]
fn vertices_with_many_neighbours() {
    for (num_vertices, percent, max_dim) in [(70, 95, 3), (150, 60, 4), (400, 30, 3), (1500, 4, 9)] {
        let mut random = sig_tools::generate::SplitMix64::new(num_vertices);
        let mut edges = Vec::new();
        let mut weights = Vec::new();
        for b in 0..num_vertices as u32 {
            for a in 0..b {
                if random.next_below(100) < percent {
                    edges.push((a, b));
                    weights.push(random.next_unit());
                }
            }
        }
        let graph = Graph::from_edges(num_vertices as usize, &edges, Some(&weights)).unwrap();
        let mut adjacent = vec![std::collections::BTreeMap::new(); num_vertices as usize];
        for (&(a, b), &weight) in edges.iter().zip(&weights) {
            adjacent[a as usize].insert(b, weight);
        }
        let mut expected: Vec<Vec<(Vec<u32>, f64)>> = vec![Vec::new(); max_dim + 1];
        for vertex in 0..num_vertices as u32 {
            let candidates: Vec<u32> = adjacent[vertex as usize].keys().copied().collect();
            recurse(&adjacent, &mut vec![vertex], &candidates, 0.0, &mut expected);
        }
        while expected.pop_if(|level| level.is_empty()).is_some() {}
        let tree = expand(&graph, &options(max_dim)).unwrap();
        let (words_expected, values): (Vec<_>, Vec<_>) = expected.into_iter().flatten().unzip();
        assert!(words(&tree) == words_expected, "{num_vertices} vertices, {percent} % of all edges");
        assert!(tree.filtration == Some(values), "{num_vertices} vertices, {percent} % of all edges");
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| expand(&graph, &options(max_dim))).unwrap()
        };
        assert!(with(1) == tree && with(3) == tree);
    }
}

fn recurse(
    adjacent: &[std::collections::BTreeMap<u32, f64>],
    word: &mut Vec<u32>,
    candidates: &[u32],
    value: f64,
    found: &mut [Vec<(Vec<u32>, f64)>],
) {
    let Some((level, rest)) = found.split_first_mut() else { return };
    level.push((word.clone(), value));
    for &next in candidates {
        let later: Vec<u32> =
            candidates.iter().copied().filter(|other| adjacent[next as usize].contains_key(other)).collect();
        let value = word.iter().map(|&vertex| adjacent[vertex as usize][&next]).fold(value, f64::max);
        word.push(next);
        recurse(adjacent, word, &later, value, rest);
        word.pop();
    }
}
