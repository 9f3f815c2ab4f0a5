//! NMIA, the non-manifold indexed data structure with adjacencies, for complexes of dimension up to 3 (sig-2004, 7.4).

use sig_core::storage::Storage;
use sig_core::{Dim, Index};

use super::around::Around;
use super::faces::Marks;
use super::tops::check_width;
use super::{Face, Refusal, TopSimplices, Tops, array_bytes};
use crate::build::{index, narrow};
use crate::soup::{Labels, Soup};

/// For each top simplex its vertices, for each top triangle and tetrahedron those before and behind it around each of
/// its edges, and for each vertex one top simplex of each connected component of its restricted star: n_0 + 2 n'_1 +
/// 9 n'_2 + 16 n_3 + c_1 integers, n'_p the number of top p-simplices, and n_0 + n'_1 + n'_2 + n_3 bits for the marks of a
/// traversal.
///
/// Wire edges and dangling triangles may meet tetrahedra at vertices and edges; the components of a restricted star are
/// those of the link, not clusters. Finds the top simplices around a vertex, an edge or a triangle in time linear in
/// those around the vertex, around the edge, or around an edge of the triangle.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct NonManifoldIndexed<I> {
    /// Where the list of each vertex starts; it ends where the next one starts.
    starts: Vec<I>,
    /// For each vertex a top simplex of each component of its restricted star. Numbers up to n_0 are vertices, then come
    /// wire edges, triangles, tetrahedra.
    components: Vec<I>,
    /// The ends of the wire edges.
    wires: Vec<I>,
    larger: Around<I>,
}

impl<I: Index> NonManifoldIndexed<I> {
    /// Builds the structure: a sort of the edges of all top triangles and tetrahedra.
    ///
    /// # Errors
    /// [`Refusal`]: a simplex of dimension 4, or numbers that `I` cannot hold.
    pub fn new(tops: &Tops) -> Result<Self, Refusal> {
        tops.check_dim(3)?;
        let num_vertices = tops.num_vertices();
        let wires: Vec<I> = {
            check_width::<I>(num_vertices + tops.count(1) + tops.count(2) + tops.count(3))?;
            tops.corners(1)
        };
        let (larger, parts) = Around::new(tops, num_vertices + wires.len() / 2);
        let at_wires = || {
            let ends = wires.iter().enumerate();
            ends.map(|(at, vertex)| (narrow(vertex.to_usize()), narrow(num_vertices + at / 2)))
        };
        let mut counts = vec![0_usize; num_vertices + 1];
        at_wires().chain(parts.pairs.iter().copied()).for_each(|(vertex, _)| counts[vertex as usize + 1] += 1);
        (0..num_vertices).for_each(|vertex| counts[vertex + 1] += counts[vertex]);
        check_width::<I>(counts[num_vertices])?;
        let starts: Vec<I> = counts[..num_vertices].iter().map(|&start| index(start)).collect();
        let mut components = vec![I::STOP; counts[num_vertices]];
        for (vertex, top) in at_wires().chain(parts.pairs.iter().copied()) {
            let place = &mut counts[vertex as usize];
            components[*place] = index(top as usize);
            *place += 1;
        }
        Ok(Self { starts, components, wires, larger })
    }

    /// The top simplices as a list that [`build`](crate::build::build()) takes, vertices by number.
    #[must_use]
    pub fn to_soup(&self) -> Soup {
        let mut soup = Soup::new(Labels::Numbered(self.starts.len()), true);
        let (triangles, tetrahedra) = self.larger.words();
        let numbers = |corners: &[I]| corners.iter().map(|corner| narrow(corner.to_usize())).collect();
        soup.simplices = vec![Vec::new(), numbers(&self.wires), numbers(triangles), numbers(tetrahedra)];
        soup
    }

    fn list(&self, vertex: usize) -> &[I] {
        let start = |vertex| self.starts.get(vertex).map_or(self.components.len(), |start: &I| start.to_usize());
        &self.components[start(vertex)..start(vertex + 1)]
    }

    fn gather_at_vertex(&self, vertex: usize, marks: &mut Marks, found: &mut Vec<Face>) {
        for top in self.list(vertex).iter().map(|top| top.to_usize()) {
            if top < self.larger.first() {
                let first = self.vertex(narrow(top), 0) as usize;
                found.push(Face { top: narrow(top), mask: if first == vertex { 0b01 } else { 0b10 } });
            } else {
                self.larger.gather_at_vertex(top, index(vertex), marks, found);
            }
        }
    }

    /// Adds the top simplices around a triangular face of a tetrahedron: those around an edge of it that have all of it.
    fn gather_at_triangle(&self, face: Face, found: &mut Vec<Face>) {
        let third = face.mask & !(face.mask & face.mask.wrapping_neg());
        let apex = index::<I>(self.vertex(face.top, face.mask.trailing_zeros() as usize) as usize);
        let start = found.len();
        self.larger.gather_at_edge(Face { mask: third, ..face }, found);
        let mut kept = start;
        for number in start..found.len() {
            let Face { top, mask } = found[number];
            if let Some(at) = self.larger.corners_of(top as usize).iter().position(|&corner| corner == apex) {
                found[kept] = Face { top, mask: mask | 1 << at };
                kept += 1;
            }
        }
        found.truncate(kept);
    }
}

impl<I: Index> TopSimplices for NonManifoldIndexed<I> {
    fn dim(&self) -> Option<Dim> {
        let lower = if self.wires.is_empty() { (!self.starts.is_empty()).then_some(0) } else { Some(1) };
        self.larger.dim().or(lower)
    }

    fn storage(&self) -> Storage {
        let Around { corners, neighbours, .. } = &self.larger;
        let lists = self.starts.len() + self.components.len() + self.wires.len();
        Storage { integers: lists + corners.len() + neighbours.len(), bits: self.num_marks() }
    }

    fn bytes(&self) -> usize {
        let Around { corners, neighbours, .. } = &self.larger;
        let arrays = [&self.starts, &self.components, &self.wires, corners, neighbours];
        arrays.into_iter().map(|array| array_bytes(array)).sum::<usize>() + self.num_marks().div_ceil(8)
    }

    fn num_marks(&self) -> usize {
        self.larger.first() + self.larger.count()
    }

    fn len(&self, top: u32) -> usize {
        let top = top as usize;
        if top < self.starts.len() {
            1
        } else if top < self.larger.first() {
            2
        } else {
            self.larger.len(top)
        }
    }

    fn vertex(&self, top: u32, position: usize) -> u32 {
        let top = top as usize;
        narrow(if top < self.starts.len() {
            top
        } else if top < self.larger.first() {
            self.wires[2 * (top - self.starts.len()) + position].to_usize()
        } else {
            self.larger.corners_of(top)[position].to_usize()
        })
    }

    fn vertex_face(&self, vertex: u32) -> Option<Face> {
        ((vertex as usize) < self.starts.len()).then_some(Face { top: vertex, mask: 1 })
    }

    fn incident(&self, face: Face, marks: &mut Marks, found: &mut Vec<Face>) {
        match (face.mask.count_ones() as usize, self.len(face.top)) {
            (1, _) => {
                let vertex = self.vertex(face.top, face.mask.trailing_zeros() as usize);
                self.gather_at_vertex(vertex as usize, marks, found);
            }
            (2, 3..) => self.larger.gather_at_edge(face, found),
            (3, 4) => self.gather_at_triangle(face, found),
            _ => found.push(face),
        }
    }
}
