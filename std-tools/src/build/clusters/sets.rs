//! Disjoint sets of numbers, joined by many threads at a time: [`Sets`].

use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use rayon::prelude::*;
use sig_core::Index;

use crate::build::index;

/// An index type, and the same in memory that threads share. All accesses are relaxed: what orders them is that rayon
/// waits for its threads between the phases.
pub(in crate::build) trait Cell: Index {
    /// A number that threads share.
    type Shared: Send + Sync;
    fn share(self) -> Self::Shared;
    fn load(shared: &Self::Shared) -> Self;
    fn store(shared: &Self::Shared, value: Self);
    /// Replaces `old` by `new`; false if it is not `old`.
    fn replace(shared: &Self::Shared, old: Self, new: Self) -> bool;
    /// Replaces what is greater than `value` by it; what was there.
    fn lower(shared: &Self::Shared, value: Self) -> Self;
    fn into_inner(shared: Self::Shared) -> Self;
    /// The highest bit.
    const HIGH_BIT: Self;
    fn has_high_bit(self) -> bool;
    fn with_high_bit(self) -> Self;
    fn without_high_bit(self) -> Self;
}

macro_rules! impl_cell {
    ($($int:ty => $atomic:ty),*) => {$(
        impl Cell for $int {
            type Shared = $atomic;

            #[inline]
            fn share(self) -> $atomic {
                <$atomic>::new(self)
            }

            #[inline]
            fn load(shared: &$atomic) -> Self {
                shared.load(Ordering::Relaxed)
            }

            #[inline]
            fn store(shared: &$atomic, value: Self) {
                shared.store(value, Ordering::Relaxed);
            }

            #[inline]
            fn replace(shared: &$atomic, old: Self, new: Self) -> bool {
                shared.compare_exchange(old, new, Ordering::Relaxed, Ordering::Relaxed).is_ok()
            }

            #[inline]
            fn lower(shared: &$atomic, value: Self) -> Self {
                shared.fetch_min(value, Ordering::Relaxed)
            }

            #[inline]
            fn into_inner(shared: $atomic) -> Self {
                shared.into_inner()
            }

            const HIGH_BIT: Self = 1 << (<$int>::BITS - 1);

            #[inline]
            fn has_high_bit(self) -> bool {
                self & Self::HIGH_BIT != 0
            }

            #[inline]
            fn with_high_bit(self) -> Self {
                self | Self::HIGH_BIT
            }

            #[inline]
            fn without_high_bit(self) -> Self {
                self & !Self::HIGH_BIT
            }
        }
    )*};
}

impl_cell!(u32 => AtomicU32, u64 => AtomicU64);

/// Disjoint sets of items, which can then be given numbers, *classes*.
///
/// A set is a tree with its least item as the root, whoever joins first: every other item points to a lesser one. That
/// stays so whatever the threads do, for only a root is ever made to point elsewhere, by compare and exchange, and
/// shortening a path keeps it within the tree. Once classes are given, an item holds its class, with the high bit set.
pub(super) struct Sets<U: Cell> {
    items: Vec<U::Shared>,
}

impl<U: Cell> Sets<U> {
    /// The most items: the high bit is for the classes.
    pub(super) const MOST_ITEMS: usize = 1 << (8 * size_of::<U>() - 1);

    /// Every item alone.
    pub(super) fn new(count: usize) -> Self {
        Self { items: (0..count).into_par_iter().map(|item| index::<U>(item).share()).collect() }
    }

    #[inline]
    fn parent(&self, item: usize) -> usize {
        U::load(&self.items[item]).to_usize()
    }

    fn root(&self, mut item: usize) -> usize {
        loop {
            let parent = self.parent(item);
            let grandparent = self.parent(parent);
            if grandparent == parent {
                return parent;
            }
            U::store(&self.items[item], index(grandparent));
            item = grandparent;
        }
    }

    /// Makes one set of those of two items.
    #[inline]
    pub(super) fn join(&self, a: usize, b: usize) {
        // As a rule they are one set already, and point to its root.
        if self.parent(a) != self.parent(b) {
            self.join_roots(a, b);
        }
    }

    fn join_roots(&self, a: usize, b: usize) {
        loop {
            let (a, b) = (self.root(a), self.root(b));
            let (least, most) = (a.min(b), a.max(b));
            if least == most || U::replace(&self.items[most], index(most), index(least)) {
                return;
            }
        }
    }

    /// Makes an item point to the root of its set; whether it is the root. To be called for all items after all are
    /// joined.
    #[inline]
    pub(super) fn settle(&self, item: usize) -> bool {
        let root = self.root(item);
        if root != item {
            U::store(&self.items[item], index(root));
        }
        root == item
    }

    /// Whether a settled item is the root of its set.
    #[inline]
    pub(super) fn is_root(&self, item: usize) -> bool {
        self.parent(item) == item
    }

    /// Gives the set of `root` a class. To be called for all roots after all items are settled.
    #[inline]
    pub(super) fn name(&self, root: usize, class: usize) {
        U::store(&self.items[root], index::<U>(class).with_high_bit());
    }

    /// Gives an item the class of its set. To be called for all items after all sets have a class.
    #[inline]
    pub(super) fn resolve(&self, item: usize) {
        let parent = U::load(&self.items[item]);
        if !parent.has_high_bit() {
            U::store(&self.items[item], U::load(&self.items[parent.to_usize()]));
        }
    }

    /// The class of an item.
    #[inline]
    pub(super) fn class(&self, item: usize) -> usize {
        U::load(&self.items[item]).without_high_bit().to_usize()
    }
}
