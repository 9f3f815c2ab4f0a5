//! The top nodes: the vertices of the complex by label.
//!
//! The paper takes an array, for its vertices are numbered (simplex-tree-2012, 2.1). Labels here are any 32-bit numbers:
//! as long as they are about as small as there are vertices they are rows of a table, others are in an ordered map.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use super::arena::NONE;

/// A vertex.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Top {
    pub(super) value: f64,
    /// The set of its children.
    pub(super) child: u32,
    present: bool,
}

/// The vertices.
#[derive(Clone, Default, Debug)]
pub(super) struct Tops {
    table: Vec<Top>,
    /// Those with labels past the table.
    others: BTreeMap<u32, Top>,
    len: usize,
}

impl Tops {
    #[inline]
    pub(super) fn get(&self, label: u32) -> Option<&Top> {
        match self.table.get(label as usize) {
            Some(top) => top.present.then_some(top),
            None => self.others.get(&label),
        }
    }

    #[inline]
    pub(super) fn get_mut(&mut self, label: u32) -> Option<&mut Top> {
        match self.table.get_mut(label as usize) {
            Some(top) => top.present.then_some(top),
            None => self.others.get_mut(&label),
        }
    }

    /// The vertex with this label, made if there is none; whether it was made.
    pub(super) fn entry(&mut self, label: u32, value: f64) -> (&mut Top, bool) {
        self.make_room(label);
        let absent = Top { value, child: NONE, present: false };
        let top = match self.table.get_mut(label as usize) {
            Some(top) => top,
            None => self.others.entry(label).or_insert(absent),
        };
        let made = !top.present;
        if made {
            *top = Top { present: true, ..absent };
            self.len += 1;
        }
        (top, made)
    }

    /// Lengthens the table if that is enough for the label, and if at least about half of the rows will be used.
    fn make_room(&mut self, label: u32) {
        let rows = label as usize;
        if rows < self.table.len() || rows >= 2 * self.len + 1024 {
            return;
        }
        let rows = (rows + 1).max(2 * self.table.len()).min(2 * self.len + 1024);
        self.table.resize(rows, Top { value: 0.0, child: NONE, present: false });
        // Each label moves at most once: the table never gets shorter.
        let stay = u32::try_from(rows).map(|rows| self.others.split_off(&rows)).unwrap_or_default();
        for (label, top) in std::mem::replace(&mut self.others, stay) {
            self.table[label as usize] = top;
        }
    }

    pub(super) fn remove(&mut self, label: u32) {
        let removed = match self.table.get_mut(label as usize) {
            Some(top) => std::mem::replace(&mut top.present, false),
            None => self.others.remove(&label).is_some(),
        };
        self.len -= usize::from(removed);
    }

    /// The first vertex whose label is in the range.
    pub(super) fn first_in(&self, range: RangeInclusive<u32>) -> Option<u32> {
        let (from, to) = (*range.start() as usize, *range.end() as usize);
        let rows = self.table.get(from..).unwrap_or(&[]);
        let row = rows.iter().take((to + 1).saturating_sub(from)).position(|top| top.present);
        match row.and_then(|row| u32::try_from(from + row).ok()) {
            Some(label) => Some(label),
            None if range.is_empty() => None,
            None => self.others.range(range).next().map(|(&label, _)| label),
        }
    }

    /// The labels, increasing.
    pub(super) fn labels(&self) -> impl Iterator<Item = u32> {
        let present = (0..).zip(&self.table).filter(|(_, top)| top.present);
        present.map(|(label, _)| label).chain(self.others.keys().copied())
    }
}
