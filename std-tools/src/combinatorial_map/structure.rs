//! The map of a simplicial complex as one of the structures that are compared with the SIG.

use sig_core::storage::Storage;
use sig_core::{Dim, SimplexId, VertexId};

use super::{CombinatorialMap, Walk};
use crate::baselines::Structure;

/// A map with the memory to ask it for the simplices that its cells are; [`CombinatorialMap::new`] makes such a map.
///
/// A simplex is found among those around its first vertex. All relations are linear in the darts of the cells that they
/// walk around; see the methods of [`CombinatorialMap`].
#[derive(Clone, Debug)]
pub struct Darts<'a> {
    map: &'a CombinatorialMap,
    walk: Walk,
    /// The vertices of a simplex that is looked at.
    word: Vec<VertexId>,
}

impl<'a> Darts<'a> {
    /// Memory to ask `map`.
    #[must_use]
    pub fn new(map: &'a CombinatorialMap) -> Self {
        Self { map, walk: Walk::new(), word: Vec::new() }
    }
}

/// Replaces `word` by the vertices of a simplex, increasing.
fn vertices(map: &CombinatorialMap, simplex: SimplexId, word: &mut Vec<VertexId>) {
    word.clear();
    if let (Some(dart), Some(dim)) = (map.dart_of(simplex), map.dim_of(simplex)) {
        word.extend((0..=dim).map(|place| VertexId::new(vertex_at(map, dart.0, place) as usize)));
    }
    word.sort_unstable();
}

/// w_i of the flag (w_0, …, w_n) of a dart: β_j exchanges w_j with w_(j+1), and w_0 with w_1; β1 takes (w_0, w_1, w_2) to
/// (w_1, w_2, w_0).
fn vertex_at(map: &CombinatorialMap, dart: u32, place: usize) -> u32 {
    let at_two = (2..place).rev().fold(dart, |dart, j| map.b(j, dart));
    let first = (0..place.min(2)).fold(at_two, |dart, _| map.b(1, dart));
    map.c(0, first)
}

fn replace(found: &mut Vec<SimplexId>, answer: &[SimplexId]) {
    found.clear();
    found.extend_from_slice(answer);
}

impl Structure for Darts<'_> {
    type Simplex = SimplexId;

    fn dim(&self) -> Option<Dim> {
        Some(self.map.dim())
    }

    /// B · (2n + 1) integers: mcc-2012, section 8.
    fn storage(&self) -> Storage {
        Storage { integers: self.map.num_integers(), bits: 0 }
    }

    /// Bytes of the darts, and of the dart of each cell, which the paper does not count.
    fn bytes(&self) -> usize {
        self.map.bytes()
    }

    fn find(&mut self, word: &[VertexId]) -> Option<SimplexId> {
        let Self { map, walk, word: other } = self;
        let first = SimplexId::from(*word.first()?);
        if map.dim_of(first) != Some(0) {
            return None;
        }
        if word.len() == 1 {
            return map.dart_of(first).map(|_| first);
        }
        let mut around = map.coboundary(first, word.len() - 1, walk).iter().copied();
        around.find(|&simplex| {
            vertices(map, simplex, other);
            other == word
        })
    }

    fn vertices(&self, simplex: SimplexId, word: &mut Vec<VertexId>) {
        vertices(self.map, simplex, word);
    }

    fn boundary(&mut self, simplex: SimplexId, dim: Dim, found: &mut Vec<SimplexId>) {
        replace(found, self.map.boundary(simplex, dim, &mut self.walk));
    }

    fn coboundary(&mut self, simplex: SimplexId, dim: Dim, found: &mut Vec<SimplexId>) {
        replace(found, self.map.coboundary(simplex, dim, &mut self.walk));
    }

    fn star(&mut self, simplex: SimplexId, found: &mut Vec<SimplexId>) {
        replace(found, self.map.star(simplex, &mut self.walk));
    }

    fn link(&mut self, simplex: SimplexId, found: &mut Vec<SimplexId>) {
        replace(found, self.map.link(simplex, &mut self.walk));
    }

    fn adjacency(&mut self, simplex: SimplexId, found: &mut Vec<SimplexId>) {
        replace(found, self.map.adjacency(simplex, &mut self.walk));
    }
}
