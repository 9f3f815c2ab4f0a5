//! Memory for queries, on the heap.

use sig_core::{Index, Relations, Scratch, ScratchError, mark_words};

/// Memory for the queries on one complex: as much as any of them needs, and more on demand.
///
/// Made of zeroed memory, of which the system hands out only the pages that are used: a scratch for a complex of a
/// hundred million simplices costs no more than the queries touch.
///
/// ```
/// # use sig_core::{Complex, ScratchError, SimplexId};
/// # fn sweep(complex: &Complex<'_, u32>) -> Result<(), ScratchError> {
/// let mut memory = sig_tools::OwnedScratch::new(complex);
/// // One scratch for the whole sweep: making it clears all marks, a query only those that it set.
/// let mut scratch = memory.scratch();
/// for vertex in complex.simplices_of_dim(0) {
///     let star = complex.star(vertex, &mut scratch)?;
///     println!("{vertex}: {}", star.len());
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct OwnedScratch<I> {
    marks: Vec<u32>,
    queue: Vec<I>,
    masks: Vec<u32>,
    found: Vec<I>,
}

/// Entries of a queue and of an answer at the start, at most.
const MOST: usize = 1 << 28;

impl<I: Index> OwnedScratch<I> {
    /// Memory for the queries on `complex`: a mark, a queue entry and an entry of the answer for each simplex,
    /// and a queue entry for each vertex.
    ///
    /// That is enough for every query but [`k_adjacency`](Relations::k_adjacency) (and so
    /// [`adjacency`](Relations::adjacency)) around very many simplices of high dimension, which gathers repetitions:
    /// see [`run`](Self::run). The entries are 2^28 at most, for systems refuse to promise more memory than they have;
    /// a query with an answer larger than that is one for [`run`](Self::run), too.
    #[must_use]
    pub fn new(complex: &impl Relations<Index = I>) -> Self {
        let simplices = complex.num_simplices();
        // Vertices without edges take no bytes, and there may be any number of them. An answer has none of them but the
        // one that was asked for.
        let count = if complex.dim() == Some(0) { 1 } else { simplices.min(MOST) };
        let queue =
            if complex.dim() == Some(0) { 1 } else { simplices.saturating_add(complex.num_vertices()).min(MOST) };
        Self {
            marks: vec![0; mark_words(simplices)],
            queue: vec![I::ZERO; queue],
            masks: vec![0; queue],
            found: vec![I::ZERO; count],
        }
    }

    /// The scratch to query with. Cost: clearing the marks, a bit for each simplex; keep it over many queries.
    #[must_use]
    pub fn scratch(&mut self) -> Scratch<'_, I> {
        Scratch::new(&mut self.marks, &mut self.queue, &mut self.masks, &mut self.found)
    }

    /// Adds what a query lacked: at least that much, and at least half as much as there was.
    pub fn grow(&mut self, lacking: ScratchError) {
        let more = |needed: usize, available: usize| needed.max(available.saturating_add(available / 2));
        match lacking {
            ScratchError::Marks { needed, .. } => self.marks.resize(needed, 0),
            ScratchError::Queue { at_least, available } => {
                self.queue.resize(more(at_least, available), I::ZERO);
                self.masks.resize(more(at_least, available), 0);
            }
            ScratchError::Found { at_least, available } => self.found.resize(more(at_least, available), I::ZERO),
            // A part that this crate does not know of: twice as much of all.
            _ => {
                self.marks.resize(self.marks.len() * 2 + 1, 0);
                self.queue.resize(self.queue.len() * 2 + 1, I::ZERO);
                self.masks.resize(self.masks.len() * 2 + 1, 0);
                self.found.resize(self.found.len() * 2 + 1, I::ZERO);
            }
        }
    }

    /// The answer of one query, with as much memory as it needs.
    pub fn run<T>(&mut self, mut query: impl FnMut(&mut Scratch<'_, I>) -> Result<T, ScratchError>) -> T {
        loop {
            match query(&mut self.scratch()) {
                Ok(answer) => return answer,
                Err(lacking) => self.grow(lacking),
            }
        }
    }
}
