//! TS, the triangle-segment data structure, for complexes of dimension up to 2 (sig-2004, 7.3).

use sig_core::storage::Storage;
use sig_core::{Dim, Index};

use super::around::Around;
use super::faces::Marks;
use super::lists::Lists;
use super::tops::check_width;
use super::{Face, Refusal, TopSimplices, Tops, array_bytes};
use crate::build::{index, narrow};
use crate::soup::{Labels, Soup};

/// For each vertex the other ends of its wire edges and one triangle of each 2-cluster in its restricted star; for each
/// triangle its vertices, and the triangles before and behind it around each of its edges: n_0 + 9 n_2 + κ_0^1 + κ_0^2
/// integers, and n_0 + n_2 bits for the marks of a traversal.
///
/// Wire edges may meet at a vertex, any number of triangles at an edge, any number of clusters at a vertex. The
/// orientation of a wire edge is not kept: it stands at both ends. Finds the top simplices around a vertex or an edge in
/// time linear in them.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct TriangleSegment<I> {
    /// For each vertex the vertices at the other ends of wire edges, then triangles, each its number and n_0.
    lists: Lists<I>,
    triangles: Around<I>,
}

impl<I: Index> TriangleSegment<I> {
    /// Builds the structure: a sort of the edges of all triangles.
    ///
    /// # Errors
    /// [`Refusal`]: a simplex of dimension 3, or numbers that `I` cannot hold.
    pub fn new(tops: &Tops) -> Result<Self, Refusal> {
        tops.check_dim(2)?;
        let num_vertices = tops.num_vertices();
        let (wires, triangles) = (tops.of_dim(1), tops.count(2));
        let corners = wires.len() + 3 * triangles;
        check_width::<I>(num_vertices + triangles)?;
        check_width::<u32>(num_vertices + triangles + corners)?;
        let (triangles, parts) = Around::new(tops, num_vertices);
        let ends = || wires.chunks_exact(2).flat_map(|ends| [(ends[0], ends[1]), (ends[1], ends[0])]);
        let lists = Lists::new(num_vertices, ends().chain(parts.pairs.iter().copied()))?;
        Ok(Self { lists, triangles })
    }

    /// The top simplices as a list that [`build`](crate::build::build()) takes, vertices by number.
    #[must_use]
    pub fn to_soup(&self) -> Soup {
        let mut soup = Soup::new(Labels::Numbered(self.lists.num_vertices()), true);
        soup.simplices = vec![Vec::new(); 3];
        for vertex in 0..self.lists.num_vertices() {
            for other in self.lists.of(vertex).iter().map(|other| other.to_usize()) {
                if vertex < other && other < self.lists.num_vertices() {
                    soup.simplices[1].extend([narrow(vertex), narrow(other)]);
                }
            }
        }
        soup.simplices[2] = self.triangles.corners.iter().map(|corner| narrow(corner.to_usize())).collect();
        soup
    }

    /// The number from which on a number stands for a wire edge, as an entry of the lists.
    fn first_wire(&self) -> usize {
        self.lists.num_vertices() + self.triangles.count()
    }

    fn gather_at_vertex(&self, vertex: usize, marks: &mut Marks, found: &mut Vec<Face>) {
        let start = self.lists.start(vertex);
        for (number, entry) in self.lists.of(vertex).iter().enumerate() {
            if entry.to_usize() < self.lists.num_vertices() {
                found.push(Face { top: narrow(self.first_wire() + start + number), mask: 1 });
            } else {
                self.triangles.gather_at_vertex(entry.to_usize(), index(vertex), marks, found);
            }
        }
    }
}

impl<I: Index> TopSimplices for TriangleSegment<I> {
    fn dim(&self) -> Option<Dim> {
        let lower = if self.lists.num_entries() == 0 { (self.lists.num_vertices() > 0).then_some(0) } else { Some(1) };
        self.triangles.dim().or(lower)
    }

    fn storage(&self) -> Storage {
        let Around { corners, neighbours, .. } = &self.triangles;
        let integers = self.lists.num_integers() + corners.len() + neighbours.len();
        Storage { integers, bits: self.num_marks() }
    }

    fn bytes(&self) -> usize {
        let Around { corners, neighbours, .. } = &self.triangles;
        self.lists.bytes() + array_bytes(corners) + array_bytes(neighbours) + self.num_marks().div_ceil(8)
    }

    fn num_marks(&self) -> usize {
        self.first_wire()
    }

    fn len(&self, top: u32) -> usize {
        let top = top as usize;
        if top < self.lists.num_vertices() {
            1
        } else if top < self.first_wire() {
            3
        } else {
            2
        }
    }

    fn vertex(&self, top: u32, position: usize) -> u32 {
        let top = top as usize;
        if top < self.lists.num_vertices() {
            return narrow(top);
        }
        match top.checked_sub(self.first_wire()) {
            None => narrow(self.triangles.corners_of(top)[position].to_usize()),
            // A wire edge, by its place in the list of one of its ends.
            Some(place) if position == 0 => narrow(self.lists.owner(place)),
            Some(place) => narrow(self.lists.entry(place).to_usize()),
        }
    }

    fn vertex_face(&self, vertex: u32) -> Option<Face> {
        ((vertex as usize) < self.lists.num_vertices()).then_some(Face { top: vertex, mask: 1 })
    }

    fn incident(&self, face: Face, marks: &mut Marks, found: &mut Vec<Face>) {
        match face.mask.count_ones() as usize {
            1 => {
                let vertex = self.vertex(face.top, face.mask.trailing_zeros() as usize);
                self.gather_at_vertex(vertex as usize, marks, found);
            }
            2 if self.len(face.top) == 3 => self.triangles.gather_at_edge(face, found),
            _ => found.push(face),
        }
    }
}
