//! The simplex tree that changes (simplex-tree-2012, 2): [`SimplexTree`].
//!
//! A complex in a file is a simplex tree already, in level order, and is read where it lies; this one is for inserting,
//! removing, collapsing and contracting. It comes from nothing, from a [`FrozenTree`](crate::frozen::FrozenTree) or from
//! a file ([`SimplexTree::thaw`], [`SimplexTree::thaw_complex`]), and goes back by [`SimplexTree::freeze`].
//!
//! | operation | file |
//! |---|---|
//! | memory: sibling sets in one array, the vertices | `arena`, `top` |
//! | find, parent, children, siblings, facets | `node` |
//! | insert a simplex, with its prefixes, with all faces; filtration values | `insert`, `filtration` |
//! | remove with all cofaces | `remove` |
//! | cofaces, star, link, neighbours; label lists | `cofaces`, `lists` |
//! | depth-first, by dimension, by filtration value; maximal simplices, skeleton | `iterate` |
//! | free pairs, collapses | `collapse` |
//! | link condition, edge contraction | `contract` |
//! | relabelling, pruning, making compact | `rebuild` |
//! | flag complexes: whole, edge by edge, with a blocker | `expand` |
//! | to and from flat arrays; GUDHI's text | `freeze`, `thaw`, `text` |
//!
//! Costs are in the paper's terms: p the dimension of the simplex, d the most siblings in a set, `D_m` = O(log d) a search
//! in one (a scan below 17). A set is a sorted array, so that inserting or removing one sibling takes O(d): a move of
//! bytes.

mod arena;
mod cofaces;
mod collapse;
mod contract;
mod error;
mod expand;
mod filtration;
mod freeze;
mod insert;
mod iterate;
mod lists;
mod node;
mod rebuild;
mod remove;
mod text;
mod thaw;
mod top;

use sig_core::{Dim, MAX_DIM};

pub use cofaces::Cofaces;
pub use collapse::{Collapse, Collapses};
pub use contract::{Contraction, LinkCondition};
pub use error::{ContractError, ExpandError, InsertError, NotFree, RelabelError, SizeError, ThawError, WordError};
pub use iterate::DepthFirst;
pub use node::Simplex;
pub use thaw::Vertices;

use arena::Arena;
use lists::LabelLists;
use node::Place;
use top::Tops;

/// A simplicial complex that changes, as its simplex tree: one node a simplex (simplex-tree-2012, 2.1).
///
/// Vertices have 32-bit labels, any but the largest. A simplex is named by its word, the strictly increasing labels of
/// its vertices. With filtration values a node takes 16 bytes and a set of siblings 16 more; without, 8 and 16. Values
/// are numbers, infinities among them; −0 is kept as 0.
///
/// ```
/// use sig_tools::simplex_tree::SimplexTree;
///
/// let mut tree = SimplexTree::new();
/// tree.insert_with_faces(&[1, 2, 3], 0.5)?;
/// tree.insert_with_faces(&[3, 4], 1.0)?;
/// assert_eq!(tree.counts(), [4, 4, 1]);
/// assert_eq!(tree.star(&[3]).count(), 5);
/// assert!(tree.link_condition(3, 4));
/// tree.contract(3, 4)?;
/// assert_eq!(tree.counts(), [3, 3, 1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SimplexTree {
    tops: Tops,
    arena: Arena,
    lists: Option<LabelLists>,
    /// The number of simplices of each dimension.
    counts: [usize; MAX_DIM + 1],
    /// Memory for [`insert_with_faces`](Self::insert_with_faces), from one call to the next.
    faces: [Vec<(Place, u32)>; 2],
}

/// The empty complex, with filtration values.
impl Default for SimplexTree {
    fn default() -> Self {
        Self::new()
    }
}

impl SimplexTree {
    /// The empty complex, whose simplices will have filtration values.
    #[must_use]
    pub fn new() -> Self {
        Self::with_layout(true, false)
    }

    /// The empty complex, whose simplices will have no filtration values: those given are ignored, all read as 0.
    #[must_use]
    pub fn without_filtration() -> Self {
        Self::with_layout(false, false)
    }

    fn with_layout(filtered: bool, listed: bool) -> Self {
        Self {
            tops: Tops::default(),
            arena: Arena::new(filtered, listed),
            lists: listed.then(LabelLists::default),
            counts: [0; MAX_DIM + 1],
            faces: Default::default(),
        }
    }

    /// Whether simplices have filtration values.
    #[must_use]
    pub const fn has_filtration(&self) -> bool {
        self.arena.is_filtered()
    }

    /// The dimension of the complex; `None` if it is empty.
    #[must_use]
    pub fn dim(&self) -> Option<Dim> {
        self.counts.iter().rposition(|&count| count > 0)
    }

    /// The number of simplices of each dimension.
    #[must_use]
    pub fn counts(&self) -> &[usize] {
        &self.counts[..self.dim().map_or(0, |dim| dim + 1)]
    }

    /// The number of simplices.
    #[must_use]
    pub fn num_simplices(&self) -> usize {
        self.counts.iter().sum()
    }

    /// The number of vertices.
    #[must_use]
    pub const fn num_vertices(&self) -> usize {
        self.counts[0]
    }

    /// Whether there is no simplex.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.counts[0] == 0
    }

    /// χ = Σ (−1)^p n_p.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        let sign = |dim: Dim| if dim.is_multiple_of(2) { 1 } else { -1 };
        let signed = |(dim, &count): (Dim, &usize)| sign(dim) * i64::try_from(count).unwrap_or(i64::MAX);
        self.counts.iter().enumerate().map(signed).sum()
    }

    /// The bytes that the sibling sets take, free blocks among them; without the table of vertices and the label lists.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.arena.bytes()
    }
}

/// The same simplices with the same values.
impl PartialEq for SimplexTree {
    fn eq(&self, other: &Self) -> bool {
        let nodes = |tree: &Self| (tree.has_filtration(), tree.counts);
        nodes(self) == nodes(other)
            && self.iter().zip(other.iter()).all(|(mine, theirs)| {
                (mine.dim(), mine.label(), mine.value()) == (theirs.dim(), theirs.label(), theirs.value())
            })
    }
}

/// Checks that labels are the word of a simplex.
fn check_word(word: &[u32]) -> Result<(), WordError> {
    if word.len() > MAX_DIM + 1 {
        return Err(WordError::TooManyVertices { vertices: word.len() });
    }
    let last = *word.last().ok_or(WordError::Empty)?;
    if last == u32::MAX {
        return Err(WordError::ReservedLabel);
    }
    match word.windows(2).find(|pair| pair[0] >= pair[1]) {
        Some(pair) => Err(WordError::NotIncreasing(pair[1])),
        None => Ok(()),
    }
}
