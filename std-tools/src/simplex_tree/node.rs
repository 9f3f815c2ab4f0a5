//! A node of the tree and its relatives: [`Simplex`].

use sig_core::{Dim, MAX_DIM};

use super::arena::NONE;
use super::{DepthFirst, SimplexTree};

/// Where a node is, until the tree changes: a set and a place in it, or no set and the label of a vertex.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Place {
    pub(super) set: u32,
    pub(super) index: u32,
}

impl Place {
    pub(super) const fn top(label: u32) -> Self {
        Self { set: NONE, index: label }
    }

    pub(super) fn within(set: u32, index: usize) -> Self {
        Self { set, index: crate::build::narrow(index) }
    }
}

/// A simplex of a tree: a node, and with it the word that leads there.
#[derive(Clone, Copy)]
pub struct Simplex<'a> {
    tree: &'a SimplexTree,
    place: Place,
}

impl std::fmt::Debug for Simplex<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Simplex").field(&self.word()).field(&self.value()).finish()
    }
}

impl<'a> Simplex<'a> {
    pub(super) const fn new(tree: &'a SimplexTree, place: Place) -> Self {
        Self { tree, place }
    }

    /// The last vertex. Cost: O(1).
    #[must_use]
    pub fn label(self) -> u32 {
        self.tree.label_at(self.place)
    }

    /// The filtration value, 0 in trees without. Cost: O(1).
    #[must_use]
    pub fn value(self) -> f64 {
        self.tree.value_at(self.place)
    }

    /// The dimension. Cost: O(p).
    #[must_use]
    pub fn dim(self) -> Dim {
        self.tree.dim_of_set(self.place.set)
    }

    /// The vertices, decreasing: up the tree. Cost: O(p).
    pub fn labels_upward(self) -> impl Iterator<Item = u32> + use<'a> {
        let first = (self.label(), self.place.set);
        std::iter::successors(Some(first), move |&(_, set)| {
            (set != NONE).then(|| {
                let (parent, label) = self.tree.arena.parent(set);
                (label, parent)
            })
        })
        .map(|(label, _)| label)
    }

    /// The vertices, increasing. Cost: O(p).
    #[must_use]
    pub fn word(self) -> Vec<u32> {
        let mut word: Vec<u32> = self.labels_upward().collect();
        word.reverse();
        word
    }

    /// The parent: the face without the last vertex; `None` for a vertex, whose parent is the root. Cost: `D_m`.
    #[must_use]
    pub fn parent(self) -> Option<Self> {
        (self.place.set != NONE).then(|| Self::new(self.tree, self.tree.parent_of_set(self.place.set)))
    }

    /// The children: the simplices with one vertex more, after the last one. Cost: O(1), and as much for each.
    pub fn children(self) -> impl ExactSizeIterator<Item = Self> + use<'a> {
        let Self { tree, place } = self;
        let set = tree.child_at(place);
        (0..tree.arena.labels(set).len()).map(move |index| Self::new(tree, Place::within(set, index)))
    }

    /// The simplices with the same parent, this one among them. Cost: O(1), and as much for each.
    pub fn siblings(self) -> impl Iterator<Item = Self> + use<'a> {
        let Self { tree, place: Place { set, .. } } = self;
        let tops = (set == NONE).then(|| tree.tops.labels().map(Place::top)).into_iter().flatten();
        let within = (0..tree.arena.labels(set).len()).map(move |index| Place::within(set, index));
        tops.chain(within).map(move |place| Self::new(tree, place))
    }

    /// The facets; the i-th omits the i-th vertex, and is `None` if it is not there, which it is in a complex. None for a
    /// vertex. Cost: O(p² `D_m`), the paper's (2.2.1, *Locate facets*).
    pub fn facets(self) -> impl ExactSizeIterator<Item = Option<Self>> + use<'a> {
        let tree = self.tree;
        let mut word = [0; MAX_DIM + 1];
        let mut len = 0;
        for label in self.labels_upward() {
            word[len] = label;
            len += 1;
        }
        word[..len].reverse();
        // The nodes on the way down to this one: each facet branches off at one of them.
        let mut path = [Place::top(0); MAX_DIM + 1];
        let mut place = self.place;
        for step in path[..len].iter_mut().rev() {
            *step = place;
            if place.set != NONE {
                place = tree.parent_of_set(place.set);
            }
        }
        let count = if len == 1 { 0 } else { len };
        (0..count).map(move |omitted| {
            let start = omitted.checked_sub(1).map(|above| path[above]);
            tree.descend(start, &word[omitted + 1..len]).map(|place| Self::new(tree, place))
        })
    }

    /// This simplex and those below it in the tree, whose words start with its word: depth-first. Cost: O(1) each.
    #[must_use]
    pub fn descendants(self) -> DepthFirst<'a> {
        DepthFirst::below(self.tree, self.place)
    }
}

impl SimplexTree {
    /// The simplex with these vertices, which must increase strictly; `None` if it is not there, or if they do not.
    ///
    /// Cost: O(p `D_m`), the paper's (2.2.1).
    #[must_use]
    pub fn find(&self, word: &[u32]) -> Option<Simplex<'_>> {
        self.locate(word).map(|place| Simplex::new(self, place))
    }

    /// Whether the simplex with these vertices is there. Cost: as [`find`](Self::find).
    #[must_use]
    pub fn contains(&self, word: &[u32]) -> bool {
        self.locate(word).is_some()
    }

    pub(super) fn locate(&self, word: &[u32]) -> Option<Place> {
        if word.is_empty() { None } else { self.descend(None, word) }
    }

    /// The node that the labels lead to, from a node or from the root.
    #[inline]
    pub(super) fn descend(&self, from: Option<Place>, labels: &[u32]) -> Option<Place> {
        let (mut place, rest) = match (from, labels) {
            (Some(place), _) => (place, labels),
            (None, [first, rest @ ..]) if self.tops.get(*first).is_some() => (Place::top(*first), rest),
            _ => return None,
        };
        for &label in rest {
            let set = self.child_at(place);
            place = Place::within(set, self.arena.search(set, label).ok()?);
        }
        Some(place)
    }

    #[inline]
    pub(super) fn child_at(&self, place: Place) -> u32 {
        match place.set {
            NONE => self.tops.get(place.index).map_or(NONE, |top| top.child),
            set => self.arena.child(set, place.index as usize),
        }
    }

    pub(super) fn set_child_at(&mut self, place: Place, child: u32) {
        match place.set {
            NONE => {
                if let Some(top) = self.tops.get_mut(place.index) {
                    top.child = child;
                }
            }
            set => self.arena.set_child(set, place.index as usize, child),
        }
    }

    #[inline]
    pub(super) fn value_at(&self, place: Place) -> f64 {
        match place.set {
            NONE => self.tops.get(place.index).map_or(0.0, |top| top.value),
            set => self.arena.value(set, place.index as usize),
        }
    }

    pub(super) fn set_value_at(&mut self, place: Place, value: f64) {
        match place.set {
            NONE => {
                if let Some(top) = self.tops.get_mut(place.index).filter(|_| self.arena.is_filtered()) {
                    top.value = value;
                }
            }
            set => self.arena.set_value(set, place.index as usize, value),
        }
    }

    pub(super) fn label_at(&self, place: Place) -> u32 {
        match place.set {
            NONE => place.index,
            set => self.arena.nodes(set).get(place.index as usize).map_or(u32::MAX, |node| node.label),
        }
    }

    /// The node whose children a set holds.
    pub(super) fn parent_of_set(&self, set: u32) -> Place {
        let (parent, label) = self.arena.parent(set);
        match parent {
            NONE => Place::top(label),
            // Present, for the parent of a set is in the tree as long as the set is.
            parent => Place::within(parent, self.arena.search(parent, label).unwrap_or(0)),
        }
    }

    /// The dimension of the simplices in a set.
    pub(super) fn dim_of_set(&self, mut set: u32) -> Dim {
        let mut dim = 0;
        while set != NONE {
            set = self.arena.parent(set).0;
            dim += 1;
        }
        dim
    }
}
