//! Removing a simplex with all its cofaces.

use sig_core::Dim;

use super::arena::NONE;
use super::node::Place;
use super::{SimplexTree, SizeError};

impl SimplexTree {
    /// Removes a simplex and all its cofaces, without which it would be no complex; how many simplices that were, 0 if it
    /// is not there.
    ///
    /// Cost: locating the cofaces ([`star`](Self::star); nothing for a simplex of the dimension of the complex), O(1) for
    /// each, and O(d) for each of the sets that loses one.
    ///
    /// # Errors
    /// [`SizeError`]: if the smaller sets find no room.
    pub fn remove(&mut self, word: &[u32]) -> Result<usize, SizeError> {
        // A simplex of the highest dimension is a leaf without cofaces, whose parent is on the way to it.
        if let [prefix @ .., last] = word
            && self.dim() == Some(prefix.len())
            && !prefix.is_empty()
        {
            let Some(parent) = self.locate(prefix) else { return Ok(0) };
            let set = self.child_at(parent);
            let Ok(index) = self.arena.search(set, *last) else { return Ok(0) };
            self.remove_leaf(Place::within(set, index), parent, prefix.len())?;
            return Ok(1);
        }
        let before = self.num_simplices();
        let roots = self.coface_roots(word);
        self.remove_subtrees(&roots)?;
        Ok(before - self.num_simplices())
    }

    /// Removes subtrees, none below another, and no two of whose roots are siblings: so that taking one out moves no other.
    pub(super) fn remove_subtrees(&mut self, roots: &[Place]) -> Result<(), SizeError> {
        for &root in roots {
            let dim = self.dim_of_set(root.set);
            self.release_below(self.child_at(root), dim + 1);
            self.set_child_at(root, NONE);
            if root.set == NONE {
                self.counts[0] -= 1;
                self.tops.remove(root.index);
            } else {
                self.remove_leaf(root, self.parent_of_set(root.set), dim)?;
            }
        }
        Ok(())
    }

    /// Gives back a set of p-simplices and all below it.
    fn release_below(&mut self, set: u32, dim: Dim) {
        if set == NONE {
            return;
        }
        let len = self.arena.len(set);
        for index in 0..len {
            self.release_below(self.arena.child(set, index), dim + 1);
            self.unlist(set, index, dim);
        }
        self.counts[dim] -= len;
        self.arena.release(set);
    }

    /// Removes a node without children, of dimension `dim` > 0.
    fn remove_leaf(&mut self, Place { set, index }: Place, parent: Place, dim: Dim) -> Result<(), SizeError> {
        self.counts[dim] -= 1;
        self.unlist(set, index as usize, dim);
        if self.arena.len(set) == 1 {
            self.set_child_at(parent, NONE);
            self.arena.release(set);
            return Ok(());
        }
        let moved = self.arena.take(set, index as usize)?;
        if moved != set {
            self.set_child_at(parent, moved);
            self.list_moved(moved, dim);
        }
        Ok(())
    }
}
