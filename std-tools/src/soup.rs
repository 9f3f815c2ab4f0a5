//! What a reader hands to the builder: simplices on numbered vertices, as the input lists them.
//!
//! A [`Soup`] is not yet a complex: simplices may repeat, be faces of one another, repeat a vertex, and stand in any
//! order. [`crate::io`] makes soups, [`crate::build`] turns them into complexes; neither knows of the other.

use sig_core::complex::columns;
use sig_core::format::Column;
use sig_core::{Dim, MAX_DIM, Relations, VertexId};

use crate::attribute::Attribute;
use crate::names::vertex_label;

/// What the input calls its vertices; a vertex number of a [`Soup`] is a row of this table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Labels {
    /// Vertex `i` is called `i`, for `0 ≤ i < count`.
    Numbered(usize),
    /// Integers, all different, in any order.
    Integers(Vec<u64>),
    /// Other tokens, all different, in any order.
    Tokens(Vec<Box<str>>),
}

impl Labels {
    /// What a complex in a file calls its vertices, by number.
    ///
    /// Cost: a copy.
    #[must_use]
    pub fn of(complex: &impl Relations) -> Self {
        match complex.labels() {
            columns::Labels::Numbered => Self::Numbered(complex.num_vertices()),
            columns::Labels::Integers(labels) => Self::Integers(labels.to_vec()),
            columns::Labels::Text { .. } => {
                let vertices = (0..complex.num_vertices()).map(VertexId::new);
                Self::Tokens(vertices.map(|vertex| vertex_label(complex, vertex).into()).collect())
            }
        }
    }

    /// Labels that are integers, all different: numbers where they count up from 0.
    #[must_use]
    pub fn from_integers(labels: Vec<u64>) -> Self {
        let numbered = labels.iter().zip(0..).all(|(&label, number)| label == number);
        if numbered { Self::Numbered(labels.len()) } else { Self::Integers(labels) }
    }

    /// The label of the vertex with a number, as text; the number itself if there is no such vertex.
    #[must_use]
    pub fn name(&self, vertex: u32) -> String {
        let row = vertex as usize;
        match self {
            Self::Integers(labels) => labels.get(row).map_or_else(|| vertex.to_string(), u64::to_string),
            Self::Tokens(labels) => labels.get(row).map_or_else(|| vertex.to_string(), ToString::to_string),
            Self::Numbered(_) => vertex.to_string(),
        }
    }

    /// The number of vertices.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Numbered(count) => *count,
            Self::Integers(labels) => labels.len(),
            Self::Tokens(labels) => labels.len(),
        }
    }

    /// Whether there is no vertex.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Coordinates of the vertices, row-major: `dim` scalars a vertex, in the order of the vertex numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Coordinates {
    /// Scalars a vertex.
    pub dim: usize,
    /// The scalars, in the precision in which the input holds them.
    pub values: Scalars,
}

impl Coordinates {
    /// The coordinates of the vertices of a complex in a file, by number; `None` if there are none.
    ///
    /// Cost: a copy.
    #[must_use]
    pub fn of(complex: &impl Relations) -> Option<Self> {
        let section = complex.coordinates()?;
        let values = match section.column {
            Column::F32(values) => Scalars::F32(values.to_vec()),
            Column::F64(values) => Scalars::F64(values.to_vec()),
            _ => return None,
        };
        Some(Self { dim: section.components as usize, values })
    }
}

/// Scalars in single or double precision.
#[derive(Clone, Debug, PartialEq)]
pub enum Scalars {
    /// Single precision.
    F32(Vec<f32>),
    /// Double precision.
    F64(Vec<f64>),
}

/// Simplices on numbered vertices, as the input lists them.
#[derive(Clone, Debug, PartialEq)]
pub struct Soup {
    /// What the input calls its vertices.
    pub labels: Labels,
    /// Whether the input declares its vertices apart from the simplices (a mesh), so that a vertex may be unused.
    pub declared: bool,
    /// The coordinates of the vertices, if the input has any.
    pub coordinates: Option<Coordinates>,
    /// `simplices[p]` holds the p-simplices one after the other, `p + 1` vertex numbers each, in the input's order
    /// of simplices and of vertices within a simplex (the orientation). At most [`MAX_DIM`] + 1 arrays.
    pub simplices: Vec<Vec<u32>>,
    /// Attributes, by dimension and name: of dimension 0 with a row for each vertex, else with one for each simplex of
    /// the dimension, in the order of `simplices`.
    pub attributes: Vec<Attribute>,
}

impl Soup {
    /// A soup of the given vertices without simplices.
    #[must_use]
    pub fn new(labels: Labels, declared: bool) -> Self {
        Self { labels, declared, coordinates: None, simplices: Vec::new(), attributes: Vec::new() }
    }

    /// Adds one simplex, its vertex numbers in the input's order; of dimension at most [`MAX_DIM`], not empty.
    ///
    /// # Panics
    /// If `vertices` is empty or has more than [`MAX_DIM`] + 1 numbers.
    pub fn push(&mut self, vertices: &[u32]) {
        assert!(!vertices.is_empty() && vertices.len() <= MAX_DIM + 1, "a simplex of {} vertices", vertices.len());
        let dim = vertices.len() - 1;
        if self.simplices.len() <= dim {
            self.simplices.resize_with(dim + 1, Vec::new);
        }
        self.simplices[dim].extend_from_slice(vertices);
    }

    /// The p-simplices, `p + 1` vertex numbers each.
    pub fn of_dim(&self, dim: Dim) -> impl ExactSizeIterator<Item = &[u32]> {
        self.simplices.get(dim).map_or(&[][..], Vec::as_slice).chunks_exact(dim + 1)
    }

    /// The number of simplices that the input lists, of all dimensions.
    #[must_use]
    pub fn num_listed(&self) -> usize {
        self.simplices.iter().enumerate().map(|(dim, flat)| flat.len() / (dim + 1)).sum()
    }
}
