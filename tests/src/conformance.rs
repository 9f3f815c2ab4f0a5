//! A view compared with the oracle: every relation, of every simplex.

use sig_core::{Complex, Index, Relations, Scratch, SimplexId, Tree, VertexId, mark_words};
use sig_tools::baselines::Structure;

use crate::oracle::Oracle;
use crate::paper;

/// Memory for the queries on one complex.
#[derive(Clone, Debug)]
pub struct Memory<I> {
    /// Words of marks.
    pub marks: Vec<u32>,
    /// Entries of the queue.
    pub queue: Vec<I>,
    /// Masks of the queue.
    pub masks: Vec<u32>,
    /// Entries of an answer.
    pub found: Vec<I>,
}

impl<I: Index> Memory<I> {
    /// The memory of the given numbers of words and entries.
    #[must_use]
    pub fn new(marks: usize, queue: usize, found: usize) -> Self {
        Self { marks: vec![0; marks], queue: vec![I::ZERO; queue], masks: vec![0; queue], found: vec![I::ZERO; found] }
    }

    /// Enough for every query on a complex of `num_simplices` simplices, of dimension up to 6.
    #[must_use]
    pub fn roomy(num_simplices: usize) -> Self {
        // k-adjacency gathers the cofaces of each k-face before it drops repetitions; a 6-simplex has 35 of one k.
        Self::new(mark_words(num_simplices), 2 * num_simplices, 35 * num_simplices)
    }

    /// The scratch to query with.
    #[must_use]
    pub fn scratch(&mut self) -> Scratch<'_, I> {
        Scratch::new(&mut self.marks, &mut self.queue, &mut self.masks, &mut self.found)
    }
}

/// The ids of an answer, increasing; repetitions stay, so that a comparison finds them.
pub fn sorted(answer: impl IntoIterator<Item = SimplexId>) -> Vec<usize> {
    let mut ids = in_order(answer);
    ids.sort_unstable();
    ids
}

/// The ids of an answer in the order in which they come.
pub fn in_order(answer: impl IntoIterator<Item = SimplexId>) -> Vec<usize> {
    answer.into_iter().map(SimplexId::index).collect()
}

/// Walks an iterator and checks that it always says exactly how much is left, and stays at its end.
///
/// # Panics
/// If it does not.
pub fn exact<T>(mut iterator: impl ExactSizeIterator<Item = T>) -> Vec<T> {
    let mut items = Vec::new();
    let promised = iterator.len();
    loop {
        assert_eq!(iterator.size_hint(), (promised - items.len(), Some(promised - items.len())));
        match iterator.next() {
            Some(item) => items.push(item),
            None => break,
        }
    }
    assert_eq!(items.len(), promised);
    assert!(iterator.next().is_none(), "an iterator goes on after its end");
    items
}

/// Compares every relation of every simplex with its definition, those of the tree's sections too.
///
/// # Panics
/// Where the two differ.
pub fn assert_conforms<I: Index>(complex: &Complex<'_, I>, oracle: &Oracle) {
    assert_relations(complex, oracle);
    for simplex in 0..oracle.len() {
        assert_stored(complex, oracle, simplex);
    }
    let mut memory = Memory::roomy(oracle.len());
    let mut scratch = memory.scratch();
    for simplex in 0..oracle.len() {
        assert_clusters(complex, oracle, simplex, &mut scratch);
    }
    assert_no_clusters_past_the_end(complex, &mut scratch);
    if let Some(tree) = complex.as_tree() {
        assert_tree_conforms(tree, oracle);
    }
}

/// Compares every relation of every simplex of a tree with its definition, and the orders of all simplices.
///
/// # Panics
/// Where the two differ.
pub fn assert_tree_conforms<I: Index>(tree: &Tree<'_, I>, oracle: &Oracle) {
    assert_relations(tree, oracle);
    let mut by_word: Vec<usize> = (0..oracle.len()).collect();
    by_word.sort_by_key(|&simplex| oracle.word(simplex));
    assert_eq!(in_order(exact(tree.depth_first())), by_word);

    let mut order = vec![I::ZERO; oracle.len()];
    let ordered = in_order(tree.filtration_order(&mut order).unwrap());
    let value = |simplex: usize| tree.filtration().map_or(0.0, |values| values[simplex]);
    let mut expected: Vec<usize> = (0..oracle.len()).collect();
    expected.sort_by(|&left, &right| {
        let key = |simplex| (oracle.dim(simplex), oracle.word(simplex));
        value(left).partial_cmp(&value(right)).unwrap().then(key(left).cmp(&key(right)))
    });
    assert_eq!(ordered, expected);
    if let Some(few) = oracle.len().checked_sub(1) {
        assert!(tree.filtration_order(&mut order[..few]).is_err());
    }
}

/// Compares every relation of every simplex of a structure, however it names them, with its definition.
///
/// # Panics
/// Where the two differ.
pub fn assert_structure_conforms<S: Structure>(structure: &mut S, oracle: &Oracle) {
    assert_eq!(structure.dim(), oracle.dims().checked_sub(1));
    let mut found = Vec::new();
    for simplex in 0..oracle.len() {
        let word = oracle.word(simplex);
        let own = structure.find(&vertex_ids(word)).unwrap_or_else(|| panic!("{word:?} is not found"));
        assert_eq!(word_of(structure, own), word);
        // Each name of a simplex in an answer is as good as the one by which it was found.
        structure.star(own, &mut found);
        for name in [own].into_iter().chain(found.iter().copied().filter(|_| oracle.dim(simplex) == 0).take(4)) {
            let word = word_of(structure, name);
            let simplex = oracle.find(&word).unwrap_or_else(|| panic!("{word:?} is no simplex"));
            assert_structure(structure, oracle, simplex, name);
        }
    }
    for missing in [vec![], vec![oracle.of_dim(0).len()], (0..oracle.dims() + 1).collect()] {
        assert!(structure.find(&vertex_ids(&missing)).is_none(), "{missing:?} is found");
    }
}

fn word_of<S: Structure>(structure: &S, simplex: S::Simplex) -> Vec<usize> {
    let mut word = Vec::new();
    structure.vertices(simplex, &mut word);
    word.into_iter().map(VertexId::index).collect()
}

fn assert_structure<S: Structure>(structure: &mut S, oracle: &Oracle, simplex: usize, name: S::Simplex) {
    let word = oracle.word(simplex);
    let mut found = vec![name; 3];
    let ids = |structure: &S, found: &[S::Simplex]| {
        let id = |&name: &S::Simplex| oracle.find(&word_of(structure, name)).expect("an answer is a simplex");
        let mut ids: Vec<usize> = found.iter().map(id).collect();
        ids.sort_unstable();
        ids
    };
    for dim in 0..oracle.dims() + 2 {
        structure.boundary(name, dim, &mut found);
        assert_eq!(ids(structure, &found), oracle.boundary(simplex, dim), "{dim}-faces of {word:?}");
        structure.coboundary(name, dim, &mut found);
        assert_eq!(ids(structure, &found), oracle.coboundary(simplex, dim), "{dim}-cofaces of {word:?}");
    }
    structure.star(name, &mut found);
    assert_eq!(ids(structure, &found), oracle.star(simplex), "star of {word:?}");
    structure.link(name, &mut found);
    assert_eq!(ids(structure, &found), oracle.link(simplex), "link of {word:?}");
    structure.adjacency(name, &mut found);
    assert_eq!(ids(structure, &found), oracle.adjacency(simplex), "simplices adjacent to {word:?}");
}

/// What complexes and trees have in common.
fn assert_relations<V: Relations>(view: &V, oracle: &Oracle) {
    assert_numbers(view, oracle);
    let mut memory = Memory::roomy(oracle.len());
    let mut scratch = memory.scratch();
    for simplex in 0..oracle.len() {
        assert_downward(view, oracle, simplex);
        assert_upward(view, oracle, simplex, &mut scratch);
        assert_tree(view, oracle, simplex);
    }
    assert_no_relations_past_the_end(view, &mut scratch);
    assert!(memory.marks.iter().all(|&word| word == 0), "a query left marks behind");
}

fn assert_numbers(complex: &impl Relations, oracle: &Oracle) {
    assert_eq!(complex.dim(), oracle.dims().checked_sub(1));
    assert_eq!(complex.num_simplices(), oracle.len());
    assert_eq!(complex.num_vertices(), oracle.of_dim(0).len());
    assert_eq!(complex.euler_characteristic(), oracle.euler_characteristic());
    assert_eq!(in_order(exact(complex.simplices())), (0..oracle.len()).collect::<Vec<_>>());
    for dim in 0..oracle.dims() + 2 {
        assert_eq!(complex.num_simplices_of_dim(dim), oracle.of_dim(dim).len());
        assert_eq!(in_order(exact(complex.simplices_of_dim(dim))), oracle.of_dim(dim));
        let backwards: Vec<usize> = oracle.of_dim(dim).into_iter().rev().collect();
        assert_eq!(in_order(complex.simplices_of_dim(dim).rev()), backwards);
    }
}

/// Dimension, vertices, facets, boundary and closure.
fn assert_downward(complex: &impl Relations, oracle: &Oracle, simplex: usize) {
    let (id, dim) = (SimplexId::new(simplex), oracle.dim(simplex));
    assert_eq!(complex.dim_of(id), Some(dim));
    let word: Vec<usize> = exact(complex.vertices(id)).into_iter().map(VertexId::index).collect();
    assert_eq!(word, oracle.word(simplex), "vertices of {id}");
    assert_eq!(complex.last_vertex(id).map(VertexId::index), word.last().copied());
    let facets: Vec<usize> =
        if dim == 0 { Vec::new() } else { (0..=dim).map(|at| oracle.facet(simplex, at)).collect() };
    assert_eq!(in_order(exact(complex.facets(id))), facets, "facets of {id}");
    assert!(complex.facets(id).rev().map(SimplexId::index).eq(facets.into_iter().rev()));
    for q in 0..oracle.dims() + 2 {
        assert_eq!(in_order(exact(complex.boundary(id, q))), oracle.boundary(simplex, q), "{q}-faces of {id}");
    }
    assert_eq!(in_order(exact(complex.closure(id))), oracle.closure(simplex), "closure of {id}");
}

/// What the file stores: clusters and flags.
fn assert_stored<I: Index>(complex: &Complex<'_, I>, oracle: &Oracle, simplex: usize) {
    let id = SimplexId::new(simplex);
    let clusters = oracle.clusters(simplex);
    let stored: Vec<_> = complex.clusters(id).map(|found| (found.dim, found.representative.index())).collect();
    let expected: Vec<_> = clusters.iter().map(|cluster| (cluster.dim, cluster.members[0])).collect();
    assert_eq!(stored, expected, "clusters around {id}");
    assert_eq!(in_order(complex.partial_coboundary(id)), oracle.partial_coboundary(simplex));
    for g in 0..oracle.dims() + 1 {
        let expected: Vec<usize> = expected.iter().filter(|(dim, _)| *dim == g).map(|&(_, first)| first).collect();
        assert_eq!(in_order(complex.partial_coboundary_of_dim(id, g)), expected, "C*({g}) of {id}");
    }
    assert_eq!(complex.is_single_cluster(id), oracle.is_single_cluster(simplex), "flag of {id}");
}

/// What is found by traversal.
fn assert_upward<V: Relations>(complex: &V, oracle: &Oracle, simplex: usize, scratch: &mut Scratch<'_, V::Index>) {
    let id = SimplexId::new(simplex);
    assert_eq!(complex.is_top(id), oracle.is_top(simplex), "whether {id} is top");
    for g in 0..oracle.dims() + 1 {
        let found = sorted(exact(complex.coboundary(id, g, scratch).unwrap()));
        assert_eq!(found, oracle.coboundary(simplex, g), "{g}-cofaces of {id}");
    }
    assert_eq!(sorted(exact(complex.star(id, scratch).unwrap())), oracle.star(simplex), "star of {id}");
    let found = sorted(exact(complex.restricted_star(id, scratch).unwrap()));
    assert_eq!(found, oracle.restricted_star(simplex), "restricted star of {id}");
    assert_eq!(sorted(exact(complex.link(id, scratch).unwrap())), oracle.link(simplex), "link of {id}");
    let found = sorted(exact(complex.adjacency(id, scratch).unwrap()));
    assert_eq!(found, oracle.adjacency(simplex), "simplices adjacent to {id}");
    for k in 0..oracle.dims() + 1 {
        let found = sorted(exact(complex.k_adjacency(id, k, scratch).unwrap()));
        assert_eq!(found, oracle.k_adjacency(simplex, k), "simplices {k}-adjacent to {id}");
    }
}

/// The simplices of each cluster.
fn assert_clusters<I: Index>(complex: &Complex<'_, I>, oracle: &Oracle, simplex: usize, scratch: &mut Scratch<'_, I>) {
    let id = SimplexId::new(simplex);
    let clusters = oracle.clusters(simplex);
    for other in 0..oracle.len() {
        let cluster = clusters.iter().find(|cluster| cluster.members.contains(&other));
        let expected = cluster.map_or(&[][..], |cluster| &cluster.members);
        let found = sorted(exact(complex.cluster_members(id, SimplexId::new(other), scratch).unwrap()));
        assert_eq!(found, expected, "the cluster of #{other} around {id}");
    }
}

/// The arrays as a simplex tree.
fn assert_tree(complex: &impl Relations, oracle: &Oracle, simplex: usize) {
    let (id, word) = (SimplexId::new(simplex), oracle.word(simplex));
    assert_eq!(complex.parent(id).map(SimplexId::index), oracle.parent(simplex));
    assert_eq!(in_order(exact(complex.children(id))), oracle.children(simplex), "children of {id}");
    let siblings = oracle.parent(simplex).map_or_else(|| oracle.of_dim(0), |parent| oracle.children(parent));
    assert_eq!(in_order(exact(complex.siblings(id))), siblings, "siblings of {id}");
    assert_eq!(complex.find(&vertex_ids(word)), Some(id));
    assert_eq!(in_order(complex.with_prefix(&vertex_ids(word))), oracle.with_prefix(word), "prefix {word:?}");
    for vertex in 0..=oracle.of_dim(0).len() {
        // One vertex more, wherever it sorts, or at the end, where it may be out of order.
        let mut longer = [word, &[vertex]].concat();
        assert_eq!(complex.find(&vertex_ids(&longer)).map(SimplexId::index), oracle.find(&longer), "{longer:?}");
        longer.sort_unstable();
        assert_eq!(complex.find(&vertex_ids(&longer)).map(SimplexId::index), oracle.find(&longer), "{longer:?}");
        assert_eq!(in_order(complex.with_prefix(&vertex_ids(&longer))), oracle.with_prefix(&longer));
    }
}

fn vertex_ids(word: &[usize]) -> Vec<VertexId> {
    word.iter().copied().map(VertexId::new).collect()
}

fn ids_past_the_end(view: &impl Relations) -> [SimplexId; 4] {
    let count = view.num_simplices();
    [count, count + 1, count + 64, usize::MAX].map(SimplexId::new)
}

fn assert_no_relations_past_the_end<V: Relations>(view: &V, scratch: &mut Scratch<'_, V::Index>) {
    assert_eq!(view.find(&[]), None);
    assert_eq!(in_order(view.with_prefix(&[])), in_order(view.simplices()));
    for id in ids_past_the_end(view) {
        assert_eq!(view.dim_of(id), None);
        assert_eq!(view.vertices(id).len() + view.facets(id).len() + view.closure(id).len(), 0);
        assert_eq!(view.boundary(id, 0).len() + view.children(id).len() + view.siblings(id).len(), 0);
        assert!(!view.is_top(id) && view.parent(id).is_none() && view.last_vertex(id).is_none());
        assert_eq!(view.coboundary(id, 1, scratch).unwrap().len(), 0);
        assert_eq!(view.star(id, scratch).unwrap().len(), 0);
        assert_eq!(view.restricted_star(id, scratch).unwrap().len(), 0);
        assert_eq!(view.link(id, scratch).unwrap().len(), 0);
        assert_eq!(view.adjacency(id, scratch).unwrap().len(), 0);
        assert_eq!(view.k_adjacency(id, 0, scratch).unwrap().len(), 0);
    }
}

fn assert_no_clusters_past_the_end<I: Index>(complex: &Complex<'_, I>, scratch: &mut Scratch<'_, I>) {
    for id in ids_past_the_end(complex) {
        assert_eq!(complex.clusters(id).count() + complex.partial_coboundary(id).count(), 0);
        assert!(!complex.is_single_cluster(id));
        assert_eq!(complex.cluster_members(id, SimplexId::new(0), scratch).unwrap().len(), 0);
        assert_eq!(complex.cluster_members(SimplexId::new(0), id, scratch).unwrap().len(), 0);
    }
}

/// Compares the relations of every simplex with Algorithms 4 to 7.
///
/// # Panics
/// Where the two differ.
pub fn assert_agrees_with_the_paper<I: Index>(complex: &Complex<'_, I>) {
    let mut memory = Memory::roomy(complex.num_simplices());
    let mut scratch = memory.scratch();
    let top_dim = complex.dim().unwrap_or(0);
    for id in complex.simplices() {
        let dim = complex.dim_of(id).unwrap();
        for q in 0..dim {
            assert!(complex.boundary(id, q).eq(paper::boundary(complex, q, id)), "Algorithm 4: {q}-faces of {id}");
        }
        for g in dim + 1..=top_dim {
            let found: paper::Set = complex.coboundary(id, g, &mut scratch).unwrap().collect();
            assert_eq!(found, paper::coboundary(complex, g, id), "Algorithm 5: {g}-cofaces of {id}");
        }
        for cluster in complex.clusters(id) {
            let found = complex.cluster_members(id, cluster.representative, &mut scratch).unwrap();
            let printed = paper::retrieve_cluster(complex, id, cluster.representative);
            assert_eq!(found.collect::<paper::Set>(), printed, "Algorithm 6: {cluster:?} around {id}");
        }
        let mut printed = paper::adjacency(complex, id);
        printed.remove(&id);
        let found: paper::Set = complex.adjacency(id, &mut scratch).unwrap().collect();
        assert_eq!(found, printed, "Algorithm 7: simplices adjacent to {id}");
    }
}
