//! The walk through all cliques of a graph, vertex by vertex, in an order that is lexicographic in every dimension.
//!
//! Below a node (a clique in sorted order) stand its *candidates*: the vertices after its last one that are adjacent to
//! all of it, which are the last vertices of its children. Where there are up to 64 of them they get *letters*, their
//! positions, and the graph between them becomes one bit row each: from there down the candidates of a child are the AND
//! of those of its parent and of the row of its last letter. Nodes are grown in batches of one dimension, a batch at a time
//! all the way down, so that working memory is small and the loops are long and without branches that nobody can
//! predict. Where there are more candidates, they are sorted lists and are intersected, until there are few enough.

use sig_core::{Dim, Index};

use crate::build::{index, seek};
use crate::graph::Graph;

/// The most candidates that get letters.
pub(super) const LETTERS: usize = u64::BITS as usize;

/// Nodes whose children are grown together.
const BATCH: usize = 128;

/// What a vertex that is no letter has as its place.
pub(super) const ABSENT: u8 = u8::MAX;

/// What is done with the cliques; counting and writing.
pub(super) trait Sink<L: Index> {
    /// There is one more node, whose children follow.
    fn node(&mut self, dim: Dim, vertex: u32);

    /// There are the nodes of the largest dimension with the last vertices `candidates`.
    fn list(&mut self, dim: Dim, candidates: &[u32]);

    /// A clique of dimension `dim` − 1 with that many children is about to be grown.
    fn start(&mut self, dim: Dim, num_children: usize);

    /// There are the children, of dimension `dim`, of the nodes with the given candidates. The candidates of those that
    /// have children go into `below`.
    fn grow(&mut self, dim: Dim, nodes: Nodes<'_>, letters: &Letters<L>, below: &mut Batch);

    /// There are the children, of the largest dimension, of the nodes with the given candidates.
    fn leaves(&mut self, dim: Dim, nodes: Nodes<'_>, letters: &Letters<L>);

    /// Whether nothing more is wanted.
    fn is_full(&self) -> bool {
        false
    }
}

/// The candidates of some node by letter: their names, and the graph between them.
pub(super) struct Letters<L> {
    /// The vertex of each letter.
    pub(super) names: [L; LETTERS],
    /// For each letter the greater ones that are adjacent.
    rows: [u64; LETTERS],
}

/// The candidates of some nodes of one dimension, none empty, then 0.
pub(super) struct Batch {
    masks: Vec<u64>,
    len: usize,
}

impl Batch {
    fn new() -> Self {
        Self { masks: Vec::new(), len: 0 }
    }

    /// Empties the batch and makes room for the children of a batch.
    fn clear(&mut self) {
        self.masks.resize(BATCH * LETTERS + 1, 0);
        self.len = 0;
    }

    /// Adds a node if it has candidates.
    #[inline(always)]
    pub(super) fn push(&mut self, mask: u64) {
        // Written in any case: a branch would be mispredicted every other time.
        self.masks[self.len] = mask;
        self.len += usize::from(mask != 0);
    }

    /// The nodes, in pieces that are small enough to be grown together.
    fn pieces(&mut self) -> impl Iterator<Item = Nodes<'_>> {
        self.masks[self.len] = 0;
        let (masks, len) = (&self.masks[..=self.len], self.len);
        (0..len).step_by(BATCH).map(move |start| Nodes { masks: &masks[start..], count: BATCH.min(len - start) })
    }
}

/// Up to [`BATCH`] nodes.
#[derive(Clone, Copy)]
pub(super) struct Nodes<'a> {
    /// The candidates of the nodes, none empty, and at least one more mask.
    masks: &'a [u64],
    count: usize,
}

impl Nodes<'_> {
    /// Calls `visit` with the last letter and the candidates of every child, in order; with the instructions for bits
    /// that the processor has.
    #[inline]
    pub(super) fn for_each_child<L: Index>(
        self,
        letters: &Letters<L>,
        arch: pulp::Arch,
        visit: impl FnMut(usize, u64),
    ) {
        arch.dispatch(Children { nodes: self, letters, visit });
    }
}

/// The children of some nodes, to be visited by code for one kind of processor.
struct Children<'a, L, F> {
    nodes: Nodes<'a>,
    letters: &'a Letters<L>,
    visit: F,
}

impl<L: Index, F: FnMut(usize, u64)> pulp::WithSimd for Children<'_, L, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { nodes: Nodes { masks, count }, letters, mut visit } = self;
        let Some((&first, _)) = masks.split_first() else { return };
        let (mut node, mut mask) = (0, first);
        while node < count {
            let letter = mask.trailing_zeros() as usize % LETTERS;
            visit(letter, letters.below(mask, letter));
            mask &= mask.wrapping_sub(1);
            // On to the next node if this was its last child. Nodes have one or two children as a rule, so that a branch
            // would be mispredicted for each.
            let is_done = mask == 0;
            node += usize::from(is_done);
            mask |= masks[node] & u64::from(is_done).wrapping_neg();
        }
    }
}

/// Working memory of a walk through the cliques of a graph, reused from vertex to vertex.
pub(super) struct Walk<'a, L> {
    graph: &'a Graph,
    max_dim: Dim,
    /// The letter of each vertex, [`ABSENT`] between uses.
    places: Vec<u8>,
    letters: Letters<L>,
    /// The nodes of each dimension that are being grown.
    batches: Vec<Batch>,
    /// The candidates of the nodes of each dimension that are too many for letters.
    lists: Vec<Vec<u32>>,
}

impl<'a, L: Index> Walk<'a, L> {
    /// A walk through the cliques of up to `max_dim` + 1 vertices.
    pub(super) fn new(graph: &'a Graph, max_dim: Dim) -> Self {
        Self {
            graph,
            max_dim,
            places: vec![ABSENT; graph.num_vertices()],
            letters: Letters::new(),
            batches: (0..=max_dim).map(|_| Batch::new()).collect(),
            lists: vec![Vec::new(); max_dim + 1],
        }
    }

    /// Walks through the cliques of which `vertex` is the least vertex.
    pub(super) fn below_vertex(&mut self, vertex: u32, sink: &mut impl Sink<L>) {
        sink.node(0, vertex);
        if self.max_dim > 0 {
            self.below(1, self.graph.upper_neighbours(vertex as usize), sink);
        }
    }

    /// Walks through the cliques below a node of dimension `dim` − 1.
    fn below(&mut self, dim: Dim, candidates: &[u32], sink: &mut impl Sink<L>) {
        if candidates.is_empty() || sink.is_full() {
            return;
        }
        if dim == self.max_dim {
            sink.list(dim, candidates);
        } else if candidates.len() <= LETTERS {
            self.letters.set(self.graph, candidates, &mut self.places, |_, _, _| ());
            sink.start(dim, candidates.len());
            let all = u64::MAX >> (LETTERS - candidates.len());
            self.grow(dim, Nodes { masks: &[all, 0], count: 1 }, sink);
        } else {
            let mut list = std::mem::take(&mut self.lists[dim]);
            for (position, &vertex) in candidates.iter().enumerate() {
                sink.node(dim, vertex);
                let (later, neighbours) = (&candidates[position + 1..], self.graph.upper_neighbours(vertex as usize));
                list.clear();
                for_each_common(later, neighbours, |place, _| list.push(later[place]));
                self.below(dim + 1, &list, sink);
            }
            self.lists[dim] = list;
        }
    }

    /// Walks through the children, of dimension `dim`, of some nodes, and what is below them.
    fn grow(&mut self, dim: Dim, nodes: Nodes<'_>, sink: &mut impl Sink<L>) {
        let mut batch = std::mem::replace(&mut self.batches[dim], Batch::new());
        batch.clear();
        sink.grow(dim, nodes, &self.letters, &mut batch);
        for nodes in batch.pieces() {
            if dim + 1 == self.max_dim {
                sink.leaves(dim + 1, nodes, &self.letters);
            } else if !sink.is_full() {
                self.grow(dim + 1, nodes, sink);
            }
        }
        self.batches[dim] = batch;
    }
}

impl<L: Index> Letters<L> {
    /// No letters.
    pub(super) fn new() -> Self {
        Self { names: [L::ZERO; LETTERS], rows: [0; LETTERS] }
    }

    /// Gives letters to up to 64 vertices. `places` are all [`ABSENT`] before and after. Calls `visit` with two letters
    /// and the number of the edge between them, for every edge.
    pub(super) fn set(
        &mut self,
        graph: &Graph,
        vertices: &[u32],
        places: &mut [u8],
        mut visit: impl FnMut(usize, usize, usize),
    ) {
        for ((place, name), &vertex) in (0..).zip(&mut self.names).zip(vertices) {
            *name = index(vertex as usize);
            places[vertex as usize] = place;
        }
        for ((letter, row), &vertex) in self.rows.iter_mut().enumerate().zip(vertices) {
            let neighbours = graph.upper_neighbours(vertex as usize);
            let first_edge = graph.edges_of(vertex as usize).start;
            *row = 0;
            if neighbours.len() <= LETTERS * 16 {
                for (edge, &other) in (first_edge..).zip(neighbours) {
                    let place = places[other as usize];
                    // Without a branch, as long as nobody visits.
                    *row |= u64::from(place != ABSENT) << (place & 63);
                    if place != ABSENT {
                        visit(letter, place.into(), edge);
                    }
                }
            } else {
                // Few are looked for among many.
                for_each_common(&vertices[letter + 1..], neighbours, |before, edge| {
                    *row |= 1 << (letter + 1 + before);
                    visit(letter, letter + 1 + before, first_edge + edge);
                });
            }
        }
        for &vertex in vertices {
            places[vertex as usize] = ABSENT;
        }
    }

    /// The candidates of a child with last letter `letter` of a node with candidates `mask`.
    #[inline(always)]
    pub(super) fn below(&self, mask: u64, letter: usize) -> u64 {
        mask & self.rows[letter]
    }
}

/// Calls `visit` with the positions in both of what two increasing lists have in common.
pub(super) fn for_each_common(a: &[u32], b: &[u32], mut visit: impl FnMut(usize, usize)) {
    let (short, long) = if a.len() <= b.len() { (a, b) } else { (b, a) };
    let mut in_long = 0;
    for (in_short, &vertex) in short.iter().enumerate() {
        in_long += seek(&long[in_long..], &vertex);
        if long.get(in_long) == Some(&vertex) {
            if a.len() <= b.len() { visit(in_short, in_long) } else { visit(in_long, in_short) }
        }
    }
}
