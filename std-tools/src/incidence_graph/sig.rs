//! From the incidence graph to the SIG: Algorithms 1 to 3 (sig-2004, section 5).

use std::cmp::Reverse;

use sig_core::{Index, SimplexId};

use super::IncidenceGraph;
use crate::build::{self, Arrays, SigArrays};

impl<J: Index> IncidenceGraph<J> {
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
            if self.coboundary(face).len() == 0 {
                tops.push(face);
            }
            for coface in self.coboundary(face) {
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
            for facet in self.boundary(member) {
                for neighbour in self.coboundary(facet) {
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
            simplices().filter_map(|simplex| self.boundary(simplex).next_back()).map(SimplexId::index).collect();
        let num_vertices = self.num_simplices - parents.len();
        let first_child = |simplex| build::index(num_vertices + parents.partition_point(|&parent| parent < simplex));
        let last_vertex = |mut face: SimplexId| {
            while let Some(without_first) = self.boundary(face).next() {
                face = without_first;
            }
            build::narrow(face.index())
        };
        SigArrays {
            first: self.first.clone(),
            num_simplices: self.num_simplices,
            boundary: self.boundary.iter().map(|facet| build::index(facet.to_usize())).collect(),
            child_offsets: self.first.last().into_iter().flat_map(|&first| 0..=first).map(first_child).collect(),
            last_vertices: simplices().map(last_vertex).collect(),
            ..SigArrays::default()
        }
    }
}
