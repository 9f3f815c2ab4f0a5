//! Asking an incidence graph: relations of more than one step, level by level.

use sig_core::storage::Storage;
use sig_core::{Dim, Index, SimplexId, VertexId};

use super::IncidenceGraph;
use crate::baselines::{Marks, Structure};

/// An incidence graph with the memory to ask it: a mark for each simplex.
///
/// C_{p,p+1} and B_{p,p−1} are read off. C_{p,g} and the star go through all cofaces of the dimensions between, B_{p,q}
/// through all faces between, so they are linear in these.
#[derive(Clone, Debug)]
pub struct Walk<'a, I> {
    graph: &'a IncidenceGraph<I>,
    marks: Marks,
    /// Cofaces, each with the positions of the vertices of the simplex that is asked for.
    queue: Vec<(SimplexId, u32)>,
}

impl<'a, I: Index> Walk<'a, I> {
    /// Memory to ask `graph`.
    #[must_use]
    pub fn new(graph: &'a IncidenceGraph<I>) -> Self {
        Self { graph, marks: Marks::new(graph.num_simplices()), queue: Vec::new() }
    }

    /// Queues the simplex and its cofaces of up to `levels` dimensions more; the last level starts at the result.
    fn climb(&mut self, simplex: SimplexId, levels: usize) -> usize {
        let own = self.graph.dim_of(simplex);
        self.queue.clear();
        self.queue.push((simplex, u32::MAX >> (31 - own)));
        let mut level = 0..1;
        for dim in own + 1..=own.saturating_add(levels) {
            for number in level.clone() {
                let (face, mask) = self.queue[number];
                for coface in self.graph.coboundary(face) {
                    if self.marks.set(coface.index()) {
                        let row = self.graph.row(coface, dim);
                        let at = row.iter().position(|facet| facet.to_usize() == face.index()).unwrap_or(0);
                        let low = (1 << at) - 1;
                        self.queue.push((coface, mask & low | (mask & !low) << 1));
                    }
                }
            }
            level = level.end..self.queue.len();
            if level.is_empty() {
                break;
            }
        }
        for (coface, _) in &self.queue[1..] {
            self.marks.clear(coface.index());
        }
        level.start
    }

    /// The face of a simplex without the vertices at some positions.
    fn without(&self, mut simplex: SimplexId, mut omitted: u32) -> SimplexId {
        let mut dim = self.graph.dim_of(simplex);
        while omitted != 0 {
            // The last first, so that the others keep their places.
            let position = omitted.ilog2();
            omitted &= !(1 << position);
            simplex = SimplexId::new(self.graph.row(simplex, dim)[position as usize].to_usize());
            dim -= 1;
        }
        simplex
    }

    fn add_immediate(&self, facet: SimplexId, simplex: SimplexId, found: &mut Vec<SimplexId>) {
        found.extend(self.graph.coboundary(facet).filter(|&coface| coface != simplex));
    }
}

impl<I: Index> Structure for Walk<'_, I> {
    type Simplex = SimplexId;

    fn dim(&self) -> Option<Dim> {
        self.graph.dim()
    }

    fn storage(&self) -> Storage {
        Storage { integers: self.graph.num_integers(), bits: 0 }
    }

    fn bytes(&self) -> usize {
        self.graph.num_integers() * size_of::<I>()
    }

    fn find(&mut self, vertices: &[VertexId]) -> Option<SimplexId> {
        let (first, others) = vertices.split_first()?;
        let num_vertices = self.graph.first.get(1).copied().unwrap_or(self.graph.num_simplices);
        let mut simplex = SimplexId::from(*first);
        if simplex.index() >= num_vertices {
            return None;
        }
        for vertex in others {
            let mut cofaces = self.graph.coboundary(simplex);
            simplex = cofaces.find(|&coface| {
                let last = self.graph.dim_of(coface);
                let is_child = self.graph.boundary(coface).next_back() == Some(simplex);
                is_child && self.without(coface, (1 << last) - 1).index() == vertex.index()
            })?;
        }
        Some(simplex)
    }

    fn vertices(&self, simplex: SimplexId, vertices: &mut Vec<VertexId>) {
        vertices.clear();
        let all = u32::MAX >> (31 - self.graph.dim_of(simplex));
        let others = (0..=self.graph.dim_of(simplex)).map(|kept| all & !(1 << kept));
        vertices.extend(others.map(|omitted| VertexId::new(self.without(simplex, omitted).index())));
    }

    fn boundary(&mut self, simplex: SimplexId, dim: Dim, found: &mut Vec<SimplexId>) {
        found.clear();
        let own = self.graph.dim_of(simplex);
        if dim >= own {
            return;
        }
        found.push(simplex);
        let mut level = 0;
        for _ in dim..own {
            let end = found.len();
            for number in level..end {
                for facet in self.graph.boundary(found[number]) {
                    if self.marks.set(facet.index()) {
                        found.push(facet);
                    }
                }
            }
            level = end;
        }
        found[1..].iter().for_each(|face| self.marks.clear(face.index()));
        found.drain(..level);
    }

    fn coboundary(&mut self, simplex: SimplexId, dim: Dim, found: &mut Vec<SimplexId>) {
        found.clear();
        match dim.checked_sub(self.graph.dim_of(simplex)) {
            None | Some(0) => {}
            Some(1) => found.extend(self.graph.coboundary(simplex)),
            Some(levels) => {
                let last = self.climb(simplex, levels);
                found.extend(self.queue[last..].iter().map(|&(coface, _)| coface));
            }
        }
    }

    fn star(&mut self, simplex: SimplexId, found: &mut Vec<SimplexId>) {
        found.clear();
        self.climb(simplex, usize::MAX);
        found.extend(self.queue.iter().map(|&(coface, _)| coface));
    }

    fn link(&mut self, simplex: SimplexId, found: &mut Vec<SimplexId>) {
        found.clear();
        self.climb(simplex, usize::MAX);
        // What a coface has beside the simplex is a simplex of the link, another one for each.
        found.extend(self.queue[1..].iter().map(|&(coface, own)| self.without(coface, own)));
    }

    fn adjacency(&mut self, simplex: SimplexId, found: &mut Vec<SimplexId>) {
        found.clear();
        if self.graph.dim_of(simplex) > 0 {
            // Two simplices of one dimension share one facet at most.
            self.graph.boundary(simplex).for_each(|facet| self.add_immediate(facet, simplex, found));
            return;
        }
        for edge in self.graph.coboundary(simplex) {
            found.extend(self.graph.boundary(edge).filter(|&end| end != simplex));
        }
    }
}
