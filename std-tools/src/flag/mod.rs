//! Flag complexes: all cliques of a [`Graph`], straight into the flat arrays of a [`FrozenTree`] (simplex-tree-2012,
//! 3.1, without the pointer tree).
//!
//! The walk (`walk`) goes through the vertices in order and below each through the cliques of which it is the least
//! vertex. Restricted to one dimension that is the canonical order, so every simplex is written once, where it belongs.
//! It is made twice: `count` only counts, which tells whether there is room, how the work is to be divided, and where the
//! simplices of each part go; `write` then fills the arrays, which are allocated once at their final size. `values`
//! carries the weights of the edges down the same cliques. `estimate` counts below some of the vertices.
//!
//! The result depends on the graph and the largest dimension only, not on the number of threads. Work runs in rayon's
//! current pool.

mod count;
mod estimate;
mod values;
mod walk;
mod write;

use sig_core::{Dim, Index, MAX_DIM};

use crate::build::available_memory;
use crate::frozen::{FrozenTree, LastVertices, MAX_SIMPLICES};
use crate::graph::Graph;

pub use estimate::{Accuracy, Estimate, estimate};

/// What the expansion is doing, for a progress report; counted in vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Phase {
    /// Counting the simplices.
    Counting,
    /// Writing the tree.
    Writing,
    /// Finding the filtration values.
    Values,
}

/// A callback that is told the phase, how much of it is done, and how much there is.
pub type Progress<'a> = &'a (dyn Fn(Phase, u64, u64) + Sync);

/// How to expand a graph. The default: the whole flag complex, as far as memory allows.
#[derive(Clone, Copy)]
pub struct FlagOptions<'a> {
    /// The largest dimension of a simplex; at most [`MAX_DIM`], which is what larger numbers mean.
    pub max_dim: Dim,
    /// The most simplices that the complex may have.
    pub max_simplices: Option<u64>,
    /// The most bytes that the tree may take; the system's available memory if `None` and the system tells it.
    pub max_bytes: Option<u64>,
    /// Told how far the work is, from any thread.
    pub progress: Option<Progress<'a>>,
}

impl Default for FlagOptions<'_> {
    fn default() -> Self {
        Self { max_dim: MAX_DIM, max_simplices: None, max_bytes: None, progress: None }
    }
}

/// Why a graph is not expanded. Nothing has been allocated then.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FlagError {
    /// There are more simplices than the options, or 32-bit ids, allow.
    #[error(
        "the complex has at least {at_least} simplices, and the limit is {limit}: \
         take a smaller radius, fewer points or a smaller dimension{}",
        if *limit < MAX_SIMPLICES as u64 { ", or raise the limit" } else { "" }
    )]
    TooManySimplices {
        /// A lower bound of the number of simplices.
        at_least: u64,
        /// The most that there may be.
        limit: u64,
    },
    /// The tree takes more bytes than the options, or the memory, allow.
    #[error(
        "the complex has at least {at_least} simplices, which take at least {bytes} bytes, and the budget is {budget} \
         bytes: take a smaller radius, fewer points or a smaller dimension, or raise the budget"
    )]
    TooManyBytes {
        /// A lower bound of the number of simplices.
        at_least: u64,
        /// Bytes that these take.
        bytes: u64,
        /// The most bytes that the tree may take.
        budget: u64,
    },
}

/// Expands a graph to its flag complex: all cliques of at most `max_dim` + 1 vertices, with the number of the vertex in
/// the graph as its id.
///
/// The tree has filtration values exactly if the edges of the graph [have weights](Graph::is_weighted): the largest
/// weight of an edge and of a vertex of the simplex. Labels are the numbers of the vertices; there are no coordinates.
///
/// Time is linear in the number of simplices, a few nanoseconds each, while vertices have up to some hundred neighbours;
/// memory is that of the result and little more.
///
/// # Errors
/// [`FlagError`]: a complex larger than `options` or memory allow.
pub fn expand(graph: &Graph, options: &FlagOptions<'_>) -> Result<FrozenTree, FlagError> {
    if graph.num_vertices() <= LastVertices::MOST_BITS16 {
        expand_with::<u16>(graph, options, LastVertices::Bits16)
    } else {
        expand_with::<u32>(graph, options, LastVertices::Bits32)
    }
}

/// Expands with vertex ids stored as `L`.
fn expand_with<L: Index>(
    graph: &Graph,
    options: &FlagOptions<'_>,
    last_vertices: fn(Vec<L>) -> LastVertices,
) -> Result<FrozenTree, FlagError> {
    let max_dim = options.max_dim.min(MAX_DIM);
    let budget = Budget {
        simplices: options.max_simplices.unwrap_or(u64::MAX).min(MAX_SIMPLICES as u64),
        bytes: options.max_bytes.or_else(available_memory).unwrap_or(u64::MAX),
        bytes_a_simplex: (L::WIDTH.bytes() + if graph.is_weighted() { 8 } else { 0 }) as u64,
    };
    let parts = count::parts::<L>(graph, max_dim, &budget, options.progress)?;
    let mut tree = write::write::<L>(graph, &parts, last_vertices, options.progress);
    if graph.is_weighted() {
        tree.filtration = Some(values::find(graph, &tree, &parts, options.progress));
    }
    Ok(tree)
}

/// How much room there is.
struct Budget {
    /// The most simplices.
    simplices: u64,
    /// The most bytes.
    bytes: u64,
    /// Bytes that any simplex takes, child offsets apart.
    bytes_a_simplex: u64,
}

impl Budget {
    /// More simplices than this are an error whatever their dimensions.
    fn most_simplices(&self) -> u64 {
        self.simplices.min(self.bytes / self.bytes_a_simplex)
    }

    /// Checks that there is room for `count` simplices, `inner` of them with a child offset.
    fn check(&self, count: u64, inner: u64) -> Result<(), FlagError> {
        if count > self.simplices {
            return Err(FlagError::TooManySimplices { at_least: count, limit: self.simplices });
        }
        let bytes = count * self.bytes_a_simplex + inner * size_of::<u32>() as u64;
        if bytes > self.bytes {
            return Err(FlagError::TooManyBytes { at_least: count, bytes, budget: self.bytes });
        }
        Ok(())
    }
}
