//! What is checked of the arrays of a multi-resolution complex.

use super::{Arcs, Mcc};
use crate::cell::{Arc, CellId};
use crate::format::{FormatError, Rule, SectionKind};
use crate::id::Dim;

fn invalid(section: SectionKind, element: usize, rule: Rule) -> FormatError {
    FormatError::Invalid { section, element: element as u64, rule }
}

impl Mcc<'_> {
    /// Checks every array: offsets, dimensions, order, incidences, that refinements depend on earlier ones only, errors,
    /// and the tree over the sites.
    ///
    /// Not checked: that boundaries of boundaries are zero, and that a refinement is feasible; a front says so when it is made.
    ///
    /// Cost: linear.
    ///
    /// # Errors
    /// [`FormatError::Invalid`]: the first element that is wrong.
    pub fn validate(&self) -> Result<(), FormatError> {
        self.validate_base()?;
        let mut end = self.arrays.base_offsets.last().copied().unwrap_or(0);
        for (row, &offset) in self.arrays.offsets.iter().enumerate() {
            if offset < end || offset as usize > self.arrays.arcs.len() {
                return Err(invalid(SectionKind::RefinementOffsets, row, Rule::ArcOffset));
            }
            end = offset;
        }
        if end as usize != self.arrays.arcs.len() {
            return Err(invalid(SectionKind::CellArcs, end as usize, Rule::ArcOffset));
        }
        for number in 0..self.num_refinements() {
            self.validate_refinement(number)?;
        }
        match self.wrong_place_in_site_tree() {
            Some(place) => Err(invalid(SectionKind::SiteTree, place, Rule::SiteTree)),
            None => Ok(()),
        }
    }

    /// Checks the arrays of the base complex, all that must be right for a front to begin with: refinements are checked when
    /// they are applied.
    ///
    /// Cost: linear in the base.
    ///
    /// # Errors
    /// As [`validate`](Self::validate).
    pub fn validate_base(&self) -> Result<(), FormatError> {
        let mut end = 0;
        for (row, &offset) in self.arrays.base_offsets.iter().enumerate() {
            if offset < end || row == 0 && offset != 0 || offset as usize > self.arrays.arcs.len() {
                return Err(invalid(SectionKind::BaseOffsets, row, Rule::ArcOffset));
            }
            end = offset;
        }
        for number in (0..).take(self.num_base_cells()) {
            let cell = CellId::new(number);
            let dim = self.dim_of(cell).and_then(|dim| dim.checked_sub(1));
            self.validate_arcs(self.base_boundary(cell), dim, self.num_base_cells())?;
        }
        Ok(())
    }

    fn validate_refinement(&self, number: usize) -> Result<(), FormatError> {
        let Some(refinement) = self.refinement(number) else { return Ok(()) };
        if self.site(number).is_some_and(|site| site >= self.num_cells()) {
            return Err(invalid(SectionKind::RefinementSites, number, Rule::Origin));
        }
        if refinement.dim + 1 >= self.num_dims() {
            return Err(invalid(SectionKind::RefinementShapes, number, Rule::Shape));
        }
        for (place, list) in refinement.lists.into_iter().enumerate() {
            let dim = (refinement.dim + place).checked_sub(1);
            self.validate_arcs(list, dim, refinement.low.index())?;
        }
        let error = self.error(number);
        if error.is_nan() || self.dependencies(number).any(|before| self.error(before) < error) {
            return Err(invalid(SectionKind::RefinementErrors, number, Rule::ErrorOrder));
        }
        Ok(())
    }

    fn validate_arcs(&self, arcs: Arcs<'_>, dim: Option<Dim>, limit: usize) -> Result<(), FormatError> {
        let mut before = None;
        let start = arcs.range.start;
        for (place, Arc { cell, incidence }) in arcs.enumerate() {
            let is_arc = cell.index() < limit
                && dim.is_some()
                && self.dim_of(cell) == dim
                && before.replace(cell) < Some(cell)
                && incidence.multiplicity > 0
                && incidence.is_consistent();
            if !is_arc {
                return Err(invalid(SectionKind::CellArcs, start + place, Rule::Arc));
            }
        }
        Ok(())
    }
}
