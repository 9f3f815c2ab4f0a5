//! Integers in headers, and byte order: the one place that turns bytes into integers one at a time.

use super::FormatError;
use super::container::Container;
use super::header::RawHeader;
use super::section::element_bytes;
use super::table::{Entry, entry_start};
use crate::slices;

/// In which order the bytes of an integer stand.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum ByteOrder {
    /// That of a file.
    Little,
    /// The other one.
    Big,
}

impl ByteOrder {
    /// The order of this host.
    pub(super) const NATIVE: Self = if cfg!(target_endian = "little") { Self::Little } else { Self::Big };

    const fn other(self) -> Self {
        match self {
            Self::Little => Self::Big,
            Self::Big => Self::Little,
        }
    }
}

/// The `N` bytes at `offset`, zeros where the buffer ends.
fn array<const N: usize>(bytes: &[u8], offset: usize) -> [u8; N] {
    let mut array = [0; N];
    if let Some(found) = bytes.get(offset..).and_then(|tail| tail.get(..N)) {
        array.copy_from_slice(found);
    }
    array
}

macro_rules! integers {
    ($($get:ident, $put:ident: $int:ty;)*) => {$(
        pub(super) fn $get(bytes: &[u8], offset: usize, order: ByteOrder) -> $int {
            match order {
                ByteOrder::Little => <$int>::from_le_bytes(array(bytes, offset)),
                ByteOrder::Big => <$int>::from_be_bytes(array(bytes, offset)),
            }
        }

        pub(super) fn $put(bytes: &mut [u8], offset: usize, value: $int, order: ByteOrder) {
            let encoded = match order {
                ByteOrder::Little => value.to_le_bytes(),
                ByteOrder::Big => value.to_be_bytes(),
            };
            if let Some(target) = bytes.get_mut(offset..).and_then(|tail| tail.get_mut(..encoded.len())) {
                target.copy_from_slice(&encoded);
            }
        }
    )*};
}

integers! {
    get_u16, put_u16: u16;
    get_u32, put_u32: u32;
    get_u64, put_u64: u64;
}

/// Turns a whole file in `bytes` from one byte order into the other, in place: a little-endian file into a buffer that
/// a big-endian host can view, and back. Twice is nothing.
///
/// Checksums speak of a file's bytes: verify before swapping. Cost: one pass over the buffer.
///
/// # Errors
/// What [`Container::from_bytes`](super::Container::from_bytes) would say of the header and the table, except of the
/// byte order; the buffer is then unchanged.
pub fn swap_byte_order(bytes: &mut [u8]) -> Result<(), FormatError> {
    let native = RawHeader::byte_order(bytes)? == ByteOrder::NATIVE;
    let from = if native { ByteOrder::NATIVE } else { ByteOrder::NATIVE.other() };
    let header = *Container::parse(bytes, from)?.header();
    // The sections lie apart from the table, and its entries are swapped after them.
    for number in 0..header.sections {
        let entry = Entry::read(bytes, entry_start(number), from);
        let section = bytes.get_mut(entry.range()).unwrap_or_default();
        for element in section.chunks_exact_mut(element_bytes(entry.element).unwrap_or(1)) {
            slices::reverse(element);
        }
    }
    for number in 0..header.sections {
        Entry::swap(bytes, entry_start(number), from, from.other());
    }
    RawHeader::swap(bytes, from, from.other());
    let checksum = RawHeader::checksum(bytes.get(..header.table_bytes()).unwrap_or_default());
    RawHeader::seal(bytes, checksum, from.other());
    Ok(())
}
