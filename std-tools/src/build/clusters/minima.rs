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

use crate::build::clusters::Cell;
use crate::build::clusters::walk::{MANY_OTHERS, Tops};
use crate::build::cofaces::{self, Cofacets, FewCofacets};
use crate::build::limits::Stage;
use crate::build::lists::{Part, flaggable};
use crate::build::{SigArrays, index};

/// Simplices that are looked through at a time.
const CHUNK: usize = 1 << 16;

/// The relations, as found.
pub(super) struct Minima<I: Cell> {
    first: Vec<usize>,
    /// The least local minimum of the largest dimension at each simplex below dimension d − 1; the stop code if none.
    representatives: Vec<I::Shared>,
    /// What else is in the list of a simplex, by simplex.
    others: Vec<Minimum<I>>,
    /// The top simplices of each dimension below d, from 1, by facet.
    cofacets: Vec<FewCofacets<I>>,
}

/// A local minimum at a face.
#[derive(Clone, Copy)]
pub(super) struct Minimum<I> {
    pub(super) face: I,
    pub(super) top: I,
    /// The positions of the vertices of the face in the top simplex; none once it is known to be in the cluster of a
    /// lesser one.
    pub(super) mask: u32,
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
    let representatives: Vec<I::Shared> =
        (0..flaggable(&arrays.first)).into_par_iter().map(|_| I::STOP.share()).collect();
    let rows: Vec<&[I]> = (0..=top_dim).map(|dim| arrays.facets(dim)).collect();
    let finder = Finder { faces: Faces { first: &arrays.first, rows: &rows }, representatives: &representatives };
    // From dimension d downwards: a representative is of the largest dimension.
    let (cofacets, found) = cofaces::find(arrays, top_dim, Vec::new, |others, number, shared| {
        finder.add(number, top_dim, shared, others);
    });
    let mut num_others = vec![0; top_dim + 1];
    let mut take = |dim: Dim, found: Vec<Vec<Minimum<I>>>| {
        let before = minima.others.len();
        minima.others.extend(found.into_iter().flatten());
        num_others[dim] = minima.others.len() - before;
        stage.add(1);
    };
    take(top_dim, found);
    minima.cofacets.resize_with(top_dim - 1, FewCofacets::default);
    for dim in (1..top_dim).rev().filter(|&dim| !is_top[dim].is_empty()) {
        let tops: Vec<I> = numbers(&is_top[dim]);
        let (cofacets, found) = cofaces::find_few(arrays, dim, &tops, Vec::new, |others, number, shared| {
            finder.add(number, dim, shared, others);
        });
        minima.cofacets[dim - 1] = cofacets;
        take(dim, found);
    }
    let mut tops = Tops {
        faces: finder.faces,
        cofacets: &cofacets,
        few: &minima.cofacets,
        next: vec![Vec::new(); top_dim],
        representatives: &representatives,
    };
    for dim in (2..=top_dim).filter(|&dim| num_others[dim] > is_top[dim].len() / MANY_OTHERS) {
        tops.next[dim - 1] = tops.all_next(dim, &is_top[dim]);
    }
    tops.join(&mut minima.others);
    minima.representatives = representatives;
    (minima, cofacets)
}

/// The numbers of the top simplices.
fn numbers<I: Index>(is_top: &[bool]) -> Vec<I> {
    let tops = is_top.par_chunks(CHUNK).enumerate().flat_map_iter(|(chunk, is_top)| {
        (chunk * CHUNK..).zip(is_top).filter(|&(_, &is_top)| is_top).map(|(number, _)| index(number))
    });
    tops.collect()
}

/// Finds local minima.
struct Finder<'a, I: Cell> {
    faces: Faces<'a, I>,
    representatives: &'a [I::Shared],
}

impl<I: Cell> Finder<'_, I> {
    /// Takes in top simplex number `number` of dimension `dim`, which has the facets at the positions `shared` in common
    /// with ones before; the larger ones are there already. What is not the representative of a face goes to `others`.
    #[inline]
    fn add(&self, number: usize, dim: Dim, shared: u32, others: &mut Vec<Minimum<I>>) {
        let top: I = index(self.faces.first[dim] + number);
        let larger = self.faces.first.get(dim + 1).copied().unwrap_or(usize::MAX);
        self.faces.for_each_above(top, dim, shared, |face, mask| {
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
                others.push(Minimum { face, top: before, mask: self.faces.positions(face, before, dim) });
            }
        });
    }
}

impl<I: Cell> Minima<I> {
    /// Writes the lists of a range of simplices below dimension d − 1.
    pub(super) fn write(&self, ids: Range<usize>, part: &mut Part<I>) {
        let start = self.others.partition_point(|other| other.face.to_usize() < ids.start);
        let mut others = self.others[start..].iter().peekable();
        let mut list = Vec::new();
        for (range, cofacets) in self.first.windows(2).zip(&self.cofacets) {
            let ids = ids.start.max(range[0])..ids.end.min(range[1]);
            let mut pairs = cofacets.pairs_from(ids.start.saturating_sub(range[0])).peekable();
            for id in ids {
                let representative = I::load(&self.representatives[id]);
                let is_alone = others.peek().is_none_or(|other| other.face.to_usize() != id)
                    && pairs.peek().is_none_or(|&(facet, _)| facet != id - range[0]);
                if is_alone && representative != I::STOP {
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
                while let Some((_, top)) = pairs.next_if(|&(facet, _)| facet == id - range[0]) {
                    list.push(top);
                }
                part.push(&list);
            }
        }
    }
}

/// Lists the faces of simplices.
pub(super) struct Faces<'a, I> {
    pub(super) first: &'a [usize],
    /// The facets of the simplices of each dimension.
    pub(super) rows: &'a [&'a [I]],
}

impl<I: Index> Faces<'_, I> {
    /// Calls `visit` with every face of a simplex that has the vertices at the positions `kept` and at least two fewer
    /// than the simplex, and the positions of its vertices.
    #[inline]
    fn for_each_above(&self, simplex: I, dim: Dim, kept: u32, mut visit: impl FnMut(I, u32)) {
        let all = u32::MAX >> (31 - dim);
        let free = all & !kept;
        // Vertices are left out from the last to the first, which meets each face once; a facet is no use in itself.
        for position in positions(free & free.wrapping_sub(1)).filter(|_| dim > 1) {
            let facet = self.facet(simplex, dim, position);
            let rest = (free & below(position), 1 << position);
            self.for_each_in(facet, dim - 1, rest, &mut |face, omitted| visit(face, all & !omitted));
        }
    }

    /// Calls `visit` with the faces of `face` that leave out at least one of the positions `free`, and with all that they
    /// leave out of the simplex, in which `face` leaves out `omitted`.
    fn for_each_in(&self, face: I, dim: Dim, (free, omitted): (u32, u32), visit: &mut impl FnMut(I, u32)) {
        // Positions before all that are left out are the same in the face and in the simplex.
        for position in positions(free) {
            let facet = self.facet(face, dim, position);
            let omitted = omitted | 1 << position;
            visit(facet, omitted);
            let rest = (free & below(position), omitted);
            if rest.0 != 0 && dim > 1 {
                self.for_each_in(facet, dim - 1, rest, visit);
            }
        }
    }

    #[inline]
    fn facet(&self, simplex: I, dim: Dim, position: u32) -> I {
        self.rows[dim][(simplex.to_usize() - self.first[dim]) * (dim + 1) + position as usize]
    }

    /// The positions of the vertices of a face in a top simplex of dimension `dim`.
    fn positions(&self, face: I, top: I, dim: Dim) -> u32 {
        let mut mask = 0;
        self.for_each_above(top, dim, 0, |other, positions| {
            if other == face {
                mask = positions;
            }
        });
        mask
    }
}

/// The bits that are set, from the lowest.
fn positions(mut mask: u32) -> impl Iterator<Item = u32> {
    std::iter::from_fn(move || {
        let position = (mask != 0).then(|| mask.trailing_zeros());
        mask &= mask.wrapping_sub(1);
        position
    })
}

/// The bits before a position.
fn below(position: u32) -> u32 {
    (1 << position) - 1
}
