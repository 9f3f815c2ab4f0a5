//! Carrying everything over to the new ids, in one linear pass over each array, with what the edits recomputed put in.

use rayon::prelude::*;
use sig_core::{Dim, Index};

use super::edit::{Before, Edit};
use super::renumber::{Renumbering, row_starts};
use super::view::{View, list};
use crate::build::{Arrays, SigArrays, index, narrow, numbered_if_possible, pack};
use crate::soup::{Coordinates, Labels, Scalars};

/// Entries that one task renumbers.
const TASK: usize = 1 << 15;

/// The arrays after the contractions.
pub(super) fn arrays<I: Index>(mut arrays: SigArrays<I>, edits: &[Edit], renumbering: &Renumbering<I>) -> Arrays
where
    Arrays: From<SigArrays<I>>,
{
    let new_ids = &renumbering.new_ids;
    arrays.boundary.par_chunks_mut(TASK).flatten_iter().for_each(|facet| *facet = new_ids[facet.to_usize()]);
    renumbering.move_boundary(&mut arrays.boundary);
    // Vertices are simplices too, and have no number that is added.
    arrays.last_vertices.par_chunks_mut(TASK).flatten_iter().for_each(|last| {
        *last = u32::try_from(new_ids[*last as usize].to_usize()).unwrap_or(u32::MAX);
    });
    renumbering.move_rows(&mut arrays.last_vertices);
    add_rows(&mut arrays, edits, renumbering);
    let before = SigArrays {
        first: renumbering.old_first.clone(),
        pointers: std::mem::take(&mut arrays.pointers),
        lists: std::mem::take(&mut arrays.lists),
        flags: std::mem::take(&mut arrays.flags),
        ..SigArrays::default()
    };
    arrays.first.clone_from(&renumbering.first);
    arrays.num_simplices = renumbering.num_simplices;
    find_children(&mut arrays);
    relations(arrays, &before, edits, renumbering)
}

/// Fills in the facets and the last vertices of the simplices that were not there before.
fn add_rows<I: Index>(arrays: &mut SigArrays<I>, edits: &[Edit], renumbering: &Renumbering<I>) {
    let starts = row_starts(&renumbering.first, renumbering.num_simplices);
    let views: Vec<_> = edits.iter().map(|edit| View::new(&edit.local)).collect();
    for changed in renumbering.new_simplices() {
        let (view, local_ids) = (&views[changed.edit], &renumbering.local_ids[changed.edit]);
        let row = view.row(changed.local);
        let dim = row.len() - 1;
        let start = starts[dim] + (changed.id - renumbering.first[dim]) * row.len();
        for (entry, facet) in arrays.boundary[start..].iter_mut().zip(row) {
            *entry = index(local_ids[facet.to_usize()]);
        }
        let last = view.arrays.last_vertices[changed.local] as usize;
        arrays.last_vertices[changed.id] = narrow(local_ids[last]);
    }
}

/// Fills in the child offsets from the parents, the last facets: both increase.
fn find_children<I: Index>(arrays: &mut SigArrays<I>) {
    let mut offsets = std::mem::take(&mut arrays.child_offsets);
    offsets.clear();
    for dim in 1..arrays.first.len() {
        let parents = arrays.facets(dim).iter().skip(dim).step_by(dim + 1);
        for (child, parent) in arrays.ids(dim).zip(parents) {
            // Parents up to this one that have no child yet have none, but this.
            while offsets.len() <= parent.to_usize() {
                offsets.push(index(child));
            }
        }
        offsets.resize(arrays.first[dim], index(arrays.ids(dim).end));
    }
    offsets.push(index(arrays.num_simplices));
    arrays.child_offsets = offsets;
}

/// Completes the arrays with the partial co-boundary relations: those before, renumbered, but for what has changed.
fn relations<I: Index>(
    arrays: SigArrays<I>,
    before: &SigArrays<I>,
    edits: &[Edit],
    renumbering: &Renumbering<I>,
) -> Arrays
where
    Arrays: From<SigArrays<I>>,
{
    // In a smaller dimension other relations are flagged, so that each has to be looked at.
    let same_dim = renumbering.first.len() == renumbering.old_first.len();
    pack(arrays, |ids, part| {
        let start = renumbering.changed.partition_point(|changed| changed.id < ids.start);
        let mut changed = renumbering.changed[start..].iter().peekable();
        let start = renumbering.runs.partition_point(|run| run.to + run.len <= ids.start);
        let mut runs = renumbering.runs[start..].iter().peekable();
        let mut id = ids.start;
        let mut entries = Vec::new();
        while id < ids.end {
            if let Some(changed) = changed.next_if(|changed| changed.id == id) {
                let local_ids = &renumbering.local_ids[changed.edit];
                let list = list(&edits[changed.edit].local, changed.local);
                entries.clear();
                entries.extend(list.iter().map(|top| index::<I>(local_ids[top.to_usize()])));
                part.push(&entries);
                id += 1;
                continue;
            }
            // What is no survivor has changed, so there is a run.
            while runs.next_if(|run| run.to + run.len <= id).is_some() {}
            let Some(run) = runs.peek() else { break };
            let end = changed.peek().map_or(ids.end, |changed| changed.id.min(ids.end)).min(run.to + run.len);
            let old = id - run.to + run.from..end - run.to + run.from;
            if same_dim {
                part.push_renumbered(before, old, &renumbering.new_ids);
            } else {
                for old in old {
                    entries.clear();
                    entries.extend(list(before, old).iter().map(|top| renumbering.new_ids[top.to_usize()]));
                    part.push(&entries);
                }
            }
            id = end;
        }
    })
}

/// The parity of the top simplices of the result, and how many there are of each dimension.
pub(super) fn parity<I: Index>(
    before: &Before<'_, I>,
    edits: &[Edit],
    renumbering: &Renumbering<I>,
) -> (Vec<u8>, Vec<usize>) {
    let old = before.view.arrays;
    let top_dim = old.first.last().copied().unwrap_or(0)..old.num_simplices;
    let survivors = before.low_tops.iter().copied().chain(top_dim).enumerate().filter_map(|(row, id)| {
        let new = renumbering.new_ids[id];
        (new != I::STOP)
            .then(|| (new.to_usize(), before.parity.get(row / 8).is_some_and(|byte| byte >> (row % 8) & 1 == 1)))
    });
    let fresh = fresh_tops(edits, renumbering);
    let mut fresh = fresh.iter().copied().peekable();
    let mut changed = renumbering.changed.iter().map(|changed| changed.id).peekable();
    let mut tops = Tops {
        first: &renumbering.first,
        dim: 0,
        bits: Vec::new(),
        count: 0,
        counts: vec![0; renumbering.first.len()],
    };
    for (id, is_odd) in survivors {
        while let Some((id, is_odd)) = fresh.next_if(|&(fresh, _)| fresh <= id) {
            tops.push(id, is_odd);
        }
        while changed.next_if(|&changed| changed < id).is_some() {}
        if changed.peek() != Some(&id) {
            tops.push(id, is_odd);
        }
    }
    fresh.for_each(|(id, is_odd)| tops.push(id, is_odd));
    (tops.bits, tops.counts)
}

/// The top simplices among those that have changed, by increasing new id, with their parity.
fn fresh_tops<I: Index>(edits: &[Edit], renumbering: &Renumbering<I>) -> Vec<(usize, bool)> {
    let mut fresh = Vec::new();
    for (edit, local_ids) in edits.iter().zip(&renumbering.local_ids) {
        let tops = (0..edit.local.num_simplices).filter(|&local| list(&edit.local, local).is_empty());
        for (row, local) in tops.enumerate().filter(|&(_, local)| edit.is_changed[local]) {
            fresh.push((local_ids[local], edit.parity[row / 8] >> (row % 8) & 1 == 1));
        }
    }
    fresh.sort_unstable();
    fresh
}

/// Top simplices, as they are met.
struct Tops<'a> {
    first: &'a [usize],
    dim: Dim,
    bits: Vec<u8>,
    count: usize,
    counts: Vec<usize>,
}

impl Tops<'_> {
    fn push(&mut self, id: usize, is_odd: bool) {
        if self.count.is_multiple_of(8) {
            self.bits.push(0);
        }
        if let Some(byte) = self.bits.last_mut() {
            *byte |= u8::from(is_odd) << (self.count % 8);
        }
        self.count += 1;
        // Ids increase.
        while self.first.get(self.dim + 1).is_some_and(|&first| first <= id) {
            self.dim += 1;
        }
        self.counts[self.dim] += 1;
    }
}

/// The filtration values: of a simplex the least over those that are taken onto it.
pub(super) fn filtration<I: Index>(values: &mut Vec<f64>, edits: &[Edit], renumbering: &Renumbering<I>) {
    renumbering.move_rows(values);
    renumbering.new_simplices().for_each(|added| values[added.id] = f64::INFINITY);
    for (edit, local_ids) in edits.iter().zip(&renumbering.local_ids) {
        for &(local, value) in &edit.filtration {
            let least = &mut values[local_ids[local]];
            *least = least.min(value);
        }
    }
}

/// The labels without those of the vertices that vanish, which increase.
pub(super) fn labels(labels: Labels, removed: &[u32]) -> Labels {
    numbered_if_possible(match labels {
        Labels::Numbered(count) => {
            let mut labels = (0..count as u64).collect();
            remove_rows(&mut labels, 1, removed);
            Labels::Integers(labels)
        }
        Labels::Integers(mut labels) => {
            remove_rows(&mut labels, 1, removed);
            Labels::Integers(labels)
        }
        Labels::Tokens(mut labels) => {
            remove_rows(&mut labels, 1, removed);
            Labels::Tokens(labels)
        }
    })
}

/// Drops the coordinates of the vertices that vanish, which increase.
pub(super) fn remove_coordinates(coordinates: &mut Coordinates, removed: &[u32]) {
    match &mut coordinates.values {
        Scalars::F32(values) => remove_rows(values, coordinates.dim, removed),
        Scalars::F64(values) => remove_rows(values, coordinates.dim, removed),
    }
}

/// Drops rows of a table, whose numbers increase.
fn remove_rows<T>(table: &mut Vec<T>, width: usize, rows: &[u32]) {
    if width == 0 {
        return;
    }
    let mut position = 0;
    let mut rows = rows.iter().map(|&row| row as usize).peekable();
    table.retain(|_| {
        let row = position / width;
        position += 1;
        while rows.next_if(|&removed| removed < row).is_some() {}
        rows.peek() != Some(&row)
    });
}
