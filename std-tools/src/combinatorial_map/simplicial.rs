//! Back to a simplicial complex, while the map is one.

use sig_core::{Dim, SimplexId};

use super::{CombinatorialMap, Walk, darts_of_simplex};
use crate::build::narrow;
use crate::soup::{Labels, Soup};

/// Why the cells of a map are not the simplices of a complex.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NotSimplicial {
    /// A cell has not the vertices or not the flags of a simplex.
    #[error("cell {cell} of dimension {dim} is no simplex: {vertices} vertices, {darts} darts")]
    Cell {
        /// The cell.
        cell: SimplexId,
        /// Its dimension.
        dim: Dim,
        /// Its different vertices.
        vertices: usize,
        /// Its darts in one cell of each higher dimension.
        darts: usize,
    },
    /// Two cells have the same vertices.
    #[error("cells {cell} and {other} of dimension {dim} have the same vertices")]
    SameVertices {
        /// One of them.
        cell: SimplexId,
        /// The other.
        other: SimplexId,
        /// Their dimension.
        dim: Dim,
    },
}

impl CombinatorialMap {
    /// The n-cells as simplices on their vertices, with the orientation of the map. Vertices are numbered in the order of the
    /// cells, and called by the numbers of the cells.
    ///
    /// [`build`](crate::build::build()) with [`VertexOrder::Input`](crate::build::VertexOrder) makes of them, for a map as
    /// [`CombinatorialMap::new`] made it, the arrays of the complex that it was made from; the orientations too, if those of
    /// the complex agree across facets. Labels and coordinates are not in the map.
    ///
    /// Cost: a walk over all darts for each dimension, and a sort of the words of each dimension.
    ///
    /// # Errors
    /// [`NotSimplicial`], by the first dimension and cell in which the map is no simplicial complex.
    pub fn to_soup(&self) -> Result<Soup, NotSimplicial> {
        let vertices: Vec<SimplexId> = self.cells(0).collect();
        let labels = if vertices.iter().enumerate().all(|(number, vertex)| number == vertex.index()) {
            Labels::Numbered(vertices.len())
        } else {
            Labels::Integers(vertices.iter().map(|vertex| vertex.index() as u64).collect())
        };
        let mut soup = Soup::new(labels, false);
        let mut walk = Walk::new();
        for dim in 1..=self.dim {
            let mut words = Vec::with_capacity(self.num_cells(dim));
            for cell in self.cells(dim) {
                words.push((self.word(cell, dim, &mut walk)?, cell));
            }
            if dim == self.dim {
                for (word, _) in &words {
                    let number = |&vertex: &SimplexId| vertices.binary_search(&vertex).map_or(u32::MAX, narrow);
                    soup.push(&word.iter().map(number).collect::<Vec<u32>>());
                }
            }
            words.iter_mut().for_each(|(word, _)| word.sort_unstable());
            words.sort_unstable();
            if let Some(pair) = words.windows(2).find(|pair| pair[0].0 == pair[1].0) {
                return Err(NotSimplicial::SameVertices { cell: pair[0].1, other: pair[1].1, dim });
            }
        }
        Ok(soup)
    }

    /// The vertices of a cell that is a simplex, in the order of the flag of its dart.
    fn word(&self, cell: SimplexId, dim: Dim, walk: &mut Walk) -> Result<Vec<SimplexId>, NotSimplicial> {
        let Some(dart) = self.dart_of(cell) else { return Ok(Vec::new()) };
        let mut word = vec![SimplexId::new(self.c(0, dart.0) as usize)];
        // The i-th vertex is the one that the flag's face of dimension i has more than that of dimension i − 1.
        for i in 1..=dim {
            self.walk_boundary(dart.0, i, walk);
            let darts = walk.orbit.len();
            let other_end = (i == 1).then(|| self.b(1, dart.0));
            for &at in walk.orbit.iter().chain(&other_end) {
                let vertex = SimplexId::new(self.c(0, at) as usize);
                if !word.contains(&vertex) {
                    word.push(vertex);
                }
            }
            if word.len() != i + 1 || Some(darts) != darts_of_simplex(i) {
                return Err(NotSimplicial::Cell { cell, dim, vertices: word.len(), darts });
            }
        }
        Ok(word)
    }
}
