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

use std::cmp::Reverse;
use std::ops::Range;

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::blocks::Blocks;
use crate::build::clusters::Cell;
use crate::build::cofaces::{self, Cofacets};
use crate::build::limits::Stage;
use crate::build::lists::{Part, flaggable};
use crate::build::{SigArrays, index};

/// Top simplices that one task handles.
const TASK: usize = 1 << 14;

/// If there is more than one local minimum that is no representative for so many top simplices, all steps of walks are
/// found at a time.
const MANY_OTHERS: usize = 2;

/// The relations, as found.
pub(super) struct Minima<I> {
    first: Vec<usize>,
    /// The least local minimum of the largest dimension at each simplex below dimension d − 1; the stop code if none.
    representatives: Vec<I>,
    /// What else is in the list of a simplex, by simplex.
    others: Vec<Minimum<I>>,
    /// The top simplices of each dimension below d, from 1, by facet; nothing if none is top.
    cofacets: Vec<Cofacets<I>>,
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

/// The relations of all simplices below dimension d − 1, and the cofacets of those of dimension d − 1. `is_top[p]` tells
/// which p-simplices are top, or is empty. The entries of the cofacets must fit the index type.
pub(super) fn find<I: Cell>(
    arrays: &SigArrays<I>,
    is_top: &[Vec<bool>],
    stage: &Stage<'_>,
) -> (Minima<I>, Cofacets<I>) {
    let mut minima =
        Minima { first: arrays.first.clone(), representatives: Vec::new(), others: Vec::new(), cofacets: Vec::new() };
    let Some(top_dim @ 1..) = arrays.dim() else { return (minima, Cofacets::default()) };
    let blocks = Blocks::new(arrays);
    let mut cofacets: Vec<Cofacets<I>> = (1..=top_dim)
        .map(|dim| match is_top[dim].as_slice() {
            _ if dim == top_dim => cofaces::find(arrays, &blocks, dim, None),
            [] => Cofacets::default(),
            is_top => cofaces::find(arrays, &blocks, dim, Some(is_top)),
        })
        .collect();
    drop(blocks);
    let representatives = (0..flaggable(&arrays.first)).into_par_iter().map(|_| I::STOP.share()).collect();
    let rows: Vec<&[I]> = (0..=top_dim).map(|dim| arrays.facets(dim)).collect();
    let next = vec![Vec::new(); top_dim];
    let mut tops = Tops { first: &arrays.first, rows: &rows, cofacets: &cofacets, next, representatives };
    // From dimension d downwards: a representative is of the largest dimension.
    for dim in (1..=top_dim).rev() {
        if !is_top[dim].is_empty() && dim > 1 {
            let others = tops.minima_of_dim(dim, &is_top[dim]);
            if others.len() > is_top[dim].len() / MANY_OTHERS {
                tops.next[dim - 1] = tops.all_next(dim, &is_top[dim]);
            }
            minima.others.extend(others);
        }
        stage.add(1);
    }
    tops.join(&mut minima.others);
    minima.representatives = std::mem::take(&mut tops.representatives).into_par_iter().map(I::into_inner).collect();
    let of_facets = cofacets.pop().unwrap_or_default();
    minima.cofacets = cofacets;
    (minima, of_facets)
}

/// The top simplices, and what is found of them.
struct Tops<'a, I: Cell> {
    first: &'a [usize],
    rows: &'a [&'a [I]],
    /// By dimension, from 1.
    cofacets: &'a [Cofacets<I>],
    /// [`next`](Self::next) of each top simplex and position, by dimension, from 1; nothing where few walks need it.
    next: Vec<Vec<I>>,
    representatives: Vec<I::Shared>,
}

impl<I: Cell> Tops<'_, I> {
    /// Takes in the top simplices of dimension `dim`; the larger ones are there already. What is not the representative
    /// of a face is given back.
    fn minima_of_dim(&self, dim: Dim, is_top: &[bool]) -> Vec<Minimum<I>> {
        let tasks = is_top.par_chunks(TASK).enumerate().map_init(Vec::new, |stack, (task, is_top)| {
            let mut others = Vec::new();
            let mut faces = Faces { first: self.first, rows: self.rows, stack: std::mem::take(stack) };
            for number in (task * TASK..).zip(is_top).filter_map(|(number, is_top)| is_top.then_some(number)) {
                self.add(number, dim, &mut faces, &mut others);
            }
            *stack = faces.stack;
            others
        });
        tasks.collect::<Vec<_>>().concat()
    }

    /// Takes in top simplex number `number` of dimension `dim`.
    #[inline]
    fn add(&self, number: usize, dim: Dim, faces: &mut Faces<'_, I>, others: &mut Vec<Minimum<I>>) {
        let (facet_start, cofacets) = (self.first[dim - 1], &self.cofacets[dim - 1]);
        let top: I = index(self.first[dim] + number);
        let mut shared = 0;
        for (i, facet) in self.rows[dim][number * (dim + 1)..][..dim + 1].iter().enumerate() {
            shared |= u32::from(cofacets.first(facet.to_usize() - facet_start) != top) << i;
        }
        let larger = self.first.get(dim + 1).copied().unwrap_or(usize::MAX);
        faces.for_each_above(top, dim, shared, |face, mask| {
            let representative = &self.representatives[face.to_usize()];
            let before = I::load(representative);
            if before != I::STOP && before.to_usize() >= larger {
                others.push(Minimum { face, top, mask });
                return;
            }
            // Other threads may come in between, with greater ones or lesser.
            let before = I::lower(representative, top);
            if before < top {
                others.push(Minimum { face, top, mask });
            } else if before != I::STOP {
                others.push(Minimum { face, top: before, mask: self.positions(face, before, dim) });
            }
        });
    }

    /// The top simplices of dimension `dim` around the facet `i` of one, as a ring: the number of the one after it.
    #[inline]
    fn next(&self, dim: Dim, number: usize, i: usize) -> usize {
        match self.next[dim - 1].get(number * (dim + 1) + i) {
            Some(next) => next.to_usize(),
            None => self.find_next(dim, number, i),
        }
    }

    fn find_next(&self, dim: Dim, number: usize, i: usize) -> usize {
        let facet = self.rows[dim][number * (dim + 1) + i].to_usize() - self.first[dim - 1];
        let top = index(self.first[dim] + number);
        let list = self.cofacets[dim - 1].of(facet);
        let after = list.iter().position(|&entry| entry == top).map_or(0, |place| place + 1);
        list.get(after).or(list.first()).map_or(number, |next| next.to_usize() - self.first[dim])
    }

    fn all_next(&self, dim: Dim, is_top: &[bool]) -> Vec<I> {
        let next = |place: usize| {
            let number = place / (dim + 1);
            if is_top[number] { index(self.find_next(dim, number, place % (dim + 1))) } else { I::STOP }
        };
        (0..is_top.len() * (dim + 1)).into_par_iter().map(next).collect()
    }

    /// The positions of the vertices of a face in a top simplex of dimension `dim`.
    fn positions(&self, face: I, top: I, dim: Dim) -> u32 {
        let mut faces = Faces { first: self.first, rows: self.rows, stack: Vec::new() };
        let mut mask = 0;
        faces.for_each_above(top, dim, 0, |other, positions| {
            if other == face {
                mask = positions;
            }
        });
        mask
    }

    /// Sorts the other minima by face, and strikes out those in the cluster of another.
    fn join(&self, others: &mut [Minimum<I>]) {
        // At each face by decreasing dimension, then increasing id.
        others.par_sort_unstable_by_key(|minimum| (minimum.face, Reverse(self.dim_of(minimum.top)), minimum.top));
        let mut groups: Vec<&mut [Minimum<I>]> = others.chunk_by_mut(|a, b| a.face == b.face).collect();
        groups.par_iter_mut().for_each_init(
            || Walk { tops: self, visited: Vec::new(), queue: Vec::new() },
            |walk, group| walk.join_at_face(group),
        );
    }

    fn dim_of(&self, id: I) -> Dim {
        self.first.partition_point(|&first| first <= id.to_usize()) - 1
    }
}

impl<I: Index> Minima<I> {
    /// Writes the lists of a range of simplices below dimension d − 1.
    pub(super) fn write(&self, ids: Range<usize>, part: &mut Part<I>) {
        let start = self.others.partition_point(|other| other.face.to_usize() < ids.start);
        let mut others = self.others[start..].iter().peekable();
        let mut list = Vec::new();
        for (range, cofacets) in self.first.windows(2).zip(&self.cofacets) {
            for id in ids.start.max(range[0])..ids.end.min(range[1]) {
                let representative = self.representatives[id];
                let has_others = others.peek().is_some_and(|other| other.face.to_usize() == id);
                if representative != I::STOP && cofacets.pointers.is_empty() && !has_others {
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
                if !cofacets.pointers.is_empty() {
                    list.extend_from_slice(cofacets.of(id - range[0]));
                }
                part.push(&list);
            }
        }
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
struct Walk<'a, I: Cell> {
    tops: &'a Tops<'a, I>,
    /// A bit for each simplex of the dimension, all clear between the walks.
    visited: Vec<u64>,
    /// The numbers of the top simplices met, and the positions of the vertices of the face in them.
    queue: Vec<(usize, u32)>,
}

impl<I: Cell> Walk<'_, I> {
    /// Strikes out the minima at a face that are in the cluster of a lesser one. `group` holds all but the first.
    fn join_at_face(&mut self, group: &mut [Minimum<I>]) {
        let Some(minimum) = group.first() else { return };
        let representative = I::load(&self.tops.representatives[minimum.face.to_usize()]);
        let first_dim = self.tops.dim_of(representative);
        for run in group.chunk_by_mut(|a, b| self.tops.dim_of(a.top) == self.tops.dim_of(b.top)) {
            let dim = self.tops.dim_of(run[0].top);
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
        let (first, rows) = (self.tops.first[dim], self.tops.rows[dim]);
        let row = |number: usize| &rows[number * (dim + 1)..][..dim + 1];
        let all = u32::MAX >> (31 - dim);
        let mut meets_least = false;
        self.visited.resize(self.visited.len().max(rows.len() / (dim + 1) / 64 + 1), 0);
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
                let neighbour = self.tops.next(dim, number, i as usize);
                let (word, bit) = (&mut self.visited[neighbour / 64], 1 << (neighbour % 64));
                if *word & bit != 0 {
                    continue;
                }
                *word |= bit;
                let facet = row(number)[i as usize];
                let place = row(neighbour).iter().position(|&other| other == facet).unwrap_or(0);
                self.queue.push((neighbour, insert_bit(remove_bit(mask, i), place)));
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
