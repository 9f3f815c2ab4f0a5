//! The linear check that a buffer holds a complex in canonical order, with a partial co-boundary that fits it.

use super::Complex;
use super::columns::Labels;
use crate::format::{Column, Container, FormatError, Rule, SectionKind};
use crate::id::{Dim, Index, SimplexId, VertexId};
use crate::tree::validate_value;

impl<I: Index> Complex<'_, I> {
    /// Checks every array: indices in range, the semi-simplicial identity, canonical order, lists in their places,
    /// ordered and ended, C* of the right dimensions and incident, flags exactly where they belong, and the optional
    /// sections against the boundary.
    ///
    /// After it, queries are right, but for what it cannot know: whether a list lacks a cluster, names one twice, or
    /// names a simplex of a cluster that is not the least. To know that, C* must be built again and compared
    /// (`sig verify --rebuild`). It does not check the checksums either: [`verify`](crate::format::verify) does.
    ///
    /// Cost: linear in the buffer, with O(d²) reads a simplex; no memory.
    ///
    /// # Errors
    /// [`FormatError::Invalid`]: the first rule that is broken, with section and element.
    pub fn validate(&self) -> Result<(), FormatError> {
        self.validate_boundary()?;
        // Flags are zero at dimension d − 1 and in the padding.
        check_padding(SectionKind::Flags, self.flags, self.levels().flags_end())?;
        self.validate_partial_coboundary()?;
        self.validate_tree()?;
        self.validate_filtration()?;
        self.validate_parity()?;
        validate_columns(&self.container)
    }

    fn validate_boundary(&self) -> Result<(), FormatError> {
        let mut row_start = 0;
        for dim in 1..self.levels().dims() {
            let below = self.levels().ids(dim - 1);
            let mut previous = None;
            for simplex in self.levels().ids(dim) {
                let row = self.row(dim, simplex);
                let broken = |position: usize, rule| invalid(SectionKind::Boundary, row_start + position, rule);
                if let Some(position) = row.iter().position(|facet| !below.contains(&facet.to_usize())) {
                    return Err(broken(position, Rule::FacetRange));
                }
                let key = (row.last().copied(), row.first().copied());
                let edge_in_order = dim > 1 || key.0 < key.1;
                if previous.replace(key).is_some_and(|before| before >= key) || !edge_in_order {
                    return Err(broken(0, Rule::CanonicalOrder));
                }
                if let Some(position) = self.broken_identity(dim, row) {
                    return Err(broken(position, Rule::SemiSimplicial));
                }
                row_start += row.len();
            }
        }
        Ok(())
    }

    /// The first column j of a row for which F\[F\[σ\]\[j\]\]\[i\] = F\[F\[σ\]\[i\]\]\[j−1\] fails for some i < j.
    fn broken_identity(&self, dim: Dim, row: &[I]) -> Option<usize> {
        if dim < 2 {
            return None;
        }
        let facet_row = |facet: &I| self.row(dim - 1, facet.to_usize());
        row.iter().enumerate().position(|(j, upper)| {
            row.iter().take(j).zip(facet_row(upper)).any(|(lower, face)| facet_row(lower).get(j - 1) != Some(face))
        })
    }

    fn validate_partial_coboundary(&self) -> Result<(), FormatError> {
        let top_dim = self.levels().dims().saturating_sub(1);
        let mut list_start = 0;
        // Beside pairs the lists end where the flags do.
        let listed = if self.has_pairs() { self.levels().flags_end() } else { self.levels().num_pointers() };
        for dim in 0..top_dim {
            for simplex in self.levels().ids(dim).take_while(|&simplex| simplex < listed) {
                let pointer = self.pointer(simplex).map_or(usize::MAX, Index::to_usize);
                let broken = |rule| invalid(SectionKind::Pointers, simplex, rule);
                if self.flag(simplex) {
                    if !self.levels().ids(top_dim).contains(&pointer) || !self.is_face(simplex, pointer) {
                        return Err(broken(Rule::FlaggedPointer));
                    }
                } else if pointer != list_start {
                    return Err(broken(Rule::ListOffset));
                } else {
                    list_start += self.validate_list(dim, simplex, list_start)?;
                }
            }
        }
        if list_start != self.lists.len() {
            return Err(invalid(SectionKind::Lists, list_start, Rule::ListEnd));
        }
        self.validate_pairs(top_dim)?;
        for dim in 1..=top_dim {
            for simplex in self.levels().ids(dim) {
                for facet in self.row(dim, simplex) {
                    if self.is_top(SimplexId::new(facet.to_usize())) {
                        return Err(invalid(SectionKind::Pointers, facet.to_usize(), Rule::MissingEntry));
                    }
                }
            }
        }
        Ok(())
    }

    /// Checks that each pair holds simplices of dimension d around the simplex that it belongs to, increasing, and then
    /// stop codes.
    fn validate_pairs(&self, top_dim: Dim) -> Result<(), FormatError> {
        for (number, simplex) in (self.levels().flags_end()..self.levels().num_pointers()).enumerate() {
            let Some(pair) = self.pair(simplex) else { return Ok(()) };
            let mut previous = None;
            for (position, &entry) in pair.iter().enumerate() {
                let broken = |rule| invalid(SectionKind::Pairs, 2 * number + position, rule);
                if entry == I::STOP {
                    if position == 0 && pair.get(1) != Some(&I::STOP) {
                        return Err(broken(Rule::ListOrder));
                    }
                    continue;
                }
                if previous.replace(entry).is_some_and(|before| before >= entry) {
                    return Err(broken(Rule::ListOrder));
                }
                let entry = entry.to_usize();
                if !self.levels().ids(top_dim).contains(&entry) || !self.is_face(simplex, entry) {
                    return Err(broken(Rule::ListEntry));
                }
            }
        }
        Ok(())
    }

    /// Checks the list of an unflagged simplex and returns its length, the stop code included.
    fn validate_list(&self, dim: Dim, simplex: usize, start: usize) -> Result<usize, FormatError> {
        let list = self.lists_from(start);
        let top_dim = self.levels().dims().saturating_sub(1);
        let mut previous: Option<(Dim, usize)> = None;
        for (position, &entry) in list.iter().enumerate() {
            let broken = |rule| invalid(SectionKind::Lists, start + position, rule);
            if entry == I::STOP {
                let only_top = position == 1 && previous.is_some_and(|(entry_dim, _)| entry_dim == top_dim);
                return if only_top && dim + 1 < top_dim { Err(broken(Rule::Unflagged)) } else { Ok(position + 1) };
            }
            let entry = SimplexId::new(entry.to_usize());
            let entry_dim = self.dim_of(entry).filter(|&entry_dim| entry_dim > dim).ok_or(broken(Rule::ListEntry))?;
            let in_order =
                previous.is_none_or(|(before, id)| entry_dim < before || (entry_dim == before && id < entry.index()));
            if !in_order {
                return Err(broken(Rule::ListOrder));
            }
            if !self.is_top(entry) || !self.is_face(simplex, entry.index()) {
                return Err(broken(Rule::ListEntry));
            }
            previous = Some((entry_dim, entry.index()));
        }
        Err(invalid(SectionKind::Lists, start + list.len(), Rule::ListEnd))
    }

    fn is_face(&self, simplex: usize, container: usize) -> bool {
        self.positions(SimplexId::new(simplex), SimplexId::new(container)).is_some()
    }

    fn validate_tree(&self) -> Result<(), FormatError> {
        let Some(tree) = self.as_tree() else { return Ok(()) };
        // The offset of a node is the number of nodes, of all dimensions but 0, whose parents come before it: walk
        // both in step.
        let mut child = self.num_vertices();
        for (node, offset) in tree.child_offsets().iter().enumerate() {
            while self.parent(SimplexId::new(child)).is_some_and(|parent| parent.index() < node) {
                child += 1;
            }
            if offset.to_usize() != child {
                return Err(invalid(SectionKind::ChildOffsets, node, Rule::ChildOffset));
            }
        }
        for (dim, simplex) in self.each() {
            let last = tree.last_vertex(SimplexId::new(simplex)).map(VertexId::index);
            if last != self.last_vertex_by_facets(dim, simplex) {
                return Err(invalid(SectionKind::LastVertices, simplex, Rule::LastVertex));
            }
        }
        tree.validate_lower()
    }

    /// All simplices with their dimensions.
    fn each(&self) -> impl Iterator<Item = (Dim, usize)> {
        (0..self.levels().dims()).flat_map(|dim| self.levels().ids(dim).map(move |simplex| (dim, simplex)))
    }

    fn validate_filtration(&self) -> Result<(), FormatError> {
        let Some(values) = self.filtration() else { return Ok(()) };
        self.each().try_for_each(|(dim, simplex)| {
            validate_value(values, simplex, self.row(dim, simplex).iter().map(|facet| facet.to_usize()))
        })
    }

    fn validate_parity(&self) -> Result<(), FormatError> {
        let Some(Column::Bits { bytes, len }) = self.parity() else { return Ok(()) };
        // One more than there should be is enough to know; of vertices alone there may be more than the buffer has bytes.
        let tops = self.simplices().filter(|&simplex| self.is_top(simplex)).take(len.saturating_add(1)).count();
        if len != tops {
            return Err(invalid(SectionKind::Parity, tops.min(len), Rule::FlagBits));
        }
        check_padding(SectionKind::Parity, bytes, len)
    }
}

/// Checks what a file carries beside its relations, but for filtration values and orientations: labels, text, padding.
pub(crate) fn validate_columns(container: &Container<'_>) -> Result<(), FormatError> {
    for section in container.sections() {
        match (section.kind, section.column) {
            (SectionKind::Provenance, Column::U8(text)) => {
                if let Err(error) = core::str::from_utf8(text) {
                    return Err(invalid(SectionKind::Provenance, error.valid_up_to(), Rule::Text));
                }
            }
            (SectionKind::LabelOffsets, Column::U64(offsets)) => validate_labels(container, offsets)?,
            (SectionKind::Flags | SectionKind::Parity, _) => {}
            (kind, Column::Bits { bytes, len }) => check_padding(kind, bytes, len)?,
            _ => {}
        }
    }
    Ok(())
}

/// Labels that every vertex has: text between offsets that start at 0, do not decrease, and end with the text.
fn validate_labels(container: &Container<'_>, offsets: &[u64]) -> Result<(), FormatError> {
    let labels = Labels::of(container);
    let text_len = container.section(SectionKind::LabelText).map_or(0, |text| text.column.len() as u64);
    let broken = offsets.iter().enumerate().find(|&(row, &offset)| match row {
        0 => offset != 0,
        row => labels.get(VertexId::new(row - 1)).is_none(),
    });
    let last = offsets.len().saturating_sub(1);
    let broken = broken.map(|(row, _)| row).or((offsets.last() != Some(&text_len)).then_some(last));
    broken.map_or(Ok(()), |row| Err(invalid(SectionKind::LabelOffsets, row, Rule::Labels)))
}

/// Checks that the bits from number `len` on are zero.
fn check_padding(section: SectionKind, bytes: &[u8], len: usize) -> Result<(), FormatError> {
    let bit = |bit: usize| bytes.get(bit / 8).is_some_and(|byte| byte >> (bit % 8) & 1 == 1);
    match (len..bytes.len() * 8).find(|&position| bit(position)) {
        Some(position) => Err(invalid(section, position, Rule::FlagBits)),
        None => Ok(()),
    }
}

pub(crate) fn invalid(section: SectionKind, element: usize, rule: Rule) -> FormatError {
    FormatError::Invalid { section, element: element as u64, rule }
}
