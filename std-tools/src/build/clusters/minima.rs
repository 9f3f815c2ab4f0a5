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

use rayon::prelude::*;
use sig_core::{Dim, Index};

use crate::build::limits::Stage;
use crate::build::{SigArrays, index};

/// The relations, as found.
pub(super) struct Minima<I> {
    first: Vec<usize>,
    /// The least local minimum of the largest dimension at each simplex below dimension d − 1; the stop code if none.
    representatives: Vec<I>,
    /// What else is in the list of a simplex, by simplex.
    others: Vec<Minimum<I>>,
    /// The top cofacets of the simplices of each dimension.
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

/// The top cofacets of the simplices of one dimension; empty if there are none at all.
struct Cofacets<I> {
    starts: Vec<usize>,
    entries: Vec<I>,
}

impl<I> Cofacets<I> {
    fn of(&self, simplex: usize) -> &[I] {
        match self.starts.get(simplex..simplex + 2) {
            Some(&[start, end]) => &self.entries[start..end],
            _ => &[],
        }
    }
}

/// The relations of all simplices below dimension d. `is_top[p]` tells which p-simplices are top, or is empty.
pub(super) fn find<I: Index>(arrays: &SigArrays<I>, is_top: &[Vec<bool>], stage: &Stage<'_>) -> Minima<I> {
    let rows: Vec<&[I]> = (0..arrays.first.len()).map(|dim| arrays.facets(dim)).collect();
    let below = arrays.first.len().checked_sub(2).map_or(0, |facets| arrays.first[facets]);
    let mut minima = Minima {
        first: arrays.first.clone(),
        representatives: vec![I::STOP; below],
        others: Vec::new(),
        cofacets: Vec::new(),
    };
    minima
        .cofacets
        .resize_with(arrays.first.len().saturating_sub(1), || Cofacets { starts: Vec::new(), entries: Vec::new() });
    for dim in (1..arrays.first.len()).rev() {
        if is_top[dim].iter().any(|&is_top| is_top) {
            minima.add_dim(dim, &rows, &is_top[dim], arrays.ids(dim - 1).len());
        }
        stage.add(1);
    }
    minima.join(&rows);
    minima
}

impl<I: Index> Minima<I> {
    /// Takes in the top simplices of dimension `dim`; the larger ones are there already. There are `num_facets`
    /// simplices in the dimension below.
    fn add_dim(&mut self, dim: Dim, rows: &[&[I]], is_top: &[bool], num_facets: usize) {
        let mut cofacets = Cofacets { starts: vec![0; num_facets + 2], entries: Vec::new() };
        let facet_start = self.first[dim - 1];
        let tops = || rows[dim].chunks_exact(dim + 1).zip(self.first[dim]..).zip(is_top).filter(|&(_, &is_top)| is_top);
        let mut faces = Faces { first: &self.first, rows, stack: Vec::new() };
        let (representatives, others) = (&mut self.representatives, &mut self.others);
        for ((facets, top), _) in tops() {
            let mut shared = 0;
            for (i, facet) in facets.iter().enumerate() {
                let count = &mut cofacets.starts[facet.to_usize() - facet_start + 2];
                shared |= u32::from(*count > 0) << i;
                *count += 1;
            }
            let top = index(top);
            faces.for_each_above(top, dim, shared, |face, mask| {
                let representative = &mut representatives[face.to_usize()];
                if *representative == I::STOP {
                    *representative = top;
                } else {
                    others.push(Minimum { face, top, mask });
                }
            });
        }
        for facet in 2..cofacets.starts.len() {
            cofacets.starts[facet] += cofacets.starts[facet - 1];
        }
        // Shifted by one, so that filling in moves each start to where it belongs.
        cofacets.entries = vec![I::ZERO; cofacets.starts[num_facets + 1]];
        for ((facets, top), _) in tops() {
            for facet in facets {
                let next = &mut cofacets.starts[facet.to_usize() - facet_start + 1];
                cofacets.entries[*next] = index(top);
                *next += 1;
            }
        }
        cofacets.starts.pop();
        self.cofacets[dim - 1] = cofacets;
    }

    /// Sorts the other minima by face, and strikes out those in the cluster of another.
    fn join(&mut self, rows: &[&[I]]) {
        // Stable, so that at each face they stay by decreasing dimension, then increasing id.
        let mut others = std::mem::take(&mut self.others);
        others.par_sort_by_key(|minimum| minimum.face);
        let mut groups: Vec<&mut [Minimum<I>]> = others.chunk_by_mut(|a, b| a.face == b.face).collect();
        groups.par_iter_mut().for_each_init(
            || Walk { rows, minima: &*self, visited: Vec::new(), queue: Vec::new() },
            |walk, group| walk.join_at_face(group),
        );
        drop(groups);
        self.others = others;
    }

    /// Hands over C\*(σ) for every simplex σ below dimension d in id order.
    pub(super) fn for_each_list(&self, write: &mut dyn FnMut(&[I])) {
        let mut others = self.others.iter().peekable();
        let mut list = Vec::new();
        for (dim, range) in self.first.windows(2).enumerate() {
            for id in range[0]..range[1] {
                list.clear();
                list.extend(self.representatives.get(id).filter(|&&top| top != I::STOP));
                while let Some(other) = others.next_if(|other| other.face.to_usize() == id) {
                    if other.mask != 0 {
                        list.push(other.top);
                    }
                }
                list.extend_from_slice(self.cofacets[dim].of(id - range[0]));
                write(&list);
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
        self.stack.push((simplex, dim, 0));
        while let Some((face, face_dim, omitted)) = self.stack.pop() {
            if face_dim + 2 <= dim {
                visit(face, all & !omitted);
            }
            if face_dim == 0 {
                continue;
            }
            // Positions before all that are left out are the same in the face and in the simplex.
            let mut free = all & !kept & (omitted & omitted.wrapping_neg()).wrapping_sub(1);
            let row = (face.to_usize() - self.first[face_dim]) * (face_dim + 1);
            while free != 0 {
                let position = free.trailing_zeros();
                free &= free - 1;
                self.stack.push((self.rows[face_dim][row + position as usize], face_dim - 1, omitted | 1 << position));
            }
        }
    }
}

/// Walks clusters from top simplex to top simplex.
struct Walk<'a, I> {
    rows: &'a [&'a [I]],
    minima: &'a Minima<I>,
    /// A bit for each simplex of the dimension, all clear between the walks.
    visited: Vec<u64>,
    /// The top simplices met, and the positions of the vertices of the face in them.
    queue: Vec<(I, u32)>,
}

impl<I: Index> Walk<'_, I> {
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
        let (first, facet_first) = (self.minima.first[dim], self.minima.first[dim - 1]);
        let rows = self.rows[dim];
        let cofacets = &self.minima.cofacets[dim - 1];
        let mut left = later.iter().filter(|minimum| minimum.mask != 0).count() + usize::from(least.is_some());
        let mut meets_least = false;
        if left == 0 {
            return false;
        }
        self.visited.resize(self.visited.len().max(rows.len() / (dim + 1) / 64 + 1), 0);
        self.queue.clear();
        self.queue.push((start.top, start.mask));
        let bit = |top: I| ((top.to_usize() - first) / 64, 1_u64 << ((top.to_usize() - first) % 64));
        let (word, mask) = bit(start.top);
        self.visited[word] |= mask;
        let mut next = 0;
        while left > 0
            && let Some(&(top, mask)) = self.queue.get(next)
        {
            next += 1;
            let row = (top.to_usize() - first) * (dim + 1);
            // The facets that leave out a vertex of the face do not contain it.
            for i in (0..=dim).filter(|i| mask >> i & 1 == 0) {
                let facet = rows[row + i];
                for &neighbour in cofacets.of(facet.to_usize() - facet_first) {
                    let (word, bit) = bit(neighbour);
                    if self.visited[word] & bit != 0 {
                        continue;
                    }
                    self.visited[word] |= bit;
                    self.queue
                        .push((neighbour, cross(mask, i, &rows[(neighbour.to_usize() - first) * (dim + 1)..], facet)));
                    if least == Some(neighbour) {
                        meets_least = true;
                        left -= 1;
                    } else if let Ok(met) = later.binary_search_by_key(&neighbour, |minimum| minimum.top) {
                        later[met].mask = 0;
                        left -= 1;
                    }
                }
            }
        }
        for &(top, _) in &self.queue {
            self.visited[bit(top).0] = 0;
        }
        meets_least
    }
}

/// Takes positions in a simplex, which avoid `i`, through its facet `i` to a simplex whose facets start with `row`.
fn cross<I: Index>(mask: u32, i: usize, row: &[I], facet: I) -> u32 {
    let in_facet = remove_bit(mask, i);
    let j = row.iter().position(|&other| other == facet).unwrap_or(0);
    let low = (1_u32 << j) - 1;
    (in_facet & low) | (in_facet & !low) << 1
}

/// Removes the bit `i` and shifts those above down.
fn remove_bit(mask: u32, i: usize) -> u32 {
    let low = (1_u32 << i) - 1;
    (mask & low) | (mask >> 1 & !low)
}
