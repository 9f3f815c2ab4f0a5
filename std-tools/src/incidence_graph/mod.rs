//! The incidence graph: all simplices, with the immediate boundary and the immediate co-boundary of each (sig-2004, 7.1),
//! and the construction of the SIG from it (section 5, Algorithms 1 to 3, in `sig`).
//!
//! It is the structure that the paper starts from and compares with, and the second way to the arrays of
//! [`crate::build`]: [`IncidenceGraph::new`] finds the faces by closing sets of words, and
//! [`build_sig`](IncidenceGraph::build_sig) the clusters by walking stars. Both ways share the numbering of the vertices and
//! the writing of the lists, nothing else. As a structure to compare with it is built by
//! [`of_tops`](IncidenceGraph::of_tops), with the care that the SIG is built with, and asked through a [`Walk`].

mod sig;
mod walk;

use std::collections::{BTreeSet, HashMap};

use sig_core::{Dim, Index, SimplexId};

use crate::baselines::{Refusal, Tops};
use crate::build::{self, Arrays, BuildError, BuildOptions, SigArrays};
use crate::soup::Soup;

pub use walk::Walk;

/// An incidence graph over the canonical ids: by dimension, then lexicographic order of the sorted vertex words.
///
/// 2 Σ_{0<p≤d} (p+1) n_p + Σ_{0≤p<d} n_p integers: boundaries and co-boundaries, and where each co-boundary starts; it ends
/// where the next one starts.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct IncidenceGraph<I> {
    /// The first id of each dimension.
    first: Vec<usize>,
    num_simplices: usize,
    /// The facets of each simplex of dimension 1 or more, by the position of the vertex that is left out.
    boundary: Vec<I>,
    /// Where the cofacets start of each simplex below dimension d.
    starts: Vec<I>,
    /// The cofacets of each simplex, increasing.
    coboundary: Vec<I>,
}

/// Why there is no incidence graph of a complex.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IncidenceError {
    /// The faces of the simplices are too many.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The integers are too narrow.
    #[error(transparent)]
    Refused(#[from] Refusal),
}

impl IncidenceGraph<u64> {
    /// The incidence graph of all faces of the simplices of `soup`, numbered as [`build::build`] numbers them.
    ///
    /// Takes O(n log n) comparisons of words, and holds all words while it works.
    ///
    /// # Errors
    /// As [`build::build`].
    pub fn new(soup: &Soup, options: &BuildOptions<'_>) -> Result<Self, BuildError> {
        Ok(Self::from_words(&close(build::sorted_words(soup, options)?)))
    }

    /// The graph of the words of each dimension, which are closed under taking faces.
    fn from_words(levels: &[BTreeSet<Vec<u32>>]) -> Self {
        let (mut first, mut boundary) = (Vec::new(), Vec::new());
        let mut ids: HashMap<&[u32], u64> = HashMap::new();
        for level in levels {
            first.push(ids.len());
            for word in level {
                boundary.extend(facets(word).map(|facet| ids[facet.as_slice()]));
                ids.insert(word, ids.len() as u64);
            }
        }
        Self::from_boundary(first, ids.len(), boundary)
    }
}

impl<I: Index> IncidenceGraph<I> {
    /// The incidence graph of a complex from its top simplices: faces as the SIG's builder finds them, and one counting
    /// sort of them for the co-boundary.
    ///
    /// # Errors
    /// [`IncidenceError`]: a complex that is too large for memory, or for integers of the width of `I`.
    pub fn of_tops(tops: &Tops) -> Result<Self, IncidenceError> {
        // Of top simplices alone there is more than this to store: not worth a build that comes to nothing.
        let largest = tops.num_listed_vertices();
        if I::from_usize(largest).is_none() {
            return Err(Refusal::TooNarrow { largest, bits: I::WIDTH.bits() }.into());
        }
        let options = BuildOptions { order: build::VertexOrder::Input, ..BuildOptions::default() };
        Ok(match build::faces(tops.numbered(), &options)? {
            Arrays::Narrow(faces) => Self::of_faces(faces),
            Arrays::Wide(faces) => Self::of_faces(faces),
        }?)
    }

    fn of_faces<J: Index>(faces: SigArrays<J>) -> Result<Self, Refusal> {
        let largest = faces.num_simplices.saturating_sub(1).max(faces.boundary.len());
        if I::from_usize(largest).is_none() {
            return Err(Refusal::TooNarrow { largest, bits: I::WIDTH.bits() });
        }
        let boundary = faces.boundary.iter().map(|facet| build::index(facet.to_usize())).collect();
        Ok(Self::from_boundary(faces.first, faces.num_simplices, boundary))
    }

    /// The graph with the given boundary relations: the co-boundaries are counted, then filled in.
    fn from_boundary(first: Vec<usize>, num_simplices: usize, boundary: Vec<I>) -> Self {
        let below_top = first.last().copied().unwrap_or(0);
        let mut counts = vec![0_usize; below_top + 1];
        boundary.iter().for_each(|facet| counts[facet.to_usize() + 1] += 1);
        (0..below_top).for_each(|simplex| counts[simplex + 1] += counts[simplex]);
        let starts = counts[..below_top].iter().map(|&start| build::index(start)).collect();
        let mut coboundary = vec![I::ZERO; boundary.len()];
        let mut row = 0;
        for dim in 1..first.len() {
            for simplex in build::ids(&first, num_simplices, dim) {
                for facet in &boundary[row..row + dim + 1] {
                    let place = &mut counts[facet.to_usize()];
                    coboundary[*place] = build::index(simplex);
                    *place += 1;
                }
                row += dim + 1;
            }
        }
        Self { first, num_simplices, boundary, starts, coboundary }
    }

    /// The number of simplices.
    #[must_use]
    pub fn num_simplices(&self) -> usize {
        self.num_simplices
    }

    /// The dimension of the complex; `None` if it is empty.
    #[must_use]
    pub fn dim(&self) -> Option<Dim> {
        self.first.len().checked_sub(1)
    }

    /// The dimension of a simplex; that of the complex for an id past the end.
    #[must_use]
    pub fn dim_of(&self, simplex: SimplexId) -> Dim {
        self.first.partition_point(|&first| first <= simplex.index()).saturating_sub(1)
    }

    /// B_{p,p−1}(σ): the facets of a p-simplex, by the position of the vertex that is left out; empty for a vertex. Cost:
    /// a sum over the dimensions below p.
    #[must_use]
    pub fn boundary(&self, simplex: SimplexId) -> impl ExactSizeIterator<Item = SimplexId> + DoubleEndedIterator + '_ {
        self.row(simplex, self.dim_of(simplex)).iter().map(simplex_at)
    }

    /// The facets of a simplex of dimension `dim`.
    fn row(&self, simplex: SimplexId, dim: Dim) -> &[I] {
        if dim == 0 || simplex.index() >= self.num_simplices {
            return &[];
        }
        let before: usize = (1..dim).map(|lower| (self.first[lower + 1] - self.first[lower]) * (lower + 1)).sum();
        let start = before + (simplex.index() - self.first[dim]) * (dim + 1);
        &self.boundary[start..start + dim + 1]
    }

    /// C_{p,p+1}(σ): the cofacets of a p-simplex, by increasing id. O(1).
    #[must_use]
    pub fn coboundary(&self, simplex: SimplexId) -> impl ExactSizeIterator<Item = SimplexId> + '_ {
        let start = |simplex: usize| self.starts.get(simplex).map_or(self.coboundary.len(), |start| start.to_usize());
        self.coboundary[start(simplex.index())..start(simplex.index() + 1)].iter().map(simplex_at)
    }

    /// The integers that the graph holds: both relations, and where the list of each simplex below dimension d starts
    /// (sig-2004, 7.1).
    #[must_use]
    pub fn num_integers(&self) -> usize {
        self.boundary.len() + self.coboundary.len() + self.starts.len()
    }

    /// The top simplices as a list that [`build::build`] takes, vertices by number.
    #[must_use]
    pub fn to_soup(&self) -> Soup {
        let mut soup =
            Soup::new(crate::soup::Labels::Numbered(self.first.get(1).copied().unwrap_or(self.num_simplices)), true);
        for simplex in
            (0..self.num_simplices).map(SimplexId::new).filter(|&simplex| self.coboundary(simplex).len() == 0)
        {
            soup.push(&self.word(simplex));
        }
        soup
    }

    /// The vertices of a simplex, increasing: the k-th is reached by leaving out the first k, then the last ones.
    fn word(&self, mut simplex: SimplexId) -> Vec<u32> {
        let mut word = Vec::with_capacity(self.dim_of(simplex) + 1);
        loop {
            let mut vertex = simplex;
            while let Some(facet) = self.boundary(vertex).next_back() {
                vertex = facet;
            }
            word.push(build::narrow(vertex.index()));
            match self.boundary(simplex).next() {
                Some(facet) => simplex = facet,
                None => return word,
            }
        }
    }
}

fn simplex_at(id: &impl Index) -> SimplexId {
    SimplexId::new(id.to_usize())
}

/// The words without one letter each, from the first to the last; none for a word of one letter.
fn facets(word: &[u32]) -> impl Iterator<Item = Vec<u32>> {
    let omitted = if word.len() > 1 { 0..word.len() } else { 0..0 };
    omitted.map(|i| [&word[..i], &word[i + 1..]].concat())
}

/// Adds all faces of the words, which `levels` holds by dimension.
fn close(mut levels: Vec<BTreeSet<Vec<u32>>>) -> Vec<BTreeSet<Vec<u32>>> {
    for dim in (1..levels.len()).rev() {
        let (lower, upper) = levels.split_at_mut(dim);
        lower[dim - 1].extend(upper[0].iter().flat_map(|word| facets(word)));
    }
    levels
}
