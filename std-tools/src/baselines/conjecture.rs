//! The conjecture of sig-2004, 7.1, on which the SIG's advantage over the incidence graph rests in the general case: that
//! no simplex has more clusters of one dimension in its restricted star than cofaces of the next one.

use serde::Serialize;
use sig_core::{Complex, Dim, Index, MAX_DIM};

use super::Tops;
use crate::build::narrow;

/// The first p-simplex with more q-clusters than (p+1)-cofaces, and how many such simplices there are.
#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub struct Violation {
    /// p.
    pub p: Dim,
    /// q.
    pub q: Dim,
    /// The first, by the labels of its vertices.
    pub simplex: String,
    /// Its q-clusters.
    pub clusters: usize,
    /// Its (p+1)-cofaces.
    pub cofaces: usize,
    /// How many p-simplices have more q-clusters than (p+1)-cofaces.
    pub simplices: usize,
}

/// Where the conjecture fails in a complex, which has the top simplices `tops`; nothing, as a rule.
///
/// A cone over a Steiner system, twelve triples on nine points, is the least case known to fail: its apex has twelve clusters
/// of tetrahedra and nine edges. Cost: a pass over boundary and lists, and a number for each simplex of one dimension.
#[must_use]
pub fn violations<I: Index>(complex: &Complex<'_, I>, tops: &Tops) -> Vec<Violation> {
    let mut violations = Vec::new();
    for p in 0..complex.dim().unwrap_or(0) {
        let first = complex.simplices_of_dim(p).bounds().0.index();
        let mut cofaces = vec![0_u32; complex.num_simplices_of_dim(p)];
        for facet in complex.simplices_of_dim(p + 1).flat_map(|coface| complex.facets(coface)) {
            cofaces[facet.index() - first] += 1;
        }
        let mut worst: Vec<Option<Violation>> = vec![None; MAX_DIM + 1];
        for (simplex, &cofaces) in complex.simplices_of_dim(p).zip(&cofaces) {
            // A single cluster has a coface.
            if complex.is_single_cluster(simplex) {
                continue;
            }
            let mut clusters = [0_usize; MAX_DIM + 1];
            complex.clusters(simplex).for_each(|cluster| clusters[cluster.dim] += 1);
            for (q, &clusters) in clusters.iter().enumerate().filter(|&(_, &clusters)| clusters > cofaces as usize) {
                let word: Vec<u32> = complex.vertices(simplex).map(|vertex| narrow(vertex.index())).collect();
                let first =
                    || Violation { p, q, simplex: tops.name(&word), clusters, cofaces: cofaces as usize, simplices: 0 };
                worst[q].get_or_insert_with(first).simplices += 1;
            }
        }
        violations.extend(worst.into_iter().flatten());
    }
    violations
}
