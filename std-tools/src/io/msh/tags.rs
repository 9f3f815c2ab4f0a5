//! Tags of nodes or elements, and the way from a tag to a number.

/// Tags in the order of the file; the number of a node or element is its place.
pub(super) struct Tags {
    tags: Vec<u64>,
    index: Index,
}

/// The way from a tag to a number, the cheapest that the tags allow.
enum Index {
    /// The tags count up from this one.
    Consecutive(u64),
    /// The number by tag, `u32::MAX` where there is none: for tags not much greater than their number.
    Table(Vec<u32>),
    /// Tags and numbers, sorted by tag.
    Sorted(Vec<(u64, u32)>),
}

impl Tags {
    pub(super) fn new() -> Self {
        Self { tags: Vec::new(), index: Index::Consecutive(0) }
    }

    pub(super) fn len(&self) -> usize {
        self.tags.len()
    }

    pub(super) fn as_slice(&self) -> &[u64] {
        &self.tags
    }

    /// Adds a tag; false if there can be no more.
    pub(super) fn push(&mut self, tag: u64) -> bool {
        self.tags.push(tag);
        self.tags.len() < u32::MAX as usize
    }

    /// Prepares [`Self::find`], now that all tags are there.
    ///
    /// # Errors
    /// A tag that two bear.
    pub(super) fn index(&mut self) -> Result<(), u64> {
        let first = self.tags.first().copied().unwrap_or(0);
        let consecutive = self.tags.iter().zip(0..).all(|(&tag, number)| tag.checked_sub(first) == Some(number));
        let greatest = self.tags.iter().copied().max().unwrap_or(0);
        let numbers = 0..u32::MAX;
        if consecutive {
            self.index = Index::Consecutive(first);
        } else if let Some(size) = usize::try_from(greatest).ok().filter(|&size| size <= 4 * self.tags.len() + 1024) {
            let mut table = vec![u32::MAX; size + 1];
            for (&tag, number) in self.tags.iter().zip(numbers) {
                // The greatest tag fits the table, so all do.
                let slot = table.get_mut(usize::try_from(tag).unwrap_or(usize::MAX)).ok_or(tag)?;
                if *slot != u32::MAX {
                    return Err(tag);
                }
                *slot = number;
            }
            self.index = Index::Table(table);
        } else {
            let mut sorted: Vec<(u64, u32)> = self.tags.iter().copied().zip(numbers).collect();
            sorted.sort_unstable();
            if let Some(pair) = sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
                return Err(pair[0].0);
            }
            self.index = Index::Sorted(sorted);
        }
        Ok(())
    }

    /// The number of the tag.
    pub(super) fn find(&self, tag: u64) -> Option<u32> {
        match &self.index {
            Index::Consecutive(first) => {
                let number = u32::try_from(tag.checked_sub(*first)?).ok()?;
                ((number as usize) < self.tags.len()).then_some(number)
            }
            Index::Table(table) => table.get(usize::try_from(tag).ok()?).copied().filter(|&number| number != u32::MAX),
            Index::Sorted(sorted) => sorted.binary_search_by_key(&tag, |&(tag, _)| tag).ok().map(|at| sorted[at].1),
        }
    }

    /// The tags.
    pub(super) fn into_vec(self) -> Vec<u64> {
        self.tags
    }
}
