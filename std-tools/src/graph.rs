//! A weighted graph in flat arrays: [`Graph`], the 1-skeleton from which flag complexes are expanded.

use std::ops::Range;

use rayon::prelude::*;
use sig_core::{Relations, SimplexId, VertexId};

/// A simple graph on the vertices `0..num_vertices`; each edge is kept once, with its lower vertex.
///
/// Made by the searches on points and by the readers of matrices and edge lists; expanded by [`crate::flag`].
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Graph {
    /// Where the upper neighbours of each vertex start, and the end: `num_vertices + 1` of them.
    offsets: Vec<usize>,
    /// N⁺(v): for each vertex its neighbours with a larger number, increasing.
    upper: Vec<u32>,
    /// The weight of each edge, in the order of `upper`; none if edges have no weight.
    weights: Option<Vec<f64>>,
    /// The weight of each vertex, the value at which it enters a filtration; all 0 if none are given.
    vertex_weights: Option<Vec<f64>>,
}

/// Why arrays are not a graph.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GraphError {
    /// An edge names a vertex that the graph does not have.
    #[error("edge {edge} names vertex {vertex}, but there are {vertices} vertices")]
    VertexOutOfRange {
        /// Which of the listed edges, from 0.
        edge: usize,
        /// The vertex.
        vertex: u32,
        /// How many there are.
        vertices: usize,
    },
    /// An edge joins a vertex to itself.
    #[error("edge {edge} joins vertex {vertex} to itself")]
    Loop {
        /// Which of the listed edges, from 0.
        edge: usize,
        /// The vertex.
        vertex: u32,
    },
    /// A weight is not a number.
    #[error("the weight of edge {edge} is not a number")]
    NotANumber {
        /// Which of the listed edges, from 0.
        edge: usize,
    },
    /// The weights are not those of the vertices, or not numbers.
    #[error("{weights} weights do not fit {vertices} vertices, or are not numbers")]
    VertexWeights {
        /// How many weights there are.
        weights: usize,
        /// How many vertices there are.
        vertices: usize,
    },
    /// An edge enters the filtration before one of its vertices.
    #[error("edge ({0}, {1}) has a smaller weight than one of its vertices")]
    NotMonotone(u32, u32),
    /// Vertex numbers are 32-bit, and the largest is reserved.
    #[error("{0} vertices are more than 4294967294")]
    TooManyVertices(usize),
}

impl Graph {
    /// The graph with the given edges, in any order, in either direction; of a repeated edge the least weight counts.
    ///
    /// Time: a sort of the edges.
    ///
    /// # Errors
    /// [`GraphError`]: the first edge that is not one.
    pub fn from_edges(num_vertices: usize, edges: &[(u32, u32)], weights: Option<&[f64]>) -> Result<Self, GraphError> {
        check_vertices(num_vertices)?;
        let mut sorted = Vec::with_capacity(edges.len());
        for (edge, &(a, b)) in edges.iter().enumerate() {
            let vertex = a.max(b);
            if vertex as usize >= num_vertices {
                return Err(GraphError::VertexOutOfRange { edge, vertex, vertices: num_vertices });
            }
            if a == b {
                return Err(GraphError::Loop { edge, vertex });
            }
            let weight = weights.and_then(|weights| weights.get(edge)).copied().unwrap_or(0.0);
            if weight.is_nan() {
                return Err(GraphError::NotANumber { edge });
            }
            // −0 and 0 are one weight.
            sorted.push((a.min(b), vertex, weight + 0.0));
        }
        sorted.sort_unstable_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2)));
        sorted.dedup_by_key(|&mut (a, b, _)| (a, b));
        let mut offsets = vec![0; num_vertices + 1];
        for &(a, _, _) in &sorted {
            offsets[a as usize + 1] += 1;
        }
        for vertex in 0..num_vertices {
            offsets[vertex + 1] += offsets[vertex];
        }
        let upper = sorted.iter().map(|&(_, b, _)| b).collect();
        let weights = weights.map(|_| sorted.iter().map(|&(_, _, weight)| weight).collect());
        Ok(Self { offsets, upper, weights, vertex_weights: None })
    }

    /// The 1-skeleton of a complex in a file of either kind, with the filtration values as weights if it has them.
    ///
    /// Time: linear in vertices and edges, whatever else there is.
    ///
    /// # Errors
    /// [`GraphError`]: more vertices than 32-bit numbers tell apart, or a damaged file.
    pub fn of(complex: &impl Relations) -> Result<Self, GraphError> {
        let number = |vertex: VertexId| u32::try_from(vertex.index()).unwrap_or(u32::MAX);
        let ends = |edge: SimplexId| {
            let mut vertices = complex.vertices(edge).map(number);
            (vertices.next().unwrap_or(u32::MAX), vertices.next().unwrap_or(u32::MAX))
        };
        let edges: Vec<(u32, u32)> = complex.simplices_of_dim(1).map(ends).collect();
        let Some(values) = complex.filtration() else {
            return Self::from_edges(complex.num_vertices(), &edges, None);
        };
        let of = |simplex: SimplexId| values.get(simplex.index()).copied().unwrap_or(f64::NAN);
        let weights: Vec<f64> = complex.simplices_of_dim(1).map(of).collect();
        let graph = Self::from_edges(complex.num_vertices(), &edges, Some(&weights))?;
        graph.with_vertex_weights(complex.simplices_of_dim(0).map(of).collect())
    }

    /// The graph with the given edges, all different and each with its lower vertex first, in parts as a search found
    /// them; weighted by `weight` if there is one.
    ///
    /// Time: linear, and a sort of each vertex's neighbours. The vertices must be fewer than 2^32 − 1.
    pub(crate) fn from_pairs<W: Fn(u32, u32) -> f64 + Sync>(
        num_vertices: usize,
        parts: Vec<Vec<(u32, u32)>>,
        weight: Option<&W>,
    ) -> Self {
        let mut offsets = vec![0; num_vertices + 1];
        for &(a, _) in parts.iter().flatten() {
            offsets[a as usize + 1] += 1;
        }
        for vertex in 0..num_vertices {
            offsets[vertex + 1] += offsets[vertex];
        }
        let mut ends = offsets.clone();
        let mut upper = vec![0; offsets[num_vertices]];
        for (a, b) in parts.into_iter().flatten() {
            upper[ends[a as usize]] = b;
            ends[a as usize] += 1;
        }
        drop(ends);
        let mut lists: Vec<&mut [u32]> = Vec::with_capacity(num_vertices);
        let mut rest = upper.as_mut_slice();
        for degree in offsets.windows(2).map(|pair| pair[1] - pair[0]) {
            let (list, others) = rest.split_at_mut(degree);
            lists.push(list);
            rest = others;
        }
        lists.into_par_iter().with_min_len(256).for_each(<[u32]>::sort_unstable);
        let weights = weight.map(|weight| {
            let of = |vertex: usize| &upper[offsets[vertex]..offsets[vertex + 1]];
            let weights = |vertex| of(vertex).iter().map(move |&other| weight(crate::build::narrow(vertex), other));
            (0..num_vertices).into_par_iter().with_min_len(256).flat_map_iter(weights).collect()
        });
        Self { offsets, upper, weights, vertex_weights: None }
    }

    /// The graph with the upper neighbours of each vertex, increasing, as the searches on points find them.
    ///
    /// # Errors
    /// [`GraphError::TooManyVertices`].
    ///
    /// # Panics
    /// If a list does not increase, names a vertex that is not above its own, or has not as many weights.
    pub fn from_upper_lists(lists: &[Vec<u32>], weights: Option<&[Vec<f64>]>) -> Result<Self, GraphError> {
        check_vertices(lists.len())?;
        let mut offsets = Vec::with_capacity(lists.len() + 1);
        offsets.push(0);
        let mut end = 0;
        for (vertex, list) in lists.iter().enumerate() {
            let above = list.iter().all(|&other| other as usize > vertex && (other as usize) < lists.len());
            assert!(above && list.is_sorted_by(|a, b| a < b), "not the upper neighbours of {vertex}: {list:?}");
            assert!(weights.is_none_or(|weights| weights[vertex].len() == list.len()), "weights of {vertex}");
            end += list.len();
            offsets.push(end);
        }
        Ok(Self { offsets, upper: lists.concat(), weights: weights.map(<[Vec<f64>]>::concat), vertex_weights: None })
    }

    /// The graph of the edges with a weight of at most `most`, which keep their weights if `weighted`; edges without a
    /// weight have the weight 0. The vertices stay, and keep their weights likewise.
    #[must_use]
    pub fn up_to(&self, most: f64, weighted: bool) -> Self {
        let mut kept = Self { offsets: vec![0], upper: Vec::new(), weights: None, vertex_weights: None };
        let mut weights = Vec::new();
        for vertex in 0..self.num_vertices() {
            for edge in self.edges_of(vertex).filter(|&edge| self.weight(edge) <= most) {
                kept.upper.push(self.upper[edge]);
                weights.extend(weighted.then(|| self.weight(edge)));
            }
            kept.offsets.push(kept.upper.len());
        }
        kept.weights = weighted.then_some(weights);
        kept.vertex_weights = self.vertex_weights.clone().filter(|_| weighted);
        kept
    }

    /// The same graph with weights at the vertices, each at most the weights of its edges.
    ///
    /// # Errors
    /// [`GraphError::VertexWeights`], [`GraphError::NotMonotone`].
    pub fn with_vertex_weights(mut self, weights: Vec<f64>) -> Result<Self, GraphError> {
        if weights.len() != self.num_vertices() || weights.iter().any(|weight| weight.is_nan()) {
            return Err(GraphError::VertexWeights { weights: weights.len(), vertices: self.num_vertices() });
        }
        for vertex in 0..self.num_vertices() {
            for edge in self.edges_of(vertex) {
                let (other, weight) = (self.upper[edge], self.weight(edge));
                if weight < weights[vertex].max(weights[other as usize]) {
                    return Err(GraphError::NotMonotone(crate::build::narrow(vertex), other));
                }
            }
        }
        self.vertex_weights = Some(weights.into_iter().map(|weight| weight + 0.0).collect());
        Ok(self)
    }

    /// The number of vertices.
    #[must_use]
    pub fn num_vertices(&self) -> usize {
        self.offsets.len().saturating_sub(1)
    }

    /// The number of edges.
    #[must_use]
    pub fn num_edges(&self) -> usize {
        self.upper.len()
    }

    /// The neighbours of a vertex with a larger number, increasing.
    #[must_use]
    pub fn upper_neighbours(&self, vertex: usize) -> &[u32] {
        &self.upper[self.edges_of(vertex)]
    }

    /// The numbers of the edges to the upper neighbours of a vertex: edges are numbered by (lower vertex, upper vertex).
    #[must_use]
    pub fn edges_of(&self, vertex: usize) -> Range<usize> {
        self.offsets[vertex]..self.offsets[vertex + 1]
    }

    /// Whether edges have weights.
    #[must_use]
    pub fn is_weighted(&self) -> bool {
        self.weights.is_some()
    }

    /// The weight of an edge; 0 if edges have none.
    #[must_use]
    pub fn weight(&self, edge: usize) -> f64 {
        self.weights.as_ref().map_or(0.0, |weights| weights[edge])
    }

    /// The weights of the edges, by edge number, if they have any.
    #[must_use]
    pub fn weights(&self) -> Option<&[f64]> {
        self.weights.as_deref()
    }

    /// The weight of a vertex; 0 if none are given.
    #[must_use]
    pub fn vertex_weight(&self, vertex: usize) -> f64 {
        self.vertex_weights.as_ref().map_or(0.0, |weights| weights[vertex])
    }
}

/// Refuses more vertices than 32-bit numbers tell apart.
pub(crate) fn check_vertices(count: usize) -> Result<(), GraphError> {
    u32::try_from(count).ok().filter(|&count| count < u32::MAX).map(|_| ()).ok_or(GraphError::TooManyVertices(count))
}
