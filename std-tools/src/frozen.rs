//! The simplex tree in level order, as the file stores it: [`FrozenTree`].
//!
//! What every construction of this crate that does not come from a mesh ends with: flag, Rips and witness complexes, and
//! the dynamic simplex tree when it is frozen. It is encoded as it is, as a file of kind *tree*
//! ([`crate::store::Encoding::of_tree`]), or completed to a whole Simplified Incidence Graph
//! ([`crate::build::complete`]).

use std::ops::Range;

use sig_core::{Dim, Relations, SimplexId, VertexId};

use crate::build::ids;
use crate::soup::{Coordinates, Labels};

/// The most simplices that a [`FrozenTree`] holds: ids are 32-bit, and the largest is the stop code.
pub const MAX_SIMPLICES: usize = u32::MAX as usize - 1;

/// A simplicial complex as its simplex tree (simplex-tree-2012, 2.1) in level order.
///
/// Simplices are numbered by (dimension, lexicographic order of the sorted vertex word): a node of depth p + 1 of the
/// tree is a p-simplex, the children of a node have consecutive numbers. The complex has at most [`MAX_SIMPLICES`].
#[derive(Clone, PartialEq, Debug)]
pub struct FrozenTree {
    /// The first id of each dimension, `d + 1` of them; none for the empty complex.
    pub first: Vec<usize>,
    /// The number of simplices.
    pub num_simplices: usize,
    /// The first child of every simplex below dimension d, then the number of simplices: `first[d] + 1` in all; none for
    /// the empty complex.
    pub child_offsets: Vec<u32>,
    /// The last vertex of every simplex; of vertex `v` that is `v`.
    pub last_vertices: LastVertices,
    /// The filtration value of every simplex, at least that of its faces; no NaN, no −0.
    pub filtration: Option<Vec<f64>>,
    /// The labels of the vertices, by vertex id; [`Labels::Numbered`] if they are the ids themselves.
    pub labels: Labels,
    /// The coordinates of the vertices, by vertex id.
    pub coordinates: Option<Coordinates>,
}

/// The empty complex.
impl Default for FrozenTree {
    fn default() -> Self {
        Self {
            first: Vec::new(),
            num_simplices: 0,
            child_offsets: Vec::new(),
            last_vertices: LastVertices::Bits16(Vec::new()),
            filtration: None,
            labels: Labels::Numbered(0),
            coordinates: None,
        }
    }
}

impl FrozenTree {
    /// The tree of a complex in a file of either kind, with all that a tree has beside it: labels, coordinates, filtration
    /// values. `None` if the complex has more simplices than [`MAX_SIMPLICES`].
    ///
    /// Cost: O(1) a simplex where the file has the tree's sections.
    #[must_use]
    pub fn of(complex: &impl Relations) -> Option<Self> {
        let num_simplices = complex.num_simplices();
        u32::try_from(num_simplices).ok().filter(|_| num_simplices <= MAX_SIMPLICES)?;
        let narrow = |id: usize| u32::try_from(id).unwrap_or(u32::MAX);
        let dims = complex.dim().map_or(0, |dim| dim + 1);
        let first = (0..dims).map(|dim| complex.simplices_of_dim(dim).bounds().0.index()).collect::<Vec<_>>();
        let below_top = (0..first.last().copied().unwrap_or(0)).map(SimplexId::new);
        let first_child = |simplex| narrow(complex.children(simplex).bounds().0.index());
        let end = (dims > 0).then_some(narrow(num_simplices));
        let last = complex.simplices().map(|simplex| complex.last_vertex(simplex).map_or(usize::MAX, VertexId::index));
        let last_vertices = if complex.num_vertices() <= LastVertices::MOST_BITS16 {
            LastVertices::Bits16(last.map(|vertex| u16::try_from(vertex).unwrap_or(u16::MAX)).collect())
        } else {
            LastVertices::Bits32(last.map(narrow).collect())
        };
        Some(Self {
            child_offsets: below_top.map(first_child).chain(end).collect(),
            first,
            num_simplices,
            last_vertices,
            filtration: complex.filtration().map(<[f64]>::to_vec),
            labels: Labels::of(complex),
            coordinates: Coordinates::of(complex),
        })
    }

    /// The dimension of the complex; `None` if it is empty.
    #[must_use]
    pub fn dim(&self) -> Option<Dim> {
        self.first.len().checked_sub(1)
    }

    /// The ids of the simplices of dimension `dim`.
    #[must_use]
    pub fn ids(&self, dim: Dim) -> Range<usize> {
        ids(&self.first, self.num_simplices, dim)
    }

    /// The number of simplices of each dimension.
    #[must_use]
    pub fn counts(&self) -> Vec<usize> {
        (0..self.first.len()).map(|dim| self.ids(dim).len()).collect()
    }

    /// The number of vertices.
    #[must_use]
    pub fn num_vertices(&self) -> usize {
        self.ids(0).len()
    }

    /// The ids of the children of simplex `id`; empty in dimension d.
    #[must_use]
    pub fn children(&self, id: usize) -> Range<usize> {
        match self.child_offsets.get(id..id + 2) {
            Some(&[start, end]) => start as usize..end as usize,
            _ => 0..0,
        }
    }
}

/// Vertex ids in the least width that holds the number of vertices.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum LastVertices {
    /// Of complexes with up to 65,534 vertices.
    Bits16(Vec<u16>),
    /// Of others.
    Bits32(Vec<u32>),
}

impl LastVertices {
    /// The most vertices whose ids are stored in 16 bits.
    pub const MOST_BITS16: usize = u16::MAX as usize - 1;

    /// The vertex at `index`.
    ///
    /// # Panics
    /// Past the end.
    #[must_use]
    #[inline]
    pub fn at(&self, index: usize) -> u32 {
        match self {
            Self::Bits16(vertices) => vertices[index].into(),
            Self::Bits32(vertices) => vertices[index],
        }
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Bits16(vertices) => vertices.len(),
            Self::Bits32(vertices) => vertices.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}
