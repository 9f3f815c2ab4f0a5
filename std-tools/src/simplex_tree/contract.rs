//! Edge contraction (simplex-tree-2012, 2.2.2; the text of the paper breaks off), and the link condition under which it
//! keeps the homotopy type: Lk(a) ∩ Lk(b) = Lk(ab).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use hashbrown::HashMap;
use sig_core::MAX_DIM;

use super::node::Place;
use super::{ContractError, DepthFirst, SimplexTree};

/// Whether an edge must satisfy the link condition to be contracted.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum LinkCondition {
    /// It must, so that the homotopy type is kept.
    #[default]
    Required,
    /// It need not.
    Ignored,
}

/// An edge that was contracted.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Contraction {
    /// The vertex that stays.
    pub kept: u32,
    /// The vertex that has become the other.
    pub removed: u32,
    /// The filtration value of the edge.
    pub value: f64,
}

impl SimplexTree {
    /// Whether Lk(a) ∩ Lk(b) = Lk(ab), under which contracting the edge keeps the homotopy type; false if there is no
    /// such edge.
    ///
    /// Cost: finding the [`neighbours`](Self::neighbours) of both, then up to three searches, O(p `D_m`) each, for each
    /// pair of a simplex in Lk(a) ∩ Lk(b) and a later common neighbour that makes one with each of its facets at that end.
    #[must_use]
    pub fn link_condition(&self, a: u32, b: u32) -> bool {
        let edge = [a.min(b), a.max(b)];
        if a == b || !self.contains(&edge) {
            return false;
        }
        let others = self.neighbours(edge[1]);
        let mut common = self.neighbours(edge[0]);
        common.retain(|vertex| others.binary_search(vertex).is_ok());
        let mut query = LinkQuery { tree: self, edge, word: [0; MAX_DIM + 1], pool: Vec::new() };
        query.holds_above(0, &common)
    }

    /// Contracts the edge {a, b}: b becomes a in every simplex. The result is the image of the complex, each simplex of
    /// which gets the least filtration value of those that become it. Homology is kept under the
    /// [`link_condition`](Self::link_condition), which this does not ask.
    ///
    /// Cost: the [`star`](Self::star) of b, and an insertion, O(p `D_m` + d), for each simplex in it.
    ///
    /// # Errors
    /// [`ContractError::NoEdge`]; nothing is done then.
    pub fn contract(&mut self, a: u32, b: u32) -> Result<(), ContractError> {
        if a == b || !self.contains(&[a.min(b), a.max(b)]) {
            return Err(ContractError::NoEdge(a, b));
        }
        let roots = self.coface_roots(&[b]);
        let images = self.images(&roots, a, b);
        self.remove_subtrees(&roots)?;
        // By dimension, so that prefixes are there with their own values.
        for (dim, image) in images.iter().enumerate() {
            for (word, &value) in image.words.chunks_exact(dim + 1).zip(&image.values) {
                self.insert_path(word, value)?;
            }
        }
        Ok(())
    }

    /// What the subtrees of b become, by dimension.
    fn images(&self, roots: &[Place], a: u32, b: u32) -> Vec<Image> {
        let mut images = vec![Image::default(); self.counts().len()];
        for &root in roots {
            for simplex in DepthFirst::below(self, root) {
                let mut word = [0; MAX_DIM + 1];
                let (mut start, mut is_in) = (word.len(), false);
                for label in simplex.labels_upward().filter(|&label| label != b) {
                    if label <= a && !is_in {
                        is_in = true;
                        if label < a {
                            start -= 1;
                            word[start] = a;
                        }
                    }
                    start -= 1;
                    word[start] = label;
                }
                if !is_in {
                    start -= 1;
                    word[start] = a;
                }
                let image = &mut images[word.len() - start - 1];
                image.words.extend_from_slice(&word[start..]);
                image.values.push(simplex.value());
            }
        }
        images
    }

    /// Contracts edges, those of least filtration value first, until there are `target` vertices or no edge is left that
    /// may be contracted; the smaller label is kept. Edges that fail the link condition are tried again after their ends
    /// have changed, and all of them once more when no other is left, until that contracts none. `progress` is told how many
    /// are contracted, of as many as the target takes.
    ///
    /// Cost: [`link_condition`](Self::link_condition) for each trial, [`contract`](Self::contract) for each success. Label
    /// lists are kept meanwhile, so that both depend on the stars of the two vertices and not on the complex.
    ///
    /// # Errors
    /// [`ContractError::Size`].
    pub fn contract_all(
        &mut self,
        target: usize,
        condition: LinkCondition,
        progress: Option<&(dyn Fn(u64, u64) + Sync)>,
    ) -> Result<Vec<Contraction>, ContractError> {
        let total = self.num_vertices().saturating_sub(target) as u64;
        let listed = self.has_label_lists();
        if !listed {
            self.keep_label_lists()?;
        }
        let edges = self.skeleton(1).filter(|simplex| simplex.dim() == 1);
        let edges = edges.filter_map(|edge| Some((edge.value(), <[u32; 2]>::try_from(edge.word()).ok()?)));
        let mut queue = Queue::new(edges.map(|(value, [a, b])| (OrderedValue(value), a, b)).collect());
        let mut contractions = Vec::new();
        let (mut refused, mut since) = (Vec::new(), 0);
        while self.num_vertices() > target {
            let Some((a, b, value)) = queue.pop() else {
                if refused.is_empty() || since == contractions.len() {
                    break;
                }
                since = contractions.len();
                refused.drain(..).for_each(|(a, b, value)| queue.push(a, b, value));
                continue;
            };
            if self.find(&[a, b]).is_none_or(|edge| edge.value().to_bits() != value.to_bits()) {
                continue;
            }
            if condition == LinkCondition::Required && !self.link_condition(a, b) {
                refused.push((a, b, value));
                continue;
            }
            self.contract(a, b)?;
            contractions.push(Contraction { kept: a, removed: b, value });
            if let Some(progress) = progress {
                progress(contractions.len() as u64, total);
            }
            for other in self.neighbours(a) {
                let (a, b) = (a.min(other), a.max(other));
                if let Some(edge) = self.find(&[a, b]) {
                    queue.push(a, b, edge.value());
                }
            }
        }
        if !listed {
            self.drop_label_lists()?;
        }
        Ok(contractions)
    }
}

/// Words of one dimension, and their values.
#[derive(Clone, Default)]
struct Image {
    words: Vec<u32>,
    values: Vec<f64>,
}

/// Edges by filtration value, then by labels; each at most once.
struct Queue {
    /// Those that waited at first, the next one last: most of all, and sorted they are read one after the other.
    first: Vec<(OrderedValue, u32, u32)>,
    /// Those that have come since.
    heap: BinaryHeap<Reverse<(OrderedValue, u32, u32)>>,
    /// The value with which an edge is waiting; others of it in the heap are out of date.
    waiting: HashMap<(u32, u32), u64>,
}

/// A value in the order of `total_cmp`.
#[derive(Clone, Copy)]
struct OrderedValue(f64);

impl PartialEq for OrderedValue {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for OrderedValue {}

impl PartialOrd for OrderedValue {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for OrderedValue {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl Queue {
    fn new(mut edges: Vec<(OrderedValue, u32, u32)>) -> Self {
        edges.sort_unstable_by(|one, other| other.cmp(one));
        let waiting = edges.iter().map(|&(OrderedValue(value), a, b)| ((a, b), value.to_bits())).collect();
        Self { first: edges, heap: BinaryHeap::new(), waiting }
    }

    fn push(&mut self, a: u32, b: u32, value: f64) {
        if self.waiting.insert((a, b), value.to_bits()) != Some(value.to_bits()) {
            self.heap.push(Reverse((OrderedValue(value), a, b)));
        }
    }

    fn pop(&mut self) -> Option<(u32, u32, f64)> {
        loop {
            let is_first = match (self.first.last(), self.heap.peek()) {
                (Some(first), Some(Reverse(pushed))) => first <= pushed,
                (first, _) => first.is_some(),
            };
            let next = if is_first { self.first.pop() } else { self.heap.pop().map(|Reverse(next)| next) };
            let (OrderedValue(value), a, b) = next?;
            if self.waiting.get(&(a, b)) == Some(&value.to_bits()) {
                self.waiting.remove(&(a, b));
                return Some((a, b, value));
            }
        }
    }
}

/// A walk through Lk(a) ∩ Lk(b).
struct LinkQuery<'a> {
    tree: &'a SimplexTree,
    edge: [u32; 2],
    /// The simplex at hand, which is in Lk(ab).
    word: [u32; MAX_DIM + 1],
    pool: Vec<Vec<u32>>,
}

impl LinkQuery<'_> {
    /// Whether all simplices of Lk(a) ∩ Lk(b) that start with the first `len` labels of the word are in Lk(ab);
    /// `candidates` are the later vertices of which each makes one with the word that is in both links.
    fn holds_above(&mut self, len: usize, candidates: &[u32]) -> bool {
        let mut next = self.pool.pop().unwrap_or_default();
        let mut holds = true;
        for (position, &vertex) in candidates.iter().enumerate() {
            if len >= MAX_DIM {
                holds = false;
                break;
            }
            self.word[len] = vertex;
            // With one vertex the word is in both links, being a common neighbour; with more it was looked at below.
            if len == 0 && !self.spans(1, &self.edge) {
                holds = false;
                break;
            }
            next.clear();
            for &later in &candidates[position + 1..] {
                self.word[len + 1] = later;
                if self.spans(len + 2, &self.edge) {
                    next.push(later);
                } else if self.spans(len + 2, &self.edge[..1]) && self.spans(len + 2, &self.edge[1..]) {
                    holds = false;
                    break;
                }
            }
            if !holds || (!next.is_empty() && !self.holds_above(len + 1, &next)) {
                holds = false;
                break;
            }
        }
        self.pool.push(next);
        holds
    }

    /// Whether the first `len` labels of the word span a simplex together with the given one or two.
    fn spans(&self, len: usize, ends: &[u32]) -> bool {
        let mut merged = [0; MAX_DIM + 3];
        let (mut count, mut ends) = (0, ends);
        for &label in &self.word[..len] {
            while let [end, rest @ ..] = ends
                && *end < label
            {
                merged[count] = *end;
                count += 1;
                ends = rest;
            }
            merged[count] = label;
            count += 1;
        }
        for &end in ends {
            merged[count] = end;
            count += 1;
        }
        self.tree.contains(&merged[..count])
    }
}
