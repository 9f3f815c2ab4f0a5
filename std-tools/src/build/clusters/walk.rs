//! Walks through the clusters at a face where there is more than one local minimum ([`super::minima`]): two are in one
//! cluster if the walk from one meets the other.

use std::cmp::Reverse;

use rayon::prelude::*;
use sig_core::Dim;

use crate::build::clusters::Cell;
use crate::build::clusters::minima::{Faces, Minimum};
use crate::build::cofaces::{Cofacets, FewCofacets};
use crate::build::index;

/// If there is more than one local minimum that is no representative for so many top simplices, all steps of walks are
/// found at a time.
pub(super) const MANY_OTHERS: usize = 2;

/// The top simplices, and what is found of them.
pub(super) struct Tops<'a, I: Cell> {
    pub(super) faces: Faces<'a, I>,
    /// Those of dimension d.
    pub(super) cofacets: &'a Cofacets<I>,
    /// Those of lower dimensions, from 1.
    pub(super) few: &'a [FewCofacets<I>],
    /// [`next`](Self::next) of each top simplex and position, by dimension, from 1; nothing where few walks need it.
    pub(super) next: Vec<Vec<I>>,
    pub(super) representatives: &'a [I::Shared],
}

impl<I: Cell> Tops<'_, I> {
    /// The top simplices of dimension `dim` around the facet `i` of one, as a ring: the number of the one after it.
    #[inline]
    fn next(&self, dim: Dim, number: usize, i: usize) -> usize {
        match self.next[dim - 1].get(number * (dim + 1) + i) {
            Some(next) => next.to_usize(),
            None => self.find_next(dim, number, i),
        }
    }

    fn find_next(&self, dim: Dim, number: usize, i: usize) -> usize {
        let facet = self.faces.rows[dim][number * (dim + 1) + i].to_usize() - self.faces.first[dim - 1];
        let top = index(self.faces.first[dim] + number);
        let list = self.few.get(dim - 1).map_or_else(|| self.cofacets.of(facet), |few| few.of(facet));
        let after = list.iter().position(|&entry| entry == top).map_or(0, |place| place + 1);
        list.get(after).or(list.first()).map_or(number, |next| next.to_usize() - self.faces.first[dim])
    }

    pub(super) fn all_next(&self, dim: Dim, is_top: &[bool]) -> Vec<I> {
        let next = |place: usize| {
            let number = place / (dim + 1);
            if is_top[number] { index(self.find_next(dim, number, place % (dim + 1))) } else { I::STOP }
        };
        (0..is_top.len() * (dim + 1)).into_par_iter().map(next).collect()
    }

    /// Sorts the other minima by face, and strikes out those in the cluster of another.
    pub(super) fn join(&self, others: &mut [Minimum<I>]) {
        // At each face by decreasing dimension, then increasing id.
        let rank = |minimum: &Minimum<I>| (Reverse(self.dim_of(minimum.top)), minimum.top);
        others.par_sort_unstable_by(|a, b| a.face.cmp(&b.face).then_with(|| rank(a).cmp(&rank(b))));
        let mut groups: Vec<&mut [Minimum<I>]> = others.chunk_by_mut(|a, b| a.face == b.face).collect();
        groups.par_iter_mut().for_each_init(
            || Walk { tops: self, visited: Vec::new(), queue: Vec::new() },
            |walk, group| walk.join_at_face(group),
        );
    }

    fn dim_of(&self, id: I) -> Dim {
        self.faces.first.partition_point(|&first| first <= id.to_usize()) - 1
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
        let (first, rows) = (self.tops.faces.first[dim], self.tops.faces.rows[dim]);
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
