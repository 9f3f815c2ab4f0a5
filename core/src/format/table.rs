//! The section table: where each section lies, and what it is called.

use core::ops::Range;

use super::header::Header;
use super::section::byte_len;
use super::wire::{ByteOrder, get_u16, get_u64, put_u16, put_u64};
use super::{ENTRY_BYTES, HEADER_BYTES, SECTION_ALIGN, TableError};
use crate::id::Dim;

/// The next multiple of [`SECTION_ALIGN`]; `None` past the largest.
pub(super) fn align_up(offset: u64) -> Option<u64> {
    offset.checked_next_multiple_of(SECTION_ALIGN as u64)
}

/// An entry of the section table.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Entry {
    pub(super) code: u16,
    pub(super) element: u8,
    /// The dimension to which the section belongs, or [`WHOLE_COMPLEX`].
    pub(super) dim: u8,
    pub(super) components: u16,
    pub(super) name_len: u16,
    pub(super) offset: u64,
    pub(super) count: u64,
}

/// The dimension code of a section that belongs to the whole complex.
pub(super) const WHOLE_COMPLEX: u8 = 0xFF;

impl Entry {
    const AT_ELEMENT: usize = 2;
    const AT_DIM: usize = 3;
    const AT_COMPONENTS: usize = 4;
    const AT_NAME_LEN: usize = 6;
    const AT_OFFSET: usize = 8;
    const AT_COUNT: usize = 16;

    /// Where the section lies; a range outside the buffer if the entry was not checked.
    pub(super) fn range(&self) -> Range<usize> {
        let length = byte_len(self.element, self.count).unwrap_or(0);
        let start = usize::try_from(self.offset).unwrap_or(usize::MAX);
        start..start.saturating_add(usize::try_from(length).unwrap_or(usize::MAX))
    }

    pub(super) fn dim(&self) -> Option<Dim> {
        (self.dim != WHOLE_COMPLEX).then_some(usize::from(self.dim))
    }

    /// Checks that the section is inside a file with this header, and that its shape is one.
    pub(super) fn check(&self, header: &Header) -> Result<(), TableError> {
        let length = byte_len(self.element, self.count).ok_or(TableError::ElementType(self.element))?;
        if self.dim().is_some_and(|dim| dim >= header.dims) {
            return Err(TableError::Dimension(self.dim));
        }
        if self.components == 0 || !self.count.is_multiple_of(u64::from(self.components)) {
            return Err(TableError::Components(self.components.into()));
        }
        if self.offset.checked_add(length).is_none_or(|end| end > header.file_bytes) {
            return Err(TableError::PastEnd);
        }
        Ok(())
    }

    /// Reads the entry that starts at byte `start`.
    pub(super) fn read(bytes: &[u8], start: usize, order: ByteOrder) -> Self {
        let at = |offset: usize| bytes.get(start + offset).copied().unwrap_or(0);
        Self {
            code: get_u16(bytes, start, order),
            element: at(Self::AT_ELEMENT),
            dim: at(Self::AT_DIM),
            components: get_u16(bytes, start + Self::AT_COMPONENTS, order),
            name_len: get_u16(bytes, start + Self::AT_NAME_LEN, order),
            offset: get_u64(bytes, start + Self::AT_OFFSET, order),
            count: get_u64(bytes, start + Self::AT_COUNT, order),
        }
    }

    /// The entry in the byte order of a file.
    pub(super) fn to_file_bytes(self) -> [u8; ENTRY_BYTES] {
        let order = ByteOrder::Little;
        let mut bytes = [0; ENTRY_BYTES];
        put_u16(&mut bytes, 0, self.code, order);
        bytes[Self::AT_ELEMENT] = self.element;
        bytes[Self::AT_DIM] = self.dim;
        put_u16(&mut bytes, Self::AT_COMPONENTS, self.components, order);
        put_u16(&mut bytes, Self::AT_NAME_LEN, self.name_len, order);
        put_u64(&mut bytes, Self::AT_OFFSET, self.offset, order);
        put_u64(&mut bytes, Self::AT_COUNT, self.count, order);
        bytes
    }

    /// Swaps the entry that starts at byte `start`.
    pub(super) fn swap(bytes: &mut [u8], start: usize, from: ByteOrder, to: ByteOrder) {
        for offset in [start, start + Self::AT_COMPONENTS, start + Self::AT_NAME_LEN] {
            put_u16(bytes, offset, get_u16(bytes, offset, from), to);
        }
        for offset in [start + Self::AT_OFFSET, start + Self::AT_COUNT] {
            put_u64(bytes, offset, get_u64(bytes, offset, from), to);
        }
    }
}

/// Where entry `number` of the table starts.
pub(super) const fn entry_start(number: u32) -> usize {
    HEADER_BYTES + number as usize * ENTRY_BYTES
}

/// The entries of a table, each with its name, in the order of the table; `None` for a name that is not UTF-8, holds a
/// zero, or reaches past the names.
#[derive(Clone, Debug)]
pub(super) struct Entries<'a> {
    bytes: &'a [u8],
    order: ByteOrder,
    next: u32,
    sections: u32,
    /// The names that are left.
    names: &'a [u8],
}

impl<'a> Entries<'a> {
    /// The entries of a table that is inside the buffer.
    pub(super) fn new(bytes: &'a [u8], header: &Header, order: ByteOrder) -> Self {
        let names = entry_start(header.sections)..header.table_bytes();
        let names = bytes.get(names).unwrap_or_default();
        Self { bytes, order, next: 0, sections: header.sections, names }
    }

    /// Whether all entries were read and no name is left over.
    pub(super) fn is_done(&self) -> bool {
        self.next == self.sections && self.names.is_empty()
    }
}

impl<'a> Iterator for Entries<'a> {
    type Item = (Entry, Option<&'a str>);

    fn next(&mut self) -> Option<Self::Item> {
        if self.next == self.sections {
            return None;
        }
        let entry = Entry::read(self.bytes, entry_start(self.next), self.order);
        self.next += 1;
        let name = self.names.split_at_checked(entry.name_len.into()).and_then(|(name, rest)| {
            self.names = rest;
            core::str::from_utf8(name).ok().filter(|name| !name.contains('\0'))
        });
        Some((entry, name))
    }
}
