//! The binary data of an array in XML: raw or in base64, behind a header of lengths, plain or compressed by zlib in blocks.

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::super::OnBad;
use super::super::error::{ErrorKind, Fault, Position};
use super::super::source::{Source, truncated};
use super::{Type, Values};

/// Bytes asked for at a time.
const PIECE: usize = 1 << 15;

/// How the numbers of a file are written.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    pub(super) big_endian: bool,
    /// Whether the lengths in headers have 64 bits, not 32.
    pub(super) wide: bool,
    /// Whether arrays are compressed by zlib.
    pub(super) zlib: bool,
    /// What becomes of numbers that are not possible.
    pub(super) on_bad: OnBad,
}

/// The values of base64's digits; 64 for bytes that are none.
const DIGITS: [u8; 256] = {
    let digits = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let (mut table, mut digit) = ([64; 256], 0_u8);
    while digit < 64 {
        table[digits[digit as usize] as usize] = digit;
        digit += 1;
    }
    table
};

/// A stream of bytes, raw or decoded from base64. Padding ends a group, after which another may begin, as the header of a
/// compressed array is encoded by itself.
pub(super) struct Bytes<'s, 'a> {
    source: &'s mut Source<'a>,
    /// The bits of base64 that are not handed out yet, and how many; `None` for raw bytes.
    base64: Option<(u32, u32)>,
    /// The number of characters or raw bytes consumed.
    pub(super) consumed: u64,
}

impl<'s, 'a> Bytes<'s, 'a> {
    pub(super) fn raw(source: &'s mut Source<'a>) -> Self {
        Self { source, base64: None, consumed: 0 }
    }

    pub(super) fn base64(source: &'s mut Source<'a>) -> Self {
        Self { source, base64: Some((0, 0)), consumed: 0 }
    }

    /// Passes over `count` characters or raw bytes.
    pub(super) fn skip(&mut self, count: u64) -> Result<(), Fault> {
        self.source.skip(count, EXPECTED)?;
        self.consumed += count;
        if let Some(bits) = &mut self.base64 {
            *bits = (0, 0);
        }
        Ok(())
    }

    fn position(&self) -> Position {
        self.source.end_of_text()
    }

    /// Fills `out`.
    fn read(&mut self, out: &mut [u8]) -> Result<(), Fault> {
        let Some((mut bits, mut count)) = self.base64 else {
            out.copy_from_slice(self.source.take(out.len(), EXPECTED)?);
            self.consumed += out.len() as u64;
            return Ok(());
        };
        let mut filled = 0;
        while filled < out.len() {
            let position = self.source.end_of_text();
            // Four characters for three bytes, and padding; blanks take another round.
            let text = self.source.peek((out.len() - filled) / 3 * 4 + 4)?;
            if text.is_empty() {
                return Err(truncated(position, EXPECTED));
            }
            let mut passed = 0;
            let mut wrong = None;
            for &byte in text {
                if filled == out.len() {
                    break;
                }
                let digit = DIGITS[usize::from(byte)];
                if digit < 64 {
                    bits = bits << 6 | u32::from(digit);
                    count += 6;
                    if count >= 8 {
                        count -= 8;
                        out[filled] = (bits >> count & 0xff) as u8;
                        filled += 1;
                    }
                } else if byte == b'=' {
                    (bits, count) = (0, 0);
                } else if !byte.is_ascii_whitespace() {
                    wrong = Some(byte);
                    break;
                }
                passed += 1;
            }
            self.source.pass(passed);
            self.consumed += passed as u64;
            if let Some(byte) = wrong {
                let found = super::super::error::excerpt(&[byte]);
                let kind = ErrorKind::Expected { expected: EXPECTED.into(), found };
                return Err(Fault::new(self.source.end_of_text(), kind));
            }
        }
        self.base64 = Some((bits, count));
        Ok(())
    }

    /// The next number of a header.
    fn length(&mut self, layout: Layout) -> Result<u64, Fault> {
        let mut bytes = [0; 8];
        let bytes = &mut bytes[..if layout.wide { 8 } else { 4 }];
        self.read(bytes)?;
        if layout.big_endian {
            bytes.reverse();
        }
        Ok(bytes.iter().rev().fold(0, |number, &byte| number << 8 | u64::from(byte)))
    }

    /// Reads an array of numbers of the given type into `values`, which are to have `most` at most: a fault not far beyond
    /// that.
    pub(super) fn array(
        &mut self,
        layout: Layout,
        scalar: Type,
        most: Option<u64>,
        values: &mut Values,
    ) -> Result<(), Fault> {
        let most = most.unwrap_or(u64::MAX);
        let mut numbers =
            Numbers { scalar, on_bad: layout.on_bad, big_endian: layout.big_endian, left: Vec::new(), most, values };
        if !layout.zlib {
            let mut length = self.length(layout)?;
            let mut piece = vec![0; PIECE];
            while length > 0 {
                let now = usize::try_from(length).map_or(PIECE, |length| length.min(PIECE));
                let position = self.position();
                self.read(&mut piece[..now])?;
                numbers.push(&piece[..now], position)?;
                length -= now as u64;
            }
            return numbers.end(self.position());
        }
        let blocks = self.length(layout)?;
        // The sizes of a whole block and of the last one, which the blocks themselves tell.
        self.length(layout)?;
        self.length(layout)?;
        let mut sizes = Vec::new();
        for _ in 0..blocks {
            sizes.push(self.length(layout)?);
        }
        // What is left of the group in which the header is encoded is padding.
        for size in sizes {
            self.block(size, &mut numbers)?;
        }
        numbers.end(self.position())
    }

    /// Reads a block that takes `size` bytes, compressed.
    fn block(&mut self, size: u64, numbers: &mut Numbers<'_>) -> Result<(), Fault> {
        let position = self.position();
        let (mut packed, mut left) = (Vec::new(), size);
        while left > 0 {
            // In pieces: the size may be a lie.
            let now = usize::try_from(left).map_or(PIECE, |left| left.min(PIECE));
            let start = packed.len();
            packed.resize(start + now, 0);
            self.read(&mut packed[start..])?;
            left -= now as u64;
        }
        let mut decoder = ZlibDecoder::new(&packed[..]);
        let mut piece = vec![0; PIECE];
        loop {
            match decoder.read(&mut piece).map_err(|error| Fault::new(position, ErrorKind::Io(error)))? {
                0 => return Ok(()),
                read => numbers.push(&piece[..read], position)?,
            }
        }
    }
}

const EXPECTED: &str = "as much binary data as the array has";

/// Numbers out of bytes that come in pieces of any length.
struct Numbers<'v> {
    scalar: Type,
    on_bad: OnBad,
    big_endian: bool,
    /// The start of a number whose end has not come.
    left: Vec<u8>,
    most: u64,
    values: &'v mut Values,
}

impl Numbers<'_> {
    fn push(&mut self, mut bytes: &[u8], position: Position) -> Result<(), Fault> {
        if self.values.len() as u64 > self.most {
            let message = format!("the array goes on after the {} numbers that the piece says it has", self.most);
            return Err(Fault::new(position, ErrorKind::Rule(message.into())));
        }
        let size = self.scalar.size();
        while !self.left.is_empty() && !bytes.is_empty() {
            self.left.push(bytes[0]);
            bytes = &bytes[1..];
            if self.left.len() == size {
                let number = self.scalar.decode(&self.left, self.big_endian);
                self.values.push(number, self.on_bad).map_err(|kind| Fault::new(position, kind))?;
                self.left.clear();
            }
        }
        for number in bytes.chunks(size) {
            if number.len() < size {
                self.left.extend(number);
            } else {
                let number = self.scalar.decode(number, self.big_endian);
                self.values.push(number, self.on_bad).map_err(|kind| Fault::new(position, kind))?;
            }
        }
        Ok(())
    }

    fn end(&self, position: Position) -> Result<(), Fault> {
        if self.left.is_empty() {
            return Ok(());
        }
        let message =
            format!("the length of the array is no multiple of {}, the bytes of a number", self.scalar.size());
        Err(Fault::new(position, ErrorKind::Rule(message.into())))
    }
}
