//! Checksums of the sections, block by block, so that damage is located and blocks can be checked in parallel.

use core::ops::Range;

use super::container::Container;
use super::wire::{ByteOrder, get_u32};
use super::{FormatError, SectionKind};
use crate::id::Dim;

/// Bytes that one checksum covers; the last block of a section is shorter. Blocks do not cross sections.
pub const CHECKSUM_BLOCK_BYTES: usize = 1 << 22;

const TABLE: [u32; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut crc = byte;
        let mut bit = 0;
        while bit < 8 {
            crc = if crc & 1 == 1 { 0xEDB8_8320 ^ (crc >> 1) } else { crc >> 1 };
            bit += 1;
        }
        table[byte as usize] = crc;
        byte += 1;
    }
    table
};

/// The CRC-32 (IEEE 802.3, as in zlib) of bytes that follow others, whose CRC-32 is `before`; 0 if there are none.
///
/// One table look-up a byte: small rather than fast. [`verify_with`] and [`Encoder`](super::Encoder) take a faster one.
#[must_use]
pub fn crc32(before: u32, bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!before, |crc, &byte| {
        let [low, ..] = crc.to_le_bytes();
        TABLE.get(usize::from(low ^ byte)).copied().unwrap_or(0) ^ (crc >> 8)
    })
}

/// The number of blocks of a section of so many bytes.
pub(super) const fn num_blocks(section_bytes: u64) -> u64 {
    section_bytes.div_ceil(CHECKSUM_BLOCK_BYTES as u64)
}

/// A block of a section and the checksum that the file has for it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct ChecksumBlock<'a> {
    /// The section.
    pub section: SectionKind,
    /// The dimension to which the section belongs, where it belongs to one.
    pub dim: Option<Dim>,
    /// Where the block starts in the file.
    pub offset: usize,
    /// The bytes of the block.
    pub bytes: &'a [u8],
    /// The checksum that the file has for it.
    pub stored: u32,
}

impl ChecksumBlock<'_> {
    /// Compares the checksum of the bytes, by `crc`, with the stored one.
    ///
    /// # Errors
    /// [`FormatError::Checksum`] if they differ.
    pub fn check(&self, crc: impl FnOnce(u32, &[u8]) -> u32) -> Result<(), FormatError> {
        if crc(0, self.bytes) == self.stored { Ok(()) } else { Err(self.damaged()) }
    }

    fn damaged(&self) -> FormatError {
        let (offset, length) = (self.offset as u64, self.bytes.len() as u64);
        FormatError::Checksum { section: self.section, dim: self.dim, offset, length }
    }
}

/// The blocks of a file that has checksums, in the order of the file.
#[derive(Clone, Debug)]
pub struct Blocks<'a> {
    container: Container<'a>,
    checksums: Range<usize>,
}

impl<'a> Blocks<'a> {
    /// The blocks of a file as it lies on disk (little-endian on every host).
    ///
    /// The header, the table, the padding and the checksums themselves have been checked when this returns.
    ///
    /// # Errors
    /// What [`Container::from_bytes`] says, [`FormatError::Padding`], and [`FormatError::NoChecksums`] if the file has
    /// none.
    pub fn of_file(bytes: &'a [u8]) -> Result<Self, FormatError> {
        let container = Container::parse_file(bytes)?;
        container.check_padding(ByteOrder::Little)?;
        let spans = || container.spans_in(ByteOrder::Little);
        let (_, _, checksums) =
            spans().find(|(kind, ..)| *kind == SectionKind::Checksums).ok_or(FormatError::NoChecksums)?;
        let blocks = Self { container, checksums };
        let expected = blocks.sections().map(|(_, _, range)| num_blocks(range.len() as u64)).sum::<u64>() * 4 + 4;
        let stored_at = blocks.checksums.end.wrapping_sub(4);
        let block = ChecksumBlock {
            section: SectionKind::Checksums,
            dim: None,
            offset: blocks.checksums.start,
            bytes: bytes.get(blocks.checksums.start..stored_at).unwrap_or_default(),
            stored: get_u32(bytes, stored_at, ByteOrder::Little),
        };
        if blocks.checksums.len() as u64 != expected {
            return Err(block.damaged());
        }
        block.check(crc32)?;
        Ok(blocks)
    }

    /// The sections that have checksums; a file of a newer minor version may have some of unknown kinds.
    fn sections(&self) -> impl Iterator<Item = (Option<SectionKind>, Option<Dim>, Range<usize>)> + use<'a> {
        self.container.all_spans_in(ByteOrder::Little).filter(|(kind, ..)| *kind != Some(SectionKind::Checksums))
    }

    /// The blocks of the sections of known kinds, in the order of the file.
    pub fn iter(&self) -> impl Iterator<Item = ChecksumBlock<'a>> + use<'a> {
        let bytes = self.container.bytes();
        let checksums = self.checksums.start;
        self.sections()
            .flat_map(|(section, dim, range)| {
                range.clone().step_by(CHECKSUM_BLOCK_BYTES).map(move |start| {
                    let end = range.end.min(start.saturating_add(CHECKSUM_BLOCK_BYTES));
                    (section, dim, start..end)
                })
            })
            .enumerate()
            .filter_map(move |(number, (section, dim, range))| {
                Some(ChecksumBlock {
                    section: section?,
                    dim,
                    offset: range.start,
                    bytes: bytes.get(range).unwrap_or_default(),
                    stored: get_u32(bytes, checksums + 4 * number, ByteOrder::Little),
                })
            })
    }
}

/// Checks every byte of a file against its checksums: header, table, padding and sections. The file is taken as it lies
/// on disk, little-endian on every host.
///
/// Finds every change of a single bit, and says in which section. It passes over sections of unknown kinds in a file of a
/// newer minor version. It does not check that the contents are a complex: see
/// [`Complex::validate`](crate::Complex::validate). Cost: one pass, with [`crc32`].
///
/// # Errors
/// The first thing that is wrong, and where; [`FormatError::NoChecksums`] if the file has none.
pub fn verify(bytes: &[u8]) -> Result<(), FormatError> {
    verify_with(bytes, crc32)
}

/// [`verify`] with another implementation of the CRC-32: `crc(before, bytes)` as [`crc32`].
///
/// # Errors
/// As [`verify`].
pub fn verify_with(bytes: &[u8], crc: impl Fn(u32, &[u8]) -> u32) -> Result<(), FormatError> {
    Blocks::of_file(bytes)?.iter().try_for_each(|block| block.check(&crc))
}
