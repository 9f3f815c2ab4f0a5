//! The new ids of all simplices after some contractions, and the moves of the rows that follow from them.
//!
//! Survivors keep their order: a survivor's word only loses the vertex numbers that are left out in between. So the new ids
//! are the old ones shifted piece by piece, and a row of an array moves with its neighbours.

use std::iter::Peekable;
use std::ops::Range;

use sig_core::{Dim, Index};

use super::edit::{Before, Edit};
use super::view::{Place, canonical, counts};
use crate::build::{ids, index};

/// Consecutive simplices of one dimension that stay consecutive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Run {
    pub(super) dim: Dim,
    pub(super) from: usize,
    pub(super) to: usize,
    pub(super) len: usize,
}

/// A simplex of the result whose relations are not those of a simplex before, renumbered.
#[derive(Clone, Copy, Debug)]
pub(super) struct Changed {
    /// Its new id.
    pub(super) id: usize,
    /// Which edit has it, and its local id there.
    pub(super) edit: usize,
    pub(super) local: usize,
    /// Whether it was not there before.
    pub(super) is_new: bool,
}

/// Where everything goes.
pub(super) struct Renumbering<I> {
    /// The new id of every simplex; the stop code if it vanishes.
    pub(super) new_ids: Vec<I>,
    /// The survivors, by increasing id.
    pub(super) runs: Vec<Run>,
    /// The first id of each dimension before, and the number of simplices.
    pub(super) old_first: Vec<usize>,
    pub(super) old_count: usize,
    /// The same after.
    pub(super) first: Vec<usize>,
    pub(super) num_simplices: usize,
    /// By increasing new id.
    pub(super) changed: Vec<Changed>,
    /// For each edit the new ids of the local simplices that are changed or top.
    pub(super) local_ids: Vec<Vec<usize>>,
}

/// A simplex that was not there before.
struct Added {
    word: Vec<u32>,
    before: usize,
    edit: usize,
    local: usize,
}

impl<I: Index> Renumbering<I> {
    /// Cost: one pass over the ids, which writes them.
    pub(super) fn new(before: &Before<'_, I>, edits: &[Edit]) -> Self {
        let arrays = before.view.arrays;
        let added = added(edits);
        let mut removed: Vec<usize> = edits.iter().flat_map(|edit| edit.star.iter().copied()).collect();
        removed.sort_unstable();
        let mut counts = counts(arrays);
        removed.iter().for_each(|&id| counts[before.view.dim_of(id)] -= 1);
        added.iter().for_each(|added| counts[added.word.len() - 1] += 1);
        while counts.last() == Some(&0) {
            counts.pop();
        }
        let first: Vec<usize> =
            counts.iter().scan(0, |next, count| Some(std::mem::replace(next, *next + count))).collect();
        let num_simplices = counts.iter().sum();
        let mut this = Self {
            new_ids: vec![I::STOP; arrays.num_simplices],
            runs: Vec::new(),
            old_first: arrays.first.clone(),
            old_count: arrays.num_simplices,
            first,
            num_simplices,
            changed: Vec::new(),
            local_ids: edits.iter().map(|edit| vec![0; edit.places.len()]).collect(),
        };
        this.number(&added, &removed);
        this.find_changed(edits);
        this
    }

    /// Gives numbers to survivors and to those that are added, in one merge.
    fn number(&mut self, added: &[Added], removed: &[usize]) {
        let mut added = added.iter().peekable();
        let mut removed = removed.iter().copied().peekable();
        let mut next = 0;
        for dim in 0..self.old_first.len() {
            let mut range = ids(&self.old_first, self.old_count, dim);
            loop {
                // Those that are added at the end of a dimension come before those at the start of the next.
                while let Some(added) =
                    added.next_if(|added| added.before == range.start && added.word.len() == dim + 1)
                {
                    self.local_ids[added.edit][added.local] = next;
                    next += 1;
                }
                if range.is_empty() {
                    break;
                }
                if removed.next_if_eq(&range.start).is_some() {
                    range.start += 1;
                    continue;
                }
                let end = end_of_run(&range, &mut removed, added.peek().map(|added| added.before));
                let (from, len) = (range.start, end - range.start);
                for (new_id, id) in self.new_ids[from..end].iter_mut().zip(next..) {
                    *new_id = index(id);
                }
                self.runs.push(Run { dim, from, to: next, len });
                next += len;
                range.start = end;
            }
        }
    }

    /// Resolves the places of the edits.
    fn find_changed(&mut self, edits: &[Edit]) {
        for (number, edit) in edits.iter().enumerate() {
            for (local, &place) in edit.places.iter().enumerate() {
                if let Place::At(id) = place {
                    self.local_ids[number][local] = self.new_ids[id].to_usize();
                }
                if edit.is_changed[local] {
                    let id = self.local_ids[number][local];
                    self.changed.push(Changed { id, edit: number, local, is_new: matches!(place, Place::Before(_)) });
                }
            }
        }
        self.changed.sort_unstable_by_key(|changed| changed.id);
    }

    /// The simplices that were not there before.
    pub(super) fn new_simplices(&self) -> impl Iterator<Item = &Changed> {
        self.changed.iter().filter(|changed| changed.is_new)
    }

    /// Moves the rows of a column over the simplices, and makes room for those that are added, whose rows hold anything.
    pub(super) fn move_rows<T: Copy>(&self, column: &mut Vec<T>) {
        move_all(column, self.runs.iter().map(|run| (run.from, run.to, run.len)));
        column.truncate(self.num_simplices);
    }

    /// Moves the rows of the boundary, p + 1 for each p-simplex.
    pub(super) fn move_boundary(&self, boundary: &mut Vec<I>) {
        let (old, new) = (row_starts(&self.old_first, self.old_count), row_starts(&self.first, self.num_simplices));
        let moves = self.runs.iter().filter(|run| run.dim > 0).map(|run| {
            let row =
                |starts: &[usize], first: &[usize], id: usize| starts[run.dim] + (id - first[run.dim]) * (run.dim + 1);
            (row(&old, &self.old_first, run.from), row(&new, &self.first, run.to), run.len * (run.dim + 1))
        });
        move_all(boundary, moves);
        boundary.truncate(new.last().copied().unwrap_or(0));
    }
}

/// Where the rows of each dimension start in the boundary, and the end.
pub(super) fn row_starts(first: &[usize], num_simplices: usize) -> Vec<usize> {
    let lengths = (1..first.len()).map(|dim| ids(first, num_simplices, dim).len() * (dim + 1));
    let mut starts = vec![0, 0];
    for length in lengths {
        starts.push(starts[starts.len() - 1] + length);
    }
    starts
}

/// Moves pieces of a column: (from, to, length), increasing, none onto another.
///
/// A piece that moves up lands before the one after it lands, one that moves down after the one before it lands. So the
/// former from the last to the first, then the latter from the first to the last, overwrite nothing that is still needed.
fn move_all<T: Copy>(column: &mut [T], moves: impl DoubleEndedIterator<Item = (usize, usize, usize)> + Clone) {
    for (from, to, len) in moves.clone().rev().filter(|(from, to, _)| from < to) {
        column.copy_within(from..from + len, to);
    }
    for (from, to, len) in moves.filter(|(from, to, _)| from > to) {
        column.copy_within(from..from + len, to);
    }
}

/// Where the survivors from the start of `range` on end: at the next that is removed, the next place of one that is added,
/// or the end of the range.
fn end_of_run(
    range: &Range<usize>,
    removed: &mut Peekable<impl Iterator<Item = usize>>,
    added: Option<usize>,
) -> usize {
    let end = removed.peek().copied().unwrap_or(range.end).min(range.end);
    // One that is added in the next dimension, at its start, is at the end of this.
    end.min(added.unwrap_or(range.end))
}

/// What the edits add, in canonical order.
fn added(edits: &[Edit]) -> Vec<Added> {
    let mut added: Vec<Added> = Vec::new();
    for (number, edit) in edits.iter().enumerate() {
        for (local, &place) in edit.places.iter().enumerate().filter(|&(local, _)| edit.is_changed[local]) {
            if let Place::Before(before) = place {
                added.push(Added { word: edit.word(local), before, edit: number, local });
            }
        }
    }
    added.sort_unstable_by(|a, b| canonical(&a.word, &b.word));
    added
}
