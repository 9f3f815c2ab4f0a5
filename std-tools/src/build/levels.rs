//! Finds all faces, one bucket of vertices a task ([`super::trie`]).

use rayon::prelude::*;

use crate::build::trie::{Bucket, Finder};
use crate::build::words::Words;
use crate::build::{BuildError, Limit, Meter, Phase};

/// All faces, as found by the tasks: consecutive ranges of least vertices.
pub(super) struct Chunks {
    pub(super) buckets: Vec<Bucket>,
}

impl Chunks {
    /// The number of simplices of each dimension.
    pub(super) fn counts(&self) -> Vec<usize> {
        let dims = self.buckets.iter().map(|bucket| bucket.counts.len()).max().unwrap_or(0);
        let count = |dim: usize| self.buckets.iter().filter_map(|bucket| bucket.counts.get(dim)).sum();
        (0..dims).map(count).collect()
    }

    /// The number of simplices.
    pub(super) fn num_simplices(&self) -> usize {
        self.counts().iter().sum()
    }
}

/// Finds all faces of the listed words; `is_unused` tells which vertices are in no word, and kept.
pub(super) fn find(
    words: &Words,
    is_unused: impl Fn(u32) -> bool + Sync,
    limit: &Limit,
    meter: &Meter<'_>,
) -> Result<Chunks, BuildError> {
    let stage = meter.stage(Phase::Levels, words.num_vertices());
    let arch = pulp::Arch::new();
    let buckets: Result<Vec<_>, _> = (0..words.num_buckets())
        .into_par_iter()
        .map_init(
            || (Finder::new(), Vec::new()),
            |(finder, room), number| {
                let vertices = words.vertices(number);
                let flat = words.gather(number, room);
                let mut reservation = limit.reservation();
                let count = vertices.len();
                // With the instructions for bits that the processor has.
                let bucket = arch.dispatch(
                    #[inline(always)]
                    || finder.find(flat, vertices, &is_unused, &mut reservation),
                )?;
                reservation.settle()?;
                stage.add(count);
                Ok(bucket)
            },
        )
        .collect();
    Ok(Chunks { buckets: buckets? })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use proptest::prelude::*;

    use super::*;
    use crate::build::local::{EVEN, ODD, UNUSED};
    use crate::build::order::number_vertices;
    use crate::build::{BuildOptions, SigArrays, VertexOrder, assemble, words};
    use crate::soup::{Labels, Soup};

    /// The arrays of the faces of a soup without unused vertices, by buckets of about so many tails, and how they are
    /// listed.
    fn faces(soup: &Soup, bucket: usize) -> (SigArrays<u32>, Vec<Vec<u8>>) {
        let meter = Meter::new(None);
        let used = words::check(&soup.simplices, soup.labels.len()).unwrap();
        let order = number_vertices(&soup.labels, None, &soup.simplices, &used, true, VertexOrder::Input).unwrap();
        let words = words::sort(soup.simplices.clone(), &order, bucket..bucket, &meter).unwrap();
        let limit = Limit::new(soup, &BuildOptions::default()).unwrap();
        let chunks = find(&words, |vertex| !used[vertex as usize], &limit, &meter).unwrap();
        assemble::assemble(chunks, &meter)
    }

    /// All faces as words, by dimension, then lexicographically.
    fn all_faces(simplices: &[Vec<u32>]) -> Vec<Vec<u32>> {
        let mut faces: BTreeSet<(usize, Vec<u32>)> = BTreeSet::new();
        for simplex in simplices {
            for mask in 1_u32..1 << simplex.len() {
                let kept = (0..simplex.len()).filter(|place| mask >> place & 1 == 1);
                let mut face: Vec<u32> = kept.map(|place| simplex[place]).collect();
                face.sort_unstable();
                faces.insert((face.len(), face));
            }
        }
        faces.into_iter().map(|(_, face)| face).collect()
    }

    proptest! {
        /// Vertices with more neighbours than a mask has bits among them, in buckets of one vertex and of all.
        #[test]
        fn faces_are_all_subsets(
            mut simplices in prop::collection::vec(prop::collection::vec(0_u32..150, 1..6), 0..40),
            hubs in prop::collection::vec(prop::collection::vec(50_u32..150, 0..4), 0..150),
            bucket in 0_usize..300,
        ) {
            simplices.extend(hubs.into_iter().map(|mut link| { link.push(49); link }));
            let mut soup = Soup::new(Labels::Numbered(150), true);
            for simplex in &mut simplices {
                let mut seen = BTreeSet::new();
                simplex.retain(|&vertex| seen.insert(vertex));
                soup.push(simplex);
            }
            let (arrays, listed) = faces(&soup, bucket);
            let listed_or_unused: Vec<Vec<u32>> = simplices.iter().cloned().chain((0..150).map(|v| vec![v])).collect();
            let words = all_faces(&listed_or_unused);
            prop_assert_eq!(arrays.num_simplices, words.len());
            prop_assert_eq!(arrays.first.len(), words.last().map_or(0, Vec::len));
            let find = |word: &[u32]| words.binary_search_by_key(&(word.len(), word), |w| (w.len(), w)).unwrap();
            for dim in 0..arrays.first.len() {
                for (number, id) in arrays.ids(dim).enumerate() {
                    let word = &words[id];
                    prop_assert_eq!(word.len(), dim + 1);
                    prop_assert_eq!(arrays.last_vertices[id], word[dim]);
                    for place in (0..=dim).filter(|_| dim > 0) {
                        let mut facet = word.clone();
                        facet.remove(place);
                        prop_assert_eq!(arrays.facets(dim)[number * (dim + 1) + place] as usize, find(&facet));
                    }
                    if dim + 1 < arrays.first.len() {
                        let starts = |w: &Vec<u32>| w.len() == dim + 2 && &w[..=dim] >= word.as_slice();
                        let child = words.iter().position(starts);
                        let end = arrays.ids(dim + 1).end;
                        prop_assert_eq!(arrays.child_offsets[id] as usize, child.unwrap_or(end));
                    }
                    // Once for each listing of the same vertices: the parity of the permutation that sorts it.
                    let same = simplices.iter().filter(|simplex| {
                        simplex.len() == word.len() && simplex.iter().all(|vertex| word.contains(vertex))
                    });
                    let mut mark = same.fold(0, |mark, simplex| {
                        let pairs = (0..simplex.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
                        let inversions = pairs.filter(|&(a, b)| simplex[a] > simplex[b]).count();
                        mark | if inversions % 2 == 0 { EVEN } else { ODD }
                    });
                    if dim == 0 && !simplices.iter().flatten().any(|vertex| vertex == &word[0]) {
                        mark = UNUSED;
                    }
                    prop_assert_eq!(listed[dim].get(number).copied().unwrap_or(0), mark);
                }
            }
        }
    }
}
