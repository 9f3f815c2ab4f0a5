//! Whether a multi-resolution complex is one: what can only be known by making its fronts.

use sig_core::CellId;
use sig_core::mcc::Mcc;

use super::front::{BadRefinement, Front};
use crate::cells::BrokenInvariant;

/// Why a file whose arrays are [valid](Mcc::validate) is no multi-resolution complex.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BrokenMcc {
    /// The base is no cell complex.
    #[error("the base complex: {0}")]
    Base(#[source] BrokenInvariant),
    /// A refinement cannot be applied, or taken back.
    #[error(transparent)]
    Refinement(#[from] BadRefinement),
    /// What all refinements make is no cell complex.
    #[error("the full complex: {0}")]
    Full(#[source] BrokenInvariant),
    /// The cells of the full complex have other numbers than 0 to n − 1, each once.
    #[error("cell {cell} is said to be cell {origin} of the full complex, which there is not, or is another one")]
    Origin {
        /// The cell.
        cell: CellId,
        /// Its number in the full complex.
        origin: usize,
    },
    /// The full complex has another Euler characteristic than the base.
    #[error("the Euler characteristic of the base is {base}, that of the full complex {full}")]
    Euler {
        /// That of the base.
        base: i64,
        /// That of the full complex.
        full: i64,
    },
    /// Taking all refinements back does not lead to the base again.
    #[error("taking back all refinements does not lead to the base complex again")]
    NotUndone,
}

/// Checks that the base is a cell complex, that every refinement can be applied, that the full complex is one too, of the same
/// Euler characteristic, that its cells have the numbers 0 to n − 1, and that taking all refinements back gives the base.
/// Returns the Euler characteristic.
///
/// The arrays must be [valid](Mcc::validate). Cost: all operators twice, and [`CellComplex::check`](crate::cells::CellComplex::check)
/// of the full complex.
///
/// # Errors
/// [`BrokenMcc`]: the first that does not hold.
pub fn verify(mcc: Mcc<'_>) -> Result<i64, BrokenMcc> {
    origins(&mcc)?;
    let mut front = Front::new(mcc);
    front.complex().check().map_err(BrokenMcc::Base)?;
    let base = front.complex().euler_characteristic();
    front.change(0..mcc.num_refinements(), [])?;
    front.complex().check().map_err(BrokenMcc::Full)?;
    let full = front.complex().euler_characteristic();
    if full != base {
        return Err(BrokenMcc::Euler { base, full });
    }
    front.change([], 0..mcc.num_refinements())?;
    if front.complex() != Front::new(mcc).complex() {
        return Err(BrokenMcc::NotUndone);
    }
    Ok(full)
}

/// Checks that each cell of the full complex is one of the file's. A front that was saved has some of them only.
fn origins(mcc: &Mcc<'_>) -> Result<(), BrokenMcc> {
    if mcc.num_refinements() == 0 {
        return Ok(());
    }
    let mut is_seen = vec![false; mcc.num_cells()];
    for (cell, &origin) in (0..).map(CellId::new).zip(mcc.arrays().origins) {
        let origin = origin as usize;
        match is_seen.get_mut(origin) {
            Some(seen) if !*seen => *seen = true,
            _ => return Err(BrokenMcc::Origin { cell, origin }),
        }
    }
    Ok(())
}
