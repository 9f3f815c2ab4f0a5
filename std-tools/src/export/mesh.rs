//! What the mesh formats have in common: vertices in a row, each with coordinates, and cells that number them.

use std::io::{self, Write};

use sig_core::complex::columns::{Label, Labels};
use sig_core::format::{Column, Section, SectionKind};
use sig_core::{Dim, Relations, SimplexId, VertexId};

use crate::tops::top_simplices;

/// A complex as a mesh: its vertices in the order of their labels, which is the order of the input.
pub(super) struct Mesh<'v, V> {
    pub(super) complex: &'v V,
    coordinates: Section<'v>,
    /// The vertices by label and the place of each among them; `None` if they are in that order.
    order: Option<Order>,
}

struct Order {
    vertices: Vec<VertexId>,
    places: Vec<usize>,
}

impl<'v, V: Relations> Mesh<'v, V> {
    pub(super) fn new(complex: &'v V) -> Self {
        let none = Section { components: 3, ..Section::new(SectionKind::Coordinates, Column::F64(&[])) };
        Self { complex, coordinates: complex.coordinates().unwrap_or(none), order: Order::new(complex) }
    }

    /// Coordinates a vertex.
    pub(super) fn components(&self) -> usize {
        self.coordinates.components as usize
    }

    /// Whether the coordinates are in single precision.
    pub(super) fn is_single(&self) -> bool {
        matches!(self.coordinates.column, Column::F32(_))
    }

    pub(super) fn num_vertices(&self) -> usize {
        self.complex.num_vertices()
    }

    /// The vertices in the order of their labels.
    pub(super) fn vertices(&self) -> impl Iterator<Item = VertexId> {
        (0..self.num_vertices()).map(|place| match &self.order {
            Some(order) => order.vertices[place],
            None => VertexId::new(place),
        })
    }

    /// The place of a vertex among the vertices; its own number if there is no such vertex.
    fn place(&self, vertex: VertexId) -> usize {
        let places = self.order.as_ref().map(|order| &order.places);
        places.and_then(|places| places.get(vertex.index())).copied().unwrap_or(vertex.index())
    }

    /// The row of the coordinates of a vertex: indices into [`value`](Self::value) and [`write_value`](Self::write_value).
    pub(super) fn row(&self, vertex: VertexId) -> std::ops::Range<usize> {
        let components = self.components();
        vertex.index() * components..(vertex.index() + 1) * components
    }

    /// A coordinate.
    pub(super) fn value(&self, row: usize) -> f64 {
        self.coordinates.column.number_at(row).unwrap_or(0.0)
    }

    /// Writes a coordinate with as many digits as it takes to read it back.
    pub(super) fn write_value(&self, row: usize, out: &mut dyn Write) -> io::Result<()> {
        match self.coordinates.column {
            Column::F32(values) => write!(out, "{:?}", values.get(row).copied().unwrap_or(0.0)),
            _ => write!(out, "{:?}", self.value(row)),
        }
    }

    /// Writes the coordinates of a vertex, separated by blanks.
    pub(super) fn write_point(&self, vertex: VertexId, out: &mut dyn Write) -> io::Result<()> {
        for (axis, row) in self.row(vertex).enumerate() {
            if axis > 0 {
                out.write_all(b" ")?;
            }
            self.write_value(row, out)?;
        }
        Ok(())
    }

    /// The coordinates of a vertex, filled up with zeros to three.
    pub(super) fn padded(&self, vertex: VertexId) -> [f64; 3] {
        let mut point = [0.0; 3];
        for (value, row) in point.iter_mut().zip(self.row(vertex)) {
            *value = self.value(row);
        }
        point
    }

    /// Writes the coordinates of a vertex, filled up with zeros to three.
    pub(super) fn write_padded_point(&self, vertex: VertexId, out: &mut dyn Write) -> io::Result<()> {
        self.write_point(vertex, out)?;
        (self.components()..3).try_for_each(|_| out.write_all(b" 0.0"))
    }

    /// The dimension of the complex; 0 if it is empty.
    pub(super) fn dim(&self) -> Dim {
        self.complex.dim().unwrap_or(0)
    }

    /// The number of top simplices of all dimensions.
    pub(super) fn num_tops(&self) -> usize {
        top_simplices(self.complex).count()
    }

    /// Hands each top simplex of a dimension in `dims` to `cell`, as the places of its vertices in an order of its
    /// orientation.
    pub(super) fn cells(
        &self,
        dims: std::ops::RangeInclusive<Dim>,
        mut cell: impl FnMut(&[usize]) -> io::Result<()>,
    ) -> io::Result<()> {
        let (mut vertices, mut places) = (Vec::new(), Vec::new());
        for top in top_simplices(self.complex).filter(|top| dims.contains(&top.dim)) {
            top.oriented_vertices(self.complex, &mut vertices);
            if vertices.len() != top.dim + 1 {
                return Err(io::Error::other("a simplex without its vertices: the complex is not valid"));
            }
            places.clear();
            places.extend(vertices.iter().map(|&vertex| self.place(vertex)));
            cell(&places)?;
        }
        Ok(())
    }

    /// The top simplices of a dimension in `dims`, in the order of [`cells`](Self::cells): dimension and number in it.
    pub(super) fn rows(&self, dims: std::ops::RangeInclusive<Dim>) -> impl Iterator<Item = (Dim, usize)> {
        let first = |dim| self.complex.simplices_of_dim(dim).next().map_or(0, SimplexId::index);
        let first: Vec<usize> = (0..=self.dim()).map(first).collect();
        let tops = top_simplices(self.complex).filter(move |top| dims.contains(&top.dim));
        tops.map(move |top| (top.dim, top.id.index() - first.get(top.dim).copied().unwrap_or(0)))
    }

    /// The number of top simplices of each of the dimensions 0 to 3.
    pub(super) fn num_cells(&self) -> [usize; 4] {
        let mut counts = [0; 4];
        for top in top_simplices(self.complex) {
            if let Some(count) = counts.get_mut(top.dim) {
                *count += 1;
            }
        }
        counts
    }

    /// Whether the labels are the numbers that a format gives by itself, from `first` on.
    pub(super) fn is_numbered_from(&self, first: u64) -> bool {
        let labels = self.complex.labels();
        self.vertices().zip(first..).all(|(vertex, number)| labels.get(vertex) == Some(Label::Integer(number)))
    }

    /// The labels in the order of the vertices, if they are integers.
    pub(super) fn integer_labels(&self) -> Option<impl Iterator<Item = u64>> {
        let labels = self.complex.labels();
        let integers = !matches!(labels, Labels::Text { .. });
        let label = move |vertex| match labels.get(vertex) {
            Some(Label::Integer(label)) => label,
            _ => 0,
        };
        integers.then(|| self.vertices().map(label))
    }
}

impl Order {
    fn new(complex: &impl Relations) -> Option<Self> {
        let labels = complex.labels();
        if matches!(labels, Labels::Numbered) {
            return None;
        }
        let ids = || (0..complex.num_vertices()).map(VertexId::new);
        if ids().is_sorted_by_key(|vertex| labels.get(vertex)) {
            return None;
        }
        let mut vertices: Vec<_> = ids().collect();
        vertices.sort_by_key(|&vertex| labels.get(vertex));
        let mut places = vec![0; vertices.len()];
        for (place, vertex) in vertices.iter().enumerate() {
            places[vertex.index()] = place;
        }
        Some(Self { vertices, places })
    }
}
