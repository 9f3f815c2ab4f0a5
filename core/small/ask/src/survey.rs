//! Everything of every simplex, in one line a relation: how many simplices were found, and their checksum.

use sig_core::{Complex, Index, Relations, Scratch, ScratchError, SimplexId, mark_words};

use crate::{Relation, ask, ask_view};

/// The answers to a relation for all simplices.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Summary {
    /// How many simplices were found in all.
    pub count: u32,
    /// Σ [`mix`] over (simplex, argument, found), modulo 2³².
    pub checksum: u32,
}

impl Summary {
    fn add(&mut self, simplex: usize, argument: usize, found: usize) {
        self.count = self.count.wrapping_add(1);
        self.checksum = self.checksum.wrapping_add(mix(mix(low(simplex), low(argument)), low(found)));
    }
}

/// The low 32 bits.
#[expect(clippy::cast_possible_truncation, reason = "that is what it is for")]
const fn low(value: usize) -> u32 {
    value as u32
}

/// Two integers as one: the finaliser of MurmurHash3 of a·0x9E3779B1 + b.
#[must_use]
pub const fn mix(a: u32, b: u32) -> u32 {
    let mut bits = a.wrapping_mul(0x9E37_79B1).wrapping_add(b);
    bits = (bits ^ (bits >> 16)).wrapping_mul(0x85EB_CA6B);
    bits = (bits ^ (bits >> 13)).wrapping_mul(0xC2B2_AE35);
    bits ^ (bits >> 16)
}

/// Asks a relation of every simplex, for every argument that has an answer: the dimensions of the complex, or the
/// representatives of the clusters.
///
/// # Errors
/// [`ScratchError`] if the scratch is too small.
pub fn survey<I: Index>(
    complex: &Complex<'_, I>,
    relation: Relation,
    scratch: &mut Scratch<'_, I>,
) -> Result<Summary, ScratchError> {
    let mut summary = Summary::default();
    if relation != Relation::Cluster {
        return survey_with(complex, relation, |(argument, simplex), summary| {
            let mut add = |found| summary.add(simplex.index(), argument, found);
            ask(complex, (relation, argument), simplex, scratch, &mut add)
        });
    }
    for simplex in complex.simplices() {
        for cluster in complex.clusters(simplex) {
            let argument = cluster.representative.index();
            let mut add = |found| summary.add(simplex.index(), argument, found);
            ask(complex, (relation, argument), simplex, scratch, &mut add)?;
        }
    }
    Ok(summary)
}

/// As [`survey`], of a complex or of a tree; for relations that do not need clusters.
///
/// # Errors
/// [`ScratchError`] if the scratch is too small.
pub fn survey_view<V: Relations>(
    view: &V,
    relation: Relation,
    scratch: &mut Scratch<'_, V::Index>,
) -> Result<Summary, ScratchError> {
    survey_with(view, relation, |(argument, simplex), summary| {
        let mut add = |found| summary.add(simplex.index(), argument, found);
        ask_view(view, (relation, argument), simplex, scratch, &mut add)
    })
}

fn survey_with<V: Relations>(
    view: &V,
    relation: Relation,
    mut ask: impl FnMut((usize, SimplexId), &mut Summary) -> Result<(), ScratchError>,
) -> Result<Summary, ScratchError> {
    let arguments = match relation {
        Relation::Boundary | Relation::Coboundary | Relation::KAdjacency => view.dim().map_or(0, |dim| dim + 1),
        _ => 1,
    };
    let mut summary = Summary::default();
    for simplex in view.simplices() {
        for argument in 0..arguments {
            ask((argument, simplex), &mut summary)?;
        }
    }
    Ok(summary)
}

/// Memory for queries, of which a part can be lent.
#[derive(Debug)]
pub struct Memory<'m, I> {
    /// Words of marks.
    pub marks: &'m mut [u32],
    /// Entries of the queue.
    pub queue: &'m mut [I],
    /// Masks of the queue.
    pub masks: &'m mut [u32],
    /// Entries of an answer.
    pub found: &'m mut [I],
}

impl<I: Index> Memory<'_, I> {
    /// A scratch of all of it.
    #[must_use]
    pub fn scratch(&mut self) -> Scratch<'_, I> {
        Scratch::new(self.marks, self.queue, self.masks, self.found)
    }

    /// A scratch of so many words of marks, entries of the queue, and entries of an answer, if there are as many.
    #[must_use]
    pub fn part(&mut self, marks: usize, queue: usize, found: usize) -> Option<Scratch<'_, I>> {
        let (queue, masks) = (self.queue.get_mut(..queue)?, self.masks.get_mut(..queue)?);
        Some(Scratch::new(self.marks.get_mut(..marks)?, queue, masks, self.found.get_mut(..found)?))
    }
}

/// Asks a relation of a simplex with no memory at all, then with what the error asks for, until it is answered: how often
/// the memory was too small, and the answer. `None` if the memory is too small in all, or an error asks for what there is.
fn grow_until_answered<I: Index>(
    complex: &Complex<'_, I>,
    question: (Relation, usize),
    simplex: SimplexId,
    memory: &mut Memory<'_, I>,
) -> Option<(u32, Summary)> {
    let (mut marks, mut queue, mut found) = (0, 0, 0);
    for errors in 0.. {
        let mut summary = Summary::default();
        let mut add = |item| summary.add(simplex.index(), question.1, item);
        let mut scratch = memory.part(marks, queue, found)?;
        match ask(complex, question, simplex, &mut scratch, &mut add) {
            Ok(()) => return Some((errors, summary)),
            Err(ScratchError::Marks { needed, available }) => {
                marks = (available == marks && needed == mark_words(complex.num_simplices())).then_some(needed)?;
            }
            Err(ScratchError::Queue { at_least, available }) => {
                queue = (available == queue && at_least > queue).then_some(at_least)?;
            }
            Err(ScratchError::Found { at_least, available }) => {
                found = (available == found && at_least > found).then_some(at_least)?;
            }
            Err(_) => return None,
        }
    }
    None
}

/// A line of a [`report`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Line {
    /// What is counted, and how many.
    Number(&'static str, usize),
    /// A relation, and its answers.
    Summary(&'static str, Summary),
    /// A relation of vertex 0, how often the memory was too small, and the answer.
    Grown(&'static str, u32, Summary),
}

/// Surveys all relations, then asks four of vertex 0 from no memory at all up to enough, and tells each result.
///
/// # Errors
/// [`ReportError`]: what went wrong in which relation.
pub fn report<I: Index>(
    complex: &Complex<'_, I>,
    memory: &mut Memory<'_, I>,
    tell: &mut impl FnMut(Line),
) -> Result<(), ReportError> {
    tell(Line::Number("simplices", complex.num_simplices()));
    for relation in Relation::all() {
        let summary = survey(complex, relation, &mut memory.scratch()).map_err(|_| ReportError::Memory)?;
        tell(Line::Summary(relation.name(), summary));
    }
    for relation in [Relation::Coboundary, Relation::Star, Relation::Link, Relation::Adjacency] {
        // The 1-cofaces of the vertex are its edges.
        let grown = grow_until_answered(complex, (relation, 1), SimplexId::new(0), memory);
        let (errors, summary) = grown.ok_or(ReportError::Growth)?;
        tell(Line::Grown(relation.name(), errors, summary));
    }
    Ok(())
}

/// Why a report ends early.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ReportError {
    /// All of the memory is too small.
    Memory,
    /// An error asked for memory that the query had, or for more than there is.
    Growth,
}
