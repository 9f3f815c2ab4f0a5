//! The partial co-boundary relations C\*, from the facets.
//!
//! C\*(σ) names one top simplex of each cluster in the restricted star of σ (sig-2004, 4.1): the top g-simplices that
//! contain σ, joined where they share a (g − 1)-simplex that properly contains σ. The paper walks the star of every σ
//! ([`crate::incidence_graph`]). Here are two ways that do less: `minima` sees for nearly all simplices of a mesh
//! without a walk that there is one cluster, and `walk` walks the stars of the others; `union` goes from dimension to dimension
//! and never looks at a star.

mod minima;
mod sets;
mod union;
mod walk;

pub(super) use sets::Cell;

use crate::build::cofaces::{self, Cofacets};
use crate::build::limits::Stage;
use crate::build::lists::pack_below_facets;
use crate::build::{Arrays, Meter, Phase, SigArrays};

/// Pairs (top simplex, face) for each simplex up to which walking stars is the faster way. Meshes of dimension 3 to 5
/// have 3 to 8; where large simplices overlap there may be hundreds.
const MANY_FACES: usize = 16;

/// Completes the arrays of the faces with the relations. `is_top[p]` tells which p-simplices are top, or is empty if
/// none is.
pub(super) fn add<I: Cell>(arrays: SigArrays<I>, is_top: &[Vec<bool>], meter: &Meter<'_>) -> Arrays
where
    Arrays: From<SigArrays<I>>,
{
    let stage = meter.stage(Phase::Coboundary, arrays.dim().unwrap_or(0));
    let num_tops = |tops: &Vec<bool>| tops.iter().filter(|&&is_top| is_top).count();
    let pairs = is_top.iter().enumerate().map(|(dim, tops)| num_tops(tops).saturating_mul(2 << dim));
    let is_mesh = pairs.fold(0, usize::saturating_add) / MANY_FACES <= arrays.num_simplices;
    let num_cofacets = arrays.dim().filter(|&dim| dim > 0).map_or(0, |dim| cofaces::len(&arrays, dim));
    match (is_mesh, I::from_usize(num_cofacets)) {
        (true, Some(_)) => by_minima(arrays, is_top, &stage),
        (false, Some(_)) => by_union(arrays, &stage),
        (true, None) => by_minima::<u64>(arrays.widen(), is_top, &stage),
        (false, None) => by_union::<u64>(arrays.widen(), &stage),
    }
}

/// The arrays with the relations by local minima.
fn by_minima<I: Cell>(arrays: SigArrays<I>, is_top: &[Vec<bool>], stage: &Stage<'_>) -> Arrays
where
    Arrays: From<SigArrays<I>>,
{
    let (minima, cofacets) = minima::find(&arrays, is_top, stage);
    pack_below_facets(arrays, cofacets, |ids, part| minima.write(ids, part))
}

/// The arrays with the relations by union-find.
fn by_union<I: Cell>(arrays: SigArrays<I>, stage: &Stage<'_>) -> Arrays
where
    Arrays: From<SigArrays<I>>,
{
    let Some(dim @ 1..) = arrays.dim() else { return pack_below_facets(arrays, Cofacets::default(), |_, _| {}) };
    let relations = union::find(&arrays, stage);
    let (cofacets, _) = cofaces::find(&arrays, dim, || (), |(), _, _| {});
    let first = arrays.first.clone();
    pack_below_facets(arrays, cofacets, |ids, part| union::write(&relations, &first, ids, part))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use sig_core::Index;

    use super::*;
    use crate::build::{BuildOptions, build};
    use crate::soup::{Labels, Soup};

    proptest! {
        /// Both ways, whichever the size of the complex suggests, at every width.
        #[test]
        fn both_ways_agree(simplices in prop::collection::vec(prop::collection::vec(0_u32..12, 1..8), 0..14)) {
            let mut soup = Soup::new(Labels::Numbered(12), true);
            for mut simplex in simplices {
                simplex.sort_unstable();
                simplex.dedup();
                soup.push(&simplex);
            }
            let Ok(Arrays::Narrow(arrays)) = build(soup, &BuildOptions::default()).map(|built| built.arrays) else {
                panic!("a small complex");
            };
            let mut is_top: Vec<Vec<bool>> =
                (0..arrays.first.len()).map(|dim| vec![true; arrays.ids(dim).len()]).collect();
            for dim in 1..arrays.first.len() {
                for facet in arrays.facets(dim) {
                    is_top[dim - 1][facet.to_usize() - arrays.first[dim - 1]] = false;
                }
            }
            let meter = Meter::new(None);
            let stage = meter.stage(Phase::Coboundary, 0);
            let expected = by_union(arrays.clone(), &stage).into_wide();
            for tops in is_top.iter_mut().filter(|tops| !tops.contains(&true)) {
                tops.clear();
            }
            prop_assert_eq!(by_minima(arrays.clone(), &is_top, &stage).into_wide(), expected.clone());
            let wide = arrays.clone().widen();
            prop_assert_eq!(by_minima(wide.clone(), &is_top, &stage).into_wide(), expected.clone());
            prop_assert_eq!(by_union(wide, &stage).into_wide(), expected);
        }
    }
}
