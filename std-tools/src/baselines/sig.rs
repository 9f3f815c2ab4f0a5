//! The SIG as one of the structures that are compared.

use sig_core::relations::Simplices;
use sig_core::storage::Storage;
use sig_core::{Complex, Dim, Index, Scratch, ScratchError, SimplexId, VertexId};

use super::Structure;
use crate::OwnedScratch;

/// A complex in a file with the memory to ask it.
#[derive(Debug)]
pub struct Sig<'a, 's, I: Index> {
    complex: Complex<'a, I>,
    scratch: Scratch<'s, I>,
}

/// An answer longer than there are simplices: only in a buffer that is no complex.
const TOO_LONG: &str = "no answer has more simplices than the complex, or for adjacency as many for each facet";

impl<'a, 's, I: Index> Sig<'a, 's, I> {
    /// Asks a complex that is valid, with memory that is grown to what any answer needs.
    #[must_use]
    pub fn new(complex: Complex<'a, I>, memory: &'s mut OwnedScratch<I>) -> Self {
        let dims = complex.dim().map_or(0, |dim| dim + 1);
        memory.grow(ScratchError::Found { at_least: dims * complex.num_simplices(), available: 0 });
        Self { complex, scratch: memory.scratch() }
    }
}

fn replace<I: Index>(found: &mut Vec<SimplexId>, answer: Result<Simplices<'_, I>, ScratchError>) {
    found.clear();
    found.extend(answer.expect(TOO_LONG));
}

/// # Panics
/// The relations that go up, on a buffer that is no complex: see [`Complex::validate`].
impl<I: Index> Structure for Sig<'_, '_, I> {
    type Simplex = SimplexId;

    fn dim(&self) -> Option<Dim> {
        self.complex.dim()
    }

    fn storage(&self) -> Storage {
        self.complex.file_storage().sig()
    }

    /// Bytes of the sections that are the paper's arrays.
    fn bytes(&self) -> usize {
        let Storage { integers, bits } = self.storage();
        integers * I::WIDTH.bytes() + bits.div_ceil(8)
    }

    fn find(&mut self, vertices: &[VertexId]) -> Option<SimplexId> {
        self.complex.find(vertices)
    }

    fn vertices(&self, simplex: SimplexId, vertices: &mut Vec<VertexId>) {
        vertices.clear();
        vertices.extend(self.complex.vertices(simplex));
    }

    fn boundary(&mut self, simplex: SimplexId, dim: Dim, found: &mut Vec<SimplexId>) {
        found.clear();
        found.extend(self.complex.boundary(simplex, dim));
    }

    fn coboundary(&mut self, simplex: SimplexId, dim: Dim, found: &mut Vec<SimplexId>) {
        replace(found, self.complex.coboundary(simplex, dim, &mut self.scratch));
    }

    fn star(&mut self, simplex: SimplexId, found: &mut Vec<SimplexId>) {
        replace(found, self.complex.star(simplex, &mut self.scratch));
    }

    fn link(&mut self, simplex: SimplexId, found: &mut Vec<SimplexId>) {
        replace(found, self.complex.link(simplex, &mut self.scratch));
    }

    fn adjacency(&mut self, simplex: SimplexId, found: &mut Vec<SimplexId>) {
        replace(found, self.complex.adjacency(simplex, &mut self.scratch));
    }
}
