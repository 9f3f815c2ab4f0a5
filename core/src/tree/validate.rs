//! The linear check that a buffer holds the simplex tree of a complex in canonical order.

use heapless::Vec;

use super::Tree;
use crate::complex::validate::{invalid, validate_columns};
use crate::format::{FormatError, Rule, SectionKind};
use crate::id::{Dim, Index, MAX_DIM};

/// A node on the way down, and what is needed to find the facets of its children.
struct Step {
    /// Its children that are still to be checked.
    children: core::ops::Range<usize>,
    /// Its number; nothing for the root.
    node: usize,
    /// Where the facets of its children without one of its own vertices are: among the children of its own facets.
    facets: Vec<usize, { MAX_DIM + 1 }>,
}

impl<I: Index> Tree<'_, I> {
    /// Checks every array: child offsets in order, last vertices increasing among siblings and above that of the parent,
    /// all facets of all simplices in the tree, filtration values not less than those of faces, lower neighbours exactly
    /// those of the edges, labels, text and padding.
    ///
    /// After it, queries are right. It does not check the checksums: [`verify`](crate::format::verify) does. Of a SIG it
    /// checks the tree's sections only: see [`Complex::validate`](crate::Complex::validate).
    ///
    /// Cost: p searches among children for each p-simplex, in a walk through the tree; no memory.
    ///
    /// # Errors
    /// [`FormatError::Invalid`]: the first rule that is broken, with section and element.
    pub fn validate(&self) -> Result<(), FormatError> {
        self.validate_offsets()?;
        self.validate_siblings()?;
        self.validate_facets()?;
        self.validate_lower()?;
        validate_columns(&self.container)
    }

    fn validate_offsets(&self) -> Result<(), FormatError> {
        let broken = |node: usize| Err(invalid(SectionKind::ChildOffsets, node, Rule::OffsetOrder));
        for dim in 0..self.levels.dims().saturating_sub(1) {
            let below = self.levels.ids(dim + 1);
            let mut previous = below.start;
            for node in self.levels.ids(dim) {
                let offset = self.child_offsets.get(node).map_or(usize::MAX, |offset| offset.to_usize());
                let is_first = node == self.levels.start(dim);
                if offset < previous || offset > below.end || (is_first && offset != below.start) {
                    return broken(node);
                }
                previous = offset;
            }
        }
        match self.child_offsets.split_last() {
            // Where the number of simplices is the stop code it stands as that.
            Some((end, _)) if end.to_usize() != self.num_simplices() => broken(self.child_offsets.len() - 1),
            _ => Ok(()),
        }
    }

    fn validate_siblings(&self) -> Result<(), FormatError> {
        let broken = |node: usize| invalid(SectionKind::LastVertices, node, Rule::SiblingOrder);
        let label = |node: usize| self.last_vertices.index_at(node);
        if let Some(vertex) = self.levels.ids(0).find(|&vertex| label(vertex) != Some(vertex)) {
            return Err(broken(vertex));
        }
        for dim in 0..self.levels.dims().saturating_sub(1) {
            for node in self.levels.ids(dim) {
                let mut previous = label(node);
                for child in self.child_range(dim, node) {
                    let next = label(child).filter(|&vertex| vertex < self.num_vertices());
                    if next.is_none() || previous >= next {
                        return Err(broken(child));
                    }
                    previous = next;
                }
            }
        }
        Ok(())
    }

    /// Walks the tree depth first. The facets of the child \[τv\] of τ are τ and the children with v of the facets of τ.
    fn validate_facets(&self) -> Result<(), FormatError> {
        let values = self.filtration();
        let mut steps: Vec<Step, { MAX_DIM + 1 }> = Vec::new();
        for vertex in self.levels.ids(0) {
            if let Some(values) = values {
                validate_value(values, vertex, core::iter::empty())?;
            }
            let _ = steps.push(Step { children: self.child_range(0, vertex), node: vertex, facets: Vec::new() });
            while let Some(step) = steps.last_mut() {
                let Some(child) = step.children.next() else {
                    steps.pop();
                    continue;
                };
                let dim = steps.len();
                let facets = self.facets_of_child(dim, steps.last(), child)?;
                if let Some(values) = values {
                    validate_value(values, child, facets.iter().copied())?;
                }
                // Never full: the children of the last dimension are none.
                let children = self.child_range(dim, child);
                if !children.is_empty() {
                    let _ = steps.push(Step { children, node: child, facets });
                }
            }
        }
        Ok(())
    }

    /// The facets of a child of dimension `dim` of the node of a step.
    fn facets_of_child(
        &self,
        dim: Dim,
        parent: Option<&Step>,
        child: usize,
    ) -> Result<Vec<usize, { MAX_DIM + 1 }>, FormatError> {
        let missing = || invalid(SectionKind::LastVertices, child, Rule::MissingFacet);
        let (parent, label) = parent.zip(self.last_vertices.index_at(child)).ok_or_else(missing)?;
        let mut facets = Vec::new();
        if dim == 1 {
            // Without its first vertex an edge is its last one.
            let _ = facets.push(label);
        }
        for &facet in &parent.facets {
            let found = self.child(dim - 1, facet, label).ok_or_else(missing)?;
            let _ = facets.push(found);
        }
        let _ = facets.push(parent.node);
        Ok(facets)
    }

    /// Checks the lower neighbours: as many as there are edges, each the first end of one that ends with the vertex, so
    /// they are all of them.
    pub(crate) fn validate_lower(&self) -> Result<(), FormatError> {
        let Some(lower) = &self.lower else { return Ok(()) };
        let broken = |section, element| Err(invalid(section, element, Rule::LowerNeighbours));
        let mut row = 0;
        for (vertex, offset) in lower.offsets.iter().enumerate() {
            // The rows up to this offset are those of the vertex before; of the first there are none.
            let end = offset.to_usize();
            if end < row || end > lower.vertices.len() || (vertex == 0 && end != 0) {
                return broken(SectionKind::LowerOffsets, vertex);
            }
            let mut previous = None;
            while row < end {
                let neighbour = lower.vertices.index_at(row);
                let is_edge = neighbour.zip(vertex.checked_sub(1)).is_some_and(|(neighbour, vertex)| {
                    neighbour < vertex && self.child(1, neighbour, vertex).is_some()
                });
                if previous >= neighbour || !is_edge {
                    return broken(SectionKind::LowerNeighbours, row);
                }
                previous = neighbour;
                row += 1;
            }
        }
        if row == lower.vertices.len() { Ok(()) } else { broken(SectionKind::LowerOffsets, self.num_vertices()) }
    }
}

/// Checks the filtration value of a simplex against those of its facets.
pub(crate) fn validate_value(
    values: &[f64],
    simplex: usize,
    mut facets: impl Iterator<Item = usize>,
) -> Result<(), FormatError> {
    let value = values.get(simplex).copied().unwrap_or(f64::NAN);
    let late_face = |facet: usize| values.get(facet).is_none_or(|&face| face > value);
    let minus_zero = value == 0.0 && value.is_sign_negative();
    if value.is_nan() || minus_zero || facets.any(late_face) {
        return Err(invalid(SectionKind::Filtration, simplex, Rule::Filtration));
    }
    Ok(())
}
