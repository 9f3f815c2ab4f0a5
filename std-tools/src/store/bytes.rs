//! Bytes in memory at the alignment that a view needs.

use std::io::{self, Read};
use std::ops::{Deref, DerefMut};

/// Bytes that start at a multiple of eight, as every view asks.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct AlignedBytes {
    words: Vec<u64>,
    len: usize,
}

impl AlignedBytes {
    /// So many zeros. Cost: memory is touched only where it is used.
    #[must_use]
    pub fn zeroed(len: usize) -> Self {
        Self { words: vec![0; len.div_ceil(size_of::<u64>())], len }
    }

    /// Everything that a reader gives; `expected` bytes are made room for at the start, more are taken all the same.
    ///
    /// # Errors
    /// The first error of the reader.
    pub fn read(reader: &mut impl Read, expected: usize) -> io::Result<Self> {
        // One byte more, so that the end is seen without growing.
        let mut bytes = Self::zeroed(expected.saturating_add(1));
        let mut filled = 0;
        loop {
            match reader.read(&mut bytes[filled..]) {
                Ok(0) => break,
                Ok(count) => filled += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
            if filled == bytes.len {
                bytes.resize(filled.saturating_mul(2));
            }
        }
        bytes.resize(filled);
        Ok(bytes)
    }

    fn resize(&mut self, len: usize) {
        self.words.resize(len.div_ceil(size_of::<u64>()), 0);
        self.len = len;
    }
}

impl From<&[u8]> for AlignedBytes {
    fn from(bytes: &[u8]) -> Self {
        let mut aligned = Self::zeroed(bytes.len());
        aligned.copy_from_slice(bytes);
        aligned
    }
}

impl Deref for AlignedBytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.len]
    }
}

impl DerefMut for AlignedBytes {
    fn deref_mut(&mut self) -> &mut [u8] {
        &mut bytemuck::cast_slice_mut(&mut self.words)[..self.len]
    }
}

#[cfg(test)]
mod tests {
    use super::AlignedBytes;

    #[test]
    fn reads_more_and_less_than_expected() {
        let data: Vec<u8> = (0..=250).cycle().take(10_001).collect();
        for expected in [0, 1, 7, 10_000, 10_001, 20_000] {
            let read = AlignedBytes::read(&mut data.as_slice(), expected).unwrap();
            assert_eq!(*read, *data);
            assert_eq!(read.as_ptr().align_offset(8), 0);
        }
        assert!(AlignedBytes::read(&mut std::io::empty(), 0).unwrap().is_empty());
    }
}
