//! The header and the section table, read and checked without touching a section.

use core::fmt;
use core::ops::Range;

use super::checksum::crc32;
use super::section::byte_len;
use super::wire::{ByteOrder, get_u16, get_u32, get_u64, put_u16, put_u32, put_u64};
use super::{
    BUFFER_ALIGN, Column, ENTRY_BYTES, FormatError, HEADER_BYTES, MAGIC, NAME_BYTES, SECTION_ALIGN, Section,
    SectionKind, TableError, VERSION,
};
use crate::id::{Dim, IndexWidth, MAX_DIM};

/// What a file holds. The numbers are part of the format.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[repr(u8)]
#[non_exhaustive]
pub enum Kind {
    /// A simplicial complex as a Simplified Incidence Graph.
    Sig = 1,
    /// A simplicial complex as a frozen simplex tree: labels and child offsets.
    Tree = 2,
    /// A cell complex as an incidence graph with multiplicities.
    CellComplex = 3,
    /// A multi-resolution cell complex.
    MultiResolution = 4,
}

impl Kind {
    const ALL: [Self; 4] = [Self::Sig, Self::Tree, Self::CellComplex, Self::MultiResolution];
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Sig => "simplicial complex (SIG)",
            Self::Tree => "simplex tree",
            Self::CellComplex => "cell complex",
            Self::MultiResolution => "multi-resolution complex",
        })
    }
}

/// What the header of a file says.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Header {
    /// Major and minor version of the format.
    pub version: (u16, u16),
    /// What the file holds.
    pub kind: Kind,
    /// How wide its indices are.
    pub width: IndexWidth,
    /// The number of dimensions of the complex: its dimension + 1, and 0 for the empty complex.
    pub dims: usize,
    /// The number of simplices, or cells.
    pub num_simplices: u64,
    /// The number of sections.
    pub sections: u32,
    /// Bytes of the file.
    pub file_bytes: u64,
}

/// Where the fields of the header stand.
pub(super) struct RawHeader;

impl RawHeader {
    const MARK: u32 = 0x0A0B_0C0D;
    const AT_MARK: usize = 8;
    const AT_MAJOR: usize = 12;
    const AT_MINOR: usize = 14;
    const AT_KIND: usize = 16;
    const AT_WIDTH: usize = 17;
    const AT_DIMS: usize = 18;
    const AT_FLAGS: usize = 19;
    const AT_SECTIONS: usize = 20;
    const AT_LENGTH: usize = 24;
    const AT_SIMPLICES: usize = 32;
    const AT_CRC: usize = 40;
    const AT_RESERVED: usize = 44;

    /// In which order the buffer is, by its mark.
    pub(super) fn byte_order(bytes: &[u8]) -> Result<ByteOrder, FormatError> {
        let found = bytes.len() as u64;
        if !bytes.starts_with(&MAGIC) {
            let short = !bytes.is_empty() && MAGIC.starts_with(bytes);
            return Err(if short {
                FormatError::Truncated { needed: HEADER_BYTES as u64, found }
            } else {
                FormatError::NotASigFile
            });
        }
        if bytes.len() < HEADER_BYTES {
            return Err(FormatError::Truncated { needed: HEADER_BYTES as u64, found });
        }
        [ByteOrder::Little, ByteOrder::Big]
            .into_iter()
            .find(|&order| get_u32(bytes, Self::AT_MARK, order) == Self::MARK)
            .ok_or(FormatError::Header { offset: Self::AT_MARK })
    }

    /// The header in the byte order of a file, with the checksum of itself and of the table that follows.
    pub(super) fn to_file_bytes(header: &Header, table: impl Iterator<Item = Entry>) -> [u8; HEADER_BYTES] {
        let order = ByteOrder::Little;
        let mut bytes = [0; HEADER_BYTES];
        bytes[..MAGIC.len()].copy_from_slice(&MAGIC);
        put_u32(&mut bytes, Self::AT_MARK, Self::MARK, order);
        put_u16(&mut bytes, Self::AT_MAJOR, header.version.0, order);
        put_u16(&mut bytes, Self::AT_MINOR, header.version.1, order);
        bytes[Self::AT_KIND] = header.kind as u8;
        bytes[Self::AT_WIDTH] = header.width.bytes().to_le_bytes()[0];
        bytes[Self::AT_DIMS] = header.dims.to_le_bytes()[0];
        put_u32(&mut bytes, Self::AT_SECTIONS, header.sections, order);
        put_u64(&mut bytes, Self::AT_LENGTH, header.file_bytes, order);
        put_u64(&mut bytes, Self::AT_SIMPLICES, header.num_simplices, order);
        let crc = table.fold(Self::checksum(&bytes), |crc, entry| crc32(crc, &entry.to_file_bytes()));
        put_u32(&mut bytes, Self::AT_CRC, crc, order);
        bytes
    }

    pub(super) fn swap(bytes: &mut [u8], from: ByteOrder, to: ByteOrder) {
        for offset in [Self::AT_MARK, Self::AT_SECTIONS] {
            put_u32(bytes, offset, get_u32(bytes, offset, from), to);
        }
        for offset in [Self::AT_MAJOR, Self::AT_MINOR] {
            put_u16(bytes, offset, get_u16(bytes, offset, from), to);
        }
        for offset in [Self::AT_LENGTH, Self::AT_SIMPLICES] {
            put_u64(bytes, offset, get_u64(bytes, offset, from), to);
        }
    }

    /// Writes the checksum of the header and the table, the first `length` bytes.
    pub(super) fn seal(bytes: &mut [u8], length: usize, order: ByteOrder) {
        let crc = Self::checksum(bytes.get(..length).unwrap_or_default());
        put_u32(bytes, Self::AT_CRC, crc, order);
    }

    /// The checksum of the header and the table, in which the checksum's own field counts as zero.
    fn checksum(table: &[u8]) -> u32 {
        let before = crc32(0, table.get(..Self::AT_CRC).unwrap_or_default());
        crc32(crc32(before, &[0; 4]), table.get(Self::AT_RESERVED..).unwrap_or_default())
    }
}

/// Bytes of the header and of a table of so many entries.
pub(super) fn table_bytes(sections: u32) -> usize {
    (sections as usize).saturating_mul(ENTRY_BYTES).saturating_add(HEADER_BYTES)
}

/// The next multiple of [`SECTION_ALIGN`]; `None` past the largest.
pub(super) fn align_up(offset: u64) -> Option<u64> {
    offset.checked_next_multiple_of(SECTION_ALIGN as u64)
}

impl Header {
    pub(super) fn parse(bytes: &[u8], order: ByteOrder) -> Result<Self, FormatError> {
        let at = |offset: usize| bytes.get(offset).copied().unwrap_or(0);
        let version = (get_u16(bytes, RawHeader::AT_MAJOR, order), get_u16(bytes, RawHeader::AT_MINOR, order));
        if version.0 != VERSION.0 {
            return Err(FormatError::UnsupportedVersion { major: version.0, minor: version.1 });
        }
        let undefined = |offset| FormatError::Header { offset };
        let kind = Kind::ALL.into_iter().find(|&kind| kind as u8 == at(RawHeader::AT_KIND));
        let width = IndexWidth::ALL.into_iter().find(|width| width.bytes() == usize::from(at(RawHeader::AT_WIDTH)));
        let header = Self {
            version,
            kind: kind.ok_or(undefined(RawHeader::AT_KIND))?,
            width: width.ok_or(undefined(RawHeader::AT_WIDTH))?,
            dims: usize::from(at(RawHeader::AT_DIMS)),
            num_simplices: get_u64(bytes, RawHeader::AT_SIMPLICES, order),
            sections: get_u32(bytes, RawHeader::AT_SECTIONS, order),
            file_bytes: get_u64(bytes, RawHeader::AT_LENGTH, order),
        };
        if header.dims > MAX_DIM + 1 {
            return Err(undefined(RawHeader::AT_DIMS));
        }
        if at(RawHeader::AT_FLAGS) != 0 {
            return Err(undefined(RawHeader::AT_FLAGS));
        }
        if let Some(offset) = (RawHeader::AT_RESERVED..HEADER_BYTES).find(|&offset| at(offset) != 0) {
            return Err(undefined(offset));
        }
        if isize::try_from(header.file_bytes).is_err() {
            return Err(FormatError::TooLarge { length: header.file_bytes });
        }
        let found = bytes.len() as u64;
        if header.file_bytes != found {
            return Err(FormatError::Length { declared: header.file_bytes, found });
        }
        let table = table_bytes(header.sections);
        let table = bytes.get(..table).ok_or(FormatError::Truncated { needed: table as u64, found })?;
        let stored = get_u32(bytes, RawHeader::AT_CRC, order);
        let computed = RawHeader::checksum(table);
        if stored != computed {
            return Err(FormatError::HeaderChecksum { stored, computed });
        }
        Ok(header)
    }
}

/// An entry of the section table.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Entry {
    pub(super) code: u16,
    pub(super) element: u8,
    pub(super) dim: u8,
    pub(super) components: u32,
    pub(super) offset: u64,
    pub(super) count: u64,
    pub(super) name: [u8; NAME_BYTES],
}

/// The dimension code of a section that belongs to the whole complex.
pub(super) const WHOLE_COMPLEX: u8 = 0xFF;

impl Entry {
    const AT_COMPONENTS: usize = 4;
    const AT_OFFSET: usize = 8;
    const AT_COUNT: usize = 16;
    const AT_NAME: usize = 24;

    /// Where the section lies; a range outside the buffer if the entry was not checked.
    pub(super) fn range(&self) -> Range<usize> {
        let length = byte_len(self.element, self.count).unwrap_or(0);
        let start = usize::try_from(self.offset).unwrap_or(usize::MAX);
        start..start.saturating_add(usize::try_from(length).unwrap_or(usize::MAX))
    }

    /// Reads entry `number` of a table that is inside the buffer, and checks that its section is.
    pub(super) fn parse(bytes: &[u8], header: &Header, number: u32, order: ByteOrder) -> Result<Self, FormatError> {
        let entry = Self::read(bytes, number, order);
        let wrong = |error| FormatError::Table { entry: number, error };
        let length = byte_len(entry.element, entry.count).ok_or(wrong(TableError::ElementType(entry.element)))?;
        if entry.dim != WHOLE_COMPLEX && usize::from(entry.dim) >= header.dims {
            return Err(wrong(TableError::Dimension(entry.dim)));
        }
        if entry.components == 0 || !entry.count.is_multiple_of(u64::from(entry.components)) {
            return Err(wrong(TableError::Components(entry.components)));
        }
        if entry.offset.checked_add(length).is_none_or(|end| end > header.file_bytes) {
            return Err(wrong(TableError::PastEnd));
        }
        Ok(entry)
    }

    fn read(bytes: &[u8], number: u32, order: ByteOrder) -> Self {
        let start = HEADER_BYTES + number as usize * ENTRY_BYTES;
        let at = |offset: usize| bytes.get(start + offset).copied().unwrap_or(0);
        let mut name = [0; NAME_BYTES];
        for (offset, byte) in name.iter_mut().enumerate() {
            *byte = at(Self::AT_NAME + offset);
        }
        Self {
            code: get_u16(bytes, start, order),
            element: at(2),
            dim: at(3),
            components: get_u32(bytes, start + Self::AT_COMPONENTS, order),
            offset: get_u64(bytes, start + Self::AT_OFFSET, order),
            count: get_u64(bytes, start + Self::AT_COUNT, order),
            name,
        }
    }

    /// The entry in the byte order of a file.
    pub(super) fn to_file_bytes(self) -> [u8; ENTRY_BYTES] {
        let mut bytes = [0; ENTRY_BYTES];
        put_u16(&mut bytes, 0, self.code, ByteOrder::Little);
        bytes[2] = self.element;
        bytes[3] = self.dim;
        put_u32(&mut bytes, Self::AT_COMPONENTS, self.components, ByteOrder::Little);
        put_u64(&mut bytes, Self::AT_OFFSET, self.offset, ByteOrder::Little);
        put_u64(&mut bytes, Self::AT_COUNT, self.count, ByteOrder::Little);
        bytes[Self::AT_NAME..].copy_from_slice(&self.name);
        bytes
    }

    pub(super) fn swap(bytes: &mut [u8], start: usize, from: ByteOrder, to: ByteOrder) {
        put_u16(bytes, start, get_u16(bytes, start, from), to);
        let components = start + Self::AT_COMPONENTS;
        put_u32(bytes, components, get_u32(bytes, components, from), to);
        for offset in [start + Self::AT_OFFSET, start + Self::AT_COUNT] {
            put_u64(bytes, offset, get_u64(bytes, offset, from), to);
        }
    }

    /// What the sections of a table are ordered by.
    fn order_key(&self) -> (u16, u8, [u8; NAME_BYTES]) {
        (self.code, self.dim, self.name)
    }

    /// The name without its padding; `None` if it is not UTF-8 or goes on after a zero.
    fn name_in<'a>(bytes: &'a [u8], number: u32) -> Option<&'a str> {
        let start = HEADER_BYTES + number as usize * ENTRY_BYTES + Self::AT_NAME;
        let field: &'a [u8] = bytes.get(start..start + NAME_BYTES)?;
        let len = field.iter().position(|&byte| byte == 0).unwrap_or(NAME_BYTES);
        let (name, padding) = field.split_at(len);
        if padding.iter().any(|&byte| byte != 0) { None } else { core::str::from_utf8(name).ok() }
    }
}

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
        let mut end = table_bytes(header.sections) as u64;
        let mut previous = None;
        for number in 0..header.sections {
            let entry = Entry::parse(bytes, &header, number, order)?;
            let wrong = |error| FormatError::Table { entry: number, error };
            let expected = align_up(end).ok_or(wrong(TableError::PastEnd))?;
            if entry.offset != expected {
                return Err(wrong(TableError::Offset { found: entry.offset, expected }));
            }
            end = entry.range().end as u64;
            if previous.replace(entry.order_key()).is_some_and(|key| key >= entry.order_key()) {
                return Err(wrong(TableError::Order));
            }
            let name = Entry::name_in(bytes, number).ok_or(wrong(TableError::Name))?;
            match SectionKind::from_code(entry.code) {
                Some(kind) if name.is_empty() == (kind == SectionKind::Attribute) => {
                    return Err(wrong(TableError::Name));
                }
                None if header.version == VERSION => return Err(wrong(TableError::UnknownKind(entry.code))),
                _ => {}
            }
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
    pub const fn sections(&self) -> Sections<'a> {
        Sections { container: *self, next: 0 }
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
        self.entries(order).map(|entry| (SectionKind::from_code(entry.code), dim_of(entry.dim), entry.range()))
    }

    /// Checks that the bytes between the sections are zero.
    pub(super) fn check_padding(&self, order: ByteOrder) -> Result<(), FormatError> {
        let mut end = table_bytes(self.header.sections);
        for range in self.entries(order).map(|entry| entry.range()) {
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

    fn entries(&self, order: ByteOrder) -> impl Iterator<Item = Entry> + use<'a> {
        let bytes = self.bytes;
        (0..self.header.sections).map(move |number| Entry::read(bytes, number, order))
    }

    fn read_section(&self, number: u32) -> Option<Section<'a>> {
        let entry = Entry::read(self.bytes, number, ByteOrder::NATIVE);
        let len = usize::try_from(entry.count).ok()?;
        Some(Section {
            kind: SectionKind::from_code(entry.code)?,
            dim: dim_of(entry.dim),
            name: Entry::name_in(self.bytes, number)?,
            components: entry.components,
            column: Column::from_parts(entry.element, len, self.bytes.get(entry.range())?)?,
        })
    }
}

fn dim_of(code: u8) -> Option<Dim> {
    (code != WHOLE_COMPLEX).then_some(usize::from(code))
}

/// The sections of a container: see [`Container::sections`].
#[derive(Clone, Debug)]
pub struct Sections<'a> {
    container: Container<'a>,
    next: u32,
}

impl<'a> Iterator for Sections<'a> {
    type Item = Section<'a>;

    fn next(&mut self) -> Option<Self::Item> {
        while self.next < self.container.header.sections {
            let number = self.next;
            self.next += 1;
            if let Some(section) = self.container.read_section(number) {
                return Some(section);
            }
        }
        None
    }
}

impl core::iter::FusedIterator for Sections<'_> {}
