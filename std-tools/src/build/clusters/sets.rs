//! Disjoint sets of numbers: [`Sets`].

/// Disjoint sets of items. A set is a tree with its least item as the root: every other item points to a lesser one.
#[derive(Default)]
pub(super) struct Sets {
    items: Vec<usize>,
}

impl Sets {
    /// Items, every one alone.
    pub(super) fn reset(&mut self, count: usize) {
        self.items.clear();
        self.items.extend(0..count);
    }

    fn root(&mut self, mut item: usize) -> usize {
        loop {
            let parent = self.items[item];
            if parent == item {
                return item;
            }
            let grandparent = self.items[parent];
            self.items[item] = grandparent;
            item = grandparent;
        }
    }

    /// Makes one set of those of two items.
    #[inline]
    pub(super) fn join(&mut self, a: usize, b: usize) {
        // As a rule they are one set already, and point to its root.
        if self.items[a] != self.items[b] {
            self.join_roots(a, b);
        }
    }

    fn join_roots(&mut self, a: usize, b: usize) {
        let (a, b) = (self.root(a), self.root(b));
        self.items[a.max(b)] = a.min(b);
    }

    /// Makes an item point to the root of its set; whether it is the root. To be called for all items in order, after all
    /// are joined.
    #[inline]
    pub(super) fn settle(&mut self, item: usize) -> bool {
        let root = self.items[self.items[item]];
        self.items[item] = root;
        root == item
    }

    /// The root of the set of a settled item.
    #[inline]
    pub(super) fn root_of_settled(&self, item: usize) -> usize {
        self.items[item]
    }
}
