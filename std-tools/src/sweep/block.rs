//! The answers of a relation for consecutive simplices, and their making by a counting sort.

use std::ops::Range;

use sig_core::{Dim, Index, SimplexId};

use super::parts::Parts;
use super::rows::Rows;

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

/// What is asked about each simplex.
#[derive(Clone)]
pub(super) enum Question {
    /// The cofaces of some dimensions; of its own, itself.
    Cofaces(Range<Dim>),
    /// The other ends of the edges at a vertex.
    OtherEnds,
}

/// Cofaces that are looked at between two checks of the room.
const PIECE: usize = 1 << 10;

/// More answers than there is room for.
pub(super) struct Overflow;

/// Memory to answer for one block after the other.
pub(super) struct Sorter<I> {
    /// The place of a simplex in the block, and one of its answer.
    pairs: Vec<(u32, I)>,
    /// How many pairs there are; behind them are old ones.
    len: usize,
    starts: Vec<usize>,
    ids: Vec<I>,
}

impl<I: Index> Sorter<I> {
    pub(super) const fn new() -> Self {
        Self { pairs: Vec::new(), len: 0, starts: Vec::new(), ids: Vec::new() }
    }

    /// Answers for consecutive simplices of a dimension, unless there is more than `room` to say.
    pub(super) fn answer(
        &mut self,
        (rows, parts): (&Rows<'_, I>, &Parts),
        question: &Question,
        (dim, block): (Dim, Range<usize>),
        room: usize,
    ) -> Result<Block<'_, I>, Overflow> {
        self.begin(block.len());
        let around = parts.around(dim, &block);
        let dims = match question {
            Question::Cofaces(dims) => dims.clone(),
            Question::OtherEnds => 1..2,
        };
        for above in dims {
            if above == dim {
                self.reserve(block.len());
                block.clone().for_each(|id| self.push(id - block.start, narrow(id)));
                continue;
            }
            let pieces = around.iter().flat_map(|&part| {
                let ids = parts.ids(above, part);
                ids.clone().step_by(PIECE).map(move |start| start..(start + PIECE).min(ids.end))
            });
            for cofaces in pieces {
                self.reserve(cofaces.len().saturating_mul(binomial(above + 1, dim + 1)));
                match question {
                    Question::Cofaces(_) => self.push_faces(rows, (dim, &block), (above, cofaces)),
                    Question::OtherEnds => self.push_ends(rows, &block, cofaces),
                }
                if self.len > room {
                    return Err(Overflow);
                }
            }
        }
        Ok(self.sort(&block))
    }

    /// Forgets what was answered before.
    fn begin(&mut self, simplices: usize) {
        self.len = 0;
        self.starts.clear();
        self.starts.resize(simplices + 3, 0);
    }

    /// Makes room for so many pairs more.
    fn reserve(&mut self, more: usize) {
        let needed = self.len + more;
        if self.pairs.len() < needed {
            self.pairs.resize(needed, (0, I::ZERO));
        }
    }

    /// Adds to the answer of the simplex at a place; to none, for a place past the block. Without a branch: which faces
    /// of a simplex are in a block is not to be foreseen.
    #[inline]
    #[expect(clippy::cast_possible_truncation, reason = "a block has less than 2^32 simplices")]
    fn push(&mut self, place: usize, id: I) {
        let end = self.starts.len() - 3;
        let clamped = place.min(end);
        if let Some(pair) = self.pairs.get_mut(self.len) {
            *pair = (clamped as u32, id);
        }
        if let Some(count) = self.starts.get_mut(clamped + 2) {
            *count += 1;
        }
        self.len += usize::from(clamped < end);
    }

    /// Adds each of some cofaces to the answers of its faces in the block.
    fn push_faces(
        &mut self,
        rows: &Rows<'_, I>,
        (dim, block): (Dim, &Range<usize>),
        (above, ids): (Dim, Range<usize>),
    ) {
        for (id, row) in ids.clone().zip(rows.of(above, &ids).chunks_exact(above + 1)) {
            let coface = narrow(id);
            rows.faces(above, row, above - dim, &mut |face: I| {
                self.push(face.to_usize().wrapping_sub(block.start), coface);
            });
        }
    }

    /// Adds each end of some edges to the answer of the other one, if that is in the block.
    fn push_ends(&mut self, rows: &Rows<'_, I>, block: &Range<usize>, edges: Range<usize>) {
        for ends in rows.of(1, &edges).chunks_exact(2) {
            self.push(ends[1].to_usize().wrapping_sub(block.start), ends[0]);
            self.push(ends[0].to_usize().wrapping_sub(block.start), ends[1]);
        }
    }

    /// Sorts the pairs by place; those of one place keep their order.
    fn sort(&mut self, block: &Range<usize>) -> Block<'_, I> {
        // The counts are shifted by two, so that filling in moves each start to where it belongs.
        for place in 2..self.starts.len() {
            self.starts[place] += self.starts[place - 1];
        }
        if self.ids.len() < self.len {
            self.ids.resize(self.len, I::ZERO);
        }
        for &(place, id) in &self.pairs[..self.len] {
            let next = &mut self.starts[place as usize + 1];
            self.ids[*next] = id;
            *next += 1;
        }
        Block::new(block.start, &self.starts[..=block.len()], &self.ids[..self.len])
    }
}

/// n over k.
pub(super) fn binomial(n: usize, k: usize) -> usize {
    let exact = (0..k as u64).fold(1_u64, |product, i| product * (n as u64 - i) / (i + 1));
    usize::try_from(exact).unwrap_or(usize::MAX)
}

/// An id of the complex, which is an index of its width.
#[inline]
pub(super) fn narrow<I: Index>(id: usize) -> I {
    I::from_usize(id).unwrap_or(I::STOP)
}
