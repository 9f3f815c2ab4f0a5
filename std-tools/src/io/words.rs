//! Text as words one after the other, for formats in which line ends are blanks.

use super::error::{ErrorKind, Fault};
use super::source::Source;
use super::text::{Decimal, Float, Line};

/// The words of an input, with its rules of what ends them.
pub(super) struct Words<'s, 'a> {
    pub(super) source: &'s mut Source<'a>,
    /// What begins a comment, which ends with the line.
    comment: Option<u8>,
    /// The byte before which the words end.
    stop: Option<u8>,
}

impl<'s, 'a> Words<'s, 'a> {
    /// Words with comments that `comment` begins.
    pub(super) fn new(source: &'s mut Source<'a>, comment: Option<u8>) -> Self {
        Self { source, comment, stop: None }
    }

    /// The words before the next byte `stop`.
    pub(super) fn before(source: &'s mut Source<'a>, stop: u8) -> Self {
        Self { source, comment: None, stop: Some(stop) }
    }

    /// The next word, as a line of its own.
    pub(super) fn next(&mut self) -> Result<Option<Line<'_>>, Fault> {
        self.source.next_word(self.comment, self.stop)
    }

    /// The next word, a fault if there is none.
    pub(super) fn need(&mut self, expected: &'static str) -> Result<Line<'_>, Fault> {
        self.source.need_word(self.comment, self.stop, expected)
    }

    /// The first byte of the next word, which is not consumed.
    pub(super) fn first_byte(&mut self) -> Result<Option<u8>, Fault> {
        Ok(if self.source.has_word(self.comment, self.stop)? { self.source.peek(1)?.first().copied() } else { None })
    }

    /// The next word as an integer.
    pub(super) fn integer<T: TryFrom<i64>>(&mut self, expected: &'static str) -> Result<T, Fault> {
        if let Some(number) = self.source.plain(|decimal| T::try_from(decimal.integer()?).ok())? {
            return Ok(number);
        }
        let line = self.need(expected)?;
        line.parse_integer(line.as_word(), expected)
    }

    /// The next word as a finite number.
    pub(super) fn float<T: Float>(&mut self, expected: &'static str) -> Result<T, Fault> {
        if let Some(number) = self.source.plain(Decimal::float)? {
            return Ok(number);
        }
        let line = self.need(expected)?;
        line.parse_finite(line.as_word(), expected)
    }

    /// The next word as the number of a vertex, of which there are `vertices`, numbered from `first`; from 0 in what is
    /// returned.
    pub(super) fn vertex(&mut self, first: u8, vertices: u32, expected: &'static str) -> Result<u32, Fault> {
        let in_range = |index: i64| u32::try_from(index - i64::from(first)).ok().filter(|&vertex| vertex < vertices);
        if let Some(vertex) = self.source.plain(|decimal| in_range(decimal.integer()?))? {
            return Ok(vertex);
        }
        let line = self.need(expected)?;
        let index: i64 = line.parse_integer(line.as_word(), expected)?;
        match u32::try_from(index.saturating_sub(first.into())) {
            Ok(vertex) if vertex < vertices => Ok(vertex),
            _ => Err(line.fault(0, ErrorKind::OutOfRange { index, vertices: vertices.into(), first })),
        }
    }

    /// A fault if any word is left.
    pub(super) fn end(&mut self, of: &'static str) -> Result<(), Fault> {
        match self.next()? {
            None => Ok(()),
            Some(mut line) => Err(line.trailing(of)),
        }
    }
}
