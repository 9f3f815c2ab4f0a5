//! Triangles and tetrahedra with the ones before and behind each of them around each of its edges: what TS and NMIA have
//! in common (sig-2004, 7.3 and 7.4).

use rayon::prelude::*;
use sig_core::{Dim, Index};

use super::faces::{Marks, positions};
use super::{Face, Tops};
use crate::analysis::Classes;
use crate::build::{index, narrow};

/// Top triangles and tetrahedra, numbered from `first_triangle` on, each with its neighbours around its edges.
///
/// The order around an edge is that of the angles, counterclockwise as seen against the direction from its lesser vertex
/// to its greater one, where there are coordinates; else, and among equal angles, it is that of the numbers. The last
/// precedes the first; one alone precedes itself.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Around<I> {
    first_triangle: usize,
    first_tetrahedron: usize,
    /// Three vertices a triangle, then four a tetrahedron, in an order of the orientation.
    pub(super) corners: Vec<I>,
    /// The one before and the one behind: for each edge three pairs a triangle, then six a tetrahedron.
    pub(super) neighbours: Vec<I>,
}

/// A top simplex at an edge.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct AtEdge {
    /// The vertices of the edge, the lesser one first.
    edge: (u32, u32),
    /// The top simplex, and which of its edges it is.
    top: u32,
    slot: u8,
}

/// Which edge of a triangle or tetrahedron joins two positions.
fn slot(one: usize, other: usize) -> usize {
    let (low, high) = (one.min(other), one.max(other));
    high * (high - 1) / 2 + low
}

/// The positions that an edge joins, by its number: see [`slot`].
const ENDS: [(usize, usize); 6] = [(0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 3)];

impl<I: Index> Around<I> {
    /// Sorts the edges of all top triangles and tetrahedra, of which the first has the number `first_triangle`. Tells with
    /// it the first top simplex, by number, of each part of each vertex's restricted star that is connected through edges
    /// at the vertex: `parts[v]` in order.
    pub(super) fn new(tops: &Tops, first_triangle: usize) -> (Self, Parts) {
        let (mut corners, tetrahedra) = (tops.corners::<I>(2), tops.corners::<I>(3));
        let first_tetrahedron = first_triangle + corners.len() / 3;
        let neighbours = vec![I::STOP; 2 * corners.len() + 3 * tetrahedra.len()];
        corners.extend(tetrahedra);
        let mut around = Self { first_triangle, first_tetrahedron, corners, neighbours };
        let mut at_edges: Vec<AtEdge> =
            (0..around.count()).into_par_iter().flat_map_iter(|number| around.edges(number)).collect();
        at_edges.par_sort_unstable();
        let mut classes = Classes::new(around.corners.len());
        let points = tops.points();
        let (mut order, mut angles) = (Vec::new(), Vec::new());
        for group in at_edges.chunk_by(|left, right| left.edge == right.edge) {
            order.clear();
            order.extend_from_slice(group);
            if let Some(points) = points.as_ref().filter(|_| group.len() > 2) {
                around.sort_radially(&mut order, &mut angles, points);
            }
            for (number, at) in order.iter().enumerate() {
                let before = order[(number + order.len() - 1) % order.len()].top;
                let behind = order[(number + 1) % order.len()].top;
                let place = around.neighbours_of(at.top as usize) + 2 * at.slot as usize;
                around.neighbours[place] = index(before as usize);
                around.neighbours[place + 1] = index(behind as usize);
            }
            for pair in group.windows(2) {
                around.join_ends(&mut classes, pair[0], pair[1]);
            }
        }
        let parts = Parts::new(&around, &mut classes, tops.num_vertices());
        (around, parts)
    }

    /// The number of triangles and tetrahedra.
    pub(super) fn count(&self) -> usize {
        let triangles = self.first_tetrahedron - self.first_triangle;
        triangles + (self.corners.len() - 3 * triangles) / 4
    }

    /// The number of the first triangle.
    pub(super) fn first(&self) -> usize {
        self.first_triangle
    }

    /// The triangles, three vertices each; the tetrahedra, four each.
    pub(super) fn words(&self) -> (&[I], &[I]) {
        self.corners.split_at(3 * (self.first_tetrahedron - self.first_triangle))
    }

    /// The number of vertices of a top simplex.
    pub(super) fn len(&self, top: usize) -> usize {
        if top < self.first_tetrahedron { 3 } else { 4 }
    }

    fn corners_from(&self, top: usize) -> usize {
        match top.checked_sub(self.first_tetrahedron) {
            None => 3 * (top - self.first_triangle),
            Some(number) => 3 * (self.first_tetrahedron - self.first_triangle) + 4 * number,
        }
    }

    pub(super) fn corners_of(&self, top: usize) -> &[I] {
        let start = self.corners_from(top);
        &self.corners[start..start + self.len(top)]
    }

    fn neighbours_of(&self, top: usize) -> usize {
        match top.checked_sub(self.first_tetrahedron) {
            None => 6 * (top - self.first_triangle),
            Some(number) => 6 * (self.first_tetrahedron - self.first_triangle) + 12 * number,
        }
    }

    fn edges(&self, number: usize) -> impl Iterator<Item = AtEdge> + use<'_, I> {
        let top = self.first_triangle + number;
        let corners = self.corners_of(top);
        let edges = if corners.len() == 3 { 3 } else { 6 };
        (0_u8..edges).map(move |slot| {
            let (one, other) = ENDS[slot as usize];
            let [one, other] = [one, other].map(|at| narrow(corners[at].to_usize()));
            AtEdge { edge: (one.min(other), one.max(other)), top: narrow(top), slot }
        })
    }

    /// Orders the top simplices at an edge by the angles at which they lie around it, a tetrahedron by its middle.
    fn sort_radially(&self, order: &mut [AtEdge], angles: &mut Vec<(f64, AtEdge)>, point: &impl Fn(u32) -> [f64; 3]) {
        let Some(&AtEdge { edge: (tail, head), .. }) = order.first() else { return };
        let (origin, axis) = (point(tail), unit(minus(point(head), point(tail))));
        // The direction away from the edge, of length one.
        let away = |vertex: I| {
            let arm = minus(point(narrow(vertex.to_usize())), origin);
            let along = dot(arm, axis);
            unit([0, 1, 2].map(|i| arm[i] - along * axis[i]))
        };
        let middle = |at: &AtEdge| {
            let (one, other) = ENDS[at.slot as usize];
            let others =
                self.corners_of(at.top as usize).iter().enumerate().filter(|(at, _)| *at != one && *at != other);
            others.fold([0.0; 3], |sum, (_, &vertex)| plus(sum, away(vertex)))
        };
        let zero = unit(middle(&order[0]));
        let quarter = cross(axis, zero);
        angles.clear();
        angles.extend(order.iter().map(|at| {
            let direction = middle(at);
            let angle = dot(direction, quarter).atan2(dot(direction, zero));
            (if angle < 0.0 { angle + std::f64::consts::TAU } else { angle }, *at)
        }));
        angles[0].0 = 0.0;
        angles.sort_unstable_by(|left, right| left.0.total_cmp(&right.0).then(left.1.cmp(&right.1)));
        order.iter_mut().zip(&*angles).for_each(|(slot, (_, at))| *slot = *at);
    }

    /// Joins the corners of two top simplices at the ends of an edge that they share.
    fn join_ends(&self, classes: &mut Classes<u32>, one: AtEdge, other: AtEdge) {
        let ends = |at: AtEdge| {
            let (start, (low, high)) = (self.corners_from(at.top as usize), ENDS[at.slot as usize]);
            let least_first = self.corners[start + low] < self.corners[start + high];
            if least_first { [start + low, start + high] } else { [start + high, start + low] }
        };
        for (left, right) in ends(one).into_iter().zip(ends(other)) {
            classes.join(left, right);
        }
    }

    /// Adds the top simplices around the edge of a triangle or tetrahedron, and the edge in each.
    pub(super) fn gather_at_edge(&self, face: Face, found: &mut Vec<Face>) {
        let mut ends = positions(face.mask);
        let (Some(one), Some(other)) = (ends.next(), ends.next()) else { return };
        let corners = self.corners_of(face.top as usize);
        let (one, other) = (corners[one], corners[other]);
        let mut top = face.top as usize;
        loop {
            let (at_one, at_other) = (self.position(top, one), self.position(top, other));
            found.push(Face { top: narrow(top), mask: 1 << at_one | 1 << at_other });
            top = self.behind(top, at_one, at_other);
            if top == face.top as usize {
                return;
            }
        }
    }

    /// Adds the top simplices that a chain of shared edges at a vertex joins to `top`.
    pub(super) fn gather_at_vertex(&self, top: usize, vertex: I, marks: &mut Marks, found: &mut Vec<Face>) {
        let mut next = found.len();
        let start = next;
        marks.set(top);
        found.push(Face { top: narrow(top), mask: 1 << self.position(top, vertex) });
        while let Some(&Face { top, mask }) = found.get(next) {
            next += 1;
            let at = mask.trailing_zeros() as usize;
            for other in (0..self.len(top as usize)).filter(|&other| other != at) {
                // Whoever is behind leads on to the next: round the edge, all are found.
                let behind = self.behind(top as usize, at, other);
                if marks.set(behind) {
                    let mask = 1 << self.position(behind, vertex);
                    found.push(Face { top: narrow(behind), mask });
                }
            }
        }
        found[start..].iter().for_each(|face| marks.clear(face.top as usize));
    }

    fn behind(&self, top: usize, one: usize, other: usize) -> usize {
        self.neighbours[self.neighbours_of(top) + 2 * slot(one, other) + 1].to_usize()
    }

    fn position(&self, top: usize, vertex: I) -> usize {
        self.corners_of(top).iter().position(|&corner| corner == vertex).unwrap_or(0)
    }

    /// The dimension of the largest simplex.
    pub(super) fn dim(&self) -> Option<Dim> {
        let (triangles, tetrahedra) = self.words();
        if tetrahedra.is_empty() { (!triangles.is_empty()).then_some(2) } else { Some(3) }
    }
}

/// For each vertex, one top simplex of each part of its restricted star.
#[derive(Debug)]
pub(super) struct Parts {
    /// (vertex, top simplex), by vertex, then by top simplex.
    pub(super) pairs: Vec<(u32, u32)>,
}

impl Parts {
    fn new<I: Index>(around: &Around<I>, classes: &mut Classes<u32>, num_vertices: usize) -> Self {
        let mut starts = vec![0_usize; num_vertices + 1];
        let roots: Vec<usize> = (0..around.corners.len()).filter(|&corner| classes.root(corner) == corner).collect();
        let vertex = |corner: usize| around.corners[corner].to_usize();
        roots.iter().for_each(|&corner| starts[vertex(corner) + 1] += 1);
        (0..num_vertices).for_each(|vertex| starts[vertex + 1] += starts[vertex]);
        let triangle_corners = around.words().0.len();
        let mut pairs = vec![(0, 0); roots.len()];
        for corner in roots {
            let top = match corner.checked_sub(triangle_corners) {
                None => around.first_triangle + corner / 3,
                Some(beyond) => around.first_tetrahedron + beyond / 4,
            };
            let place = &mut starts[vertex(corner)];
            pairs[*place] = (narrow(vertex(corner)), narrow(top));
            *place += 1;
        }
        Self { pairs }
    }
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn plus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vector at length one; as it is, if it has none.
fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    if length > 0.0 { a.map(|x| x / length) } else { a }
}
