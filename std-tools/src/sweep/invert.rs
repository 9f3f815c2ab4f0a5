//! The inversion of boundaries: a counting sort of the simplices above by their faces.

use std::ops::Range;

use sig_core::{Dim, Index};

use super::block::{Block, narrow};
use super::parts::Parts;
use super::rows::Rows;

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
    starts: Vec<usize>,
    /// For each dimension of answers and each simplex, how many there are, then where the next one goes.
    next: Vec<Vec<u32>>,
    ids: Vec<I>,
}

impl<I: Index> Sorter<I> {
    pub(super) const fn new() -> Self {
        Self { starts: Vec::new(), next: Vec::new(), ids: Vec::new() }
    }

    /// Answers for consecutive simplices of a dimension, unless more than one of them have more than `room` answers
    /// together.
    ///
    /// The rows of the cofaces are read twice, to count the answers of each simplex and to put them in their places: to
    /// keep what was read the first time takes longer.
    pub(super) fn answer(
        &mut self,
        (rows, parts): (&Rows<'_, I>, &Parts),
        question: &Question,
        (dim, block): (Dim, Range<usize>),
        room: u32,
    ) -> Result<Block<'_, I>, Overflow> {
        let (itself, dims) = match question {
            Question::Cofaces(dims) => (dims.contains(&dim), dims.start.max(dim + 1)..dims.end),
            Question::OtherEnds => (false, 1..2),
        };
        let around = parts.around(dim, &block);
        let cofaces = |above| around.iter().map(move |&part| (above, parts.ids(above, part)));
        if block.len() == 1 {
            return Ok(self.answer_one(rows, question, (dim, block.start), itself, dims.flat_map(cofaces)));
        }
        self.next.resize_with(self.next.len().max(dims.len()), Vec::new);
        for (next, above) in self.next.iter_mut().zip(dims.clone()) {
            next.clear();
            next.resize(block.len(), 0);
            for cofaces in cofaces(above) {
                count(rows, question, (dim, block.start), cofaces, next);
            }
        }
        let len = self.place(usize::from(itself), block.len(), dims.len());
        if len > room as usize {
            return Err(Overflow);
        }
        self.ids.resize(self.ids.len().max(len), I::ZERO);
        let ids = &mut self.ids[..len];
        if itself {
            block.clone().zip(&self.starts).for_each(|(id, &start)| ids[start] = narrow(id));
        }
        for (next, above) in self.next.iter_mut().zip(dims) {
            for cofaces in cofaces(above) {
                put(rows, question, (dim, block.start), cofaces, (next, ids));
            }
        }
        Ok(Block::new(block.start, &self.starts, ids))
    }

    /// Turns the numbers of answers of each dimension into their places; there are `first` of each simplex before them.
    /// How many there are.
    #[expect(clippy::cast_possible_truncation, reason = "more than there is room for are not put anywhere")]
    fn place(&mut self, first: usize, simplices: usize, dims: usize) -> usize {
        let next = &mut self.next[..dims];
        let mut end = 0;
        self.starts.clear();
        self.starts.extend((0..simplices).map(|simplex| {
            let start = end;
            end += first;
            for next in next.iter_mut() {
                end += std::mem::replace(&mut next[simplex], end as u32) as usize;
            }
            start
        }));
        self.starts.push(end);
        end
    }

    /// The answers of one simplex, however many.
    fn answer_one(
        &mut self,
        rows: &Rows<'_, I>,
        question: &Question,
        (dim, simplex): (Dim, usize),
        itself: bool,
        cofaces: impl Iterator<Item = (Dim, Range<usize>)>,
    ) -> Block<'_, I> {
        let id = narrow(simplex);
        self.ids.clear();
        self.ids.extend(itself.then_some(id));
        for cofaces in cofaces {
            each(rows, question, dim, cofaces, |face, coface| self.ids.extend((face == id).then_some(coface)));
        }
        self.starts.clear();
        self.starts.extend([0, self.ids.len()]);
        Block::new(simplex, &self.starts, &self.ids)
    }
}

/// Counts some answers of the simplices from `first`.
fn count<I: Index>(
    rows: &Rows<'_, I>,
    question: &Question,
    (dim, first): (Dim, usize),
    cofaces: (Dim, Range<usize>),
    counts: &mut [u32],
) {
    each(rows, question, dim, cofaces, move |face, _| {
        if let Some(count) = counts.get_mut(face.to_usize().wrapping_sub(first)) {
            // Too many for the type are more than there is room for, too.
            *count = count.saturating_add(1);
        }
    });
}

/// Puts some answers of the simplices from `first` where they belong.
fn put<I: Index>(
    rows: &Rows<'_, I>,
    question: &Question,
    (dim, first): (Dim, usize),
    cofaces: (Dim, Range<usize>),
    (next, ids): (&mut [u32], &mut [I]),
) {
    // It has what it uses, not where that is to be found: each step would look there.
    each(rows, question, dim, cofaces, move |face, id| {
        if let Some(next) = next.get_mut(face.to_usize().wrapping_sub(first)) {
            let place = *next;
            *next = place.wrapping_add(1);
            if let Some(slot) = ids.get_mut(place as usize) {
                *slot = id;
            }
        }
    });
}

/// Calls `visit` with each simplex asked about of which one of some consecutive cofaces says something, and that.
#[inline]
fn each<I: Index>(
    rows: &Rows<'_, I>,
    question: &Question,
    dim: Dim,
    (above, cofaces): (Dim, Range<usize>),
    mut visit: impl FnMut(I, I),
) {
    match question {
        Question::Cofaces(_) => rows.each_face((dim, above), &cofaces, visit),
        Question::OtherEnds => rows.each_edge(&cofaces, |one, other| {
            visit(one, other);
            visit(other, one);
        }),
    }
}

/// n over k.
pub(super) fn binomial(n: usize, k: usize) -> usize {
    let exact = (0..k as u64).fold(1_u64, |product, i| product * (n as u64 - i) / (i + 1));
    usize::try_from(exact).unwrap_or(usize::MAX)
}
