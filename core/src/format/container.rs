//! A whole file: its header and its section table, checked without touching a section.

use core::ops::Range;

use super::header::{Header, RawHeader};
use super::table::{Entries, align_up};
use super::wire::ByteOrder;
use super::{BUFFER_ALIGN, Column, FormatError, Section, SectionKind, TableError, VERSION};
use crate::id::Dim;

/// A file of any kind, of which the header and the section table are known to be sound.
///
/// `Copy`: two words and the header. What the sections hold is not checked; see [`crate::Complex`] for a view.
#[derive(Clone, Copy, Debug)]
pub struct Container<'a> {
    bytes: &'a [u8],
    header: Header,
}

impl<'a> Container<'a> {
    /// Opens a file that lies in `bytes`, in the host's byte order and aligned to
    /// [`BUFFER_ALIGN`](super::BUFFER_ALIGN) bytes.
    ///
    /// Checks the header and every entry of the section table: values that the format defines, the checksum of both,
    /// sections in order, one after the other, inside the buffer. Reads no section. Sections of unknown kind are an
    /// error in a file of this version, and passed over in one of a newer minor version.
    ///
    /// Cost: O(number of sections), whatever the length of the buffer.
    ///
    /// # Errors
    /// [`FormatError`]: which field is wrong, and where. Never a panic, whatever the bytes.
    pub fn from_bytes(bytes: &'a [u8]) -> Result<Self, FormatError> {
        if RawHeader::byte_order(bytes)? != ByteOrder::NATIVE {
            return Err(FormatError::ForeignByteOrder);
        }
        // Alignment matters from here on only: a foreign file is told as such first.
        if bytes.as_ptr().align_offset(BUFFER_ALIGN) != 0 {
            return Err(FormatError::Misaligned);
        }
        Self::parse(bytes, ByteOrder::NATIVE)
    }

    /// Opens a file as it lies on disk, for the checks that work on bytes alone: its columns cannot be read on a
    /// host of the other order.
    pub(super) fn parse_file(bytes: &'a [u8]) -> Result<Self, FormatError> {
        RawHeader::byte_order(bytes)?;
        Self::parse(bytes, ByteOrder::Little)
    }

    /// Checks header and table in either byte order.
    pub(super) fn parse(bytes: &'a [u8], order: ByteOrder) -> Result<Self, FormatError> {
        let header = Header::parse(bytes, order)?;
        let mut end = header.table_bytes() as u64;
        let mut previous = None;
        let mut entries = Entries::new(bytes, &header, order);
        for (number, (entry, name)) in (0..).zip(entries.by_ref()) {
            let wrong = |error| FormatError::Table { entry: number, error };
            entry.check(&header).map_err(wrong)?;
            let expected = align_up(end).ok_or(wrong(TableError::PastEnd))?;
            if entry.offset != expected {
                return Err(wrong(TableError::Offset { found: entry.offset, expected }));
            }
            end = entry.range().end as u64;
            let name = name.ok_or(wrong(TableError::Name))?;
            let key = (entry.code, entry.dim, name);
            if previous.replace(key).is_some_and(|before| before >= key) {
                return Err(wrong(TableError::Order));
            }
            match SectionKind::from_code(entry.code) {
                Some(kind) if name.is_empty() == (kind == SectionKind::Attribute) => {
                    return Err(wrong(TableError::Name));
                }
                None if header.version == VERSION => return Err(wrong(TableError::UnknownKind(entry.code))),
                _ => {}
            }
        }
        if !entries.is_done() {
            return Err(FormatError::Table { entry: header.sections, error: TableError::Name });
        }
        if align_up(end) != Some(header.file_bytes) {
            return Err(FormatError::Length { declared: header.file_bytes, found: align_up(end).unwrap_or(u64::MAX) });
        }
        Ok(Self { bytes, header })
    }

    /// What the header says.
    #[must_use]
    pub const fn header(&self) -> &Header {
        &self.header
    }

    /// The buffer.
    #[must_use]
    pub const fn bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// The sections of known kinds, in the order of the table.
    #[must_use]
    pub fn sections(&self) -> Sections<'a> {
        Sections { bytes: self.bytes, entries: self.entries(ByteOrder::NATIVE) }
    }

    /// The first section of a kind.
    #[must_use]
    pub fn section(&self, kind: SectionKind) -> Option<Section<'a>> {
        self.sections().find(|section| section.kind == kind)
    }

    /// Where the sections of known kinds lie in the file, in the order of the table.
    pub fn spans(&self) -> impl Iterator<Item = (SectionKind, Option<Dim>, Range<usize>)> + use<'a> {
        self.spans_in(ByteOrder::NATIVE)
    }

    pub(super) fn spans_in(
        &self,
        order: ByteOrder,
    ) -> impl Iterator<Item = (SectionKind, Option<Dim>, Range<usize>)> + use<'a> {
        self.all_spans_in(order).filter_map(|(kind, dim, range)| Some((kind?, dim, range)))
    }

    /// The same with the sections of unknown kinds.
    pub(super) fn all_spans_in(
        &self,
        order: ByteOrder,
    ) -> impl Iterator<Item = (Option<SectionKind>, Option<Dim>, Range<usize>)> + use<'a> {
        self.entries(order).map(|(entry, _)| (SectionKind::from_code(entry.code), entry.dim(), entry.range()))
    }

    /// Checks that the bytes between the sections are zero.
    pub(super) fn check_padding(&self, order: ByteOrder) -> Result<(), FormatError> {
        let mut end = self.header.table_bytes();
        for range in self.entries(order).map(|(entry, _)| entry.range()) {
            self.check_zero(end..range.start)?;
            end = range.end;
        }
        self.check_zero(end..self.bytes.len())
    }

    fn check_zero(&self, range: Range<usize>) -> Result<(), FormatError> {
        let gap = self.bytes.get(range.clone()).unwrap_or_default();
        match gap.iter().position(|&byte| byte != 0) {
            Some(at) => Err(FormatError::Padding { offset: (range.start + at) as u64 }),
            None => Ok(()),
        }
    }

    pub(super) fn entries(&self, order: ByteOrder) -> Entries<'a> {
        Entries::new(self.bytes, &self.header, order)
    }
}

/// The sections of a container: see [`Container::sections`].
#[derive(Clone, Debug)]
pub struct Sections<'a> {
    bytes: &'a [u8],
    entries: Entries<'a>,
}

impl<'a> Iterator for Sections<'a> {
    type Item = Section<'a>;

    fn next(&mut self) -> Option<Self::Item> {
        let bytes = self.bytes;
        self.entries.find_map(|(entry, name)| {
            let len = usize::try_from(entry.count).ok()?;
            Some(Section {
                kind: SectionKind::from_code(entry.code)?,
                dim: entry.dim(),
                name: name?,
                components: entry.components.into(),
                column: Column::from_parts(entry.element, len, bytes.get(entry.range())?)?,
            })
        })
    }
}

impl core::iter::FusedIterator for Sections<'_> {}
