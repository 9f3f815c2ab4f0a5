//! Reading the builder's arrays around a vertex: words, search, and the top simplices of a star.
//!
//! What [`sig_core::Complex`] answers on a file, here on arrays that are about to change.

use std::cmp::Ordering;

use hashbrown::HashSet;
use sig_core::{Dim, Index};

use crate::build::{SigArrays, ids};

/// The arrays, with the facets of each dimension at hand.
pub(super) struct View<'a, I> {
    pub(super) arrays: &'a SigArrays<I>,
    rows: Vec<&'a [I]>,
}

/// Where a simplex stands in the canonical order.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Place {
    /// It has this id.
    At(usize),
    /// It is not in the complex; the simplices before it are those with ids below this.
    Before(usize),
}

impl<'a, I: Index> View<'a, I> {
    pub(super) fn new(arrays: &'a SigArrays<I>) -> Self {
        Self { arrays, rows: (0..arrays.first.len()).map(|dim| arrays.facets(dim)).collect() }
    }

    pub(super) fn dim_of(&self, id: usize) -> Dim {
        self.arrays.first.partition_point(|&first| first <= id).saturating_sub(1)
    }

    /// The facets of a simplex, by the position of the vertex that is left out; none of a vertex.
    pub(super) fn row(&self, id: usize) -> &'a [I] {
        let dim = self.dim_of(id);
        if dim == 0 { &[] } else { &self.rows[dim][(id - self.arrays.first[dim]) * (dim + 1)..][..=dim] }
    }

    /// C\*(σ): empty if σ is top.
    pub(super) fn list(&self, id: usize) -> &'a [I] {
        list(self.arrays, id)
    }

    /// The vertices of a simplex, increasing. Cost: a read of the tree for each.
    pub(super) fn word(&self, id: usize) -> Vec<u32> {
        let mut word = vec![self.arrays.last_vertices[id]];
        let mut row = self.row(id);
        while let Some(parent) = row.last() {
            word.push(self.arrays.last_vertices[parent.to_usize()]);
            row = self.row(parent.to_usize());
        }
        word.reverse();
        word
    }

    /// Where the simplex of the given vertices stands, which increase, exist and are no more than d + 1. Cost: a binary
    /// search among the children of each prefix.
    pub(super) fn locate(&self, word: &[u32]) -> Place {
        let Some((&first, rest)) = word.split_first() else { return Place::Before(0) };
        let children = &self.arrays.child_offsets;
        rest.iter().fold(Place::At(first as usize), |place, &vertex| match place {
            Place::At(node) => {
                let range = children[node].to_usize()..children[node + 1].to_usize();
                let siblings = &self.arrays.last_vertices[range.clone()];
                match siblings.binary_search(&vertex) {
                    Ok(number) => Place::At(range.start + number),
                    Err(number) => Place::Before(range.start + number),
                }
            }
            // The children of the prefix would stand after those of all before it.
            Place::Before(node) => Place::Before(children[node].to_usize()),
        })
    }

    /// The top simplices that contain a vertex, in no particular order: Algorithm 6 of sig-2004 from each cluster. Cost:
    /// linear in the facets of the top simplices reported and the lists of these.
    pub(super) fn tops_of(&self, vertex: usize) -> Vec<usize> {
        let mut tops = Vec::new();
        let mut visited = HashSet::new();
        for representative in self.list(vertex) {
            let representative = representative.to_usize();
            let ids = self.arrays.ids(self.dim_of(representative));
            let mut next = tops.len();
            tops.push(representative);
            visited.insert(representative);
            while let Some(&top) = tops.get(next) {
                next += 1;
                let row = self.row(top);
                // An edge is a cluster of its own.
                if row.len() == 2 {
                    continue;
                }
                let opposite = self.opposite(top, vertex);
                for facet in row.iter().enumerate().filter(|&(i, _)| i != opposite).map(|(_, facet)| facet.to_usize()) {
                    if visited.insert(facet) {
                        let others = self.list(facet).iter().map(|other| other.to_usize());
                        tops.extend(others.filter(|other| ids.contains(other) && visited.insert(*other)));
                    }
                }
            }
        }
        if tops.is_empty() {
            tops.push(vertex);
        }
        tops
    }

    /// The position of a vertex in a simplex that has it.
    pub(super) fn opposite(&self, id: usize, vertex: usize) -> usize {
        let word = self.word(id);
        word.iter().position(|&other| other as usize == vertex).unwrap_or(word.len())
    }

    /// The ids of the simplices that contain `vertex`, increasing, if `tops` are all top simplices that do.
    pub(super) fn star(&self, vertex: usize, tops: &[usize]) -> Vec<usize> {
        let mut star = Vec::new();
        let mut stack = Vec::new();
        for &top in tops {
            // Leaving out positions from the last to the first meets each face once; those before are as in the top simplex.
            let kept = self.opposite(top, vertex);
            stack.push((top, self.row(top).len()));
            while let Some((face, free)) = stack.pop() {
                star.push(face);
                let facets = self.row(face).iter().take(free).enumerate().filter(|&(i, _)| i != kept);
                stack.extend(facets.map(|(i, facet)| (facet.to_usize(), i)));
            }
        }
        star.sort_unstable();
        star.dedup();
        star
    }

    /// The faces of the given simplices and these themselves, marked by id.
    pub(super) fn closure(&self, simplices: impl Iterator<Item = usize>) -> Vec<bool> {
        let mut marks = vec![false; self.arrays.num_simplices];
        let mut stack: Vec<usize> = simplices.collect();
        while let Some(face) = stack.pop() {
            if !std::mem::replace(&mut marks[face], true) {
                stack.extend(self.row(face).iter().map(|facet| facet.to_usize()));
            }
        }
        marks
    }

    /// The top simplices below dimension d, increasing, where `counts` says that there are some. Cost: one pass over the
    /// dimensions that have some.
    pub(super) fn low_tops(&self, counts: &[usize]) -> Vec<usize> {
        let below = counts.iter().take(self.arrays.first.len().saturating_sub(1)).enumerate();
        let dims = below.filter(|&(_, &count)| count > 0).map(|(dim, _)| dim);
        dims.flat_map(|dim| self.arrays.ids(dim)).filter(|&id| self.list(id).is_empty()).collect()
    }
}

/// C\*(σ): empty if σ is top.
pub(super) fn list<I: Index>(arrays: &SigArrays<I>, id: usize) -> &[I] {
    let Some(pointer) = arrays.pointers.get(id) else { return &[] };
    if arrays.flags[id / 8] >> (id % 8) & 1 == 1 {
        return std::slice::from_ref(pointer);
    }
    let lists = &arrays.lists[pointer.to_usize()..];
    &lists[..lists.iter().position(|&entry| entry == I::STOP).unwrap_or(lists.len())]
}

/// Compares simplices by dimension, then lexicographically.
pub(super) fn canonical(a: &[u32], b: &[u32]) -> Ordering {
    a.len().cmp(&b.len()).then_with(|| a.cmp(b))
}

/// The number of simplices of each dimension.
pub(super) fn counts<I: Index>(arrays: &SigArrays<I>) -> Vec<usize> {
    (0..arrays.first.len()).map(|dim| ids(&arrays.first, arrays.num_simplices, dim).len()).collect()
}
