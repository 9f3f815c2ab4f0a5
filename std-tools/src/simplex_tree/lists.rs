//! L_j(ℓ): the nodes of each depth with a given label (simplex-tree-2012, 2.1), by which cofaces are located.
//!
//! A list holds the handles of the sets that have a sibling of that label; each such sibling knows its slot in the list,
//! so that lists follow a set that moves. Trees keep lists only when they are asked to.

use hashbrown::HashMap;

use sig_core::Dim;

use super::SimplexTree;
use super::arena::UNLISTED;

/// The lists, by label and dimension; top nodes are in none.
#[derive(Clone, Default, Debug)]
pub(super) struct LabelLists {
    sets: HashMap<(u32, u8), Vec<u32>>,
}

impl LabelLists {
    /// The sets of p-simplices, p > 0, one of which has this last vertex.
    pub(super) fn sets(&self, label: u32, dim: Dim) -> &[u32] {
        self.sets.get(&key(label, dim)).map_or(&[], Vec::as_slice)
    }

    /// Adds a set to a list, and tells its slot.
    fn add(&mut self, label: u32, dim: Dim, set: u32) -> u32 {
        let list = self.sets.entry(key(label, dim)).or_default();
        list.push(set);
        crate::build::narrow(list.len() - 1)
    }
}

fn key(label: u32, dim: Dim) -> (u32, u8) {
    // Dimensions end at MAX_DIM.
    (label, u8::try_from(dim).unwrap_or(u8::MAX))
}

impl SimplexTree {
    /// Whether the tree keeps label lists.
    #[must_use]
    pub const fn has_label_lists(&self) -> bool {
        self.lists.is_some()
    }

    /// Puts those siblings of a set of p-simplices that are in no list yet into theirs.
    #[inline]
    pub(super) fn list_new(&mut self, set: u32, dim: Dim) {
        let Some(lists) = &mut self.lists else { return };
        for index in 0..self.arena.len(set) {
            if self.arena.slot(set, index) == UNLISTED {
                let slot = lists.add(self.arena.nodes(set)[index].label, dim, set);
                self.arena.set_slot(set, index, slot);
            }
        }
    }

    /// Tells the lists where the siblings of a set of p-simplices are now, all that are in one.
    pub(super) fn list_moved(&mut self, set: u32, dim: Dim) {
        let Some(lists) = &mut self.lists else { return };
        for (index, label) in self.arena.labels(set).enumerate() {
            let slot = self.arena.slot(set, index);
            if slot == UNLISTED {
                continue;
            }
            if let Some(entry) = lists.sets.get_mut(&key(label, dim)).and_then(|list| list.get_mut(slot as usize)) {
                *entry = set;
            }
        }
    }

    /// Takes a sibling of a set of p-simplices out of its list.
    pub(super) fn unlist(&mut self, set: u32, index: usize, dim: Dim) {
        let Some(lists) = &mut self.lists else { return };
        let (label, slot) = (self.arena.nodes(set)[index].label, self.arena.slot(set, index));
        let Some(list) = lists.sets.get_mut(&key(label, dim)).filter(|list| (slot as usize) < list.len()) else {
            return;
        };
        list.swap_remove(slot as usize);
        // The last of the list has taken the slot.
        match list.get(slot as usize) {
            Some(&other) => {
                if let Ok(index) = self.arena.search(other, label) {
                    self.arena.set_slot(other, index, slot);
                }
            }
            None if list.is_empty() => {
                lists.sets.remove(&key(label, dim));
            }
            None => {}
        }
    }
}
