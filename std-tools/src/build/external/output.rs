//! The file, written in any order by any thread: runs of numbers or bits into its sections, and what checks them.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs::File;
use std::io;
use std::ops::Range;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crc32fast::Hasher;
use serde::{Deserialize, Serialize};
use sig_core::format::{CHECKSUM_BLOCK_BYTES, Column, Encoder, SectionKind};

use crate::spool::{changed, write_at};
use crate::store::crc32;

/// Bytes that a run keeps before it writes them.
const BUFFER: usize = 1 << 18;

/// A file whose sections have their places.
pub(super) struct Output<'a> {
    file: &'a File,
    /// Whose turn it is to write.
    turn: Mutex<()>,
    places: Vec<Place>,
    checksums: bool,
    /// Whether nothing of it was written by an earlier process.
    pub(super) is_new: bool,
    written: Mutex<Written>,
}

/// A section, and the bytes of the file that it takes.
struct Place {
    kind: SectionKind,
    range: Range<u64>,
    /// Bytes of an element, 1 of bits.
    width: usize,
}

/// What was written, as far as it has to be known at the end.
#[derive(Clone, Default, Serialize, Deserialize)]
pub(super) struct Written {
    /// Where in the file each part starts, how many bytes it has, and its checksum; no part is in two blocks.
    parts: Vec<(u64, u64, u32)>,
    /// Bytes that several runs of bits share, by place in the file.
    shared: Vec<(u64, u8)>,
}

/// Who writes some part of the file, on one thread.
pub(super) struct Pen<'a> {
    output: &'a Output<'a>,
    written: RefCell<Written>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl<'a> Output<'a> {
    /// Writes the header for `encoder`, of whose sections only the shapes count. `width` tells the bytes of an element.
    pub(super) fn new(
        file: &'a File,
        encoder: &Encoder<'_>,
        checksums: bool,
        width: impl Fn(SectionKind) -> usize,
    ) -> io::Result<Self> {
        let is_new = file.metadata()?.len() != encoder.file_bytes();
        if is_new {
            // What nobody writes is padding, and zero.
            file.set_len(0)?;
            file.set_len(encoder.file_bytes())?;
        }
        let mut header = Vec::new();
        encoder.write_header(|piece| {
            header.extend_from_slice(piece);
            Ok::<(), io::Error>(())
        })?;
        write_at(file, 0, &header)?;
        let place = |(kind, range)| Place { kind, range, width: width(kind) };
        let places = encoder.places().map(place).collect();
        Ok(Self { file, turn: Mutex::new(()), places, checksums, is_new, written: Mutex::default() })
    }

    /// One who writes into it.
    pub(super) fn pen(&'a self) -> Pen<'a> {
        Pen { output: self, written: RefCell::default() }
    }

    /// Takes note of what was written, by a pen of this or of an earlier process.
    pub(super) fn add(&self, written: Written) {
        let mut all = lock(&self.written);
        all.parts.extend(written.parts);
        all.shared.extend(written.shared);
    }

    /// Writes what is left: the bytes that runs of bits share, and the checksums.
    pub(super) fn finish(&self) -> io::Result<()> {
        let Written { mut parts, shared } = std::mem::take(&mut *lock(&self.written));
        let mut bytes = BTreeMap::new();
        shared.into_iter().for_each(|(start, byte)| *bytes.entry(start).or_insert(0) |= byte);
        let pen = self.pen();
        for (start, byte) in bytes {
            if let Some(place) = self.places.iter().find(|place| place.range.contains(&start)) {
                pen.write(place, start, &[byte])?;
            }
        }
        if !self.checksums {
            return Ok(());
        }
        parts.extend(std::mem::take(&mut pen.written.borrow_mut().parts));
        parts.sort_unstable();
        let mut run = pen.numbers(SectionKind::Checksums, 0);
        let mut total = 0;
        for place in self.places.iter().filter(|place| place.kind != SectionKind::Checksums) {
            for checksum in place.checksums(&parts) {
                total = crc32(total, &checksum.to_le_bytes());
                run.push(checksum.into())?;
            }
        }
        run.push(total.into())?;
        run.finish()
    }
}

impl Place {
    /// The checksums of the blocks, from those of the parts of the file, which are in order.
    fn checksums(&self, parts: &[(u64, u64, u32)]) -> Vec<u32> {
        let [first, end] = [self.range.start, self.range.end].map(|at| parts.partition_point(|part| part.0 < at));
        let block = |start: u64| (start - self.range.start) / CHECKSUM_BLOCK_BYTES as u64;
        let of_block = |parts: &[(u64, u64, u32)]| {
            let mut hasher = Hasher::new();
            for &(_, len, checksum) in parts {
                hasher.combine(&Hasher::new_with_initial_len(checksum, len));
            }
            hasher.finalize()
        };
        parts[first..end].chunk_by(|a, b| block(a.0) == block(b.0)).map(of_block).collect()
    }
}

impl Pen<'_> {
    /// What was written by it.
    pub(super) fn end(self) -> Written {
        self.written.into_inner()
    }

    /// Where a section is; `None` if the file does not have it.
    fn place(&self, kind: SectionKind) -> Option<&Place> {
        self.output.places.iter().find(|place| place.kind == kind)
    }

    /// Writes bytes of a section at a place in the file.
    fn write(&self, place: &Place, start: u64, bytes: &[u8]) -> io::Result<()> {
        if start < place.range.start || start + bytes.len() as u64 > place.range.end {
            return Err(changed());
        }
        {
            let _turn = lock(&self.output.turn);
            write_at(self.output.file, start, bytes)?;
        }
        if self.output.checksums {
            let block = CHECKSUM_BLOCK_BYTES as u64;
            let parts = &mut self.written.borrow_mut().parts;
            let (mut start, mut bytes) = (start, bytes);
            while !bytes.is_empty() {
                let room = block - (start - place.range.start) % block;
                let len = usize::try_from(room).map_or(bytes.len(), |room| room.min(bytes.len()));
                let (part, rest) = bytes.split_at(len);
                parts.push((start, len as u64, crc32(0, part)));
                start += len as u64;
                bytes = rest;
            }
        }
        Ok(())
    }

    /// A run of numbers from element `first` of a section on; they go nowhere if the file does not have it.
    pub(super) fn numbers(&self, kind: SectionKind, first: usize) -> Numbers<'_> {
        let place = self.place(kind);
        let at = place.map_or(0, |place| place.range.start + (first * place.width) as u64);
        Numbers { pen: self, place, at, buffer: Vec::new() }
    }

    /// A run of bits from bit `first` of a section on.
    pub(super) fn bits(&self, kind: SectionKind, first: usize) -> Bits<'_> {
        let start = self.place(kind).map_or(0, |place| place.range.start) + first as u64 / 8;
        Bits { bytes: self.numbers(kind, first.div_ceil(8)), shared: start, byte: 0, from: first % 8, next: first % 8 }
    }

    /// Writes a whole section.
    pub(super) fn column(&self, kind: SectionKind, column: &Column<'_>) -> io::Result<()> {
        let mut run = self.numbers(kind, 0);
        match column {
            Column::U8(values) => values.iter().try_for_each(|&value| run.push(value.into()))?,
            Column::U16(values) => values.iter().try_for_each(|&value| run.push(value.into()))?,
            Column::U32(values) => values.iter().try_for_each(|&value| run.push(value.into()))?,
            Column::U64(values) => values.iter().try_for_each(|&value| run.push(value))?,
            // The lower bytes, of negative numbers too.
            Column::I32(values) => values.iter().try_for_each(|value| run.push(value.cast_unsigned().into()))?,
            Column::I64(values) => values.iter().try_for_each(|value| run.push(value.cast_unsigned()))?,
            Column::F32(values) => values.iter().try_for_each(|value| run.push(value.to_bits().into()))?,
            Column::F64(values) => values.iter().try_for_each(|value| run.push(value.to_bits()))?,
            Column::Bits { bytes, .. } => bytes.iter().try_for_each(|&value| run.push(value.into()))?,
        }
        run.finish()
    }
}

/// A run of numbers.
pub(super) struct Numbers<'a> {
    pen: &'a Pen<'a>,
    place: Option<&'a Place>,
    at: u64,
    buffer: Vec<u8>,
}

impl Numbers<'_> {
    /// Writes one at the width of the section: its lower bytes.
    #[inline]
    pub(super) fn push(&mut self, value: u64) -> io::Result<()> {
        let Some(place) = self.place else { return Ok(()) };
        self.buffer.extend_from_slice(&value.to_le_bytes()[..place.width]);
        if self.buffer.len() >= BUFFER { self.flush() } else { Ok(()) }
    }

    fn flush(&mut self) -> io::Result<()> {
        if let Some(place) = self.place
            && !self.buffer.is_empty()
        {
            self.pen.write(place, self.at, &self.buffer)?;
            self.at += self.buffer.len() as u64;
            self.buffer.clear();
        }
        Ok(())
    }

    /// To be called after the last one.
    pub(super) fn finish(mut self) -> io::Result<()> {
        self.flush()
    }
}

/// A run of bits. Its first and its last byte may be shared with others.
pub(super) struct Bits<'a> {
    /// The bytes that are all of this run.
    bytes: Numbers<'a>,
    /// Where the first byte is in the file, for the bytes that are not.
    shared: u64,
    byte: u8,
    /// The bits of the byte that are of this run: from `from` to `next`.
    from: usize,
    next: usize,
}

impl Bits<'_> {
    pub(super) fn push(&mut self, bit: bool) -> io::Result<()> {
        self.byte |= u8::from(bit) << self.next;
        self.next += 1;
        if self.next == 8 { self.end_byte() } else { Ok(()) }
    }

    fn end_byte(&mut self) -> io::Result<()> {
        if self.bytes.place.is_some() {
            if (self.from, self.next) == (0, 8) {
                self.bytes.push(self.byte.into())?;
            } else if self.from < self.next {
                self.bytes.pen.written.borrow_mut().shared.push((self.shared, self.byte));
            }
        }
        self.shared += 1;
        (self.byte, self.from, self.next) = (0, 0, 0);
        Ok(())
    }

    pub(super) fn finish(mut self) -> io::Result<()> {
        self.end_byte()?;
        self.bytes.finish()
    }
}
