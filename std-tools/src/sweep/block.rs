//! The answers of a relation for consecutive simplices.

use sig_core::{Index, SimplexId};

/// What a relation gives for some consecutive simplices.
#[derive(Clone, Debug)]
pub struct Block<'b, I> {
    first: usize,
    /// One more than there are simplices.
    starts: &'b [usize],
    ids: &'b [I],
}

impl<'b, I: Index> Block<'b, I> {
    pub(super) const fn new(first: usize, starts: &'b [usize], ids: &'b [I]) -> Self {
        Self { first, starts, ids }
    }

    /// The simplices, each with its answer: ids at the width of the file.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (SimplexId, &'b [I])> + Clone + use<'b, I> {
        let ids = self.ids;
        let answer = move |bounds: &[usize]| ids.get(bounds[0]..bounds[1]).unwrap_or_default();
        let answers = self.starts.windows(2).map(answer);
        let ids = self.first..self.first + answers.len();
        ids.map(SimplexId::new).zip(answers)
    }

    /// The first of the simplices.
    #[must_use]
    pub const fn first(&self) -> SimplexId {
        SimplexId::new(self.first)
    }

    /// Where the answer of each simplex starts among all of them; one more, where the last one ends.
    #[must_use]
    pub const fn starts(&self) -> &'b [usize] {
        self.starts
    }

    /// The answers of all the simplices, one behind the other.
    #[must_use]
    pub const fn ids(&self) -> &'b [I] {
        self.ids
    }
}

/// An id of the complex, which is an index of its width.
#[inline]
pub(super) fn narrow<I: Index>(id: usize) -> I {
    I::from_usize(id).unwrap_or(I::STOP)
}
