//! The simplices in order: depth-first, by dimension, by filtration value; and the maximal ones.

use sig_core::Dim;

use super::arena::NONE;
use super::node::Place;
use super::{Simplex, SimplexTree};
use crate::frozen::FrozenTree;

/// Simplices depth-first, which is lexicographic order of their words: see [`SimplexTree::iter`].
#[derive(Clone, Debug)]
pub struct DepthFirst<'a> {
    tree: &'a SimplexTree,
    /// The node at which a subtree begins.
    root: Option<Place>,
    /// The label from which the next vertex is looked for, if all of the tree is walked.
    next_top: Option<u32>,
    /// The sets on the way down, and which of their siblings is next.
    stack: Vec<(u32, usize)>,
    /// The most sets on the way down.
    limit: usize,
}

impl<'a> DepthFirst<'a> {
    pub(super) fn below(tree: &'a SimplexTree, root: Place) -> Self {
        Self { tree, root: Some(root), next_top: None, stack: Vec::new(), limit: usize::MAX }
    }

    /// The same, but at most so many steps down.
    pub(super) fn limited(self, limit: usize) -> Self {
        Self { limit, ..self }
    }

    /// The place where a subtree begins.
    fn start(&mut self) -> Option<Place> {
        if let Some(root) = self.root.take() {
            return Some(root);
        }
        let label = self.tree.tops.first_in(self.next_top?..=u32::MAX)?;
        self.next_top = label.checked_add(1);
        Some(Place::top(label))
    }
}

impl<'a> Iterator for DepthFirst<'a> {
    type Item = Simplex<'a>;

    fn next(&mut self) -> Option<Self::Item> {
        let place = loop {
            let Some((set, next)) = self.stack.last_mut() else { break self.start()? };
            if *next < self.tree.arena.len(*set) {
                *next += 1;
                break Place::within(*set, *next - 1);
            }
            self.stack.pop();
        };
        let child = self.tree.child_at(place);
        if child != NONE && self.stack.len() < self.limit {
            self.stack.push((child, 0));
        }
        Some(Simplex::new(self.tree, place))
    }
}

impl std::iter::FusedIterator for DepthFirst<'_> {}

impl<'a> IntoIterator for &'a SimplexTree {
    type Item = Simplex<'a>;
    type IntoIter = DepthFirst<'a>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

impl SimplexTree {
    /// All simplices, depth-first: in the lexicographic order of their words. Cost: O(1) each.
    #[must_use]
    pub fn iter(&self) -> DepthFirst<'_> {
        DepthFirst { tree: self, root: None, next_top: Some(0), stack: Vec::new(), limit: usize::MAX }
    }

    /// The simplices of dimension up to `dim`, depth-first: the skeleton. Cost: O(1) each.
    #[must_use]
    pub fn skeleton(&self, dim: Dim) -> DepthFirst<'_> {
        self.iter().limited(dim)
    }

    /// All simplices by dimension, then lexicographically: the order of their ids in a file. Cost: O(1) each, and 8 bytes.
    pub fn by_dimension(&self) -> impl ExactSizeIterator<Item = Simplex<'_>> + DoubleEndedIterator {
        self.places_by_dimension().into_iter().map(|place| Simplex::new(self, place))
    }

    /// All simplices by filtration value, then by dimension, then lexicographically: faces come before their cofaces where
    /// values are monotone. Cost: a sort; 8 bytes a simplex, and as many for sorting.
    pub fn by_filtration(&self) -> impl ExactSizeIterator<Item = Simplex<'_>> + DoubleEndedIterator {
        let mut places = self.places_by_dimension();
        // Stable, so that what is equal stays in order.
        places.sort_by(|&a, &b| self.value_at(a).total_cmp(&self.value_at(b)));
        places.into_iter().map(|place| Simplex::new(self, place))
    }

    pub(super) fn places_by_dimension(&self) -> Vec<Place> {
        let mut places = Vec::with_capacity(self.num_simplices());
        places.extend(self.tops.labels().map(Place::top));
        let mut next = 0;
        while let Some(&place) = places.get(next) {
            let set = self.child_at(place);
            places.extend((0..self.arena.labels(set).len()).map(|index| Place::within(set, index)));
            next += 1;
        }
        places
    }

    /// The maximal simplices, those without proper cofaces, by dimension, then lexicographically.
    ///
    /// Cost: O(p `D_m`) for each simplex, and 4 (p + 1) bytes for its facets while it runs.
    #[must_use]
    pub fn maximal_simplices(&self) -> Vec<Simplex<'_>> {
        let places = self.places_by_dimension();
        let mut is_maximal = vec![true; places.len()];
        for facet in facets(&self.freeze()).into_iter().flatten().filter(|&facet| facet != MISSING) {
            is_maximal[facet as usize] = false;
        }
        let maximal = places.into_iter().zip(is_maximal).filter(|&(_, is_maximal)| is_maximal);
        maximal.map(|(place, _)| Simplex::new(self, place)).collect()
    }
}

/// A facet that is not there, in arrays that are no complex.
pub(super) const MISSING: u32 = u32::MAX;

/// The facets of the simplices of each dimension, p + 1 each, the i-th of which omits the i-th vertex; none of vertices.
///
/// With τ the parent of a simplex τv, and d_i omitting the i-th vertex, d_i(τv) is the child of d_i(τ) with last vertex v.
pub(super) fn facets(tree: &FrozenTree) -> Vec<Vec<u32>> {
    let mut all: Vec<Vec<u32>> = vec![Vec::new(); tree.first.len()];
    for dim in 1..tree.first.len() {
        let mut facets = Vec::with_capacity(tree.ids(dim).len() * (dim + 1));
        for (row, parent) in tree.ids(dim - 1).enumerate() {
            for child in tree.children(parent) {
                let last = tree.last_vertices.at(child);
                if dim == 1 {
                    facets.push(last);
                } else {
                    let above = &all[dim - 1][row * dim..(row + 1) * dim];
                    facets.extend(above.iter().map(|&facet| child_with(tree, facet, last)));
                }
                facets.push(crate::build::narrow(parent));
            }
        }
        all[dim] = facets;
    }
    all
}

fn child_with(tree: &FrozenTree, parent: u32, last: u32) -> u32 {
    if parent == MISSING {
        return MISSING;
    }
    let (mut low, end) = (tree.children(parent as usize).start, tree.children(parent as usize).end);
    let mut high = end;
    while low < high {
        let middle = low + (high - low) / 2;
        if tree.last_vertices.at(middle) < last { low = middle + 1 } else { high = middle }
    }
    if low < end && tree.last_vertices.at(low) == last { crate::build::narrow(low) } else { MISSING }
}
