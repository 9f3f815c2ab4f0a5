//! The boundary between critical cells, read off cochains: for each critical cell α the cochain that is 1 on α, 0 on the other
//! critical cells, and whose co-boundary vanishes on every cell that went with one of its faces. Its co-boundary on a critical
//! cell of the next dimension is the incidence number of the two in the Morse complex.

use std::collections::BTreeMap;
use std::hash::BuildHasher;

use hashbrown::{DefaultHashBuilder, HashMap, HashTable};

use super::Failure;
use super::bits::Bits;
use super::chains::Level;
use super::limits::Watch;
use super::matching::{Matching, NONE};
use super::ring::{Overflow, Ring, Sparse, add_multiple};
use crate::build::narrow;

/// The values of all those cochains on each cell of a dimension: vectors over the critical cells, by their position among these.
pub(super) struct Cochains<E> {
    /// The cells on which not all cochains vanish.
    support: Bits,
    /// Of each of them, which of the vectors.
    of_cell: Vec<u32>,
    vectors: Vec<Sparse<E>>,
}

/// Steps between two looks at the watch.
const PATIENCE: usize = 1 << 12;

impl<E: Clone + Eq + std::hash::Hash> Cochains<E> {
    /// Of the cells below `above`. Cost: a pass over the boundaries in the order of the steps, for cells where cochains do not
    /// vanish that of adding their vectors.
    pub(super) fn new<R: Ring<Element = E>>(
        ring: &R,
        num_cells: usize,
        matching: &Matching,
        above: &Level<'_>,
        watch: &Watch<'_>,
    ) -> Result<Self, Failure> {
        let mut cochains =
            Self { support: Bits::new(num_cells), of_cell: vec![0; num_cells], vectors: vec![Vec::new()] };
        let mut known = Known { table: HashTable::new(), hasher: DefaultHashBuilder::default() };
        let mut critical = 0;
        let mut terms = Vec::new();
        for (number, step) in matching.steps.iter().enumerate() {
            if number.is_multiple_of(PATIENCE) {
                watch.look(0)?;
            }
            let vector = if step.coface == NONE {
                critical += 1;
                vec![(critical - 1, ring.of(1))]
            } else {
                let coface = step.coface as usize;
                // The vector of the cell itself is still zero.
                cochains.terms(above, coface, &mut terms);
                if terms.is_empty() {
                    continue;
                }
                // The incidence number of the cell is its own inverse.
                let own = above.faces(coface).position(|face| face == step.cell).unwrap_or(0);
                let own = -above.coefficient(coface, own);
                terms.iter_mut().for_each(|(_, coefficient)| *coefficient *= own);
                if let [(number, 1)] = terms[..] {
                    cochains.support.insert(step.cell as usize);
                    cochains.of_cell[step.cell as usize] = number;
                    continue;
                }
                cochains.sum(ring, terms.iter().copied())?
            };
            let number = known.number(&mut cochains.vectors, vector);
            if number != 0 {
                cochains.support.insert(step.cell as usize);
                cochains.of_cell[step.cell as usize] = number;
            }
        }
        Ok(cochains)
    }

    /// The co-boundaries of all cochains on a cell of a level.
    pub(super) fn coboundary<R: Ring<Element = E>>(
        &self,
        ring: &R,
        level: &Level<'_>,
        cell: usize,
    ) -> Result<Sparse<E>, Overflow> {
        let mut terms = Vec::new();
        self.terms(level, cell, &mut terms);
        self.sum(ring, terms.into_iter())
    }

    /// The number of the vector of a cell, and the vector, if it is not zero.
    pub(super) fn at(&self, cell: u32) -> Option<(u32, &Sparse<E>)> {
        let number = self.of_cell[cell as usize];
        (number != 0).then(|| (number, &self.vectors[number as usize]))
    }

    /// For each cochain the vectors that it has a part in, and for each vector its cells: to sum cochains by.
    pub(super) fn by_critical(&self) -> ByCritical<'_, E> {
        let mut vectors: HashMap<u32, Vec<u32>> = HashMap::new();
        for (number, vector) in (0_u32..).zip(&self.vectors) {
            vector.iter().for_each(|(critical, _)| vectors.entry(*critical).or_default().push(number));
        }
        let mut cells = vec![Vec::new(); self.vectors.len()];
        for (cell, &number) in (0_u32..).zip(&self.of_cell).filter(|(_, number)| **number != 0) {
            cells[number as usize].push(cell);
        }
        ByCritical { cochains: self, vectors, cells }
    }

    /// The co-boundary as a sum of vectors, each of them once: most often the vectors of two faces cancel, or there is one only.
    #[inline]
    fn terms(&self, level: &Level<'_>, cell: usize, terms: &mut Vec<(u32, i64)>) {
        terms.clear();
        for (k, face) in level.faces(cell).enumerate().filter(|(_, face)| self.support.contains(*face as usize)) {
            let (number, coefficient) = (self.of_cell[face as usize], level.coefficient(cell, k));
            match terms.iter_mut().find(|(other, _)| *other == number) {
                Some((_, sum)) => *sum += coefficient,
                None => terms.push((number, coefficient)),
            }
        }
        terms.retain(|&(_, sum)| sum != 0);
    }

    /// The sum of multiples of vectors.
    fn sum<R: Ring<Element = E>>(
        &self,
        ring: &R,
        terms: impl Iterator<Item = (u32, i64)>,
    ) -> Result<Sparse<E>, Overflow> {
        let mut sum = Vec::new();
        for (number, coefficient) in terms {
            add_multiple(ring, &mut sum, &ring.of(coefficient), &self.vectors[number as usize])?;
        }
        Ok(sum)
    }
}

/// The cochains, inverted.
pub(super) struct ByCritical<'c, E> {
    cochains: &'c Cochains<E>,
    vectors: HashMap<u32, Vec<u32>>,
    cells: Vec<Vec<u32>>,
}

impl<E: Clone> ByCritical<'_, E> {
    /// A sum of multiples of the cochains. Cost: that of their values.
    pub(super) fn combination<R: Ring<Element = E>>(
        &self,
        ring: &R,
        multiples: &Sparse<E>,
    ) -> Result<Sparse<E>, Overflow> {
        let mut values: BTreeMap<u32, E> = BTreeMap::new();
        for (critical, multiple) in multiples {
            for &number in self.vectors.get(critical).into_iter().flatten() {
                let vector = &self.cochains.vectors[number as usize];
                let Ok(at) = vector.binary_search_by_key(critical, |(critical, _)| *critical) else { continue };
                let sum = values.entry(number).or_insert_with(|| ring.of(0));
                *sum = ring.add_product(sum, multiple, &vector[at].1)?;
            }
        }
        values.retain(|_, value| !ring.is_zero(value));
        let of_vector =
            |(number, value): (u32, E)| self.cells[number as usize].iter().map(move |&cell| (cell, value.clone()));
        let mut sum: Sparse<E> = values.into_iter().flat_map(of_vector).collect();
        sum.sort_unstable_by_key(|(cell, _)| *cell);
        Ok(sum)
    }
}

/// What the boundaries of the critical cells of a dimension are computed from, before it is known which these are.
pub(super) struct Below<E> {
    cochains: Cochains<E>,
    /// The cells on which not all co-boundaries vanish, of those that did not go with a face; increasing.
    cells: Vec<u32>,
    /// Where the terms of each begin, and the end.
    starts: Vec<usize>,
    /// The co-boundaries, as multiples of vectors.
    terms: Vec<(u32, i64)>,
    /// The boundaries of the critical cells of the dimension below.
    pub(super) columns: Vec<Sparse<E>>,
}

impl<E: Clone + Eq + std::hash::Hash> Below<E> {
    /// Of a level, the cells of which are `gone` that went with a face. Cost: a pass over it.
    pub(super) fn new(mut cochains: Cochains<E>, level: &Level<'_>, gone: &Bits, columns: Vec<Sparse<E>>) -> Self {
        let (mut cells, mut starts, mut terms) = (Vec::new(), vec![0], Vec::new());
        let mut of_cell = Vec::new();
        for cell in gone.absent(0..level.num_cells()) {
            cochains.terms(level, cell, &mut of_cell);
            if !of_cell.is_empty() {
                cells.push(narrow(cell));
                terms.append(&mut of_cell);
                starts.push(terms.len());
            }
        }
        (cochains.of_cell, cochains.support) = (Vec::new(), Bits::default());
        Self { cochains, cells, starts, terms, columns }
    }

    /// The co-boundaries of all cochains on a cell.
    pub(super) fn coboundary<R: Ring<Element = E>>(&self, ring: &R, cell: u32) -> Result<Sparse<E>, Overflow> {
        let Ok(at) = self.cells.binary_search(&cell) else { return Ok(Vec::new()) };
        self.cochains.sum(ring, self.terms[self.starts[at]..self.starts[at + 1]].iter().copied())
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
