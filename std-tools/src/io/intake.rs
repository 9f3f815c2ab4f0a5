//! What a reader has gathered so far: the soup in the making and its report.

use sig_core::{Dim, MAX_DIM};

use super::attributes::{Attributes, References};
use super::cone::{self, Polyhedron};
use super::error::{ErrorKind, Fault};
use super::report::ReadReport;
use super::shape::{Corners, Shape};
use super::{Format, OnBad, ReadOptions};
use crate::attribute::Values;
use crate::soup::{Coordinates, Labels, Scalars, Soup};
use crate::spool::Spill;

/// Vertex numbers of the simplices of one dimension from which on they are spilled, where they are.
const SPILL: usize = 1 << 18;

/// The most room that a count declared in a header may reserve before any data has arrived, in vertices or cells.
const RESERVE: u64 = 1 << 16;

/// How much to reserve for `declared` items: never much, for headers lie.
pub(super) fn reserve(declared: u64) -> usize {
    usize::try_from(declared.min(RESERVE)).unwrap_or(0)
}

/// The most points that an input may have beyond a few for each time that it names one.
const FREE_POINTS: usize = 1 << 22;

/// Whether there may be so many points where one is named so often. A number is no proof of that many points, each of which
/// will take memory.
pub(super) const fn may_have(points: usize, named: usize) -> bool {
    points <= FREE_POINTS || points / 16 <= named
}

/// The number of a vertex that is not there.
pub(super) const NOWHERE: u32 = u32::MAX;

/// Why a cell is refused; the reader knows the place and what the input calls the vertices.
pub(super) enum Refusal {
    /// The cell repeats the vertex with this number.
    Repeats { cell: &'static str, vertex: u32 },
    /// The cell has too many vertices.
    Vertices(usize),
}

impl Refusal {
    /// The error for a reader that calls the vertices by `label`.
    pub(super) fn kind(self, label: impl FnOnce(u32) -> String) -> ErrorKind {
        match self {
            Self::Repeats { cell, vertex } => ErrorKind::Degenerate { cell, vertex: label(vertex).into() },
            Self::Vertices(vertices) => ErrorKind::TooManyDimensions { vertices },
        }
    }
}

/// Simplices gathered so far, and the report on them.
pub(super) struct Intake {
    /// Those that are not spilled.
    simplices: Vec<Vec<u32>>,
    spill: Option<Spill>,
    pub(super) report: ReadReport,
    drop_degenerate: bool,
    pub(super) on_bad: OnBad,
    /// The first simplices that were dropped because they repeat a vertex.
    degenerate: Vec<Vec<u32>>,
    pub(super) attributes: Attributes,
    /// Whether each vertex lies inside a cell of higher order; short of those that do not.
    inner: Vec<bool>,
}

impl Intake {
    pub(super) fn new(format: Format, options: &ReadOptions<'_>) -> Self {
        Self {
            simplices: Vec::new(),
            spill: options.spill.cloned(),
            report: ReadReport::new(format),
            drop_degenerate: options.drops_degenerate(),
            on_bad: options.on_bad,
            degenerate: Vec::new(),
            attributes: Attributes::new(options),
            inner: Vec::new(),
        }
    }

    /// Adds an attribute of the vertices, a row for each.
    pub(super) fn vertex_attribute(&mut self, name: &str, components: usize, values: Values) {
        self.attributes.add_of_vertices(name, components, values, &mut self.report.ignored);
    }

    /// Adds an attribute of the cells from number `first` on, a row for each.
    pub(super) fn cell_attribute(&mut self, name: &str, components: usize, values: Values, first: usize) {
        self.attributes.add_of_cells(name, components, values, first, &mut self.report.ignored);
    }

    /// Adds references, of the vertices or of the cells from the first on.
    pub(super) fn references(&mut self, of_vertices: References, of_cells: References) {
        self.attributes.add_references_of_vertices(of_vertices, &mut self.report.ignored);
        self.attributes.add_references_of_cells(of_cells, &mut self.report.ignored);
    }

    /// Takes note of an attribute that is not to be kept.
    pub(super) fn pass_over(&mut self, name: &[u8]) {
        self.attributes.pass_over(name, &mut self.report.ignored);
    }

    /// Whether cells and vertices that cannot be part of a complex are dropped.
    pub(super) fn drops_bad(&self) -> bool {
        self.on_bad == OnBad::Drop
    }

    /// What to take for a vertex that a cell names and that is not there: the cell will be dropped.
    ///
    /// # Errors
    /// The fault, if the input is to be refused, or it is another.
    pub(super) fn missing(&mut self, fault: Fault) -> Result<u32, Fault> {
        if !self.drops_bad() || !matches!(fault.kind(), ErrorKind::OutOfRange { .. } | ErrorKind::UnknownNode { .. }) {
            return Err(fault);
        }
        self.report.note_bad(format!("{}: {}", fault.position(), fault.kind()));
        Ok(NOWHERE)
    }

    /// Drops a cell that names a vertex which is not there; whether it does.
    fn is_dropped(&mut self, vertices: &[u32]) -> bool {
        let is_bad = self.drops_bad() && vertices.contains(&NOWHERE);
        self.report.bad_cells_dropped += usize::from(is_bad);
        is_bad
    }

    /// Drops a simplex that repeats a vertex.
    fn drop_repeating(&mut self, vertices: &[u32]) {
        self.report.degenerate_dropped += 1;
        if self.degenerate.len() < ReadReport::MOST_NAMED {
            self.degenerate.push(vertices.to_vec());
        }
    }

    /// Names the simplices that were dropped because they repeat a vertex.
    fn name_degenerate(&mut self, labels: &Labels) {
        for simplex in std::mem::take(&mut self.degenerate) {
            let names: Vec<_> = simplex.iter().map(|&vertex| labels.name(vertex)).collect();
            self.report.note_bad(format!(": the simplex {} repeats a vertex", names.join(",")));
        }
    }

    /// Drops the simplices at vertices that are not there or have no finite coordinates; tells which vertices stay, if not
    /// all do.
    fn drop_bad(&mut self, labels: &Labels, coordinates: Option<&Coordinates>) -> Option<Vec<bool>> {
        if !self.drops_bad() {
            return None;
        }
        let stays: Vec<bool> = match coordinates {
            Some(Coordinates { dim, values: Scalars::F32(values) }) if *dim > 0 => {
                values.chunks_exact(*dim).map(|point| point.iter().all(|value| value.is_finite())).collect()
            }
            Some(Coordinates { dim, values: Scalars::F64(values) }) if *dim > 0 => {
                values.chunks_exact(*dim).map(|point| point.iter().all(|value| value.is_finite())).collect()
            }
            _ => vec![true; labels.len()],
        };
        for (vertex, _) in (0..).zip(&stays).filter(|&(_, &stays)| !stays).take(ReadReport::MOST_NAMED) {
            self.report.note_bad(format!(": vertex {} has no finite coordinates", labels.name(vertex)));
        }
        self.report.bad_vertices_dropped = stays.iter().filter(|&&stays| !stays).count();
        for (dim, flat) in self.simplices.iter_mut().enumerate() {
            let is_good = |simplex: &[u32]| simplex.iter().all(|&vertex| stays.get(vertex as usize) == Some(&true));
            let good: Vec<bool> = flat.chunks_exact(dim + 1).map(is_good).collect();
            self.report.bad_cells_dropped += good.iter().filter(|&&good| !good).count();
            let mut each = good.iter().flat_map(|good| std::iter::repeat_n(good, dim + 1));
            flat.retain(|_| each.next() == Some(&true));
            self.attributes.retain_origins(dim, &good);
        }
        stays.contains(&false).then_some(stays)
    }

    /// Adds a simplex unless it repeats a vertex.
    pub(super) fn simplex(&mut self, vertices: &[u32]) -> Result<(), Refusal> {
        if self.is_dropped(vertices) {
            return Ok(());
        }
        if vertices.is_empty() || vertices.len() > MAX_DIM + 1 {
            return Err(Refusal::Vertices(vertices.len()));
        }
        match cone::repeated(vertices) {
            None => self.push(vertices),
            Some(_) if self.drop_degenerate => self.drop_repeating(vertices),
            Some(vertex) => return Err(Refusal::Repeats { cell: "simplex", vertex }),
        }
        Ok(())
    }

    /// Adds a polygon of any number of vertices, split if that is more than three.
    pub(super) fn polygon(&mut self, vertices: &[u32], label: impl Fn(u32) -> u64) -> Result<(), Refusal> {
        if vertices.len() <= 3 {
            return self.simplex(vertices);
        }
        if self.is_dropped(vertices) {
            return Ok(());
        }
        self.check("polygon", vertices)?;
        self.report.polygons += 1;
        cone::split_polygon(vertices, label, |triangle| self.piece(&triangle));
        Ok(())
    }

    /// Adds a polyhedron, split into tetrahedra.
    pub(super) fn polyhedron(
        &mut self,
        shape: Polyhedron,
        corners: &[u32],
        label: impl Fn(u32) -> u64,
    ) -> Result<(), Refusal> {
        if self.is_dropped(corners) {
            return Ok(());
        }
        self.check("polyhedron", corners)?;
        self.report.polyhedra += 1;
        shape.split(corners, label, |tetrahedron| self.piece(&tetrahedron));
        Ok(())
    }

    /// Adds the triangles of a strip. Those that repeat a vertex are how strips turn; they are dropped and counted whatever
    /// the options.
    pub(super) fn strip(&mut self, vertices: &[u32]) -> Result<(), Refusal> {
        for (at, triangle) in vertices.windows(3).enumerate() {
            let &[a, b, c] = triangle else { continue };
            let oriented = if at % 2 == 0 { [a, b, c] } else { [b, a, c] };
            if a == b || b == c || a == c {
                self.report.degenerate_dropped += 1;
            } else {
                self.simplex(&oriented)?;
            }
        }
        Ok(())
    }

    /// Adds a cell by its nodes, of which the corners come first; the others are vertices only if they are corners of
    /// another cell, or if no cell has them.
    pub(super) fn element(&mut self, shape: Shape, nodes: &[u32], label: impl Fn(u32) -> u64) -> Result<(), Refusal> {
        if self.is_dropped(nodes) {
            return Ok(());
        }
        let (corners, inner) = nodes.split_at(shape.num_corners.min(nodes.len()));
        for &node in inner {
            let node = node as usize;
            if node >= self.inner.len() {
                self.inner.resize(node + 1, false);
            }
            self.inner[node] = true;
        }
        match shape.corners {
            Corners::Simplex => self.simplex(corners),
            Corners::Polygon => self.polygon(corners, label),
            Corners::Polyhedron(polyhedron) => self.polyhedron(polyhedron, corners, label),
        }
    }

    fn check(&self, cell: &'static str, vertices: &[u32]) -> Result<(), Refusal> {
        match cone::repeated(vertices) {
            Some(vertex) if !self.drop_degenerate => Err(Refusal::Repeats { cell, vertex }),
            _ => Ok(()),
        }
    }

    /// Adds a piece of a cell that may be degenerate only if such are dropped.
    fn piece(&mut self, vertices: &[u32]) {
        if cone::repeated(vertices).is_some() {
            self.drop_repeating(vertices);
        } else {
            self.report.split_into += 1;
            self.push(vertices);
        }
    }

    /// Adds a simplex of one to `MAX_DIM + 1` different vertices.
    fn push(&mut self, vertices: &[u32]) {
        let dim = vertices.len() - 1;
        if self.simplices.len() <= dim {
            self.simplices.resize_with(dim + 1, Vec::new);
        }
        self.simplices[dim].extend_from_slice(vertices);
        self.attributes.push(dim);
        if self.simplices[dim].len() >= SPILL {
            self.spill(dim);
        }
    }

    /// Brings the simplices of one dimension to disk, if they are to go there.
    fn spill(&mut self, dim: Dim) {
        if let Some(spill) = &self.spill {
            spill.append(dim, &self.simplices[dim]);
            self.simplices[dim].clear();
        }
    }

    /// Whether each of `count` vertices lies in a simplex.
    pub(super) fn used(&self, count: usize) -> Vec<bool> {
        let mut used = vec![false; count];
        for &vertex in self.simplices.iter().flatten() {
            used[vertex as usize] = true;
        }
        if let Some(spill) = &self.spill {
            spill.for_each_vertex(|vertex| used[vertex as usize] = true);
        }
        used
    }

    /// Numbers the vertices anew when only those that stay are left; all vertices of simplices must stay.
    pub(super) fn renumber(&mut self, stays: &[bool]) {
        let mut left = 0;
        let mut number = |&stays: &bool| {
            let number = left;
            left += u32::from(stays);
            number
        };
        let numbers: Vec<u32> = stays.iter().map(&mut number).collect();
        for vertex in self.simplices.iter_mut().flatten() {
            *vertex = numbers[*vertex as usize];
        }
        if let Some(spill) = &self.spill {
            spill.renumber(|vertex| numbers[vertex as usize]);
        }
    }

    /// The soup, now that the vertices are known too; without simplices if they are spilled.
    pub(super) fn finish(
        mut self,
        mut labels: Labels,
        declared: bool,
        coordinates: Option<(usize, Scalars)>,
    ) -> (Soup, ReadReport) {
        let mut coordinates = coordinates.map(|(dim, values)| Coordinates { dim, values });
        let num_vertices = labels.len();
        self.name_degenerate(&labels);
        let good = self.drop_bad(&labels, coordinates.as_ref());
        // As they are numbered in the input.
        let points = self.simplices.first().cloned().unwrap_or_default();
        let mut left = None;
        if good.is_some() || !self.inner.is_empty() {
            let mut stays = self.used(labels.len());
            // A node that no cell has was declared all the same.
            for (stays, inner) in stays.iter_mut().zip(self.inner.iter().chain(std::iter::repeat(&false))) {
                *stays |= !inner;
            }
            for (stays, good) in stays.iter_mut().zip(good.iter().flatten()) {
                *stays &= good;
            }
            let dropped = stays.iter().filter(|&&stays| !stays).count();
            self.report.inner_nodes_dropped = dropped - self.report.bad_vertices_dropped;
            self.renumber(&stays);
            (labels, coordinates) = retained(labels, coordinates, &stays);
            left = Some(stays);
        }
        (0..self.simplices.len()).for_each(|dim| self.spill(dim));
        let Self { simplices, spill, mut report, mut attributes, .. } = self;
        report.refused_attributes = std::mem::take(&mut attributes.refused);
        let attributes = attributes.finish(num_vertices, &points, left.as_deref(), &mut report.ignored);
        report.vertices = labels.len();
        report.simplices = match spill {
            Some(spill) => spill.counts(),
            None => simplices.iter().enumerate().map(|(dim, flat)| flat.len() / (dim + 1)).collect(),
        };
        (Soup { labels, declared, coordinates, simplices, attributes }, report)
    }
}

/// Labels and coordinates of the vertices that stay. Those that were numbered are numbered anew only if none is left out
/// before another.
pub(super) fn retained(
    labels: Labels,
    coordinates: Option<Coordinates>,
    stays: &[bool],
) -> (Labels, Option<Coordinates>) {
    fn retain<T>(rows: &mut Vec<T>, width: usize, stays: &[bool]) {
        let mut each = stays.iter().flat_map(|stays| std::iter::repeat_n(stays, width));
        rows.retain(|_| each.next() == Some(&true));
    }
    let labels = match labels {
        Labels::Numbered(count) => {
            let mut numbers = (0..count as u64).collect();
            retain(&mut numbers, 1, stays);
            Labels::from_integers(numbers)
        }
        Labels::Integers(mut labels) => {
            retain(&mut labels, 1, stays);
            Labels::from_integers(labels)
        }
        Labels::Tokens(mut labels) => {
            retain(&mut labels, 1, stays);
            Labels::Tokens(labels)
        }
    };
    let coordinates = coordinates.map(|mut coordinates| {
        match &mut coordinates.values {
            Scalars::F32(values) => retain(values, coordinates.dim, stays),
            Scalars::F64(values) => retain(values, coordinates.dim, stays),
        }
        coordinates
    });
    (labels, coordinates)
}
