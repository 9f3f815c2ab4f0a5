//! The boundary between critical cells, read off cochains: for each critical cell α the cochain that is 1 on α, 0 on the other
//! critical cells, and whose co-boundary vanishes on every cell that went with one of its faces. Its co-boundary on a critical
//! cell of the next dimension is the incidence number of the two in the Morse complex.

use std::hash::BuildHasher;

use hashbrown::{DefaultHashBuilder, HashTable};

use super::chains::Level;
use super::matching::{Matching, NONE};
use super::ring::{Overflow, Ring, Sparse, add_multiple};
use crate::build::narrow;

/// The values of all those cochains on each cell of a dimension: vectors over the critical cells, by their position among these.
pub(super) struct Cochains<E> {
    /// Of each cell, which of the vectors; number 0 is zero.
    of_cell: Vec<u32>,
    vectors: Vec<Sparse<E>>,
}

impl<E: Clone + Eq + std::hash::Hash> Cochains<E> {
    /// Of the cells below `above`. Cost: a pass over the boundaries in the order of the steps, for cells where cochains do not
    /// vanish that of adding their vectors.
    pub(super) fn new<R: Ring<Element = E>>(
        ring: &R,
        num_cells: usize,
        matching: &Matching,
        above: &Level,
    ) -> Result<Self, Overflow> {
        let mut cochains = Self { of_cell: vec![0; num_cells], vectors: vec![Vec::new()] };
        let mut known = Known { table: HashTable::new(), hasher: DefaultHashBuilder::default() };
        let mut critical = 0;
        for step in &matching.steps {
            let vector = if step.coface == NONE {
                critical += 1;
                vec![(critical - 1, ring.of(1))]
            } else {
                let coface = step.coface as usize;
                let own = above.faces(coface).iter().position(|&face| face == step.cell).unwrap_or(0);
                // The vector of the cell is still zero. Its incidence number is its own inverse.
                let sum = cochains.coboundary(ring, above.boundary(coface))?;
                if sum.is_empty() {
                    continue;
                }
                let mut vector = Vec::new();
                add_multiple(ring, &mut vector, &ring.of(-above.coefficient(coface, own)), &sum)?;
                vector
            };
            cochains.of_cell[step.cell as usize] = known.number(&mut cochains.vectors, vector);
        }
        Ok(cochains)
    }

    /// The co-boundaries of all cochains on a cell with that boundary.
    pub(super) fn coboundary<R: Ring<Element = E>>(
        &self,
        ring: &R,
        boundary: impl Iterator<Item = (u32, i64)>,
    ) -> Result<Sparse<E>, Overflow> {
        let mut sum = Vec::new();
        for (face, coefficient) in boundary {
            let number = self.of_cell[face as usize];
            if number != 0 {
                add_multiple(ring, &mut sum, &ring.of(coefficient), &self.vectors[number as usize])?;
            }
        }
        Ok(sum)
    }
}

/// Vectors by their contents, for most cells share theirs with others.
struct Known {
    table: HashTable<u32>,
    hasher: DefaultHashBuilder,
}

impl Known {
    fn number<E: Eq + std::hash::Hash>(&mut self, vectors: &mut Vec<Sparse<E>>, vector: Sparse<E>) -> u32 {
        if vector.is_empty() {
            return 0;
        }
        let hash = |vector: &Sparse<E>| self.hasher.hash_one(vector);
        let of = hash(&vector);
        if let Some(&number) = self.table.find(of, |&number| vectors[number as usize] == vector) {
            return number;
        }
        let number = narrow(vectors.len());
        vectors.push(vector);
        self.table.insert_unique(of, number, |&number| hash(&vectors[number as usize]));
        number
    }
}
