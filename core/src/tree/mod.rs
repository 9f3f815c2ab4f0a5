//! A complex as its simplex tree (Boissonnat and Maria, 2012, *simplex-tree-2012* below) in level order: [`Tree`].
//!
//! Each node is a simplex, its word its vertices in increasing order. In canonical order an id is the number of the node
//! in level order: the children of a node are consecutive, and so are all its descendants of one dimension. Two arrays are
//! the whole structure: the first child and the last vertex of each simplex. A third, the lower neighbours of each vertex,
//! is the paper's list of the nodes of depth 2 with a label (2.1): with it cofaces are found without looking elsewhere.
//!
//! This file opens a tree and moves in it; faces are in `boundary`, cofaces in `cofaces`, orders in `order`.

mod any;
mod boundary;
mod cofaces;
mod descendants;
mod link;
mod neighbours;
mod order;
mod validate;

pub use any::AnyTree;
pub use boundary::{Boundary, Closure, Facets, Vertices};
pub use descendants::Descendants;
pub use order::DepthFirst;
pub(crate) use validate::validate_value;

use core::ops::Range;

use heapless::Vec;

use crate::complex::{Levels, Sections, SimplexRange};
use crate::format::{Column, Container, FormatError, Kind, SectionKind, WAITS, num_up_to};
use crate::id::{Dim, Index, MAX_DIM, SimplexId, VertexId};
use crate::slices;
use crate::view::{common_methods, find_word};

/// A simplicial complex as its simplex tree, read where it lies: a file of kind *tree*, or the tree's sections of a SIG.
///
/// It takes a third of the bytes of a SIG or less, and answers the same questions but those for clusters. Downwards, where
/// a SIG reads a facet, a tree descends from the root; upwards it enumerates the words that contain a word.
///
/// `Copy`, `Send` and `Sync`, as [`Complex`](crate::Complex). [`AnyTree`] picks the width at run time.
///
/// # Trust
///
/// [`from_bytes`](Self::from_bytes) makes every query safe whatever the arrays hold: it ends, within the buffer, without a
/// panic. That its answers are *right* is known after [`validate`](Self::validate).
///
/// # Conventions
///
/// Simplices are numbered by (dimension, lexicographic order of the sorted vertex word). A relation of an id past the
/// end, or of a dimension that the complex does not have, is empty.
#[derive(Clone, Copy, Debug)]
pub struct Tree<'a, I> {
    container: Container<'a>,
    levels: Levels,
    /// The facets, where the file is a SIG; else none.
    boundary: &'a [I],
    child_offsets: &'a [I],
    last_vertices: Column<'a>,
    lower: Option<LowerNeighbours<'a, I>>,
}

/// The lower neighbours of the vertices, where the file has them.
#[derive(Clone, Copy, Debug)]
struct LowerNeighbours<'a, I> {
    offsets: &'a [I],
    vertices: Column<'a>,
}

/// A node on the way from the root to a simplex.
#[derive(Clone, Copy, Debug)]
struct Node {
    id: usize,
    /// Its last vertex.
    label: usize,
}

/// The nodes from a vertex, a child of the root, down to a simplex.
type Path = Vec<Node, { MAX_DIM + 1 }>;

common_methods!(Tree);

impl<'a, I: Index> Tree<'a, I> {
    /// Opens the tree in `bytes`, which are in the host's byte order and aligned to
    /// [`BUFFER_ALIGN`](crate::format::BUFFER_ALIGN) bytes: a file of kind *tree*, or a SIG with the tree's sections.
    ///
    /// Checks the container ([`Container::from_bytes`]), the lookup table, and that each section has the type and the
    /// length that follow from the numbers of simplices. It does not look into the arrays: that is what
    /// [`validate`](Self::validate) does. On what it accepts, every query ends without a panic.
    ///
    /// Cost: O(number of sections), the same for any number of simplices.
    ///
    /// # Errors
    /// [`FormatError`]: what is wrong, and where. Never a panic, whatever the bytes.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, FormatError> {
        Self::from_container(Container::from_bytes(bytes)?)
    }

    /// Opens the tree in a container.
    ///
    /// # Errors
    /// As [`from_bytes`](Self::from_bytes).
    pub fn from_container(container: Container<'a>) -> Result<Self, FormatError> {
        let sections = Sections { container: &container };
        let found = container.header().kind;
        if !matches!(found, Kind::Sig | Kind::Tree) {
            return Err(FormatError::WrongKind { found, expected: Kind::Tree });
        }
        let levels = sections.levels::<I>()?;
        let boundary = match found {
            Kind::Sig => sections.indices(SectionKind::Boundary, Some(levels.num_boundary()))?,
            _ => &[],
        };
        let tree = Self::from_sections(&sections, levels, boundary)?;
        sections.check_columns(&levels)?;
        Ok(tree)
    }

    /// The tree in the sections of a file of which the lookup table and perhaps the boundary were read.
    pub(crate) fn from_sections(
        sections: &Sections<'_, 'a>,
        levels: Levels,
        boundary: &'a [I],
    ) -> Result<Self, FormatError> {
        let num_offsets = if levels.dims() == 0 { 0 } else { levels.num_pointers() + 1 };
        let lower = if sections.both([SectionKind::LowerOffsets, SectionKind::LowerNeighbours])? {
            Some(LowerNeighbours {
                offsets: sections.indices(SectionKind::LowerOffsets, Some(levels.ids(0).len() + 1))?,
                vertices: sections.vertices::<I>(SectionKind::LowerNeighbours, levels.ids(1).len())?,
            })
        } else {
            None
        };
        Ok(Self {
            container: *sections.container,
            levels,
            boundary,
            child_offsets: sections.indices(SectionKind::ChildOffsets, Some(num_offsets))?,
            last_vertices: sections.vertices::<I>(SectionKind::LastVertices, levels.total())?,
            lower,
        })
    }

    pub(crate) const fn child_offsets(&self) -> &'a [I] {
        self.child_offsets
    }

    /// Whether the file has the lower neighbours of each vertex, with which upward queries are fast.
    #[must_use]
    pub const fn has_lower_neighbours(&self) -> bool {
        self.lower.is_some()
    }

    /// The parent: the face without the last vertex; `None` for a vertex, whose parent is the root.
    ///
    /// Cost: a search over the child offsets of the dimension below, 16 parts at a step; one read in a SIG.
    #[must_use]
    pub fn parent(&self, simplex: SimplexId) -> Option<SimplexId> {
        self.parent_of(self.dim_of(simplex)?, simplex.index()).map(SimplexId::new)
    }

    /// The children: the simplices with one vertex more, after the last one. Cost: two reads.
    #[must_use]
    pub fn children(&self, simplex: SimplexId) -> SimplexRange {
        let range = self.dim_of(simplex).map_or(0..0, |dim| self.child_range(dim, simplex.index()));
        SimplexRange::new(range)
    }

    /// The last vertex of a simplex. Cost: one read.
    #[must_use]
    #[inline]
    pub fn last_vertex(&self, simplex: SimplexId) -> Option<VertexId> {
        self.last_vertices.index_at(simplex.index()).map(VertexId::new)
    }

    /// The simplex with the given vertices, which must increase strictly; `None` if there is none, or if they do not.
    ///
    /// Cost: for each vertex after the first two reads and a binary search among the children of the prefix before it.
    #[must_use]
    pub fn find(&self, vertices: &[VertexId]) -> Option<SimplexId> {
        find_word(vertices, |dim, node, vertex| self.child(dim, node, vertex))
    }

    /// The parent of a node of dimension `dim`.
    #[inline]
    fn parent_of(&self, dim: Dim, node: usize) -> Option<usize> {
        let level = self.levels.ids(dim.checked_sub(1)?);
        if !self.boundary.is_empty() {
            let row = self.levels.row(dim, node)?;
            return self.boundary.get(row)?.last().map(|parent| parent.to_usize());
        }
        // The last node whose first child is not after this one.
        let offsets = self.child_offsets.get(level.clone())?;
        let after = num_up_to(offsets, node);
        after.checked_sub(1).map(|before| level.start + before)
    }

    /// The children of a node of dimension `dim`.
    #[inline]
    fn child_range(&self, dim: Dim, node: usize) -> Range<usize> {
        self.children_of(dim, node..node.saturating_add(1))
    }

    /// The children of consecutive nodes of dimension `dim`, which are consecutive too.
    #[inline]
    fn children_of(&self, dim: Dim, nodes: Range<usize>) -> Range<usize> {
        self.children_in(&self.levels.ids(dim + 1), nodes)
    }

    /// The children of consecutive nodes, given the ids of the dimension that they are of.
    #[inline]
    fn children_in(&self, level: &Range<usize>, nodes: Range<usize>) -> Range<usize> {
        let bound = |node: usize| self.child_offsets.get(node).map_or(level.end, |offset| offset.to_usize());
        // Clamped, for in a buffer that is not a tree an offset may be anything.
        let start = bound(nodes.start).max(level.start).min(level.end);
        start..bound(nodes.end).max(start).min(level.end)
    }

    /// Reads the first child of a node for the sake of the cache: where it is read before it is known to be needed, the
    /// memory has the time to deliver it.
    #[inline]
    fn fetch_offset(&self, node: usize) {
        if WAITS {
            core::hint::black_box(self.child_offsets.get(node).copied());
        }
    }

    /// The child that ends with `label` of a node of `depth` vertices; the root has none, whatever its number.
    #[inline]
    fn child(&self, depth: usize, node: usize, label: usize) -> Option<usize> {
        match depth.checked_sub(1) {
            None => (label < self.levels.start(1)).then_some(label),
            Some(dim) => {
                let children = self.child_range(dim, node);
                self.fetch_offset(children.start);
                self.last_vertices.find(children, label)
            }
        }
    }

    /// The nodes from a vertex down to a simplex; none past the end. In a buffer that is not a tree some may lack.
    fn path(&self, simplex: SimplexId) -> Path {
        let mut path = Path::new();
        let Some(mut dim) = self.dim_of(simplex) else { return path };
        let mut id = simplex.index();
        while dim > 0 {
            let (Some(label), Some(parent)) = (self.last_vertices.index_at(id), self.parent_of(dim, id)) else { break };
            // Never full: a dimension is at most MAX_DIM.
            let _ = path.push(Node { id, label });
            (id, dim) = (parent, dim - 1);
        }
        // A vertex is its own label.
        let _ = path.push(Node { id, label: id });
        slices::reverse(&mut path);
        path
    }
}
