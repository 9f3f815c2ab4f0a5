//! The Smith normal form of a small dense matrix, with the bases in which it has that form.

use super::Failure;
use super::limits::Watch;
use super::ring::{Overflow, Ring};

/// A matrix A, m × n, in the bases in which it is diagonal: `left⁻¹ A right`, each entry dividing the next.
pub(super) struct Smith<'r, R: Ring> {
    ring: &'r R,
    /// The matrix, by rows.
    matrix: Vec<Vec<R::Element>>,
    /// m × m, by columns.
    left: Vec<Vec<R::Element>>,
    /// The inverse of `left`, by rows.
    left_inverse: Vec<Vec<R::Element>>,
    /// n × n, by columns.
    right: Vec<Vec<R::Element>>,
    /// The inverse of `right`, by rows.
    right_inverse: Vec<Vec<R::Element>>,
    rank: usize,
}

impl<'r, R: Ring> Smith<'r, R> {
    /// Of a matrix of so many columns, by rows.
    pub(super) fn new(
        ring: &'r R,
        matrix: Vec<Vec<R::Element>>,
        columns: usize,
        watch: &Watch<'_>,
    ) -> Result<Self, Failure> {
        let identity = |size: usize| {
            let row = |at: usize| (0..size).map(|other| ring.of(i64::from(at == other))).collect();
            (0..size).map(row).collect::<Vec<Vec<_>>>()
        };
        let (left, left_inverse) = (identity(matrix.len()), identity(matrix.len()));
        let (right, right_inverse) = (identity(columns), identity(columns));
        let mut smith = Self { ring, matrix, left, left_inverse, right, right_inverse, rank: 0 };
        while smith.step()? {
            watch.look(0)?;
            smith.rank += 1;
        }
        Ok(smith)
    }

    /// How many entries of the diagonal are not zero.
    pub(super) fn rank(&self) -> usize {
        self.rank
    }

    /// An entry of the diagonal.
    pub(super) fn entry(&self, at: usize) -> &R::Element {
        &self.matrix[at][at]
    }

    /// The basis of the range; `left[i]` times entry `i` is the image of `right[i]`.
    pub(super) fn left(&self) -> &[Vec<R::Element>] {
        &self.left
    }

    /// The inverse of the basis of the range, by rows: each gives the coordinate of a vector by one basis vector.
    pub(super) fn left_inverse(&self) -> &[Vec<R::Element>] {
        &self.left_inverse
    }

    /// The inverse of the basis of the domain, by rows.
    pub(super) fn right_inverse(&self) -> &[Vec<R::Element>] {
        &self.right_inverse
    }

    /// The basis of the domain; from number `rank` on, a basis of the kernel.
    pub(super) fn right(&self) -> &[Vec<R::Element>] {
        &self.right
    }

    /// The coordinate of a vector of the domain in the basis `right`.
    pub(super) fn coordinate(&self, at: usize, vector: &[R::Element]) -> Result<R::Element, Overflow> {
        let terms = self.right_inverse[at].iter().zip(vector);
        terms.into_iter().try_fold(self.ring.of(0), |sum, (one, other)| self.ring.add_product(&sum, one, other))
    }

    /// Makes the next entry of the diagonal; `false` if the rest is zero.
    fn step(&mut self) -> Result<bool, Overflow> {
        let at = self.rank;
        while let Some((row, column)) = self.smallest(at) {
            self.swap(row, column);
            let mut is_alone = true;
            for row in at + 1..self.matrix.len() {
                let factor = self.quotient(row, at)?;
                self.add_row(row, at, &factor)?;
                is_alone &= self.ring.is_zero(&self.matrix[row][at]);
            }
            for column in at + 1..self.right.len() {
                let factor = self.quotient(at, column)?;
                self.add_column(column, at, &factor)?;
                is_alone &= self.ring.is_zero(&self.matrix[at][column]);
            }
            if !is_alone {
                continue;
            }
            match self.indivisible(at)? {
                Some(row) => self.add_row(at, row, &self.ring.of(1))?,
                None => return Ok(true),
            }
        }
        Ok(false)
    }

    /// Minus the quotient of an entry by the pivot.
    fn quotient(&self, row: usize, column: usize) -> Result<R::Element, Overflow> {
        self.ring.negate(&self.ring.quotient(&self.matrix[row][column], self.entry(self.rank))?)
    }

    /// Where the smallest entry stands that is not zero, from a row and column on.
    fn smallest(&self, from: usize) -> Option<(usize, usize)> {
        let mut best: Option<(usize, usize)> = None;
        for row in from..self.matrix.len() {
            for column in from..self.right.len() {
                let value = &self.matrix[row][column];
                let is_better = best.is_none_or(|(row, column)| self.ring.is_smaller(value, &self.matrix[row][column]));
                if !self.ring.is_zero(value) && is_better {
                    best = Some((row, column));
                }
            }
        }
        best
    }

    /// A row with an entry that the pivot does not divide.
    fn indivisible(&self, at: usize) -> Result<Option<usize>, Overflow> {
        for row in at + 1..self.matrix.len() {
            for column in at + 1..self.right.len() {
                let factor = self.quotient(row, column)?;
                let rest = self.ring.add_product(&self.matrix[row][column], &factor, self.entry(at))?;
                if !self.ring.is_zero(&rest) {
                    return Ok(Some(row));
                }
            }
        }
        Ok(None)
    }

    /// Brings a row and a column to the place of the pivot.
    fn swap(&mut self, row: usize, column: usize) {
        let at = self.rank;
        self.matrix.swap(at, row);
        self.left.swap(at, row);
        self.left_inverse.swap(at, row);
        self.matrix.iter_mut().for_each(|values| values.swap(at, column));
        self.right.swap(at, column);
        self.right_inverse.swap(at, column);
    }

    fn add_row(&mut self, to: usize, from: usize, factor: &R::Element) -> Result<(), Overflow> {
        add(self.ring, &mut self.matrix, to, from, factor)?;
        add(self.ring, &mut self.left_inverse, to, from, factor)?;
        add(self.ring, &mut self.left, from, to, &self.ring.negate(factor)?)
    }

    fn add_column(&mut self, to: usize, from: usize, factor: &R::Element) -> Result<(), Overflow> {
        for values in &mut self.matrix {
            values[to] = self.ring.add_product(&values[to], factor, &values[from])?;
        }
        add(self.ring, &mut self.right, to, from, factor)?;
        add(self.ring, &mut self.right_inverse, from, to, &self.ring.negate(factor)?)
    }
}

/// Adds a multiple of one line to another one.
fn add<R: Ring>(
    ring: &R,
    lines: &mut [Vec<R::Element>],
    to: usize,
    from: usize,
    factor: &R::Element,
) -> Result<(), Overflow> {
    if ring.is_zero(factor) {
        return Ok(());
    }
    let [to, from] = lines.get_disjoint_mut([to, from]).unwrap_or_else(|_| unreachable!("two lines"));
    for (value, other) in to.iter_mut().zip(from.iter()) {
        *value = ring.add_product(value, factor, other)?;
    }
    Ok(())
}
