//! A relation of all simplices of a dimension at once: all vertex stars, all co-boundaries of edges, all adjacencies.
//!
//! One question about one simplex is answered by the core, which walks its star. For all of them that reads the same
//! rows again and again; a [`Sweep`] inverts the boundary instead: it goes through the simplices above, in the order in
//! which they lie, twice: once to count those at each face that is in the block at hand, once to put them where they
//! belong. Blocks are worked on by all threads, each in memory of a bounded size, and come in order.
//!
//! The answers are those of [`sig_core::Relations`], by increasing id.
//!
//! ```
//! use std::convert::Infallible;
//! use sig_tools::sweep::{Block, Sweep};
//! # fn sweep(complex: &sig_core::Complex<'_, u32>) -> Result<(), Infallible> {
//! // The number of tetrahedra at each vertex.
//! let sweep = Sweep::new(complex);
//! let count = |block: &Block<'_, u32>| block.iter().map(|(_, found)| found.len()).collect::<Vec<_>>();
//! let mut counts = Vec::new();
//! sweep.coboundary(0, 3, count, |block: Vec<usize>| Ok::<_, Infallible>(counts.extend(block)))
//! # }
//! ```

mod block;
mod invert;
mod lists;
mod ordered;
mod parts;
mod rows;

use std::ops::Range;
use std::sync::OnceLock;

pub use block::Block;
pub use ordered::in_order;
use sig_core::{Complex, Dim, Index, SimplexId};

use block::narrow;
use invert::{Overflow, Question, Sorter, binomial};
use lists::{Chunk, Lists};
use parts::Parts;
use rows::Rows;

/// Answers in a block, as a rule: few enough for the cache, many for what is read again at its edges.
const BLOCK: usize = 1 << 20;

/// Sweeps over the simplices of a complex.
///
/// The complex must be a right one, as its `validate` says: of another the answers mean nothing, but there is no panic.
///
/// # Order and threads
///
/// Every sweep takes two functions. The first one, `work`, is given blocks of consecutive simplices with their answers,
/// on any thread; the second one, `each`, what `work` makes of them, in the order of the ids, on the thread of the
/// caller. Errors of the second one end the sweep.
///
/// # Memory
///
/// For each thread an index an answer, for up to 2^21 answers, and for each simplex of the block 8 bytes and 4 for each
/// dimension of the answers; and what `work` makes of eight blocks. Of a simplex that has more answers, for as many as
/// it has. Blocks that turn out larger are done in halves.
pub struct Sweep<'c, 'a, I> {
    complex: &'c Complex<'a, I>,
    rows: Rows<'a, I>,
    parts: OnceLock<Parts>,
    block: usize,
}

impl<'c, 'a, I: Index> Sweep<'c, 'a, I> {
    /// Sweeps over a complex. Cost: none yet; the first sweep that looks upwards makes one pass over the edges, and
    /// keeps a few dozen numbers for each thousand simplices.
    #[must_use]
    pub fn new(complex: &'c Complex<'a, I>) -> Self {
        let rows = Rows::new(complex);
        Self { complex, rows, parts: OnceLock::new(), block: BLOCK }
    }

    /// The same with about so many answers in a block, more than 0: less memory, and more of the file read twice.
    #[must_use]
    pub fn with_block(self, answers: usize) -> Self {
        Self { block: answers.max(1), ..self }
    }

    /// C_{p,g} of all p-simplices: nothing for g ≤ p or g > d.
    ///
    /// Cost: about that of reading the boundary rows from dimension p + 1 to g in order, twice, and of writing the answers.
    /// Rows near the edge of a block are read again for the next: as many again, or fewer, where neighbours have near
    /// numbers; where vertices are numbered at random, all rows for each block. For g = d = p + 1 the lists of the file
    /// are the answers.
    ///
    /// # Errors
    /// The first of `each`.
    pub fn coboundary<T: Send, E>(
        &self,
        dim: Dim,
        of_dim: Dim,
        work: impl Fn(&Block<'_, I>) -> T + Sync,
        each: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        if of_dim == dim + 1 && of_dim + 1 == self.rows.dims() {
            return self.collect(dim, 2, |id, found| found.extend(self.listed(id)), work, each);
        }
        let dims = if of_dim > dim { of_dim..(of_dim + 1).min(self.rows.dims()) } else { 0..0 };
        self.invert(dim, &Question::Cofaces(dims), work, each)
    }

    /// The stars of all p-simplices, themselves included.
    ///
    /// Cost: as [`coboundary`](Self::coboundary) for each dimension above.
    ///
    /// # Errors
    /// The first of `each`.
    pub fn star<T: Send, E>(
        &self,
        dim: Dim,
        work: impl Fn(&Block<'_, I>) -> T + Sync,
        each: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        self.invert(dim, &Question::Cofaces(dim..self.rows.dims()), work, each)
    }

    /// A_p of all p-simplices: for p > 0 the other ones across each facet, facet after facet, by increasing id across
    /// each; for vertices the other ends of their edges, by increasing id.
    ///
    /// Two simplices share one facet at most, so none comes twice.
    ///
    /// Cost: for vertices as C_{0,1}; for p = d a look at the lists of all facets; and the answers. For 0 < p < d the
    /// sweep of C_{p−1,p} comes before, whose answers are kept: as many indices as the boundary rows of the p-simplices
    /// have, and a number for each (p−1)-simplex.
    ///
    /// # Errors
    /// The first of `each`.
    pub fn adjacency<T: Send, E>(
        &self,
        dim: Dim,
        work: impl Fn(&Block<'_, I>) -> T + Sync,
        each: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        if dim == 0 {
            return self.invert(0, &Question::OtherEnds, work, each);
        }
        if dim + 1 >= self.rows.dims() {
            let across = |id: usize, found: &mut Vec<I>| {
                let itself = narrow(id);
                for facet in self.rows.row(dim, id) {
                    found.extend(self.listed(facet.to_usize()).filter(|&other| other != itself));
                }
            };
            return self.collect(dim, dim + 1, across, work, each);
        }
        let cofacets = self.cofacets(dim - 1);
        let across = |id: usize, found: &mut Vec<I>| {
            for facet in self.rows.row(dim, id) {
                cofacets.append_others(facet.to_usize(), narrow(id), found);
            }
        };
        self.collect(dim, dim + 1, across, work, each)
    }

    /// What a SIG stores for a simplex; of one of dimension d − 1 the d-simplices around it, by increasing id.
    #[inline]
    fn listed(&self, simplex: usize) -> impl Iterator<Item = I> + use<'a, I> {
        self.complex.partial_coboundary(SimplexId::new(simplex)).map(|entry| narrow(entry.index()))
    }

    /// The answers C_{p,p+1} of all p-simplices.
    fn cofacets(&self, dim: Dim) -> Lists<I> {
        let ids = self.rows.ids(dim);
        let (parts, question) = (self.parts(), Question::Cofaces(dim + 1..dim + 2));
        let shift = self.num_in_block(self.num_incidences(dim, dim + 1), ids.len()).ilog2();
        let answer = |sorter: &mut Sorter<I>, block: Range<usize>| {
            let mut chunk = Chunk::new();
            self.answer((sorter, parts), dim, &question, block, |found| chunk.push(found));
            chunk
        };
        let mut chunks = Vec::new();
        let Ok(()) = in_order(blocks(ids.clone(), 1 << shift), Sorter::new, answer, |chunk| {
            chunks.push(chunk);
            Ok::<(), std::convert::Infallible>(())
        });
        Lists::new(ids.start, chunks, shift)
    }

    /// Answers a question by inversion.
    fn invert<T: Send, E>(
        &self,
        dim: Dim,
        question: &Question,
        work: impl Fn(&Block<'_, I>) -> T + Sync,
        mut each: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        let ids = self.rows.ids(dim);
        let answers = match question {
            Question::Cofaces(dims) => dims.clone().map(|above| self.num_incidences(dim, above)).sum(),
            Question::OtherEnds => self.num_incidences(0, 1),
        };
        let len = self.num_in_block(answers, ids.len());
        let parts = self.parts();
        let answer = |sorter: &mut Sorter<I>, block: Range<usize>| {
            let mut results = Vec::new();
            self.answer((sorter, parts), dim, question, block, |found| results.push(work(found)));
            results
        };
        in_order(blocks(ids, len), Sorter::new, answer, |results| results.into_iter().try_for_each(&mut each))
    }

    /// The parts of the vertices, found at the first call: to be made by a thread that does not answer.
    fn parts(&self) -> &Parts {
        self.parts.get_or_init(|| Parts::new(&self.rows, (self.block / 64).clamp(1, 1 << 10)))
    }

    /// Answers a question about consecutive simplices, in pieces where there is much to say.
    fn answer(
        &self,
        (sorter, parts): (&mut Sorter<I>, &Parts),
        dim: Dim,
        question: &Question,
        block: Range<usize>,
        mut each: impl FnMut(&Block<'_, I>),
    ) {
        let room = u32::try_from(self.block.saturating_mul(2)).unwrap_or(u32::MAX);
        // Those still to be done, the last one next.
        let mut waiting = vec![block];
        while let Some(block) = waiting.pop() {
            match sorter.answer((&self.rows, parts), question, (dim, block.clone()), room) {
                Ok(found) => each(&found),
                Err(Overflow) => {
                    let middle = block.start + block.len() / 2;
                    waiting.extend([middle..block.end, block.start..middle]);
                }
            }
        }
    }

    /// What `answer` adds to a list for each simplex, about `each_has` for one.
    fn collect<T: Send, E>(
        &self,
        dim: Dim,
        each_has: usize,
        answer: impl Fn(usize, &mut Vec<I>) + Sync,
        work: impl Fn(&Block<'_, I>) -> T + Sync,
        mut each: impl FnMut(T) -> Result<(), E>,
    ) -> Result<(), E> {
        let ids = self.rows.ids(dim);
        // A block ends where there are too many answers.
        let len = self.num_in_block(ids.len().saturating_mul(each_has), ids.len());
        let answers = |(starts, found): &mut (Vec<usize>, Vec<I>), block: Range<usize>| {
            let mut results = Vec::new();
            let mut first = block.start;
            for id in block.clone() {
                if id == first {
                    found.clear();
                    starts.clear();
                    starts.push(0);
                }
                answer(id, found);
                starts.push(found.len());
                if found.len() >= self.block || id + 1 == block.end {
                    results.push(work(&Block::new(first, starts, found)));
                    first = id + 1;
                }
            }
            results
        };
        let init = || (Vec::new(), Vec::new());
        in_order(blocks(ids, len), init, answers, |results| results.into_iter().try_for_each(&mut each))
    }

    /// How often simplices of one dimension are faces of those of another, or of their own.
    fn num_incidences(&self, dim: Dim, above: Dim) -> usize {
        self.rows.ids(above).len().saturating_mul(binomial(above + 1, dim + 1))
    }

    /// How many of `count` simplices, which have `answers` together, make a block; of few, so many that each thread has
    /// some.
    fn num_in_block(&self, answers: usize, count: usize) -> usize {
        let most = u32::MAX as usize / 2;
        let by_answers = (self.block as u128 * count as u128 / answers.max(1) as u128).min(most as u128);
        let by_threads = count.div_ceil(4 * rayon::current_num_threads()).max(256);
        usize::try_from(by_answers).unwrap_or(most).min(by_threads).max(1)
    }
}

/// Consecutive ids in blocks.
fn blocks(ids: Range<usize>, len: usize) -> impl Iterator<Item = Range<usize>> {
    ids.clone().step_by(len).map(move |start| start..(start + len).min(ids.end))
}
