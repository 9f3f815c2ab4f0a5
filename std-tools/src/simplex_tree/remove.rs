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
            self.remove_leaf(root, dim)?;
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

    /// Removes a node without children, of dimension `dim`.
    fn remove_leaf(&mut self, place: Place, dim: Dim) -> Result<(), SizeError> {
        self.counts[dim] -= 1;
        let Place { set, index } = place;
        if set == NONE {
            self.tops.remove(index);
            return Ok(());
        }
        self.unlist(set, index as usize, dim);
        let parent = self.parent_of_set(set);
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
