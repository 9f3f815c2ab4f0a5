//! The partial co-boundary relations C\*, from the facets.
//!
//! C\*(σ) names one top simplex of each cluster in the restricted star of σ (sig-2004, 4.1): the top g-simplices that
//! contain σ, joined where they share a (g − 1)-simplex that properly contains σ. The paper walks the star of every σ
//! ([`crate::incidence_graph`]). Here are two ways that do less: `minima` sees for nearly all simplices of a mesh
//! without a walk that there is one cluster, and walks the stars of the others; `union` goes from dimension to dimension
//! and never looks at a star.

mod minima;
mod sets;
mod union;

pub(super) use sets::Cell;
use sig_core::Index;

use crate::build::blocks::Blocks;
use crate::build::limits::Stage;
use crate::build::lists::pack_below_facets;
use crate::build::{Arrays, Meter, Phase, SigArrays, pack};

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
    if pairs.fold(0, usize::saturating_add) / MANY_FACES <= arrays.num_simplices {
        if u32::from_usize(minima::num_links(&arrays)).is_some() {
            let minima = minima::find::<I, u32>(&arrays, is_top, &stage);
            pack(arrays, |ids, part| minima.write(ids, part))
        } else {
            let minima = minima::find::<I, u64>(&arrays, is_top, &stage);
            pack(arrays, |ids, part| minima.write(ids, part))
        }
    } else {
        by_union(arrays, &stage)
    }
}

/// The arrays with the relations by union-find.
fn by_union<I: Cell>(arrays: SigArrays<I>, stage: &Stage<'_>) -> Arrays
where
    Arrays: From<SigArrays<I>>,
{
    let blocks = Blocks::new(&arrays);
    let relations = union::find(&arrays, &blocks, stage);
    let first = arrays.first.clone();
    pack_below_facets(arrays, &blocks, |ids, part| union::write(&relations, &first, ids, part))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::build::{BuildOptions, build};
    use crate::soup::{Labels, Soup};

    /// The arrays with the lists by local minima.
    fn by_minima<I: Cell, L: Index>(arrays: &SigArrays<I>, is_top: &[Vec<bool>]) -> SigArrays<u64>
    where
        Arrays: From<SigArrays<I>>,
    {
        let minima = minima::find::<I, L>(arrays, is_top, &Meter::new(None).stage(Phase::Coboundary, 0));
        pack(arrays.clone(), |ids, part| minima.write(ids, part)).into_wide()
    }

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
            prop_assert_eq!(by_minima::<_, u32>(&arrays, &is_top), expected.clone());
            let wide = arrays.clone().widen();
            prop_assert_eq!(by_minima::<_, u64>(&wide, &is_top), expected.clone());
            prop_assert_eq!(by_union(wide, &stage).into_wide(), expected);
        }
    }
}
