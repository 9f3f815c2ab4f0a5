//! Opening a complex: which sections it takes, and how their lengths depend on one another.

use super::{Complex, Sections};
use crate::format::{Container, FormatError, Kind, SectionKind};
use crate::id::Index;
use crate::tree::Tree;

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
        let found = container.header().kind;
        if found != Kind::Sig {
            return Err(FormatError::WrongKind { found, expected: Kind::Sig });
        }
        let sections = Sections { container: &container };
        let levels = sections.levels::<I>()?;
        let pairs = sections.optional_indices(SectionKind::Pairs, levels.num_pairs())?;
        let pointers = if pairs.is_some() { levels.flags_end() } else { levels.num_pointers() };
        let boundary = sections.indices(SectionKind::Boundary, Some(levels.num_boundary()))?;
        let has_tree = sections.both([SectionKind::ChildOffsets, SectionKind::LastVertices])?;
        if !has_tree && sections.both([SectionKind::LowerOffsets, SectionKind::LowerNeighbours])? {
            // Of no use without the tree that they speak of.
            return Err(FormatError::MissingSection(SectionKind::ChildOffsets));
        }
        let complex = Self {
            container,
            levels,
            boundary,
            pointers: sections.indices(SectionKind::Pointers, Some(pointers))?,
            lists: sections.indices(SectionKind::Lists, None)?,
            flags: sections.bits(SectionKind::Flags, pointers)?,
            pairs,
            tree: if has_tree { Some(Tree::from_sections(&sections, levels, boundary)?) } else { None },
        };
        sections.check_columns(&levels)?;
        Ok(complex)
    }
}
