//! The clusters of a simplex by the local minima among its top simplices: for meshes.
//!
//! Take the top g-simplices µ by increasing id. Let L(µ) be the facets of µ that an earlier one shares, as positions of
//! the vertices that they leave out. A shared facet contains a face σ of µ if its vertex is not in σ; so µ shares no facet
//! with an earlier one within the star of σ, is a *local minimum* at σ, exactly if σ has all vertices of L(µ). Every
//! cluster has a local minimum, its least top simplex. So where only one local minimum is found at σ, there is one
//! cluster, and that is its representative; this takes no more than listing, for each µ, the faces between L(µ) and µ.
//! (In a shelling every face is listed once: L is the restriction map.) Where there are more, the clusters are walked
//! from one minimum until the others are met.
//!
//! All that concerns top simplices of dimension g ≥ p + 2 about a p-simplex; those of dimension p + 1 are clusters of
//! their own, the top cofacets.

use std::ops::Range;

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::limits::Stage;
use crate::build::lists::Part;
use crate::build::{SigArrays, index};

/// The relations, as found. Ids are stored as `I`, links as `L`.
pub(super) struct Minima<I, L> {
    first: Vec<usize>,
    /// The least local minimum of the largest dimension at each simplex below dimension d − 1; the stop code if none.
    representatives: Vec<I>,
    /// What else is in the list of a simplex, by simplex.
    others: Vec<Minimum<I>>,
    /// How the top simplices of each dimension, from 1, hang together.
    links: Vec<Links<L>>,
}

/// A local minimum at a face.
#[derive(Clone, Copy)]
struct Minimum<I> {
    face: I,
    top: I,
    /// The positions of the vertices of the face in the top simplex; none once it is known to be in the cluster of a
    /// lesser one.
    mask: u32,
}

/// The top simplices of one dimension g around each facet, as rings by increasing number. A link is the number of a top
/// simplex among the g-simplices, and the position of the facet in it, in [`link_bits`] bits.
struct Links<L> {
    /// The next around the facet, for each top simplex and position.
    next: Vec<L>,
    /// The last around each (g − 1)-simplex; the stop code if it is in no top g-simplex. Empty if none is.
    last: Vec<L>,
}

/// Bits that a position in a simplex of dimension `dim` takes.
fn link_bits(dim: Dim) -> u32 {
    (dim + 1).next_power_of_two().trailing_zeros()
}

/// The number of links that the simplices of dimension `dim` have room for, at most.
pub(super) fn num_links<I: Index>(arrays: &SigArrays<I>) -> usize {
    (0..arrays.first.len()).map(|dim| arrays.ids(dim).len() << link_bits(dim)).max().unwrap_or(0)
}

/// The relations of all simplices below dimension d. `is_top[p]` tells which p-simplices are top, or is empty.
pub(super) fn find<I: Index, L: Index>(arrays: &SigArrays<I>, is_top: &[Vec<bool>], stage: &Stage<'_>) -> Minima<I, L> {
    let rows: Vec<&[I]> = (0..arrays.first.len()).map(|dim| arrays.facets(dim)).collect();
    let below = arrays.first.len().checked_sub(2).map_or(0, |facets| arrays.first[facets]);
    let mut minima = Minima {
        first: arrays.first.clone(),
        representatives: vec![I::STOP; below],
        others: Vec::new(),
        links: (1..arrays.first.len()).map(|_| Links { next: Vec::new(), last: Vec::new() }).collect(),
    };
    for dim in (1..arrays.first.len()).rev() {
        if is_top[dim].iter().any(|&is_top| is_top) {
            minima.add_dim(dim, &rows, &is_top[dim], arrays.ids(dim - 1).len());
        }
        stage.add(1);
    }
    minima.join();
    minima
}

impl<I: Index, L: Index> Minima<I, L> {
    /// Takes in the top simplices of dimension `dim`; the larger ones are there already. There are `num_facets`
    /// simplices in the dimension below.
    fn add_dim(&mut self, dim: Dim, rows: &[&[I]], is_top: &[bool], num_facets: usize) {
        let (facet_start, top_start, bits) = (self.first[dim - 1], self.first[dim], link_bits(dim));
        let mut links = Links { next: vec![L::STOP; is_top.len() << bits], last: vec![L::STOP; num_facets] };
        let mut faces = Faces { first: &self.first, rows, stack: Vec::new() };
        let (representatives, others) = (&mut self.representatives, &mut self.others);
        for ((number, facets), _) in
            rows[dim].chunks_exact(dim + 1).enumerate().zip(is_top).filter(|(_, is_top)| **is_top)
        {
            let mut shared = 0;
            for (i, facet) in facets.iter().enumerate() {
                let last = &mut links.last[facet.to_usize() - facet_start];
                let link = index(number << bits | i);
                let next = if *last == L::STOP {
                    link
                } else {
                    shared |= 1 << i;
                    std::mem::replace(&mut links.next[last.to_usize()], link)
                };
                links.next[link.to_usize()] = next;
                *last = link;
            }
            let top = index(top_start + number);
            faces.for_each_above(top, dim, shared, |face, mask| {
                let representative = &mut representatives[face.to_usize()];
                if *representative == I::STOP {
                    *representative = top;
                } else {
                    others.push(Minimum { face, top, mask });
                }
            });
        }
        self.links[dim - 1] = links;
    }

    /// Sorts the other minima by face, and strikes out those in the cluster of another.
    fn join(&mut self) {
        // Stable, so that at each face they stay by decreasing dimension, then increasing id.
        let mut others = std::mem::take(&mut self.others);
        others.par_sort_by_key(|minimum| minimum.face);
        let mut groups: Vec<&mut [Minimum<I>]> = others.chunk_by_mut(|a, b| a.face == b.face).collect();
        groups.par_iter_mut().for_each_init(
            || Walk { minima: &*self, visited: Vec::new(), queue: Vec::new() },
            |walk, group| walk.join_at_face(group),
        );
        drop(groups);
        self.others = others;
    }

    /// Writes the lists of a range of simplices below dimension d.
    pub(super) fn write(&self, ids: Range<usize>, part: &mut Part<I>) {
        let start = self.others.partition_point(|other| other.face.to_usize() < ids.start);
        let mut others = self.others[start..].iter().peekable();
        let mut list = Vec::new();
        for (dim, range) in self.first.windows(2).enumerate() {
            let (links, bits) = (&self.links[dim], link_bits(dim + 1));
            for id in ids.start.max(range[0])..ids.end.min(range[1]) {
                let representative = self.representatives.get(id).copied().unwrap_or(I::STOP);
                let last = links.last.get(id - range[0]).copied().unwrap_or(L::STOP);
                let has_others = others.peek().is_some_and(|other| other.face.to_usize() == id);
                if representative != I::STOP && last == L::STOP && !has_others {
                    part.push(&[representative]);
                    continue;
                }
                list.clear();
                if representative != I::STOP {
                    list.push(representative);
                }
                while let Some(other) = others.next_if(|other| other.face.to_usize() == id) {
                    if other.mask != 0 {
                        list.push(other.top);
                    }
                }
                if last != L::STOP {
                    let mut link = last;
                    loop {
                        link = links.next[link.to_usize()];
                        list.push(index(range[1] + (link.to_usize() >> bits)));
                        if link == last {
                            break;
                        }
                    }
                }
                part.push(&list);
            }
        }
    }

    fn dim_of(&self, id: I) -> Dim {
        self.first.partition_point(|&first| first <= id.to_usize()) - 1
    }
}

/// Lists faces of a simplex by leaving out vertices from the last to the first, which meets each face once.
struct Faces<'a, I> {
    first: &'a [usize],
    rows: &'a [&'a [I]],
    /// A face, its dimension, and the vertices of the simplex that are left out.
    stack: Vec<(I, Dim, u32)>,
}

impl<I: Index> Faces<'_, I> {
    /// Calls `visit` with every face of a simplex that has the vertices at the positions `kept` and at least two fewer
    /// than the simplex, and the positions of its vertices.
    fn for_each_above(&mut self, simplex: I, dim: Dim, kept: u32, mut visit: impl FnMut(I, u32)) {
        let all = u32::MAX >> (31 - dim);
        self.push_facets(simplex, dim, all & !kept, 0);
        while let Some((face, face_dim, omitted)) = self.stack.pop() {
            if face_dim + 2 <= dim {
                visit(face, all & !omitted);
            }
            // Positions before all that are left out are the same in the face and in the simplex.
            let free = all & !kept & ((omitted & omitted.wrapping_neg()) - 1);
            if face_dim > 0 && free != 0 {
                self.push_facets(face, face_dim, free, omitted);
            }
        }
    }

    /// Pushes the facets of `face` that leave out one of the positions `free` more.
    fn push_facets(&mut self, face: I, dim: Dim, mut free: u32, omitted: u32) {
        if omitted == 0 {
            // A facet of the simplex is no use in itself, and nothing is free below the first.
            free &= free.wrapping_sub(1);
        }
        let row = &self.rows[dim][(face.to_usize() - self.first[dim]) * (dim + 1)..];
        while free != 0 {
            let position = free.trailing_zeros();
            free &= free - 1;
            self.stack.push((row[position as usize], dim - 1, omitted | 1 << position));
        }
    }
}

/// Walks clusters from top simplex to top simplex.
struct Walk<'a, I, L> {
    minima: &'a Minima<I, L>,
    /// A bit for each simplex of the dimension, all clear between the walks.
    visited: Vec<u64>,
    /// The numbers of the top simplices met, and the positions of the vertices of the face in them.
    queue: Vec<(usize, u32)>,
}

impl<I: Index, L: Index> Walk<'_, I, L> {
    /// Strikes out the minima at a face that are in the cluster of a lesser one. `group` holds all but the first.
    fn join_at_face(&mut self, group: &mut [Minimum<I>]) {
        let Some(minimum) = group.first() else { return };
        let representative = self.minima.representatives[minimum.face.to_usize()];
        let first_dim = self.minima.dim_of(representative);
        for run in group.chunk_by_mut(|a, b| self.minima.dim_of(a.top) == self.minima.dim_of(b.top)) {
            let dim = self.minima.dim_of(run[0].top);
            let least = if dim == first_dim { Some(representative) } else { None };
            self.join_in_dim(dim, least, run);
        }
    }

    /// Strikes out the minima of one dimension that are in the cluster of a lesser one: `least`, if any, or one in `run`.
    fn join_in_dim(&mut self, dim: Dim, mut least: Option<I>, mut run: &mut [Minimum<I>]) {
        while let Some((start, later)) = run.split_first_mut() {
            if start.mask != 0 && self.walk(dim, *start, least, later) {
                start.mask = 0;
                // Those of its cluster are all struck out now.
                least = None;
            }
            run = later;
        }
    }

    /// Walks the cluster of `start`, strikes out those of `later` that it meets, and tells whether it meets `least`. Stops
    /// when all of these are met.
    fn walk(&mut self, dim: Dim, start: Minimum<I>, least: Option<I>, later: &mut [Minimum<I>]) -> bool {
        let mut left = later.iter().filter(|minimum| minimum.mask != 0).count() + usize::from(least.is_some());
        if left == 0 {
            return false;
        }
        let (first, bits) = (self.minima.first[dim], link_bits(dim));
        let links = &self.minima.links[dim - 1].next;
        let all = u32::MAX >> (31 - dim);
        let mut meets_least = false;
        self.visited.resize(self.visited.len().max((links.len() >> bits) / 64 + 1), 0);
        self.queue.clear();
        self.queue.push((start.top.to_usize() - first, start.mask));
        self.visited[self.queue[0].0 / 64] |= 1 << (self.queue[0].0 % 64);
        let mut next = 0;
        while let Some(&(number, mask)) = self.queue.get(next).filter(|_| left > 0) {
            next += 1;
            // The facets that leave out a vertex of the face do not contain it.
            let mut free = all & !mask;
            while free != 0 {
                let i = free.trailing_zeros();
                free &= free - 1;
                // Only the next around the facet: the others are met from there.
                let link = links[number << bits | i as usize].to_usize();
                let neighbour = link >> bits;
                let (word, bit) = (&mut self.visited[neighbour / 64], 1 << (neighbour % 64));
                if *word & bit != 0 {
                    continue;
                }
                *word |= bit;
                self.queue.push((neighbour, insert_bit(remove_bit(mask, i), link & ((1 << bits) - 1))));
                let top = index(first + neighbour);
                if least == Some(top) {
                    meets_least = true;
                    left -= 1;
                } else if let Ok(met) = later.binary_search_by_key(&top, |minimum| minimum.top) {
                    later[met].mask = 0;
                    left -= 1;
                }
            }
        }
        for &(number, _) in &self.queue {
            self.visited[number / 64] = 0;
        }
        meets_least
    }
}

/// Shifts the bits from `position` on up by one.
fn insert_bit(mask: u32, position: usize) -> u32 {
    let low = (1_u32 << position) - 1;
    (mask & low) | (mask & !low) << 1
}

/// Removes the bit `i` and shifts those above down.
fn remove_bit(mask: u32, i: u32) -> u32 {
    let low = (1_u32 << i) - 1;
    (mask & low) | (mask >> 1 & !low)
}
