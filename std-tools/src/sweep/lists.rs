//! The answers of many simplices, kept for answers that are put together from them.

use sig_core::Index;

use super::block::Block;

/// Ids that are copied at once: as many as two registers hold at 32 bits on the machines that have the smallest.
const LANES: usize = 8;

/// The answers of consecutive simplices, all of them kept.
pub(super) struct Lists<I> {
    /// The first simplex.
    first: usize,
    /// Those of 2^`shift` simplices each.
    chunks: Vec<Chunk<I>>,
    shift: u32,
}

/// The answers of some of the simplices.
pub(super) struct Chunk<I> {
    starts: Vec<usize>,
    /// Behind the answers are some ids more, so that whole lanes can be read.
    ids: Vec<I>,
}

impl<I: Index> Chunk<I> {
    pub(super) const fn new() -> Self {
        Self { starts: Vec::new(), ids: Vec::new() }
    }

    /// Adds those of the next simplices.
    pub(super) fn push(&mut self, block: &Block<'_, I>) {
        let end = self.starts.pop().unwrap_or(0);
        self.ids.truncate(end);
        self.starts.extend(block.starts().iter().map(|start| end + start));
        self.ids.reserve_exact(block.ids().len() + LANES + 1);
        self.ids.extend_from_slice(block.ids());
        self.ids.resize(self.ids.len() + LANES + 1, I::ZERO);
    }
}

impl<I: Index> Lists<I> {
    /// Of the simplices from `first`, of 2^`shift` in each chunk.
    pub(super) const fn new(first: usize, chunks: Vec<Chunk<I>>, shift: u32) -> Self {
        Self { first, chunks, shift }
    }

    /// Appends the list of a simplex without `itself`, which it holds; it is increasing.
    #[inline]
    pub(super) fn append_others(&self, simplex: usize, itself: I, found: &mut Vec<I>) {
        let place = simplex.wrapping_sub(self.first);
        let Some(chunk) = self.chunks.get(place >> self.shift) else { return };
        let starts = chunk.starts.get(place & ((1 << self.shift) - 1)..).and_then(|starts| starts.first_chunk());
        let Some(&[start, end]) = starts else { return };
        let others = end.saturating_sub(start + 1);
        let end = found.len() + others;
        for lane in (0..others).step_by(LANES) {
            if let Some(ids) = chunk.ids.get(start + lane..).and_then(|ids| ids.first_chunk()) {
                found.extend_from_slice(&without(ids, itself));
            }
        }
        found.truncate(end);
    }
}

/// Ids without the one that is not less than `itself`, of increasing ones.
#[inline]
fn without<I: Index>(ids: &[I; LANES + 1], itself: I) -> [I; LANES] {
    let (mut these, mut next) = ([I::ZERO; LANES], [I::ZERO; LANES]);
    these.copy_from_slice(&ids[..LANES]);
    next.copy_from_slice(&ids[1..]);
    for (this, next) in these.iter_mut().zip(next) {
        *this = if *this < itself { *this } else { next };
    }
    these
}
