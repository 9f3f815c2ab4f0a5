//! The bytes of an input, line by line or record by record, in memory bounded by the longest line or record.
//!
//! The one place that reads: it decompresses, counts lines and bytes, and holds the limit of a line. What a line says
//! is [`super::text`]'s matter.

use std::borrow::Cow;
use std::io::{self, Read};
use std::ops::Range;

use super::OnBad;
use super::compression::Compression;
use super::error::{ErrorKind, Excerpt, Fault, Position, excerpt};
use super::text::{Decimal, Line, Origin};

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
    /// The byte of the input at which the line at hand begins.
    line_begin: u64,
    /// The length of the (uncompressed) input, if known beforehand.
    pub(super) length: Option<u64>,
    /// How the input is compressed, if it is.
    pub(super) compression: Option<Compression>,
    /// Whether binary data have come, after which lines cannot be counted and places are bytes.
    pub(super) binary: bool,
    on_bad: OnBad,
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
            source.line_begin = source.offset();
        }
        Ok(source)
    }

    /// The same, whose lines take numbers that are not finite for coordinates if they are to be dropped.
    pub(super) fn on_bad(self, on_bad: OnBad) -> Self {
        Self { on_bad, ..self }
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
            line_begin: 0,
            length,
            compression: None,
            binary: false,
            on_bad: OnBad::Refuse,
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

    /// Passes over the next line, whatever is in it; whether that is nothing but blanks, `None` at the end of the input.
    pub(super) fn next_line(&mut self) -> Result<Option<bool>, Fault> {
        let Some(length) = self.line_length(0)? else { return Ok(None) };
        let is_empty = self.buffer[self.start..self.start + length].trim_ascii().is_empty();
        self.hand_out(length);
        Ok(Some(is_empty))
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
        let origin = self.origin();
        self.start = text.end;
        if text.end < self.end {
            self.start += 1;
            self.lines += 1;
            self.line_begin = self.offset();
        }
        Line::new(&self.buffer[text], origin).on_bad(self.on_bad)
    }

    /// What places in text that begins with the next byte are counted from.
    fn origin(&self) -> Origin {
        self.origin_at(self.start)
    }

    /// The same of text on the line at hand that begins at this byte of the buffer.
    fn origin_at(&self, start: usize) -> Origin {
        let offset = self.base + start as u64;
        if self.binary {
            Origin::Byte(offset)
        } else {
            Origin::Text { line: self.lines + 1, column: offset - self.line_begin }
        }
    }

    /// Passes over blanks and line ends up to the next byte of another kind, which is told; `None` at the end.
    pub(super) fn skip_blanks(&mut self) -> Result<Option<u8>, Fault> {
        let mut passed = 0;
        loop {
            for at in self.start..self.end {
                match self.buffer[at] {
                    b'\n' => {
                        self.lines += 1;
                        self.line_begin = self.base + at as u64 + 1;
                        passed = 0;
                    }
                    byte if byte.is_ascii_whitespace() => passed += 1,
                    byte => {
                        self.start = at;
                        return Ok(Some(byte));
                    }
                }
            }
            self.start = self.end;
            if passed > MAX_LINE {
                return Err(self.too_long());
            }
            if self.exhausted {
                return Ok(None);
            }
            self.refill()?;
        }
    }

    /// What `convert` makes of the next word, if that is a plain decimal and becomes something; it is passed over then, and
    /// blanks before it in any case.
    #[inline]
    pub(super) fn plain<T>(&mut self, convert: impl FnOnce(Decimal) -> Option<T>) -> Result<Option<T>, Fault> {
        self.skip_blanks()?;
        let Some((decimal, length)) = Decimal::first(&self.buffer[self.start..self.end], false) else {
            return Ok(None);
        };
        let converted = convert(decimal);
        if converted.is_some() {
            self.start += length;
        }
        Ok(converted)
    }

    /// The next word, on whatever line it stands, as a line of its own. Words end before `stop`, at which there is none;
    /// comments, which `comment` begins, are passed over.
    pub(super) fn next_word(&mut self, comment: Option<u8>, stop: Option<u8>) -> Result<Option<Line<'_>>, Fault> {
        let Some(word) = self.pass_word(comment, stop)? else { return Ok(None) };
        let origin = self.origin_at(word.start);
        Ok(Some(Line::new(&self.buffer[word], origin).on_bad(self.on_bad)))
    }

    /// Passes over the next word; where it is in the buffer.
    fn pass_word(&mut self, comment: Option<u8>, stop: Option<u8>) -> Result<Option<Range<usize>>, Fault> {
        if !self.has_word(comment, stop)? {
            return Ok(None);
        }
        let mut length = 1;
        loop {
            let unread = &self.buffer[self.start..self.end];
            let is_end = |byte: &u8| byte.is_ascii_whitespace() || Some(*byte) == stop;
            let found = unread[length..].iter().position(is_end);
            length = found.map_or(unread.len(), |found| length + found);
            if found.is_some() || self.exhausted {
                break;
            }
            if length > MAX_LINE {
                return Err(self.too_long());
            }
            self.refill()?;
        }
        let word = self.start..self.start + length;
        self.start = word.end;
        Ok(Some(word))
    }

    /// Like [`Self::next_word`], a fault if there is none.
    pub(super) fn need_word(
        &mut self,
        comment: Option<u8>,
        stop: Option<u8>,
        expected: &'static str,
    ) -> Result<Line<'_>, Fault> {
        if let Some(word) = self.pass_word(comment, stop)? {
            let origin = self.origin_at(word.start);
            return Ok(Line::new(&self.buffer[word], origin).on_bad(self.on_bad));
        }
        Err(match self.skip_blanks()? {
            None => truncated(self.end_of_text(), expected),
            Some(_) => {
                let found = excerpt(self.peek(1)?);
                Fault::new(self.end_of_text(), ErrorKind::Expected { expected: expected.into(), found })
            }
        })
    }

    /// Whether a word comes before `stop`; blanks and comments before it are passed over.
    pub(super) fn has_word(&mut self, comment: Option<u8>, stop: Option<u8>) -> Result<bool, Fault> {
        loop {
            match self.skip_blanks()? {
                None => return Ok(false),
                first if first == comment => self.skip_line()?,
                first => return Ok(first != stop),
            }
        }
    }

    /// Passes over the rest of the line.
    fn skip_line(&mut self) -> Result<(), Fault> {
        match self.line_length(0)? {
            Some(length) => drop(self.hand_out(length)),
            None => self.start = self.end,
        }
        Ok(())
    }

    /// Passes over `count` bytes of the buffer, counting lines.
    pub(super) fn pass(&mut self, count: usize) {
        let passed = &self.buffer[self.start..self.end.min(self.start + count)];
        self.lines += memchr::memchr_iter(b'\n', passed).count() as u64;
        if let Some(last) = memchr::memrchr(b'\n', passed) {
            self.line_begin = self.base + (self.start + last) as u64 + 1;
        }
        self.start += passed.len();
    }

    /// Passes over all up to `mark`, which is not consumed, counting lines; whether it is there.
    pub(super) fn skip_to(&mut self, mark: u8) -> Result<bool, Fault> {
        loop {
            let unread = self.peek(1)?;
            if unread.is_empty() {
                return Ok(false);
            }
            let unread = &self.buffer[self.start..self.end];
            let found = memchr::memchr(mark, unread);
            let passed = found.unwrap_or(unread.len());
            self.pass(passed);
            if found.is_some() {
                return Ok(true);
            }
        }
    }

    fn too_long(&self) -> Fault {
        Fault::new(self.end_of_text(), ErrorKind::LineTooLong { limit: MAX_LINE })
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
                return Ok(false);
            }
            let unread = &self.buffer[self.start..self.end];
            let found = memchr::memchr(b'\n', unread);
            passed = if found.is_some() { 0 } else { passed + unread.len() };
            let passed_now = found.map_or(unread.len(), |found| found + 1);
            self.pass(passed_now);
        }
    }

    /// What `read` makes of the input; a fault with the line in which it is, if that is still in the buffer.
    pub(super) fn reading<T>(&mut self, read: impl FnOnce(&mut Self) -> Result<T, Fault>) -> Result<T, Fault> {
        read(self).map_err(|fault| {
            let line = self.excerpt(fault.position());
            fault.showing(line)
        })
    }

    /// The line of a place in text, if it is still in the buffer.
    fn excerpt(&self, position: Position) -> Option<Excerpt> {
        let Position::Text { line, column } = position else { return None };
        let mut start = usize::try_from(self.line_begin.checked_sub(self.base)?).ok()?;
        for _ in line..self.lines + 1 {
            // Past the end of the line before.
            let before = self.buffer.get(..start.checked_sub(1)?)?;
            start = memchr::memrchr(b'\n', before).map_or(0, |end| end + 1);
        }
        // The first line of the buffer may have lost its beginning.
        if start == 0 && self.base > 0 || line > self.lines + 1 {
            return None;
        }
        let rest = self.buffer.get(start..self.end)?;
        let length = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        Some(Excerpt::new(line, &rest[..length], usize::try_from(column).ok()?.checked_sub(1)?))
    }

    /// The place of the next byte, as text where lines can be counted.
    pub(super) fn end_of_text(&self) -> Position {
        if self.binary {
            return self.byte();
        }
        Position::Text { line: self.lines + 1, column: self.offset() - self.line_begin + 1 }
    }
}

/// The fault of an input that ends too early, at `position`.
pub(super) fn truncated(position: Position, expected: impl Into<Cow<'static, str>>) -> Fault {
    Fault::new(position, ErrorKind::Truncated { expected: expected.into() })
}
