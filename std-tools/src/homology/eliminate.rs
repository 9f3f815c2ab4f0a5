//! Rank and invariant factors of a sparse matrix that comes column by column: elimination by units, then the Smith normal form of
//! the little that has none.

use hashbrown::HashMap;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Zero};

use super::Failure;
use super::limits::Watch;
use super::ring::{Overflow, Ring, Sparse, add_multiple};

/// A matrix in the course of elimination.
pub(super) struct Elimination<'r, R: Ring> {
    ring: &'r R,
    /// Columns with a unit, in the order in which they came; none has an entry in the row of the unit of an earlier one.
    pivots: Vec<Pivot<R::Element>>,
    /// The pivot of a row.
    of_row: HashMap<u32, usize>,
    /// Columns without a unit.
    rest: Vec<Sparse<R::Element>>,
}

struct Pivot<E> {
    column: Sparse<E>,
    row: u32,
    /// Minus the inverse of the unit.
    factor: E,
}

/// The Smith normal form of a matrix.
pub(super) struct SmithForm {
    pub(super) rank: usize,
    /// The invariant factors other than 1, each dividing the next.
    pub(super) factors: Vec<BigInt>,
}

impl<'r, R: Ring> Elimination<'r, R> {
    pub(super) fn new(ring: &'r R) -> Self {
        Self { ring, pivots: Vec::new(), of_row: HashMap::new(), rest: Vec::new() }
    }

    /// Adds a column.
    pub(super) fn push(&mut self, mut column: Sparse<R::Element>) -> Result<(), Overflow> {
        self.reduce(&mut column)?;
        self.keep(column)
    }

    /// Subtracts multiples of the pivots until no entry stands in the row of one.
    fn reduce(&self, column: &mut Sparse<R::Element>) -> Result<(), Overflow> {
        // Pivot number k has entries only in rows of later ones: so the earliest first, and each at most once.
        while let Some((number, entry)) = column
            .iter()
            .filter_map(|(row, entry)| Some((*self.of_row.get(row)?, entry)))
            .min_by_key(|(number, _)| *number)
        {
            let pivot = &self.pivots[number];
            let factor = self.ring.add_product(&self.ring.of(0), &pivot.factor, entry)?;
            add_multiple(self.ring, column, &factor, &pivot.column)?;
        }
        Ok(())
    }

    fn keep(&mut self, column: Sparse<R::Element>) -> Result<(), Overflow> {
        if column.is_empty() {
            return Ok(());
        }
        let unit = column.iter().find_map(|(row, entry)| Some((*row, self.ring.inverse(entry)?)));
        match unit {
            Some((row, inverse)) => {
                self.of_row.insert(row, self.pivots.len());
                self.pivots.push(Pivot { column, row, factor: self.ring.negate(&inverse)? });
            }
            None => self.rest.push(column),
        }
        Ok(())
    }

    /// Ends the elimination.
    pub(super) fn finish(mut self, watch: &Watch<'_>) -> Result<SmithForm, Failure> {
        loop {
            let before = self.pivots.len();
            for column in std::mem::take(&mut self.rest) {
                watch.look(0)?;
                self.push(column)?;
            }
            if self.pivots.len() == before {
                break;
            }
        }
        debug_assert!(self.pivots.iter().enumerate().all(|(number, pivot)| self.of_row[&pivot.row] == number));
        let diagonal = diagonalise(self.ring, dense(self.ring, &self.rest), watch)?;
        let mut factors: Vec<BigInt> = diagonal.iter().map(|entry| self.ring.magnitude(entry)).collect();
        divide_in_turn(&mut factors);
        let rank = self.pivots.len() + factors.len();
        factors.retain(|factor| !factor.is_one());
        Ok(SmithForm { rank, factors })
    }
}

/// The columns as rows of a dense matrix, without rows of zeros.
fn dense<R: Ring>(ring: &R, columns: &[Sparse<R::Element>]) -> Vec<Vec<R::Element>> {
    let mut rows: Vec<u32> = columns.iter().flatten().map(|(row, _)| *row).collect();
    rows.sort_unstable();
    rows.dedup();
    let mut matrix = vec![vec![ring.of(0); rows.len()]; columns.len()];
    for (line, column) in matrix.iter_mut().zip(columns) {
        for (row, entry) in column {
            line[rows.partition_point(|other| other < row)] = entry.clone();
        }
    }
    matrix
}

/// The entries that are not zero of a diagonal matrix that row and column operations make of a matrix.
fn diagonalise<R: Ring>(
    ring: &R,
    mut matrix: Vec<Vec<R::Element>>,
    watch: &Watch<'_>,
) -> Result<Vec<R::Element>, Failure> {
    let mut diagonal = Vec::new();
    while let Some((line, at)) = smallest(ring, &matrix) {
        watch.look(0)?;
        let pivot = matrix.swap_remove(line);
        let entry = pivot[at].clone();
        let mut is_alone = true;
        for other in &mut matrix {
            let factor = ring.negate(&ring.quotient(&other[at], &entry)?)?;
            if !ring.is_zero(&factor) {
                for (value, of_pivot) in other.iter_mut().zip(&pivot) {
                    *value = ring.add_product(value, &factor, of_pivot)?;
                }
            }
            is_alone &= ring.is_zero(&other[at]);
        }
        let mut pivot = pivot;
        if is_alone {
            // The column of the pivot has no other entry: column operations change the line of the pivot only.
            for (place, value) in pivot.iter_mut().enumerate().filter(|(place, _)| *place != at) {
                let _ = place;
                let factor = ring.negate(&ring.quotient(value, &entry)?)?;
                *value = ring.add_product(value, &factor, &entry)?;
                is_alone &= ring.is_zero(value);
            }
        }
        if is_alone {
            diagonal.push(entry);
        } else {
            matrix.push(pivot);
        }
    }
    Ok(diagonal)
}

/// Where the smallest entry stands that is not zero.
fn smallest<R: Ring>(ring: &R, matrix: &[Vec<R::Element>]) -> Option<(usize, usize)> {
    let mut best: Option<(usize, usize)> = None;
    for (line, values) in matrix.iter().enumerate() {
        for (at, value) in values.iter().enumerate().filter(|(_, value)| !ring.is_zero(value)) {
            if best.is_none_or(|(line, at)| ring.is_smaller(value, &matrix[line][at])) {
                best = Some((line, at));
            }
        }
    }
    best
}

/// Makes of the entries of a diagonal matrix its invariant factors, each dividing the next.
fn divide_in_turn(factors: &mut [BigInt]) {
    for first in 0..factors.len() {
        for second in first + 1..factors.len() {
            let (gcd, lcm) = factors[first].gcd_lcm(&factors[second]);
            (factors[first], factors[second]) = (gcd, lcm);
        }
    }
    debug_assert!(factors.iter().all(|factor| !factor.is_zero()));
}
