//! IA, the indexed data structure with adjacencies, for pseudo-manifolds of any dimension (sig-2004, 3 and 7.2).

use rayon::prelude::*;
use sig_core::storage::Storage;
use sig_core::{Dim, Index};

use super::faces::Marks;
use super::faces::{all, positions};
use super::tops::check_width;
use super::{Face, Refusal, TopSimplices, Tops, array_bytes};
use crate::build::{index, narrow};
use crate::soup::{Labels, Soup};

/// B_{d,0} and A_d of each d-simplex: 2 (d+1) n_d integers.
///
/// Represents regular complexes in which each (d−1)-simplex is a face of one or two d-simplices, connected or not. Finds
/// the top simplices around a d-simplex or a (d−1)-simplex in O(1); around another simplex it looks at all d-simplices.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct IndexedAdjacencies<I> {
    num_vertices: usize,
    /// d + 1.
    width: usize,
    /// The vertices of each d-simplex, in an order of its orientation.
    corners: Vec<I>,
    /// For each corner the d-simplex across the facet opposite to it; the stop code on the boundary.
    neighbours: Vec<I>,
}

/// A facet of a d-simplex.
#[derive(Clone, Copy)]
struct Facet {
    /// Its first four vertices, increasing.
    key: u128,
    /// Where the corner opposite to it stands among the corners of all.
    corner: usize,
}

impl<I: Index> IndexedAdjacencies<I> {
    /// Builds the structure: a sort of the facets.
    ///
    /// # Errors
    /// [`Refusal`]: a top simplex of lower dimension, a facet of more than two simplices, or numbers that `I` cannot hold.
    pub fn new(tops: &Tops) -> Result<Self, Refusal> {
        let num_vertices = tops.num_vertices();
        let Some(dim) = tops.dim() else {
            return Ok(Self { num_vertices, width: 1, corners: Vec::new(), neighbours: Vec::new() });
        };
        for lower in 0..dim {
            if let Some(word) = tops.of_dim(lower).chunks_exact(lower + 1).next() {
                return Err(Refusal::NotRegular { simplex: tops.name(word), dim: lower, of: dim });
            }
        }
        check_width::<I>(num_vertices.max(tops.count(dim)).saturating_sub(1))?;
        let (width, flat) = (dim + 1, tops.of_dim(dim));
        let facet_word = |corner: usize| {
            let (start, omitted) = (corner - corner % width, corner % width);
            let mut word = flat[start..start + width].to_vec();
            word.remove(omitted);
            word.sort_unstable();
            word
        };
        let key = |corner: usize| {
            let (start, omitted) = (corner - corner % width, corner % width);
            let (mut word, mut len) = ([u32::MAX; 33], 0);
            for &vertex in
                flat[start..start + width].iter().enumerate().filter(|(at, _)| *at != omitted).map(|(_, v)| v)
            {
                word[len] = vertex;
                len += 1;
            }
            word[..len].sort_unstable();
            word[..4].iter().fold(0, |packed, &vertex| packed << 32 | u128::from(vertex))
        };
        let mut facets: Vec<Facet> =
            (0..flat.len()).into_par_iter().map(|corner| Facet { key: key(corner), corner }).collect();
        // The key is the whole word of a facet of up to four vertices.
        let long = dim > 4;
        let same = |left: &Facet, right: &Facet| {
            left.key == right.key && (!long || facet_word(left.corner) == facet_word(right.corner))
        };
        facets.par_sort_unstable_by(|left, right| {
            let rest = |facet: &Facet| long.then(|| facet_word(facet.corner));
            left.key.cmp(&right.key).then_with(|| rest(left).cmp(&rest(right))).then(left.corner.cmp(&right.corner))
        });
        let mut neighbours = vec![I::STOP; flat.len()];
        for around in facets.chunk_by(same) {
            match around {
                [one, other] => {
                    neighbours[one.corner] = index(other.corner / width);
                    neighbours[other.corner] = index(one.corner / width);
                }
                [first, _, _, ..] => {
                    let simplex = tops.name(&facet_word(first.corner));
                    return Err(Refusal::Crowded { simplex, dim, cofaces: around.len() });
                }
                _ => {}
            }
        }
        Ok(Self { num_vertices, width, corners: tops.corners(dim), neighbours })
    }

    /// The d-simplices as a list that [`build`](crate::build::build()) takes, vertices by number.
    #[must_use]
    pub fn to_soup(&self) -> Soup {
        let mut soup = Soup::new(Labels::Numbered(self.num_vertices), true);
        soup.simplices.resize_with(self.width, Vec::new);
        soup.simplices[self.width - 1] = self.corners.iter().map(|corner| narrow(corner.to_usize())).collect();
        soup
    }

    fn corners_of(&self, top: usize) -> &[I] {
        &self.corners[top * self.width..(top + 1) * self.width]
    }
}

impl<I: Index> TopSimplices for IndexedAdjacencies<I> {
    fn dim(&self) -> Option<Dim> {
        (!self.corners.is_empty()).then_some(self.width - 1)
    }

    fn storage(&self) -> Storage {
        Storage { integers: self.corners.len() + self.neighbours.len(), bits: 0 }
    }

    fn bytes(&self) -> usize {
        array_bytes(&self.corners) + array_bytes(&self.neighbours)
    }

    fn num_marks(&self) -> usize {
        0
    }

    fn len(&self, _top: u32) -> usize {
        self.width
    }

    fn vertex(&self, top: u32, position: usize) -> u32 {
        narrow(self.corners[top as usize * self.width + position].to_usize())
    }

    fn vertex_face(&self, vertex: u32) -> Option<Face> {
        let vertex = I::from_usize(vertex as usize)?;
        let corner = self.corners.iter().position(|&corner| corner == vertex)?;
        Some(Face { top: narrow(corner / self.width), mask: 1 << (corner % self.width) })
    }

    fn incident(&self, face: Face, _marks: &mut Marks, found: &mut Vec<Face>) {
        let (top, missing) = (face.top as usize, all(self.width) & !face.mask);
        if missing == 0 {
            found.push(face);
        } else if missing.is_power_of_two() && self.width > 1 {
            found.push(face);
            let across = self.neighbours[top * self.width + missing.trailing_zeros() as usize];
            if across != I::STOP {
                found.extend(self.contains(across.to_usize(), face));
            }
        } else {
            found.extend((0..self.corners.len() / self.width).filter_map(|other| self.contains(other, face)));
        }
    }
}

impl<I: Index> IndexedAdjacencies<I> {
    /// A simplex as a face of another d-simplex, if it is one.
    fn contains(&self, other: usize, face: Face) -> Option<Face> {
        let (own, corners) = (self.corners_of(face.top as usize), self.corners_of(other));
        let mask = positions(face.mask).try_fold(0, |mask, position| {
            Some(mask | 1 << corners.iter().position(|&corner| corner == own[position])?)
        })?;
        Some(Face { top: narrow(other), mask })
    }
}
