//! The arrays of the SIG from the definitions, on sets of vertices: slow and obvious.

use std::collections::BTreeSet;

use sig_tools::build::SigArrays;

/// A simplex as its vertices, increasing; the derived order is by dimension, then lexicographic.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
struct Simplex {
    len: usize,
    word: Vec<u32>,
}

impl Simplex {
    fn new(mut word: Vec<u32>) -> Self {
        word.sort_unstable();
        Self { len: word.len(), word }
    }

    fn dim(&self) -> usize {
        self.len - 1
    }

    fn contains(&self, face: &Self) -> bool {
        face.word.iter().all(|vertex| self.word.contains(vertex))
    }

    fn without(&self, position: usize) -> Self {
        let mut word = self.word.clone();
        word.remove(position);
        Self::new(word)
    }
}

/// A complex as its simplices in canonical order.
pub(crate) struct Oracle {
    simplices: Vec<Simplex>,
    tops: Vec<usize>,
}

impl Oracle {
    /// All faces of the given simplices on the vertex ids.
    pub(crate) fn new(listed: &[Vec<u32>]) -> Self {
        let mut simplices = BTreeSet::new();
        for listed in listed {
            for subset in 1_u32..1 << listed.len() {
                let chosen = listed.iter().enumerate().filter(|&(k, _)| subset >> k & 1 == 1);
                simplices.insert(Simplex::new(chosen.map(|(_, &vertex)| vertex).collect()));
            }
        }
        let simplices: Vec<Simplex> = simplices.into_iter().collect();
        let is_top = |id: &usize| !simplices.iter().any(|s| s.len > simplices[*id].len && s.contains(&simplices[*id]));
        let tops = (0..simplices.len()).filter(is_top).collect();
        Self { simplices, tops }
    }

    pub(crate) fn id(&self, word: &[u32]) -> usize {
        let simplex = Simplex::new(word.to_vec());
        self.simplices.binary_search(&simplex).expect("a simplex of the complex")
    }

    pub(crate) fn tops(&self) -> impl Iterator<Item = &[u32]> {
        self.tops.iter().map(|&id| self.simplices[id].word.as_slice())
    }

    /// One top simplex, the least, of each cluster in the restricted star, by decreasing dimension.
    pub(crate) fn partial_coboundary(&self, id: usize) -> Vec<usize> {
        let simplex = &self.simplices[id];
        let mut representatives = Vec::new();
        for g in (simplex.dim() + 1..32).rev() {
            let in_star = |top: &&usize| self.simplices[**top].dim() == g && self.simplices[**top].contains(simplex);
            let mut cluster_of: Vec<(usize, usize)> = self.tops.iter().filter(in_star).map(|&top| (top, top)).collect();
            // Joined until nothing changes: a shared (g - 1)-simplex of the restricted star, so not σ itself.
            let mut changed = g > simplex.dim() + 1;
            while changed {
                changed = false;
                for a in 0..cluster_of.len() {
                    for b in 0..cluster_of.len() {
                        let (a_top, b_top) = (&self.simplices[cluster_of[a].0], &self.simplices[cluster_of[b].0]);
                        let shared = a_top.word.iter().filter(|vertex| b_top.word.contains(vertex)).count();
                        if shared == g && cluster_of[a].1 < cluster_of[b].1 {
                            cluster_of[b].1 = cluster_of[a].1;
                            changed = true;
                        }
                    }
                }
            }
            representatives.extend(cluster_of.into_iter().filter(|(top, least)| top == least).map(|(top, _)| top));
        }
        representatives
    }

    /// The arrays, with the lists as the format defines them.
    pub(crate) fn arrays(&self) -> SigArrays<u64> {
        let Some(dim) = self.simplices.last().map(Simplex::dim) else { return SigArrays::default() };
        let count = self.simplices.len();
        let first: Vec<usize> =
            (0..=dim).map(|p| self.simplices.iter().position(|simplex| simplex.dim() == p).unwrap()).collect();
        let mut arrays = SigArrays { first: first.clone(), num_simplices: count, ..SigArrays::default() };
        arrays.flags = vec![0; first[dim].div_ceil(8)];
        for (id, simplex) in self.simplices.iter().enumerate() {
            arrays.last_vertices.push(*simplex.word.last().unwrap());
            if simplex.dim() > 0 {
                let facets = (0..simplex.len).map(|i| self.id(&simplex.without(i).word) as u64);
                arrays.boundary.extend(facets);
            }
            if simplex.dim() == dim {
                continue;
            }
            // The first simplex of the next dimension whose word is not before any that extends this one.
            let prefix = |other: &Simplex| other.word[..simplex.len.min(other.len)].to_vec();
            let child = (first[simplex.dim() + 1]..count)
                .find(|&other| {
                    let other = &self.simplices[other];
                    other.dim() > simplex.dim() + 1 || prefix(other) >= simplex.word
                })
                .unwrap_or(count);
            arrays.child_offsets.push(child as u64);
            let list = self.partial_coboundary(id);
            if simplex.dim() + 1 < dim && list.len() == 1 && self.simplices[list[0]].dim() == dim {
                arrays.flags[id / 8] |= 1 << (id % 8);
                arrays.pointers.push(list[0] as u64);
            } else {
                arrays.pointers.push(arrays.lists.len() as u64);
                arrays.lists.extend(list.into_iter().map(|top| top as u64));
                arrays.lists.push(u64::MAX);
            }
        }
        arrays.child_offsets.push(count as u64);
        arrays
    }
}
