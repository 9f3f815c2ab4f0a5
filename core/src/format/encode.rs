//! From a header and sections to the bytes of a file.

use core::fmt;
use core::ops::Range;

use super::checksum::{CHECKSUM_BLOCK_BYTES, crc32, num_blocks};
use super::header::{Header, Kind, RawHeader};
use super::section::{byte_len, element_bytes};
use super::table::{Entry, WHOLE_COMPLEX, align_up};
use super::wire::ByteOrder;
use super::{Column, SECTION_ALIGN, Section, SectionKind, VERSION};
use crate::id::{IndexWidth, MAX_DIM};

/// Why sections cannot be encoded.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum EncodeError {
    /// The buffer is too small.
    TooSmall {
        /// Bytes that the file takes.
        needed: u64,
        /// Bytes that the buffer has.
        available: u64,
    },
    /// The file would be longer than 2⁶³ − 1 bytes, or have 2³² sections or more.
    TooLarge,
    /// The dimension is more than [`MAX_DIM`].
    Dimension,
    /// The sections are not in strictly increasing order of (kind, dimension, name), or the checksums are among them.
    Order {
        /// The first section out of order.
        section: SectionKind,
    },
    /// An attribute has no name, another section has one, or a name is longer than 65,535 bytes or holds a zero.
    Name {
        /// The section.
        section: SectionKind,
    },
    /// The number of components is zero, more than 65,535, or does not divide the number of elements, the dimension is not one of the
    /// complex, or the bytes of a column of bits are not as many as the bits take.
    Shape {
        /// The section.
        section: SectionKind,
    },
}

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::TooSmall { needed, available } => write!(f, "{needed} bytes needed, {available} available"),
            Self::TooLarge => f.write_str("more bytes or sections than a file can have"),
            Self::Dimension => write!(f, "a dimension of more than {MAX_DIM}"),
            Self::Order { section } => write!(f, "section '{section}' is out of order"),
            Self::Name { section } => write!(f, "section '{section}': bad name"),
            Self::Shape { section } => write!(f, "section '{section}': components, dimension or bytes do not fit"),
        }
    }
}

impl core::error::Error for EncodeError {}

/// Encodes sections as a file: the same sections, the same bytes, on every host.
///
/// The encoder is given what [`Container::sections`](super::Container::sections) gives back; it does not check that it
/// is a complex.
#[derive(Clone, Copy, Debug)]
pub struct Encoder<'a> {
    header: Header,
    sections: &'a [Section<'a>],
    checksums: bool,
}

impl<'a> Encoder<'a> {
    /// An encoder of `sections`, in increasing order of (kind, dimension, name), without [`SectionKind::Checksums`].
    /// The complex has `num_simplices` simplices of `dims` dimensions; its indices have `width`.
    ///
    /// # Errors
    /// [`EncodeError`], if the sections cannot be a file.
    pub fn new(
        kind: Kind,
        width: IndexWidth,
        dims: usize,
        num_simplices: u64,
        sections: &'a [Section<'a>],
    ) -> Result<Self, EncodeError> {
        let header =
            Header { version: VERSION, kind, width, dims, num_simplices, sections: 0, name_bytes: 0, file_bytes: 0 };
        Self { header, sections, checksums: false }.laid_out()
    }

    /// The same file with checksums: one for each block of [`CHECKSUM_BLOCK_BYTES`](super::CHECKSUM_BLOCK_BYTES) of a
    /// section, and one of the checksums.
    ///
    /// # Errors
    /// [`EncodeError::TooLarge`].
    pub fn with_checksums(self) -> Result<Self, EncodeError> {
        Self { checksums: true, ..self }.laid_out()
    }

    /// Checks the sections and fills in the number of them and the length of the file.
    fn laid_out(mut self) -> Result<Self, EncodeError> {
        if self.header.dims > MAX_DIM + 1 {
            return Err(EncodeError::Dimension);
        }
        let mut previous = None;
        for section in self.sections {
            let kind = section.kind;
            let key = (kind.code(), section.dim.unwrap_or(usize::from(WHOLE_COMPLEX)), section.name);
            if kind == SectionKind::Checksums || previous.replace(key).is_some_and(|before| before >= key) {
                return Err(EncodeError::Order { section: kind });
            }
            let named = kind == SectionKind::Attribute;
            if section.name.is_empty() == named || name_len(section).is_none() || section.name.contains('\0') {
                return Err(EncodeError::Name { section: kind });
            }
            let components = section.components as usize;
            let rows = components > 0 && components_code(section).is_some() && section.column.len() % components == 0;
            let ragged = matches!(section.column, Column::Bits { bytes, len } if bytes.len() != len.div_ceil(8));
            if ragged || !rows || section.dim.is_some_and(|dim| dim >= self.header.dims) {
                return Err(EncodeError::Shape { section: kind });
            }
        }
        self.header.sections =
            u32::try_from(self.sections.len() + usize::from(self.checksums)).map_err(|_| EncodeError::TooLarge)?;
        let names: u64 = self.sections.iter().map(|section| section.name.len() as u64).sum();
        self.header.name_bytes = u32::try_from(names).map_err(|_| EncodeError::TooLarge)?;
        let mut end = self.header.table_bytes() as u64;
        for entry in self.entries() {
            let length = byte_len(entry.element, entry.count).ok_or(EncodeError::TooLarge)?;
            end = align_up(end).and_then(|start| start.checked_add(length)).ok_or(EncodeError::TooLarge)?;
        }
        self.header.file_bytes =
            align_up(end).filter(|&length| i64::try_from(length).is_ok()).ok_or(EncodeError::TooLarge)?;
        Ok(self)
    }

    /// Bytes of the file.
    #[must_use]
    pub const fn file_bytes(&self) -> u64 {
        self.header.file_bytes
    }

    /// The sections before the checksums, and those after them.
    fn parts(&self) -> [&'a [Section<'a>]; 2] {
        let before = self.sections.partition_point(|section| section.kind < SectionKind::Checksums);
        self.sections.split_at_checked(before).map_or([self.sections, &[]], |(before, after)| [before, after])
    }

    /// The entries of the table, each with its offset.
    fn entries(&self) -> impl Iterator<Item = Entry> + use<'a> {
        let blocks: u64 = self.sections.iter().map(|section| num_blocks(section.column.as_bytes().len() as u64)).sum();
        let checksums = self.checksums.then_some(Entry {
            code: SectionKind::Checksums.code(),
            element: Column::U32(&[]).element_code(),
            dim: WHOLE_COMPLEX,
            components: 1,
            offset: 0,
            count: blocks + 1,
            name_len: 0,
        });
        let mut end = self.header.table_bytes() as u64;
        let [before, after] = self.parts();
        let entries = before.iter().map(unplaced_entry).chain(checksums).chain(after.iter().map(unplaced_entry));
        entries.map(move |entry| {
            let offset = align_up(end).unwrap_or(u64::MAX);
            end = offset.saturating_add(byte_len(entry.element, entry.count).unwrap_or(u64::MAX));
            Entry { offset, ..entry }
        })
    }

    /// The sections in the order of the file, the checksums among them, and the bytes of the file that each takes.
    pub fn places(&self) -> impl Iterator<Item = (SectionKind, Range<u64>)> + use<'a> {
        self.entries().filter_map(|entry| {
            let kind = SectionKind::from_code(entry.code)?;
            Some((kind, entry.offset..entry.offset.saturating_add(byte_len(entry.element, entry.count)?)))
        })
    }

    /// Writes the file at the start of `out` and returns its length.
    ///
    /// # Errors
    /// [`EncodeError::TooSmall`], with the length that is needed; `out` is then unchanged.
    pub fn encode(&self, out: &mut [u8]) -> Result<usize, EncodeError> {
        let available = out.len() as u64;
        let too_small = EncodeError::TooSmall { needed: self.file_bytes(), available };
        if available < self.file_bytes() {
            return Err(too_small);
        }
        let mut written = 0;
        self.write_with(crc32, |piece| {
            let target = out.get_mut(written..).and_then(|tail| tail.get_mut(..piece.len())).ok_or(too_small)?;
            target.copy_from_slice(piece);
            written += piece.len();
            Ok(())
        })?;
        Ok(written)
    }

    /// Hands the bytes of the file to `sink`, piece by piece, in order; `crc(before, bytes)` is a CRC-32 as
    /// [`crc32`](super::crc32), perhaps a faster one.
    ///
    /// # Errors
    /// The first error of `sink`.
    pub fn write_with<E>(
        &self,
        crc: impl Fn(u32, &[u8]) -> u32,
        mut sink: impl FnMut(&[u8]) -> Result<(), E>,
    ) -> Result<(), E> {
        self.write_header(&mut sink)?;
        let [before, after] = self.parts();
        before.iter().try_for_each(|section| write_section(section, &mut sink))?;
        if self.checksums {
            self.write_checksums(crc, &mut sink)?;
        }
        after.iter().try_for_each(|section| write_section(section, &mut sink))
    }

    /// Hands the bytes before the first section to `sink`, piece by piece, in order.
    ///
    /// # Errors
    /// The first error of `sink`.
    pub fn write_header<E>(&self, mut sink: impl FnMut(&[u8]) -> Result<(), E>) -> Result<(), E> {
        let names = || self.sections.iter().map(|section| section.name.as_bytes());
        let mut header = RawHeader::to_file_bytes(&self.header);
        let checksum =
            self.entries().fold(RawHeader::checksum(&header), |before, entry| crc32(before, &entry.to_file_bytes()));
        RawHeader::seal(&mut header, names().fold(checksum, crc32), ByteOrder::Little);
        sink(&header)?;
        self.entries().try_for_each(|entry| sink(&entry.to_file_bytes()))?;
        names().filter(|name| !name.is_empty()).try_for_each(&mut sink)?;
        pad(self.header.table_bytes(), &mut sink)
    }

    fn write_checksums<E>(
        &self,
        crc: impl Fn(u32, &[u8]) -> u32,
        mut sink: impl FnMut(&[u8]) -> Result<(), E>,
    ) -> Result<(), E> {
        let (mut total, mut written) = (0, 0);
        for section in self.sections {
            for block in section.column.as_bytes().chunks(CHECKSUM_BLOCK_BYTES) {
                let mut checksum = 0;
                little_endian(&section.column, block, |piece| {
                    checksum = crc(checksum, piece);
                    Ok::<(), E>(())
                })?;
                let encoded = checksum.to_le_bytes();
                total = crc(total, &encoded);
                written += encoded.len();
                sink(&encoded)?;
            }
        }
        sink(&total.to_le_bytes())?;
        pad(written + 4, &mut sink)
    }
}

fn write_section<E>(section: &Section<'_>, sink: &mut impl FnMut(&[u8]) -> Result<(), E>) -> Result<(), E> {
    little_endian(&section.column, section.column.as_bytes(), &mut *sink)?;
    pad(section.column.as_bytes().len(), sink)
}

fn name_len(section: &Section<'_>) -> Option<u16> {
    u16::try_from(section.name.len()).ok()
}

fn components_code(section: &Section<'_>) -> Option<u16> {
    u16::try_from(section.components).ok()
}

/// The entry of a section that was checked, still without its place.
fn unplaced_entry(section: &Section<'_>) -> Entry {
    Entry {
        code: section.kind.code(),
        element: section.column.element_code(),
        dim: section.dim.and_then(|dim| u8::try_from(dim).ok()).unwrap_or(WHOLE_COMPLEX),
        components: components_code(section).unwrap_or(0),
        name_len: name_len(section).unwrap_or(0),
        offset: 0,
        count: section.column.len() as u64,
    }
}

/// Zeros after `length` bytes, up to the next section.
fn pad<E>(length: usize, sink: &mut impl FnMut(&[u8]) -> Result<(), E>) -> Result<(), E> {
    let padding = length.next_multiple_of(SECTION_ALIGN) - length;
    if padding == 0 { Ok(()) } else { sink([0; SECTION_ALIGN].get(..padding).unwrap_or_default()) }
}

/// Hands `bytes`, whole elements of `column`, to `sink` in the byte order of a file.
fn little_endian<E>(column: &Column<'_>, bytes: &[u8], mut sink: impl FnMut(&[u8]) -> Result<(), E>) -> Result<(), E> {
    let size = element_bytes(column.element_code()).unwrap_or(1);
    if size == 1 || ByteOrder::NATIVE == ByteOrder::Little {
        return if bytes.is_empty() { Ok(()) } else { sink(bytes) };
    }
    let mut buffer = [0; 512];
    for piece in bytes.chunks(buffer.len()) {
        let Some(swapped) = buffer.get_mut(..piece.len()) else { continue };
        swapped.copy_from_slice(piece);
        for element in swapped.chunks_exact_mut(size) {
            element.reverse();
        }
        sink(swapped)?;
    }
    Ok(())
}
