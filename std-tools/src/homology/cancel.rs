//! Cancellation in a small chain complex: pairs of cells of unit incidence are taken out one after the other, and the boundaries
//! of the rest change so that homology stays. What is done is kept, so that chains and cochains of the rest come back.
//!
//! Taking out (α, β) subtracts from every cell γ with α on its boundary such a multiple of β that α is gone. A chain of the rest
//! gets those multiples back; a cochain of the rest is 0 on β, and on α what makes its co-boundary vanish on β.

use std::collections::{BTreeMap, BTreeSet};

use super::Failure;
use super::limits::Watch;
use super::ring::{Overflow, Ring, Sparse, add_multiple};

/// The boundaries between the cells of two dimensions, as far as both are left.
pub(super) struct Reduced<E> {
    /// Of each cell of the upper dimension, what is left of its boundary.
    pub(super) columns: Vec<Sparse<E>>,
    /// The pairs that were taken out, in their order.
    pairs: Vec<Cancelled<E>>,
    /// Which cells of the lower dimension, and of the upper, went.
    pub(super) gone: [BTreeSet<u32>; 2],
}

struct Cancelled<E> {
    low: u32,
    high: u32,
    /// Minus the inverse of their incidence number.
    factor: E,
    /// The other cells on the boundary of the upper one.
    column: Sparse<E>,
    /// The other cells with the lower one on their boundary.
    row: Sparse<E>,
}

/// Cancels in a matrix of so many rows, without the rows that are gone.
pub(super) fn cancel<R: Ring>(
    ring: &R,
    mut columns: Vec<Sparse<R::Element>>,
    gone: &BTreeSet<u32>,
    watch: &Watch<'_>,
) -> Result<Reduced<R::Element>, Failure> {
    let mut rows: BTreeMap<u32, BTreeSet<u32>> = BTreeMap::new();
    for (number, column) in (0_u32..).zip(&mut columns) {
        column.retain(|(row, _)| !gone.contains(row));
        column.iter().for_each(|(row, _)| _ = rows.entry(*row).or_default().insert(number));
    }
    let mut reduced = Reduced { columns, pairs: Vec::new(), gone: [BTreeSet::new(), BTreeSet::new()] };
    loop {
        let before = reduced.pairs.len();
        for high in 0..reduced.columns.len() {
            // Of the units the one in the shortest row.
            let column = &reduced.columns[high];
            let units = column.iter().filter_map(|(row, entry)| Some((*row, ring.inverse(entry)?)));
            let Some((low, inverse)) = units.min_by_key(|(row, _)| rows[row].len()) else { continue };
            watch.look(0)?;
            reduced.take_out(ring, &mut rows, low, high, &inverse)?;
        }
        if reduced.pairs.len() == before {
            return Ok(reduced);
        }
    }
}

impl<E: Clone> Reduced<E> {
    fn take_out<R: Ring<Element = E>>(
        &mut self,
        ring: &R,
        rows: &mut BTreeMap<u32, BTreeSet<u32>>,
        low: u32,
        high: usize,
        inverse: &E,
    ) -> Result<(), Overflow> {
        let pivot = std::mem::take(&mut self.columns[high]);
        let high = u32::try_from(high).map_err(|_| Overflow)?;
        let factor = ring.negate(inverse)?;
        for (row, _) in &pivot {
            rows.entry(*row).or_default().remove(&high);
        }
        let mut row = Vec::new();
        for other in rows.remove(&low).unwrap_or_default() {
            let column = &mut self.columns[other as usize];
            let Ok(at) = column.binary_search_by_key(&low, |(row, _)| *row) else { continue };
            let entry = column[at].1.clone();
            let multiple = ring.add_product(&ring.of(0), &factor, &entry)?;
            add_multiple(ring, column, &multiple, &pivot)?;
            // Only the rows of the pivot may have changed.
            for (changed, _) in pivot.iter().filter(|(changed, _)| *changed != low) {
                let is_there = column.binary_search_by_key(changed, |(row, _)| *row).is_ok();
                let of_row = rows.entry(*changed).or_default();
                if is_there {
                    of_row.insert(other)
                } else {
                    of_row.remove(&other)
                };
            }
            row.push((other, entry));
        }
        let column = pivot.into_iter().filter(|(row, _)| *row != low).collect();
        self.gone[0].insert(low);
        self.gone[1].insert(high);
        self.pairs.push(Cancelled { low, high, factor, column, row });
        Ok(())
    }

    /// Gives a chain of the upper dimension the multiples of the cells that went.
    pub(super) fn extend_chain<R: Ring<Element = E>>(&self, ring: &R, chain: &mut Sparse<E>) -> Result<(), Overflow> {
        let pairs = self.pairs.iter().map(|Cancelled { high, factor, row, .. }| (*high, factor, row));
        extend(ring, pairs, chain)
    }

    /// Gives a cochain of the lower dimension its values on the cells that went.
    pub(super) fn extend_cochain<R: Ring<Element = E>>(
        &self,
        ring: &R,
        cochain: &mut Sparse<E>,
    ) -> Result<(), Overflow> {
        let pairs = self.pairs.iter().map(|Cancelled { low, factor, column, .. }| (*low, factor, column));
        extend(ring, pairs, cochain)
    }
}

/// Gives values to cells, the last ones first: for each a factor times the sum of the values of others times their coefficients.
fn extend<'e, R: Ring>(
    ring: &R,
    cells: impl DoubleEndedIterator<Item = (u32, &'e R::Element, &'e Sparse<R::Element>)>,
    values: &mut Sparse<R::Element>,
) -> Result<(), Overflow>
where
    R::Element: 'e,
{
    let mut known: BTreeMap<u32, R::Element> = std::mem::take(values).into_iter().collect();
    for (cell, factor, terms) in cells.rev() {
        let mut sum = ring.of(0);
        for (other, coefficient) in terms {
            if let Some(value) = known.get(other) {
                sum = ring.add_product(&sum, coefficient, value)?;
            }
        }
        if !ring.is_zero(&sum) {
            known.insert(cell, ring.add_product(&ring.of(0), factor, &sum)?);
        }
    }
    *values = known.into_iter().collect();
    Ok(())
}
