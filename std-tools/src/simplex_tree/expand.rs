//! Flag complexes in the tree (simplex-tree-2012, 3.1): the expansion of a graph, whole, edge by edge, or with a say in
//! what enters.
//!
//! Where nothing is to change afterwards, [`crate::flag`] goes straight to flat arrays.

use sig_core::{Dim, MAX_DIM};

use super::arena::{NONE, Node};
use super::filtration::largest_of_facets;
use super::node::Place;
use super::{ExpandError, Simplex, SimplexTree, SizeError};
use crate::build::narrow;
use crate::graph::Graph;

impl SimplexTree {
    /// The tree of a graph, with its weights as filtration values if it has any. Cost: O(1) for each edge.
    ///
    /// # Errors
    /// [`SizeError`].
    pub fn from_graph(graph: &Graph) -> Result<Self, SizeError> {
        let mut tree = Self::with_layout(graph.is_weighted(), false);
        for vertex in 0..graph.num_vertices() {
            let label = narrow(vertex);
            tree.insert_top(label, graph.vertex_weight(vertex), true);
            let upper = graph.upper_neighbours(vertex);
            if !upper.is_empty() {
                let edges = graph.edges_of(vertex);
                let members = upper.iter().zip(edges).map(|(&upper, edge)| (upper, graph.weight(edge)));
                tree.add_set(Place::top(label), 1, members)?;
            }
        }
        Ok(tree)
    }

    /// The expansion of order `max_dim` of a graph: inserts every simplex of dimension up to `max_dim` whose edges are
    /// there, with the largest of their filtration values.
    ///
    /// Cost: for each simplex a merge of the siblings after it and of the upper neighbours of its last vertex, the paper's
    /// (3.1).
    ///
    /// # Errors
    /// [`ExpandError::NotAGraph`] if there is a simplex of dimension 2.
    pub fn expand(&mut self, max_dim: Dim) -> Result<(), ExpandError> {
        self.check_graph(max_dim)?;
        let tops: Vec<u32> = self.tops.labels().collect();
        let mut pool = Vec::new();
        for label in tops {
            let set = self.child_at(Place::top(label));
            if set != NONE && max_dim > 1 {
                self.expand_set(set, 2, max_dim, &mut pool)?;
            }
        }
        Ok(())
    }

    fn check_graph(&self, max_dim: Dim) -> Result<(), ExpandError> {
        match self.dim() {
            _ if max_dim > MAX_DIM => Err(ExpandError::TooManyDimensions(max_dim)),
            Some(dim) if dim > 1 => Err(ExpandError::NotAGraph(dim)),
            _ => Ok(()),
        }
    }

    /// Gives each sibling of a set its children, of dimension `dim`, and so on.
    fn expand_set(
        &mut self,
        set: u32,
        dim: Dim,
        max_dim: Dim,
        pool: &mut Vec<Vec<(u32, f64)>>,
    ) -> Result<(), SizeError> {
        let mut children = pool.pop().unwrap_or_default();
        for index in 0..self.arena.len(set) {
            children.clear();
            self.clique_children(set, index, &mut children);
            if children.is_empty() {
                continue;
            }
            let child = self.add_set(Place::within(set, index), dim, children.iter().copied())?;
            if dim < max_dim {
                self.expand_set(child, dim + 1, max_dim, pool)?;
            }
        }
        pool.push(children);
        Ok(())
    }

    /// The later siblings that are neighbours of a sibling, each with the value of the simplex that it makes.
    fn clique_children(&self, set: u32, index: usize, children: &mut Vec<(u32, f64)>) {
        let siblings = self.arena.nodes(set);
        let upper = self.child_at(Place::top(siblings[index].label));
        let (neighbours, value) = (self.arena.nodes(upper), self.arena.value(set, index));
        let mut other = 0;
        for (later, &Node { label, .. }) in siblings.iter().enumerate().skip(index + 1) {
            other += neighbours[other..].iter().take_while(|neighbour| neighbour.label < label).count();
            match neighbours.get(other) {
                Some(neighbour) if neighbour.label == label => {
                    let edge = self.arena.value(upper, other);
                    children.push((label, value.max(self.arena.value(set, later)).max(edge)));
                }
                Some(_) => {}
                None => break,
            }
        }
    }

    /// The expansion of order `max_dim` of a graph with a say in what enters: of each simplex of which all facets are there
    /// the callback is told the vertices and the largest filtration value of the facets, and if it says `true` the simplex
    /// is blocked: neither it nor any coface of it is inserted.
    ///
    /// It is asked about facets before cofaces, and about the words of one dimension with the same prefix in lexicographic
    /// order; larger first vertices come first.
    ///
    /// Cost: O(p² `D_m`) and one question for each candidate: a simplex and a later sibling of it.
    ///
    /// # Errors
    /// [`ExpandError::NotAGraph`] if there is a simplex of dimension 2.
    pub fn expand_with_blocker(
        &mut self,
        max_dim: Dim,
        mut is_blocked: impl FnMut(&[u32], f64) -> bool,
    ) -> Result<(), ExpandError> {
        self.check_graph(max_dim)?;
        let tops: Vec<u32> = self.tops.labels().collect();
        // A facet that lacks an early vertex is below a larger label: so larger ones first, at every depth.
        for &label in tops.iter().rev() {
            let set = self.child_at(Place::top(label));
            if set != NONE && max_dim > 1 {
                self.expand_blocked(&mut vec![label], set, max_dim, &mut is_blocked)?;
            }
        }
        Ok(())
    }

    /// The same below the node `word`, whose children are a set.
    fn expand_blocked(
        &mut self,
        word: &mut Vec<u32>,
        set: u32,
        max_dim: Dim,
        is_blocked: &mut impl FnMut(&[u32], f64) -> bool,
    ) -> Result<(), SizeError> {
        for index in (0..self.arena.len(set)).rev() {
            let later: Vec<u32> = self.arena.labels(set).skip(index + 1).collect();
            word.push(self.arena.nodes(set)[index].label);
            let mut children = Vec::new();
            for label in later {
                word.push(label);
                if let Some(value) = self.value_of_facets(word).filter(|&value| !is_blocked(word, value)) {
                    children.push((label, value));
                }
                word.pop();
            }
            if !children.is_empty() {
                let dim = word.len();
                let child = self.add_set(Place::within(set, index), dim, children.into_iter())?;
                if dim < max_dim {
                    self.expand_blocked(word, child, max_dim, is_blocked)?;
                }
            }
            word.pop();
        }
        Ok(())
    }

    /// The largest filtration value of the facets of a word, if they are all there.
    fn value_of_facets(&self, word: &[u32]) -> Option<f64> {
        let mut facet = [0; MAX_DIM + 1];
        let mut most = f64::NEG_INFINITY;
        let len = word.len() - 1;
        for omitted in 0..=len {
            facet[..omitted].copy_from_slice(&word[..omitted]);
            facet[omitted..len].copy_from_slice(&word[omitted + 1..]);
            most = most.max(self.value_at(self.locate(&facet[..len])?));
        }
        Some(most)
    }

    /// Inserts an edge into a flag complex and all simplices of dimension up to `max_dim` that it completes, each with the
    /// largest filtration value of its facets; how many are new, the edge among them. With edges in filtration order the
    /// complex grows in filtration order. If the edge is there, nothing is done.
    ///
    /// Cost: the [`neighbours`](Self::neighbours) of both ends, with label lists O(1) each; then an insertion, O(p² `D_m` +
    /// d), for each new simplex, and O(p `D_m`) for each that another common neighbour does not make.
    ///
    /// # Errors
    /// [`ExpandError::NotAnEdge`] if an end is no vertex, or enters after the edge, or the value is NaN.
    pub fn insert_flag_edge(&mut self, a: u32, b: u32, value: f64, max_dim: Dim) -> Result<usize, ExpandError> {
        let edge = [a.min(b), a.max(b)];
        if max_dim > MAX_DIM {
            return Err(ExpandError::TooManyDimensions(max_dim));
        }
        if self.contains(&edge) || max_dim == 0 {
            return Ok(0);
        }
        let others = self.neighbours(b);
        let mut common = self.neighbours(a);
        common.retain(|vertex| others.binary_search(vertex).is_ok());
        if a == b || self.insert(&edge, value).is_err() {
            return Err(ExpandError::NotAnEdge(a, b));
        }
        let before = self.num_simplices();
        self.complete_cliques(&mut Vec::from(edge), &common, max_dim)?;
        Ok(self.num_simplices() - before + 1)
    }

    /// Inserts the cliques of a clique, in no order, and later candidates, which are common neighbours of it.
    fn complete_cliques(&mut self, clique: &mut Vec<u32>, candidates: &[u32], max_dim: Dim) -> Result<(), SizeError> {
        if clique.len() > max_dim {
            return Ok(());
        }
        for (position, &vertex) in candidates.iter().enumerate() {
            let upper = &candidates[position + 1..];
            let edge = |&other: &u32| self.contains(&[vertex.min(other), vertex.max(other)]);
            let next: Vec<u32> = upper.iter().copied().filter(edge).collect();
            clique.push(vertex);
            let mut word = clique.clone();
            word.sort_unstable();
            self.insert_path(&word, 0.0)?;
            if let Some(place) = self.locate(&word).filter(|_| self.has_filtration()) {
                let value = largest_of_facets(Simplex::new(self, place));
                self.set_value_at(place, value);
            }
            self.complete_cliques(clique, &next, max_dim)?;
            clique.pop();
        }
        Ok(())
    }
}
