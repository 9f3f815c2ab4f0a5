//! TS, the triangle-segment data structure, for complexes of dimension up to 2 (sig-2004, 7.3).

use sig_core::storage::Storage;
use sig_core::{Dim, Index};

use super::around::Around;
use super::faces::Marks;
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
    /// Where the list of each vertex starts; it ends where the next one starts.
    starts: Vec<I>,
    /// For each vertex the vertices at the other ends of wire edges, then triangles, each its number and n_0.
    lists: Vec<I>,
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
        let mut counts = vec![0_usize; num_vertices + 1];
        ends().chain(parts.pairs.iter().copied()).for_each(|(vertex, _)| counts[vertex as usize + 1] += 1);
        (0..num_vertices).for_each(|vertex| counts[vertex + 1] += counts[vertex]);
        check_width::<I>(counts[num_vertices])?;
        let starts: Vec<I> = counts[..num_vertices].iter().map(|&start| index(start)).collect();
        let mut lists = vec![I::STOP; counts[num_vertices]];
        for (vertex, entry) in ends().chain(parts.pairs.iter().copied()) {
            let place = &mut counts[vertex as usize];
            lists[*place] = index(entry as usize);
            *place += 1;
        }
        Ok(Self { starts, lists, triangles })
    }

    /// The top simplices as a list that [`build`](crate::build::build()) takes, vertices by number.
    #[must_use]
    pub fn to_soup(&self) -> Soup {
        let mut soup = Soup::new(Labels::Numbered(self.starts.len()), true);
        soup.simplices = vec![Vec::new(); 3];
        for vertex in 0..self.starts.len() {
            for other in self.list(vertex).iter().map(|other| other.to_usize()) {
                if vertex < other && other < self.starts.len() {
                    soup.simplices[1].extend([narrow(vertex), narrow(other)]);
                }
            }
        }
        soup.simplices[2] = self.triangles.corners.iter().map(|corner| narrow(corner.to_usize())).collect();
        soup
    }

    fn list_from(&self, vertex: usize) -> usize {
        self.starts.get(vertex).map_or(self.lists.len(), |start| start.to_usize())
    }

    fn list(&self, vertex: usize) -> &[I] {
        &self.lists[self.list_from(vertex)..self.list_from(vertex + 1)]
    }

    /// The number from which on a number stands for a wire edge, as an entry of the lists.
    fn first_wire(&self) -> usize {
        self.starts.len() + self.triangles.count()
    }

    fn gather_at_vertex(&self, vertex: usize, marks: &mut Marks, found: &mut Vec<Face>) {
        let start = self.list_from(vertex);
        for (number, entry) in self.list(vertex).iter().enumerate() {
            if entry.to_usize() < self.starts.len() {
                found.push(Face { top: narrow(self.first_wire() + start + number), mask: 1 });
            } else {
                self.triangles.gather_at_vertex(entry.to_usize(), index(vertex), marks, found);
            }
        }
    }
}

impl<I: Index> TopSimplices for TriangleSegment<I> {
    fn dim(&self) -> Option<Dim> {
        let lower = if self.lists.is_empty() { (!self.starts.is_empty()).then_some(0) } else { Some(1) };
        self.triangles.dim().or(lower)
    }

    fn storage(&self) -> Storage {
        let Around { corners, neighbours, .. } = &self.triangles;
        let integers = self.starts.len() + self.lists.len() + corners.len() + neighbours.len();
        Storage { integers, bits: self.num_marks() }
    }

    fn bytes(&self) -> usize {
        let Around { corners, neighbours, .. } = &self.triangles;
        let lists = array_bytes(&self.starts) + array_bytes(&self.lists);
        lists + array_bytes(corners) + array_bytes(neighbours) + self.num_marks().div_ceil(8)
    }

    fn num_marks(&self) -> usize {
        self.first_wire()
    }

    fn len(&self, top: u32) -> usize {
        let top = top as usize;
        if top < self.starts.len() {
            1
        } else if top < self.first_wire() {
            3
        } else {
            2
        }
    }

    fn vertex(&self, top: u32, position: usize) -> u32 {
        let top = top as usize;
        if top < self.starts.len() {
            return narrow(top);
        }
        match top.checked_sub(self.first_wire()) {
            None => narrow(self.triangles.corners_of(top)[position].to_usize()),
            // The vertex in whose list the edge stands is the last that starts there or before.
            Some(entry) if position == 0 => {
                narrow(self.starts.partition_point(|start| start.to_usize() <= entry).saturating_sub(1))
            }
            Some(entry) => narrow(self.lists[entry].to_usize()),
        }
    }

    fn vertex_face(&self, vertex: u32) -> Option<Face> {
        ((vertex as usize) < self.starts.len()).then_some(Face { top: vertex, mask: 1 })
    }

    fn incident(&self, face: Face, marks: &mut Marks, found: &mut Vec<Face>) {
        match face.mask.count_ones() as usize {
            1 => {
                self.gather_at_vertex(self.vertex(face.top, face.mask.trailing_zeros() as usize) as usize, marks, found)
            }
            2 if self.len(face.top) == 3 => self.triangles.gather_at_edge(face, found),
            _ => found.push(face),
        }
    }
}
