//! Opening a complex: which sections it takes, and how their lengths depend on one another.

use super::{Complex, Levels, TreeSections};
use crate::format::{Column, Container, FormatError, Kind, Rule, Section, SectionKind, TableError};
use crate::id::Index;

impl<'a, I: Index> Complex<'a, I> {
    /// Opens the complex in `bytes`, which are in the host's byte order and aligned to
    /// [`BUFFER_ALIGN`](crate::format::BUFFER_ALIGN) bytes.
    ///
    /// Checks the container ([`Container::from_bytes`]), the lookup table, and that each section has the type and the
    /// length that follow from the numbers of simplices. It does not look into the arrays: that is what
    /// [`validate`](Self::validate) does. On what it accepts, every query ends without a panic.
    ///
    /// Cost: O(number of sections), the same for any number of simplices.
    ///
    /// # Errors
    /// [`FormatError`]: what is wrong, and where. Never a panic, whatever the bytes.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, FormatError> {
        Self::from_container(Container::from_bytes(bytes)?)
    }

    /// Opens the complex in a container.
    ///
    /// # Errors
    /// As [`from_bytes`](Self::from_bytes).
    pub fn from_container(container: Container<'a>) -> Result<Self, FormatError> {
        let header = container.header();
        if header.kind != Kind::Sig {
            return Err(FormatError::WrongKind { found: header.kind, expected: Kind::Sig });
        }
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

        let sections = Sections { container: &container };
        let lookup = sections.indices::<I>(SectionKind::Lookup, Some(header.dims))?;
        let levels = Levels::new(lookup, total).map_err(first_ids)?;
        let pointers = levels.num_pointers();
        let complex = Self {
            container,
            levels,
            boundary: sections.indices(SectionKind::Boundary, Some(levels.num_boundary()))?,
            pointers: sections.indices(SectionKind::Pointers, Some(pointers))?,
            lists: sections.indices(SectionKind::Lists, None)?,
            flags: sections.bits(SectionKind::Flags, pointers)?,
            tree: sections.tree(&levels)?,
        };
        sections.check_columns(&levels)?;
        Ok(complex)
    }
}

/// Whether the ids of `total` simplices are indices of the width.
fn fits<I: Index>(total: usize) -> bool {
    total.checked_sub(1).is_none_or(|last| I::from_usize(last).is_some())
}

/// Sections by kind, with the shapes that the format asks for.
struct Sections<'c, 'a> {
    container: &'c Container<'a>,
}

impl<'a> Sections<'_, 'a> {
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

    fn indices<I: Index>(&self, kind: SectionKind, len: Option<usize>) -> Result<&'a [I], FormatError> {
        self.as_indices(&self.required(kind)?, len)
    }

    fn as_indices<I: Index>(&self, section: &Section<'a>, len: Option<usize>) -> Result<&'a [I], FormatError> {
        let typed =
            core::mem::discriminant(&section.column) == core::mem::discriminant(&Column::from_indices::<I>(&[]));
        let indices = bytemuck::try_cast_slice(section.column.as_bytes()).ok().filter(|_| typed);
        let indices = indices.ok_or_else(|| self.element_error(section))?;
        self.check_len(section, len)?;
        Ok(indices)
    }

    fn bits(&self, kind: SectionKind, len: usize) -> Result<&'a [u8], FormatError> {
        let section = self.required(kind)?;
        let Column::Bits { bytes, .. } = section.column else { return Err(self.element_error(&section)) };
        self.check_len(&section, Some(len))?;
        Ok(bytes)
    }

    fn tree<I: Index>(&self, levels: &Levels) -> Result<Option<TreeSections<'a, I>>, FormatError> {
        let offsets = self.container.section(SectionKind::ChildOffsets);
        let last = self.container.section(SectionKind::LastVertices);
        let (offsets, last) = match (offsets, last) {
            (Some(offsets), Some(last)) => (offsets, last),
            (None, None) => return Ok(None),
            (None, _) => return Err(FormatError::MissingSection(SectionKind::ChildOffsets)),
            (_, None) => return Err(FormatError::MissingSection(SectionKind::LastVertices)),
        };
        let num_offsets = if levels.dims() == 0 { 0 } else { levels.num_pointers() + 1 };
        let child_offsets = self.as_indices(&offsets, Some(num_offsets))?;
        if !matches!(last.column, Column::U16(_) | Column::U32(_) | Column::U64(_)) {
            return Err(self.element_error(&last));
        }
        self.check_len(&last, Some(levels.total()))?;
        Ok(Some(TreeSections { child_offsets, last_vertices: last.column }))
    }

    /// The shapes of the sections that no query depends on.
    fn check_columns(&self, levels: &Levels) -> Result<(), FormatError> {
        for section in self.container.sections() {
            let (vertices, column) = (levels.ids(0).len(), &section.column);
            let vector_len = |rows: usize| rows.checked_mul(section.components as usize);
            let (typed, len) = match section.kind {
                SectionKind::IntegerLabels => (matches!(column, Column::U64(_)), Some(vertices)),
                SectionKind::LabelOffsets => (matches!(column, Column::U64(_)), Some(vertices + 1)),
                SectionKind::LabelText | SectionKind::Provenance => (matches!(column, Column::U8(_)), None),
                SectionKind::Coordinates => (matches!(column, Column::F32(_) | Column::F64(_)), vector_len(vertices)),
                SectionKind::Parity => (matches!(column, Column::Bits { .. }), None),
                SectionKind::Checksums => (matches!(column, Column::U32(_)), None),
                SectionKind::Filtration => (matches!(column, Column::F64(_)), Some(levels.total())),
                SectionKind::Attribute => (true, section.dim.and_then(|dim| vector_len(levels.ids(dim).len()))),
                _ => (true, None),
            };
            if !typed {
                return Err(self.element_error(&section));
            }
            self.check_len(&section, len)?;
            let vector = matches!(section.kind, SectionKind::Coordinates | SectionKind::Attribute);
            if section.components != 1 && !vector {
                return Err(self.wrong(&section, TableError::Components(section.components)));
            }
            if section.dim.is_some() != (section.kind == SectionKind::Attribute) {
                let dim = section.dim.and_then(|dim| u8::try_from(dim).ok()).unwrap_or(u8::MAX);
                return Err(self.wrong(&section, TableError::Dimension(dim)));
            }
        }
        let has = |kind| self.container.section(kind).is_some();
        if let (Some(_), Some(offsets)) =
            (self.container.section(SectionKind::IntegerLabels), self.container.section(SectionKind::LabelOffsets))
        {
            // Two names for one vertex.
            return Err(self.wrong(&offsets, TableError::Order));
        }
        if has(SectionKind::LabelText) != has(SectionKind::LabelOffsets) {
            let text = has(SectionKind::LabelText);
            let missing = if text { SectionKind::LabelOffsets } else { SectionKind::LabelText };
            return Err(FormatError::MissingSection(missing));
        }
        Ok(())
    }
}
