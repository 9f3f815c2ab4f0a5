//! The bytes of an input, line by line or record by record, in memory bounded by the longest line or record.
//!
//! The one place that reads: it decompresses, counts lines and bytes, and holds the limit of a line. What a line says
//! is [`super::text`]'s matter.

use std::borrow::Cow;
use std::io::{self, Read};

use super::compression::Compression;
use super::error::{ErrorKind, Fault, Position, excerpt};
use super::text::{Line, Origin};

/// Bytes asked from the reader at a time; also the most that detection may look at.
const CHUNK: usize = 256 * 1024;

/// The longest line of text.
pub(super) const MAX_LINE: usize = 16 * 1024 * 1024;

/// A reader that tells somebody now and then how much was read.
struct Counted<'a, R> {
    reader: R,
    bytes: u64,
    progress: Option<&'a (dyn Fn(u64) + Sync)>,
}

impl<R: Read> Read for Counted<'_, R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.reader.read(buffer)?;
        self.bytes += read as u64;
        if let Some(progress) = self.progress {
            progress(self.bytes);
        }
        Ok(read)
    }
}

/// An input: a buffer over a reader, and the place reached in it.
pub(super) struct Source<'a> {
    reader: Box<dyn Read + 'a>,
    buffer: Vec<u8>,
    /// The unread part of the buffer is `start..end`.
    start: usize,
    end: usize,
    /// No more bytes come from the reader.
    exhausted: bool,
    /// The byte of the input at which the buffer begins.
    base: u64,
    /// Lines ended so far.
    lines: u64,
    /// The length of the last line, if no line end closed it.
    unended: Option<usize>,
    /// The length of the (uncompressed) input, if known beforehand.
    pub(super) length: Option<u64>,
    /// How the input is compressed, if it is.
    pub(super) compression: Option<Compression>,
    /// Whether binary data have come, after which lines cannot be counted and places are bytes.
    pub(super) binary: bool,
}

impl<'a> Source<'a> {
    /// An input of `length` bytes, if that is known; decompressed if it starts like a compressed file.
    pub(super) fn new(
        reader: impl Read + 'a,
        length: Option<u64>,
        progress: Option<&'a (dyn Fn(u64) + Sync)>,
    ) -> Result<Self, Fault> {
        let raw: Box<dyn Read + 'a> = Box::new(Counted { reader, bytes: 0, progress });
        let mut source = Self::over(raw, length);
        if let Some(compression) = Compression::of(source.peek(Compression::MAGIC)?) {
            let head = io::Cursor::new(source.buffer[source.start..source.end].to_vec());
            let decoder = compression.decoder(head.chain(source.reader));
            source = Self { compression: Some(compression), ..Self::over(decoder, None) };
        }
        // A byte order mark is no part of the text: it must not stick to the first word.
        if source.peek(3)? == "\u{feff}".as_bytes() {
            source.start += 3;
        }
        Ok(source)
    }

    fn over(reader: Box<dyn Read + 'a>, length: Option<u64>) -> Self {
        Self {
            reader,
            buffer: vec![0; CHUNK],
            start: 0,
            end: 0,
            exhausted: false,
            base: 0,
            lines: 0,
            unended: None,
            length,
            compression: None,
            binary: false,
        }
    }

    /// Reads once more, making room first; the unread bytes may move to the front of the buffer.
    fn refill(&mut self) -> Result<(), Fault> {
        if self.start > 0 {
            self.buffer.copy_within(self.start..self.end, 0);
            self.base += self.start as u64;
            self.end -= self.start;
            self.start = 0;
        }
        if self.end == self.buffer.len() {
            self.buffer.resize(2 * self.buffer.len(), 0);
        }
        loop {
            match self.reader.read(&mut self.buffer[self.end..]) {
                Ok(read) => {
                    self.exhausted = read == 0;
                    self.end += read;
                    return Ok(());
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => {
                    let byte = self.base + self.end as u64;
                    let position = if byte == 0 { Position::Whole } else { Position::Byte(byte) };
                    return Err(Fault::new(position, ErrorKind::Io(error)));
                }
            }
        }
    }

    /// The next `count` bytes, or all that are left, without consuming them.
    pub(super) fn peek(&mut self, count: usize) -> Result<&[u8], Fault> {
        while self.end - self.start < count && !self.exhausted {
            self.refill()?;
        }
        Ok(&self.buffer[self.start..self.end.min(self.start + count)])
    }

    /// The bytes that detection may look at: one chunk.
    pub(super) fn head(&mut self) -> Result<&[u8], Fault> {
        self.peek(CHUNK)
    }

    /// Whether all of the input stands in [`Self::head`], so that its length is known.
    pub(super) fn whole_length(&mut self) -> Result<Option<u64>, Fault> {
        let seen = self.peek(CHUNK + 1)?.len();
        Ok(if seen <= CHUNK { Some(seen as u64) } else { self.length })
    }

    /// The next `count` bytes. They are buffered as they arrive: a `count` beyond the input costs no memory.
    pub(super) fn take(&mut self, count: usize, expected: &'static str) -> Result<&[u8], Fault> {
        if self.peek(count)?.len() < count {
            return Err(truncated(Position::Byte(self.base + self.end as u64), expected));
        }
        let taken = self.start..self.start + count;
        self.start = taken.end;
        Ok(&self.buffer[taken])
    }

    /// Calls `record` with the place and the bytes of each of `count` records of `size` bytes.
    pub(super) fn each_record(
        &mut self,
        count: u64,
        size: usize,
        expected: &'static str,
        mut record: impl FnMut(Position, &[u8]) -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        /// Records asked for at a time.
        const MANY: u64 = 4096;
        let mut left = count;
        while left > 0 {
            // At most as many as are asked for at a time.
            let now = usize::try_from(left.min(MANY)).unwrap_or(1);
            let first = self.offset();
            for (index, bytes) in (0..).zip(self.take(now * size, expected)?.chunks_exact(size)) {
                record(Position::Byte(first + index * size as u64), bytes)?;
            }
            left -= now as u64;
        }
        Ok(())
    }

    /// Passes over `count` bytes, without keeping them.
    pub(super) fn skip(&mut self, mut count: u64, expected: &'static str) -> Result<(), Fault> {
        while count > 0 {
            if self.peek(1)?.is_empty() {
                return Err(truncated(self.byte(), expected));
            }
            let passed =
                usize::try_from(count).map_or(self.end, |count| self.end.min(self.start.saturating_add(count)));
            count -= (passed - self.start) as u64;
            self.start = passed;
        }
        Ok(())
    }

    /// A fault if any byte is left.
    pub(super) fn need_end_of_bytes(&mut self, of: &'static str) -> Result<(), Fault> {
        let position = self.byte();
        let left = self.peek(16)?;
        if left.is_empty() {
            return Ok(());
        }
        Err(Fault::new(position, ErrorKind::Trailing { of, found: excerpt(left) }))
    }

    /// The number of the next byte.
    pub(super) fn byte(&self) -> Position {
        Position::Byte(self.offset())
    }

    /// The number of the next byte, as a number.
    pub(super) fn offset(&self) -> u64 {
        self.base + self.start as u64
    }

    /// The next line that holds more than blanks and a comment, which `comment` begins; without the comment.
    pub(super) fn next_content(&mut self, comment: Option<u8>) -> Result<Option<Line<'_>>, Fault> {
        loop {
            let Some(length) = self.line_length(0)? else { return Ok(None) };
            let line = &self.buffer[self.start..self.start + length];
            match line.iter().copied().find(|byte| !byte.is_ascii_whitespace()) {
                Some(first) if Some(first) != comment => {
                    let line = self.hand_out(length);
                    return Ok(Some(match comment {
                        Some(mark) => line.without_comment(mark),
                        None => line,
                    }));
                }
                _ => {
                    self.hand_out(length);
                }
            }
        }
    }

    /// Like [`Self::next_content`], a fault at the end of the input.
    pub(super) fn need_content(&mut self, comment: Option<u8>, expected: &'static str) -> Result<Line<'_>, Fault> {
        let end = self.end_of_text();
        match self.next_content(comment)? {
            Some(line) => Ok(line),
            None => Err(truncated(end, expected)),
        }
    }

    /// A fault if anything but blanks and comments is left.
    pub(super) fn need_end(&mut self, comment: Option<u8>, of: &'static str) -> Result<(), Fault> {
        match self.next_content(comment)? {
            None => Ok(()),
            Some(mut line) => Err(line.trailing(of)),
        }
    }

    /// The next line joined with those that follow as long as each ends in a backslash, which becomes a blank.
    pub(super) fn next_joined_line(&mut self) -> Result<Option<Line<'_>>, Fault> {
        let Some(mut length) = self.line_length(0)? else { return Ok(None) };
        let mut joined = 0;
        loop {
            let line = &self.buffer[self.start..self.start + length];
            let text = line.strip_suffix(b"\r").unwrap_or(line);
            if text.last() != Some(&b'\\') {
                break;
            }
            let backslash = self.start + text.len() - 1;
            self.buffer[backslash] = b' ';
            let Some(more) = self.line_length(length + 1)? else { break };
            length += 1 + more;
            joined += 1;
        }
        let number = self.lines + 1;
        self.lines += joined;
        Ok(Some(self.hand_out(length).starting_at(number)))
    }

    /// The length of the line that begins `from` bytes after the next byte; `None` at the end of the input.
    fn line_length(&mut self, from: usize) -> Result<Option<usize>, Fault> {
        let mut searched = from;
        loop {
            let unread = &self.buffer[self.start..self.end];
            let found = unread.get(searched..).and_then(|rest| memchr::memchr(b'\n', rest));
            searched = found.map_or(unread.len().max(searched), |found| searched + found);
            if searched > MAX_LINE {
                let position = Position::Text { line: self.lines + 1, column: MAX_LINE as u64 + 1 };
                return Err(Fault::new(position, ErrorKind::LineTooLong { limit: MAX_LINE }));
            }
            if found.is_some() {
                return Ok(Some(searched - from));
            }
            if self.exhausted {
                return Ok((searched > from).then(|| searched - from));
            }
            self.refill()?;
        }
    }

    /// Consumes a line of the given length, and its line end if it has one.
    fn hand_out(&mut self, length: usize) -> Line<'_> {
        let text = self.start..self.start + length;
        let origin = if self.binary { Origin::Byte(self.offset()) } else { Origin::Line(self.lines + 1) };
        if text.end < self.end {
            self.start = text.end + 1;
            self.lines += 1;
            self.unended = None;
        } else {
            self.start = text.end;
            self.unended = Some(length);
        }
        Line::new(&self.buffer[text], origin)
    }

    /// Passes over everything up to a line that starts with `mark`, which is not consumed; whether there is one.
    pub(super) fn skip_to_line(&mut self, mark: &[u8]) -> Result<bool, Fault> {
        // The bytes passed of the line at hand.
        let mut passed = 0;
        loop {
            let unread = self.peek(mark.len())?;
            if passed == 0 && unread == mark {
                return Ok(true);
            }
            if unread.is_empty() {
                self.unended = (passed > 0).then_some(passed);
                return Ok(false);
            }
            let unread = &self.buffer[self.start..self.end];
            let found = memchr::memchr(b'\n', unread);
            passed = if found.is_some() { 0 } else { passed + unread.len() };
            self.lines += u64::from(found.is_some());
            self.start += found.map_or(unread.len(), |found| found + 1);
        }
    }

    /// The place just after the last byte of text.
    pub(super) fn end_of_text(&self) -> Position {
        match self.unended {
            _ if self.binary => self.byte(),
            Some(length) => Position::Text { line: self.lines + 1, column: length as u64 + 1 },
            None => Position::Text { line: self.lines + 1, column: 1 },
        }
    }
}

/// The fault of an input that ends too early, at `position`.
pub(super) fn truncated(position: Position, expected: impl Into<Cow<'static, str>>) -> Fault {
    Fault::new(position, ErrorKind::Truncated { expected: expected.into() })
}
