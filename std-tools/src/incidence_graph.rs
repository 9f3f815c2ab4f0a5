//! The incidence graph: all simplices, with the immediate boundary and the immediate co-boundary of each, and the
//! construction of the SIG from it (sig-2004, section 5, Algorithms 1 to 3).
//!
//! It is the structure that the paper starts from and compares with, and the second way to the arrays of
//! [`crate::build`]: it finds the faces by closing sets of words, and the clusters by walking stars. Both ways share
//! the numbering of the vertices and the writing of the lists, nothing else.

use std::cmp::Reverse;
use std::collections::{BTreeSet, HashMap};

use sig_core::{Dim, Index, SimplexId};

use crate::build::{self, Arrays, BuildError, BuildOptions, SigArrays};
use crate::soup::Soup;

/// An incidence graph over the canonical ids: by dimension, then lexicographic order of the sorted vertex words.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct IncidenceGraph {
    first: Vec<usize>,
    num_simplices: usize,
    /// The facets of each simplex, by the position of the vertex that is left out.
    boundary: Lists,
    /// The cofacets of each simplex, increasing.
    coboundary: Lists,
}

/// A list of simplices for each simplex.
#[derive(Clone, PartialEq, Eq, Debug)]
struct Lists {
    starts: Vec<usize>,
    entries: Vec<SimplexId>,
}

impl Lists {
    fn of(&self, simplex: SimplexId) -> &[SimplexId] {
        match self.starts.get(simplex.index()..) {
            Some([start, end, ..]) => &self.entries[*start..*end],
            _ => &[],
        }
    }
}

impl IncidenceGraph {
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
        let mut first = Vec::new();
        let mut ids: HashMap<&[u32], SimplexId> = HashMap::new();
        let mut boundary = Lists { starts: vec![0], entries: Vec::new() };
        for level in levels {
            first.push(ids.len());
            for word in level {
                boundary.entries.extend(facets(word).map(|facet| ids[facet.as_slice()]));
                boundary.starts.push(boundary.entries.len());
                ids.insert(word, SimplexId::new(ids.len()));
            }
        }
        let num_simplices = ids.len();
        let mut cofacets = vec![Vec::new(); num_simplices];
        for simplex in (0..num_simplices).map(SimplexId::new) {
            for facet in boundary.of(simplex) {
                cofacets[facet.index()].push(simplex);
            }
        }
        let mut coboundary = Lists { starts: vec![0], entries: Vec::new() };
        for cofacets in cofacets {
            coboundary.entries.extend(cofacets);
            coboundary.starts.push(coboundary.entries.len());
        }
        Self { first, num_simplices, boundary, coboundary }
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

    /// B_{p,p−1}(σ): the facets of a p-simplex, by the position of the vertex that is left out; empty for a vertex. O(1).
    #[must_use]
    pub fn boundary(&self, simplex: SimplexId) -> &[SimplexId] {
        self.boundary.of(simplex)
    }

    /// C_{p,p+1}(σ): the cofacets of a p-simplex, by increasing id. O(1).
    #[must_use]
    pub fn coboundary(&self, simplex: SimplexId) -> &[SimplexId] {
        self.coboundary.of(simplex)
    }

    /// The integers that the paper counts for an incidence graph: both relations, and where the list of each simplex
    /// below dimension d starts (sig-2004, 7.1).
    #[must_use]
    pub fn num_integers(&self) -> usize {
        self.boundary.entries.len() + self.coboundary.entries.len() + self.first.last().copied().unwrap_or(0)
    }

    /// Algorithm 2, `RetrieveTopSimplexes`: the top simplices that contain σ, in no particular order; σ alone if it is
    /// top. Linear in the cofaces of σ and their incidences.
    ///
    /// The paper's recursion is a stack here. Its marks are in `visited`, one for each simplex, all false before and
    /// after.
    fn top_simplices(&self, simplex: SimplexId, visited: &mut [bool]) -> Vec<SimplexId> {
        let mut tops = Vec::new();
        let mut star = vec![simplex];
        visited[simplex.index()] = true;
        let mut next = 0;
        while let Some(&face) = star.get(next) {
            next += 1;
            if self.coboundary(face).is_empty() {
                tops.push(face);
            }
            for &coface in self.coboundary(face) {
                if !std::mem::replace(&mut visited[coface.index()], true) {
                    star.push(coface);
                }
            }
        }
        for face in star {
            visited[face.index()] = false;
        }
        tops
    }

    /// Algorithm 3, `VisitCluster`: takes the simplices that form one cluster with `simplex` out of the set of top
    /// simplices that `unvisited` marks.
    fn visit_cluster(&self, simplex: SimplexId, unvisited: &mut [bool]) {
        let mut stack = vec![simplex];
        unvisited[simplex.index()] = false;
        while let Some(member) = stack.pop() {
            for &facet in self.boundary(member) {
                for &neighbour in self.coboundary(facet) {
                    if std::mem::replace(&mut unvisited[neighbour.index()], false) {
                        stack.push(neighbour);
                    }
                }
            }
        }
    }

    /// C\*(σ), the inner loop of Algorithm 1: one top simplex, the least, of each cluster in the restricted star of σ, by
    /// decreasing dimension, then increasing id. `visited` as for [`Self::top_simplices`].
    fn partial_coboundary(&self, simplex: SimplexId, visited: &mut [bool]) -> Vec<SimplexId> {
        let p = self.dim_of(simplex);
        let mut tops = self.top_simplices(simplex, visited);
        tops.retain(|&top| top != simplex);
        tops.sort_unstable_by_key(|&top| (Reverse(self.dim_of(top)), top));
        let unvisited = visited;
        for &top in &tops {
            unvisited[top.index()] = true;
        }
        let mut representatives = Vec::new();
        for top in tops {
            if unvisited[top.index()] {
                representatives.push(top);
                if self.dim_of(top) == p + 1 {
                    unvisited[top.index()] = false;
                } else {
                    self.visit_cluster(top, unvisited);
                }
            }
        }
        representatives
    }

    /// Algorithm 1, `BuildSIGFromIG`: the arrays of the SIG, equal to those of [`build::build`].
    ///
    /// Walks the star of every simplex: O(Σ_σ |star σ|), which for a simplex of dimension d alone is 3^d.
    #[must_use]
    pub fn build_sig(&self) -> Arrays {
        if u32::from_usize(self.num_simplices).is_some() { self.build_with::<u32>() } else { self.build_with::<u64>() }
    }

    fn build_with<I: Index>(&self) -> Arrays
    where
        Arrays: From<SigArrays<I>>,
    {
        build::pack(self.faces::<I>(), |ids, part| {
            let mut visited = vec![false; self.num_simplices];
            for simplex in ids.map(SimplexId::new) {
                let list = self.partial_coboundary(simplex, &mut visited);
                part.push(&list.into_iter().map(|top| build::index(top.index())).collect::<Vec<I>>());
            }
        })
    }

    /// The arrays that the boundary relations give.
    fn faces<I: Index>(&self) -> SigArrays<I> {
        let simplices = || (0..self.num_simplices).map(SimplexId::new);
        // A child leaves its last vertex out to become its parent, and parents come in the order of their children.
        let parents: Vec<usize> =
            simplices().filter_map(|simplex| self.boundary(simplex).last()).map(|parent| parent.index()).collect();
        let num_vertices = self.num_simplices - parents.len();
        let first_child = |simplex| build::index(num_vertices + parents.partition_point(|&parent| parent < simplex));
        let last_vertex = |mut face: SimplexId| {
            while let Some(&without_first) = self.boundary(face).first() {
                face = without_first;
            }
            build::narrow(face.index())
        };
        SigArrays {
            first: self.first.clone(),
            num_simplices: self.num_simplices,
            boundary: self.boundary.entries.iter().map(|facet| build::index(facet.index())).collect(),
            child_offsets: self.first.last().into_iter().flat_map(|&first| 0..=first).map(first_child).collect(),
            last_vertices: simplices().map(last_vertex).collect(),
            ..SigArrays::default()
        }
    }
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
