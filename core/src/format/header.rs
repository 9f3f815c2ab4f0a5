//! The header: what a file is, and how long.

use core::fmt;

use super::checksum::crc32;
use super::wire::{ByteOrder, get_u16, get_u32, get_u64, put_u16, put_u32, put_u64};
use super::{ENTRY_BYTES, FormatError, HEADER_BYTES, MAGIC, VERSION};
use crate::id::{IndexWidth, MAX_DIM};

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
    /// Bytes of the names of all sections.
    pub name_bytes: u32,
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
    const AT_NAMES: usize = 44;

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

    /// The header in the byte order of a file, its checksum still zero.
    pub(super) fn to_file_bytes(header: &Header) -> [u8; HEADER_BYTES] {
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
        put_u32(&mut bytes, Self::AT_NAMES, header.name_bytes, order);
        bytes
    }

    pub(super) fn swap(bytes: &mut [u8], from: ByteOrder, to: ByteOrder) {
        for offset in [Self::AT_MARK, Self::AT_SECTIONS, Self::AT_NAMES] {
            put_u32(bytes, offset, get_u32(bytes, offset, from), to);
        }
        for offset in [Self::AT_MAJOR, Self::AT_MINOR] {
            put_u16(bytes, offset, get_u16(bytes, offset, from), to);
        }
        for offset in [Self::AT_LENGTH, Self::AT_SIMPLICES] {
            put_u64(bytes, offset, get_u64(bytes, offset, from), to);
        }
    }

    /// Puts the checksum of the header and the table in its place.
    pub(super) fn seal(bytes: &mut [u8], checksum: u32, order: ByteOrder) {
        put_u32(bytes, Self::AT_CRC, checksum, order);
    }

    /// The checksum of the header and what follows it, in which the checksum's own field counts as zero.
    pub(super) fn checksum(table: &[u8]) -> u32 {
        let before = crc32(0, table.get(..Self::AT_CRC).unwrap_or_default());
        crc32(crc32(before, &[0; 4]), table.get(Self::AT_NAMES..).unwrap_or_default())
    }
}

impl Header {
    /// Bytes of the header, the table and the names.
    pub(super) fn table_bytes(&self) -> usize {
        (self.sections as usize)
            .saturating_mul(ENTRY_BYTES)
            .saturating_add(self.name_bytes as usize)
            .saturating_add(HEADER_BYTES)
    }

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
            name_bytes: get_u32(bytes, RawHeader::AT_NAMES, order),
            file_bytes: get_u64(bytes, RawHeader::AT_LENGTH, order),
        };
        if header.dims > MAX_DIM + 1 {
            return Err(undefined(RawHeader::AT_DIMS));
        }
        if at(RawHeader::AT_FLAGS) != 0 {
            return Err(undefined(RawHeader::AT_FLAGS));
        }
        if isize::try_from(header.file_bytes).is_err() {
            return Err(FormatError::TooLarge { length: header.file_bytes });
        }
        let found = bytes.len() as u64;
        if header.file_bytes != found {
            return Err(FormatError::Length { declared: header.file_bytes, found });
        }
        let table = header.table_bytes();
        let table = bytes.get(..table).ok_or(FormatError::Truncated { needed: table as u64, found })?;
        let stored = get_u32(bytes, RawHeader::AT_CRC, order);
        let computed = RawHeader::checksum(table);
        if stored != computed {
            return Err(FormatError::HeaderChecksum { stored, computed });
        }
        Ok(header)
    }
}
