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

/// More answers than there is room for.
pub(super) struct Overflow;

/// Memory to answer for one block after the other.
pub(super) struct Sorter<I> {
    /// The place of a simplex in the block, and one of its answer.
    pairs: Vec<(u32, I)>,
    starts: Vec<usize>,
    ids: Vec<I>,
}

impl<I: Index> Sorter<I> {
    pub(super) const fn new() -> Self {
        Self { pairs: Vec::new(), starts: Vec::new(), ids: Vec::new() }
    }

    /// Answers for consecutive simplices of a dimension, unless there is more than `room` to say.
    pub(super) fn answer(
        &mut self,
        (rows, parts): (&Rows<'_, I>, &Parts),
        question: &Question,
        (dim, block): (Dim, Range<usize>),
        room: usize,
    ) -> Result<Block<'_, I>, Overflow> {
        self.pairs.clear();
        let around = parts.around(dim, block.clone());
        let dims = match question {
            Question::Cofaces(dims) => dims.clone(),
            Question::OtherEnds => 1..2,
        };
        for coface_dim in dims {
            if coface_dim == dim {
                self.pairs.extend((0..).zip(block.clone()).map(|(place, id)| (place, narrow(id))));
                continue;
            }
            for &part in &around {
                let cofaces = parts.ids(coface_dim, part);
                match question {
                    Question::Cofaces(_) => self.push_faces(rows, (dim, &block), (coface_dim, cofaces)),
                    Question::OtherEnds => self.push_ends(rows, &block, cofaces),
                }
                if self.pairs.len() > room {
                    return Err(Overflow);
                }
            }
        }
        Ok(self.sort(block))
    }

    /// Adds each of some cofaces to the answers of its faces in the block.
    fn push_faces(&mut self, rows: &Rows<'_, I>, (dim, block): (Dim, &Range<usize>), (above, ids): (Dim, Range<usize>)) {
        let (start, len) = (block.start, block.len());
        for (id, row) in ids.clone().zip(rows.of(above, ids).chunks_exact(above + 1)) {
            let coface = narrow(id);
            rows.faces(above, row, above + 1, above - dim, &mut |face: I| {
                let place = face.to_usize().wrapping_sub(start);
                if place < len {
                    self.pairs.push((place as u32, coface));
                }
            });
        }
    }

    /// Adds each end of some edges to the answer of the other one, if that is in the block.
    fn push_ends(&mut self, rows: &Rows<'_, I>, block: &Range<usize>, edges: Range<usize>) {
        for ends in rows.of(1, edges).chunks_exact(2) {
            for (end, other) in [(ends[1], ends[0]), (ends[0], ends[1])] {
                let place = end.to_usize().wrapping_sub(block.start);
                if place < block.len() {
                    self.pairs.push((place as u32, other));
                }
            }
        }
    }

    /// Sorts the pairs by place; those of one place keep their order.
    fn sort(&mut self, block: Range<usize>) -> Block<'_, I> {
        // Shifted by one, so that filling in moves each start to where it belongs.
        self.starts.clear();
        self.starts.resize(block.len() + 2, 0);
        for &(place, _) in &self.pairs {
            self.starts[place as usize + 2] += 1;
        }
        for place in 2..self.starts.len() {
            self.starts[place] += self.starts[place - 1];
        }
        if self.ids.len() < self.pairs.len() {
            self.ids.resize(self.pairs.len(), I::ZERO);
        }
        for &(place, id) in &self.pairs {
            let next = &mut self.starts[place as usize + 1];
            self.ids[*next] = id;
            *next += 1;
        }
        Block::new(block.start, &self.starts[..=block.len()], &self.ids[..self.pairs.len()])
    }
}

/// An id of the complex, which is an index of its width.
#[inline]
pub(super) fn narrow<I: Index>(id: usize) -> I {
    I::from_usize(id).unwrap_or(I::STOP)
}
