//! The sections of a file by kind, with the shapes that the format asks for: what opening a complex and opening a tree
//! have in common.

use super::Levels;
use crate::format::{Column, Container, FormatError, Kind, Rule, Section, SectionKind, TableError};
use crate::id::{Index, IndexWidth};

/// Sections by kind, with the shapes that the format asks for.
pub(crate) struct Sections<'c, 'a> {
    pub(crate) container: &'c Container<'a>,
}

impl<'a> Sections<'_, 'a> {
    /// The lookup table, unpacked, of a file whose indices have the width `I`.
    pub(crate) fn levels<I: Index>(&self) -> Result<Levels, FormatError> {
        let header = self.container.header();
        if header.width != I::WIDTH {
            return Err(FormatError::WrongWidth { found: header.width, expected: I::WIDTH });
        }
        let total = usize::try_from(header.num_simplices).ok();
        let total = total.filter(|&total| isize::try_from(total).is_ok() && fits::<I>(total));
        let first_ids = |element: usize| FormatError::Invalid {
            section: SectionKind::Lookup,
            element: element as u64,
            rule: Rule::FirstIds,
        };
        let total = total.ok_or(first_ids(header.dims))?;
        let lookup = self.indices::<I>(SectionKind::Lookup, Some(header.dims))?;
        Levels::new(lookup, total).map_err(first_ids)
    }

    fn required(&self, kind: SectionKind) -> Result<Section<'a>, FormatError> {
        self.container.section(kind).ok_or(FormatError::MissingSection(kind))
    }

    fn wrong(&self, section: &Section<'_>, error: TableError) -> FormatError {
        let same =
            |other: &Section<'_>| (other.kind, other.dim, other.name) == (section.kind, section.dim, section.name);
        let entry = self.container.sections().position(|other| same(&other)).unwrap_or(0);
        FormatError::Table { entry: u32::try_from(entry).unwrap_or(u32::MAX), error }
    }

    fn check_len(&self, section: &Section<'_>, expected: Option<usize>) -> Result<(), FormatError> {
        let found = section.column.len();
        match expected {
            Some(expected) if expected != found => {
                let (found, expected) = (found as u64, expected as u64);
                Err(self.wrong(section, TableError::Count { found, expected }))
            }
            _ => Ok(()),
        }
    }

    fn element_error(&self, section: &Section<'_>) -> FormatError {
        self.wrong(section, TableError::ElementType(section.column.element_code()))
    }

    /// The indices of a section that must be there.
    pub(crate) fn indices<I: Index>(&self, kind: SectionKind, len: Option<usize>) -> Result<&'a [I], FormatError> {
        let section = self.required(kind)?;
        let typed =
            core::mem::discriminant(&section.column) == core::mem::discriminant(&Column::from_indices::<I>(&[]));
        let indices = bytemuck::try_cast_slice(section.column.as_bytes()).ok().filter(|_| typed);
        let indices = indices.ok_or_else(|| self.element_error(&section))?;
        self.check_len(&section, len)?;
        Ok(indices)
    }

    /// The indices of a section that may be there.
    pub(crate) fn optional_indices<I: Index>(
        &self,
        kind: SectionKind,
        len: usize,
    ) -> Result<Option<&'a [I]>, FormatError> {
        self.container.section(kind).map(|_| self.indices(kind, Some(len))).transpose()
    }

    /// The bits of a section that must be there.
    pub(crate) fn bits(&self, kind: SectionKind, len: usize) -> Result<&'a [u8], FormatError> {
        let section = self.required(kind)?;
        let Column::Bits { bytes, .. } = section.column else { return Err(self.element_error(&section)) };
        self.check_len(&section, Some(len))?;
        Ok(bytes)
    }

    /// The vertices of a section that must be there, no wider than an index. Where all simplices are vertices, they may be as
    /// many as the stop code, which takes more than an index.
    pub(crate) fn vertices<I: Index>(&self, kind: SectionKind, len: usize) -> Result<Column<'a>, FormatError> {
        let section = self.required(kind)?;
        let widest = if self.container.header().dims < 2 { IndexWidth::Bits64 } else { I::WIDTH };
        let fits = match section.column {
            Column::U16(_) => true,
            Column::U32(_) => widest >= IndexWidth::Bits32,
            Column::U64(_) => widest >= IndexWidth::Bits64,
            _ => false,
        };
        if !fits {
            return Err(self.element_error(&section));
        }
        self.check_len(&section, Some(len))?;
        Ok(section.column)
    }

    /// Whether one of two sections that stand together is there; an error if the other one is not.
    pub(crate) fn both(&self, kinds: [SectionKind; 2]) -> Result<bool, FormatError> {
        match kinds.map(|kind| self.container.section(kind).is_some()) {
            [false, false] => Ok(false),
            [true, true] => Ok(true),
            [found, _] => {
                let [first, second] = kinds;
                Err(FormatError::MissingSection(if found { second } else { first }))
            }
        }
    }

    /// Refuses the sections that files of a kind do not have, and checks the shapes of those that no query depends on.
    pub(crate) fn check_columns(&self, levels: &Levels) -> Result<(), FormatError> {
        let is_tree = self.container.header().kind == Kind::Tree;
        for section in self.container.sections() {
            if is_tree && section.kind.is_of_sig_only() || section.kind.is_of_cells() {
                return Err(self.wrong(&section, TableError::UnknownKind(section.kind.code())));
            }
            self.check_column(&section, levels)?;
        }
        if let (Some(_), Some(offsets)) =
            (self.container.section(SectionKind::IntegerLabels), self.container.section(SectionKind::LabelOffsets))
        {
            // Two names for one vertex.
            return Err(self.wrong(&offsets, TableError::Order));
        }
        self.both([SectionKind::LabelOffsets, SectionKind::LabelText]).map(|_| ())
    }

    fn check_column(&self, section: &Section<'_>, levels: &Levels) -> Result<(), FormatError> {
        let (vertices, column) = (levels.ids(0).len(), &section.column);
        let vector_len = |rows: usize| rows.checked_mul(section.components as usize);
        let (typed, len) = match section.kind {
            SectionKind::IntegerLabels => (matches!(column, Column::U64(_)), Some(vertices)),
            SectionKind::LabelOffsets => (matches!(column, Column::U64(_)), Some(vertices + 1)),
            SectionKind::LabelText | SectionKind::Provenance => (matches!(column, Column::U8(_)), None),
            SectionKind::Coordinates => (matches!(column, Column::F32(_) | Column::F64(_)), vector_len(vertices)),
            // The (−1)-simplex has no pair.
            SectionKind::Pairs => (levels.dims() > 1, None),
            SectionKind::Parity => (matches!(column, Column::Bits { .. }), None),
            SectionKind::Checksums => (matches!(column, Column::U32(_)), None),
            SectionKind::Filtration => (matches!(column, Column::F64(_)), Some(levels.total())),
            SectionKind::Attribute => (true, section.dim.and_then(|dim| vector_len(levels.ids(dim).len()))),
            _ => (true, None),
        };
        if !typed {
            return Err(self.element_error(section));
        }
        self.check_len(section, len)?;
        let vector = matches!(section.kind, SectionKind::Coordinates | SectionKind::Attribute);
        if section.components != 1 && !vector {
            return Err(self.wrong(section, TableError::Components(section.components)));
        }
        if section.dim.is_some() != (section.kind == SectionKind::Attribute) {
            let dim = section.dim.and_then(|dim| u8::try_from(dim).ok()).unwrap_or(u8::MAX);
            return Err(self.wrong(section, TableError::Dimension(dim)));
        }
        Ok(())
    }
}

/// Whether the ids of `total` simplices are indices of the width.
fn fits<I: Index>(total: usize) -> bool {
    total.checked_sub(1).is_none_or(|last| I::from_usize(last).is_some())
}
