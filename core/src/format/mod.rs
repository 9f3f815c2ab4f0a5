//! The container: a header, a section table and flat sections, as `FORMAT.md` beside this crate says.
//!
//! Bytes come in by [`Container::from_bytes`], which reads the header and the table and touches no array, and go out by
//! [`Encoder`]. What the sections *mean* is the business of the views above: [`Complex`](crate::Complex).
//!
//! A file is little-endian; a buffer in memory is in the host's order. On a little-endian host the two are the same
//! bytes; elsewhere [`swap_byte_order`] turns one into the other.

mod checksum;
mod container;
mod encode;
mod error;
mod header;
mod section;
mod table;
mod wire;

pub use checksum::{Blocks, CHECKSUM_BLOCK_BYTES, ChecksumBlock, crc32, verify, verify_with};
pub use container::{Container, Sections};
pub use encode::{EncodeError, Encoder};
pub use error::{FormatError, Rule, TableError};
pub use header::{Header, Kind};
pub use section::{Column, Section, SectionKind};
pub(crate) use section::{WAITS, first_from, num_up_to};
pub use wire::swap_byte_order;

/// The first eight bytes of every file.
pub const MAGIC: [u8; 8] = *b"\x89SIG\r\n\x1a\n";
/// The version that this crate writes: a reader refuses another major version, and skips the unknown sections of a
/// newer minor one.
pub const VERSION: (u16, u16) = (1, 0);
/// Sections start at multiples of this many bytes, and the file is padded to one.
pub const SECTION_ALIGN: usize = 64;
/// The least alignment of a buffer that a view may lie in: that of its widest elements.
pub const BUFFER_ALIGN: usize = 8;
/// Bytes of the header.
pub const HEADER_BYTES: usize = 48;
/// Bytes of an entry of the section table.
pub const ENTRY_BYTES: usize = 24;
