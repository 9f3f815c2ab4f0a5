//! What is around a simplex: star, cofaces of a codimension, link, neighbours of a vertex.

use sig_core::Dim;

use super::arena::NONE;
use super::node::Place;
use super::{DepthFirst, Simplex, SimplexTree};

/// The cofaces of a simplex: one subtree after the other. See [`SimplexTree::star`].
#[derive(Clone, Debug)]
pub struct Cofaces<'a> {
    tree: &'a SimplexTree,
    roots: std::vec::IntoIter<Place>,
    subtree: Option<DepthFirst<'a>>,
    /// The dimension that is not passed.
    most: Dim,
}

impl<'a> Iterator for Cofaces<'a> {
    type Item = Simplex<'a>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(simplex) = self.subtree.as_mut().and_then(Iterator::next) {
                return Some(simplex);
            }
            let root = self.roots.next()?;
            let dim = self.tree.dim_of_set(root.set);
            self.subtree = (dim <= self.most).then(|| DepthFirst::below(self.tree, root).limited(self.most - dim));
        }
    }
}

impl std::iter::FusedIterator for Cofaces<'_> {}

impl SimplexTree {
    /// The star of a simplex: its cofaces, itself among them, in no particular order. Empty if it is not there.
    ///
    /// Cost, beside O(1) for each coface: with label lists ([`keep_label_lists`](Self::keep_label_lists)) O(k T), where k
    /// is the dimension of the complex and T the number of nodes at the depth of the simplex or below whose label is its
    /// last (the paper's k·T^{>j}, 2.2.1, *Locate cofaces*). Without, a traversal of the tree up to the first vertex:
    /// O(`D_m`) for each vertex before it, and for each node of which it is a neighbour.
    #[must_use]
    pub fn star(&self, word: &[u32]) -> Cofaces<'_> {
        let roots = self.coface_roots(word).into_iter();
        Cofaces { tree: self, roots, subtree: None, most: Dim::MAX }
    }

    /// The cofaces of a simplex with `codim` vertices more, in no particular order. Cost: as [`star`](Self::star), of which
    /// it passes over what has more vertices.
    pub fn cofaces(&self, word: &[u32], codim: Dim) -> impl Iterator<Item = Simplex<'_>> {
        let dim = word.len().saturating_sub(1) + codim;
        let star = Cofaces { most: dim, ..self.star(word) };
        star.filter(move |coface| coface.dim() == dim)
    }

    /// The link of a simplex: the simplices that have no vertex in common with it and together with it span one, with
    /// their own filtration values. The vertices keep their labels. Cost: the star, and O(p `D_m`) for each simplex in it.
    #[must_use]
    pub fn link(&self, word: &[u32]) -> Self {
        let mut link = Self::with_layout(self.has_filtration(), false);
        let mut words: Vec<Vec<u32>> = self.star(word).map(Simplex::word).collect();
        for labels in &mut words {
            labels.retain(|label| word.binary_search(label).is_err());
        }
        words.sort_unstable_by(|a, b| (a.len(), a).cmp(&(b.len(), b)));
        for labels in words.iter().filter(|labels| !labels.is_empty()) {
            let value = self.locate(labels).map_or(0.0, |place| self.value_at(place));
            // A link is smaller than the tree that it is in, so there is room for it.
            let _ = link.insert_path(labels, value);
        }
        link
    }

    /// The vertices that an edge joins to this one, increasing.
    ///
    /// Cost: O(1) each with label lists; without, a search of O(`D_m`) for every vertex with a smaller label.
    #[must_use]
    pub fn neighbours(&self, vertex: u32) -> Vec<u32> {
        let mut lower: Vec<u32> = match &self.lists {
            Some(lists) => lists.sets(vertex, 1).iter().map(|&set| self.arena.parent(set).1).collect(),
            None => self
                .lower_vertices(vertex)
                .filter(|&(_, set)| self.arena.search(set, vertex).is_ok())
                .map(|(lower, _)| lower)
                .collect(),
        };
        lower.sort_unstable();
        lower.extend(self.arena.labels(self.child_at(Place::top(vertex))));
        lower
    }

    /// The vertices below a label that have children, and the sets of these.
    fn lower_vertices(&self, label: u32) -> impl Iterator<Item = (u32, u32)> {
        let lower = self.tops.labels().take_while(move |&other| other < label);
        lower.map(|lower| (lower, self.child_at(Place::top(lower)))).filter(|&(_, set)| set != NONE)
    }

    /// The roots of the subtrees that make up the star: the nodes whose words end with the last vertex of the simplex and
    /// contain the others.
    pub(super) fn coface_roots(&self, word: &[u32]) -> Vec<Place> {
        let (Some(place), Some((&last, before))) = (self.locate(word), word.split_last()) else { return Vec::new() };
        if self.dim() == Some(before.len()) {
            return vec![place];
        }
        let mut roots = Vec::new();
        let Some(lists) = &self.lists else {
            self.roots_below_tops(word, &mut roots);
            return roots;
        };
        if before.is_empty() {
            roots.push(place);
        }
        for dim in before.len().max(1)..self.counts().len() {
            let sets = lists.sets(last, dim).iter().filter(|&&set| self.passes_through(set, before));
            roots.extend(sets.filter_map(|&set| Some(Place::within(set, self.arena.search(set, last).ok()?))));
        }
        roots
    }

    /// Whether the way up from a set meets all of the labels, which increase.
    fn passes_through(&self, mut set: u32, labels: &[u32]) -> bool {
        let mut wanted = labels;
        while let [rest @ .., last] = wanted {
            if set == NONE {
                return false;
            }
            let (parent, label) = self.arena.parent(set);
            if label < *last {
                return false;
            }
            if label == *last {
                wanted = rest;
            }
            set = parent;
        }
        true
    }

    fn roots_below_tops(&self, word: &[u32], roots: &mut Vec<Place>) {
        let [first, rest @ ..] = word else { return };
        for (_, set) in self.lower_vertices(*first) {
            self.roots_below(set, word, roots);
        }
        match rest {
            [] => roots.push(Place::top(*first)),
            rest => self.roots_below(self.child_at(Place::top(*first)), rest, roots),
        }
    }

    /// The same below a set: `word` is what is still to be met on the way down.
    fn roots_below(&self, set: u32, word: &[u32], roots: &mut Vec<Place>) {
        // Of a coface below this set, the parent of the set with the next vertex of the word is a face: so the next
        // vertex is in this set, or nothing is below.
        let [next, rest @ ..] = word else { return };
        let Ok(index) = self.arena.search(set, *next) else { return };
        for before in 0..index {
            let child = self.arena.child(set, before);
            if child != NONE {
                self.roots_below(child, word, roots);
            }
        }
        match rest {
            [] => roots.push(Place::within(set, index)),
            rest => self.roots_below(self.arena.child(set, index), rest, roots),
        }
    }
}
