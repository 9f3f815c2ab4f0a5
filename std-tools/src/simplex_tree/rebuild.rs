//! What makes the tree anew, in blocks that lie depth-first: pruning, making compact, label lists, relabelling.

use std::collections::BTreeMap;

use sig_core::Dim;

use super::arena::NONE;
use super::node::Place;
use super::{RelabelError, SimplexTree, SizeError};

/// A child to be: its label, its value, and what its own children are found by.
pub(super) type Member<N> = (u32, f64, N);

impl SimplexTree {
    /// Removes the simplices with a filtration value above `value`, which leaves a complex if values are monotone; how
    /// many those are. The tree is compact afterwards.
    ///
    /// Cost: O(1) for each simplex that stays. Needs memory for both trees while it runs.
    ///
    /// # Errors
    /// [`SizeError`], which cannot be where the tree has room itself.
    pub fn prune_above_value(&mut self, value: f64) -> Result<usize, SizeError> {
        self.retain(|_, other| other <= value)
    }

    /// Removes the simplices of dimension above `dim`; how many those are. Cost and errors as
    /// [`prune_above_value`](Self::prune_above_value).
    ///
    /// # Errors
    /// [`SizeError`], which cannot be where the tree has room itself.
    pub fn prune_above_dim(&mut self, dim: Dim) -> Result<usize, SizeError> {
        self.retain(|other, _| other <= dim)
    }

    /// Moves all sets together, depth-first, so that free blocks give their memory back and walks read on. Cost: O(1) for
    /// each simplex, and memory for both trees while it runs.
    ///
    /// # Errors
    /// [`SizeError`], which cannot be where the tree has room itself.
    pub fn make_compact(&mut self) -> Result<(), SizeError> {
        self.retain(|_, _| true).map(drop)
    }

    /// Keeps label lists from now on, which make [`star`](Self::star) and all that needs it depend on the star and not on
    /// the complex. They take 8 bytes a simplex, and time with each change. Cost: that of
    /// [`make_compact`](Self::make_compact).
    ///
    /// # Errors
    /// [`SizeError`]: if there is no room.
    pub fn keep_label_lists(&mut self) -> Result<(), SizeError> {
        *self = self.copied(true, |_, _| true)?;
        Ok(())
    }

    /// Keeps no label lists any more. Cost: that of [`make_compact`](Self::make_compact).
    ///
    /// # Errors
    /// [`SizeError`], which cannot be where the tree has room itself.
    pub fn drop_label_lists(&mut self) -> Result<(), SizeError> {
        *self = self.copied(false, |_, _| true)?;
        Ok(())
    }

    fn retain(&mut self, stays: impl Fn(Dim, f64) -> bool) -> Result<usize, SizeError> {
        let before = self.num_simplices();
        *self = self.copied(self.has_label_lists(), stays)?;
        Ok(before - self.num_simplices())
    }

    /// A copy of the simplices that stay with all their ancestors.
    fn copied(&self, listed: bool, stays: impl Fn(Dim, f64) -> bool) -> Result<Self, SizeError> {
        let mut copy = Self::with_layout(self.has_filtration(), listed);
        let children = |set: u32, dim: Dim, members: &mut Vec<Member<u32>>| {
            for (index, label) in self.arena.labels(set).enumerate() {
                let value = self.arena.value(set, index);
                if stays(dim, value) {
                    members.push((label, value, self.arena.child(set, index)));
                }
            }
            Ok(())
        };
        let mut growth = Growth { tree: &mut copy, children, pool: Vec::new() };
        for label in self.tops.labels() {
            let place = Place::top(label);
            let value = self.value_at(place);
            if stays(0, value) {
                growth.vertex(label, value, self.child_at(place))?;
            }
        }
        Ok(copy)
    }

    /// Gives each vertex the label that a function tells, no two the same.
    ///
    /// Cost: the insertion of all simplices, O(p `D_m`) each, and memory for both trees.
    ///
    /// # Errors
    /// [`RelabelError`]: if two vertices would have one label. The tree is what it was then.
    pub fn relabel(&mut self, label: impl Fn(u32) -> u32) -> Result<(), RelabelError> {
        let mut taken = BTreeMap::new();
        for before in self.tops.labels() {
            let after = label(before);
            if after == u32::MAX {
                return Err(RelabelError::ReservedLabel);
            }
            if let Some(other) = taken.insert(after, before) {
                return Err(RelabelError::Collision(other, before, after));
            }
        }
        let mut relabelled = Self::with_layout(self.has_filtration(), self.has_label_lists());
        // By dimension, so that prefixes are there with their own values.
        for simplex in self.by_dimension() {
            let mut word: Vec<u32> = simplex.labels_upward().map(&label).collect();
            word.sort_unstable();
            relabelled.insert_path(&word, simplex.value())?;
        }
        *self = relabelled;
        Ok(())
    }
}

/// A tree that grows depth-first from a source of children: for each node of the source, `children` tells those of the
/// given dimension, labels increasing.
pub(super) struct Growth<'t, N, F> {
    pub(super) tree: &'t mut SimplexTree,
    pub(super) children: F,
    /// Buffers that wait for use.
    pub(super) pool: Vec<Vec<Member<N>>>,
}

impl<N, F> Growth<'_, N, F>
where
    N: Copy,
{
    /// Adds a vertex and what is below it.
    pub(super) fn vertex<E: From<SizeError>>(&mut self, label: u32, value: f64, node: N) -> Result<(), E>
    where
        F: FnMut(N, Dim, &mut Vec<Member<N>>) -> Result<(), E>,
    {
        self.tree.insert_top(label, value, true);
        self.below(Place::top(label), node, 1)
    }

    /// Adds the children of a node, of dimension `dim`, and all below them.
    fn below<E: From<SizeError>>(&mut self, parent: Place, node: N, dim: Dim) -> Result<(), E>
    where
        F: FnMut(N, Dim, &mut Vec<Member<N>>) -> Result<(), E>,
    {
        let mut members = self.pool.pop().unwrap_or_default();
        members.clear();
        (self.children)(node, dim, &mut members)?;
        if !members.is_empty() {
            let set = self.tree.add_set(parent, dim, members.iter().map(|&(label, value, _)| (label, value)))?;
            for (index, &(_, _, node)) in members.iter().enumerate() {
                self.below(Place::within(set, index), node, dim + 1)?;
            }
        }
        self.pool.push(members);
        Ok(())
    }
}

impl SimplexTree {
    /// Gives a node without children its children, of dimension `dim`, labels increasing.
    pub(super) fn add_set(
        &mut self,
        parent: Place,
        dim: Dim,
        members: impl ExactSizeIterator<Item = (u32, f64)>,
    ) -> Result<u32, SizeError> {
        debug_assert_eq!(self.child_at(parent), NONE);
        let set = self.arena.allocate(parent.set, self.label_at(parent), members.len())?;
        self.counts[dim] += members.len();
        for (index, (label, value)) in members.enumerate() {
            self.arena.write(set, index, label, value);
        }
        self.set_child_at(parent, set);
        self.list_new(set, dim);
        Ok(set)
    }
}
