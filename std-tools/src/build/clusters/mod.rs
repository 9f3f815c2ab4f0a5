//! The partial co-boundary relations C\*, from the facets.
//!
//! C\*(σ) names one top simplex of each cluster in the restricted star of σ (sig-2004, 4.1): the top g-simplices that
//! contain σ, joined where they share a (g − 1)-simplex that properly contains σ. The paper walks the star of every σ
//! ([`crate::incidence_graph`]). Here are two ways that do less: `minima` sees for nearly all simplices of a mesh
//! without a walk that there is one cluster, and walks the stars of the others; `union` goes from dimension to dimension
//! and never looks at a star.

mod minima;
mod union;

use sig_core::Index;

use crate::build::{Arrays, Meter, Phase, SigArrays, pack};

/// Pairs (top simplex, face) for each simplex up to which walking stars is the faster way. Meshes of dimension 3 to 5
/// have 3 to 8; where large simplices overlap there may be hundreds.
const MANY_FACES: usize = 16;

/// Completes the arrays of the faces with the relations. `is_top[p]` tells which p-simplices are top, or is empty if
/// none is.
pub(super) fn add<I: Index>(arrays: SigArrays<I>, is_top: &[Vec<bool>], meter: &Meter<'_>) -> Arrays
where
    Arrays: From<SigArrays<I>>,
{
    let stage = meter.stage(Phase::Coboundary, arrays.dim().unwrap_or(0));
    let num_tops = |tops: &Vec<bool>| tops.iter().filter(|&&is_top| is_top).count();
    let pairs = is_top.iter().enumerate().map(|(dim, tops)| num_tops(tops).saturating_mul(2 << dim));
    if pairs.fold(0, usize::saturating_add) / MANY_FACES <= arrays.num_simplices {
        let relations = minima::find(&arrays, is_top, &stage);
        pack(arrays, |write| relations.for_each_list(write))
    } else {
        let relations = union::find(&arrays, &stage);
        pack(arrays, |write| relations.iter().flat_map(union::Relations::iter).for_each(&mut *write))
    }
}
