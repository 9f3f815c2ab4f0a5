//! A line of text as words and numbers, each with its place.

use std::borrow::Cow;
use std::str::FromStr;

use super::OnBad;
use super::error::{ErrorKind, Fault, Position, excerpt};

/// A line, and the place reached in it.
#[derive(Clone)]
pub(super) struct Line<'a> {
    bytes: &'a [u8],
    at: usize,
    origin: Origin,
    on_bad: OnBad,
}

/// What places in a line are counted from.
#[derive(Clone, Copy)]
pub(super) enum Origin {
    /// The number of the line, from 1, and how many bytes of it come before.
    Text { line: u64, column: u64 },
    /// The number of its first byte, in files that are binary in part.
    Byte(u64),
}

/// A word of a line, and where in the line it begins.
#[derive(Clone, Copy)]
pub(super) struct Word<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) at: usize,
}

fn is_blank(byte: u8) -> bool {
    byte.is_ascii_whitespace()
}

impl<'a> Line<'a> {
    pub(super) fn new(bytes: &'a [u8], origin: Origin) -> Self {
        Self { bytes, at: 0, origin, on_bad: OnBad::Refuse }
    }

    /// The same line, where numbers that are not finite are let through if they are to be dropped later.
    pub(super) fn on_bad(self, on_bad: OnBad) -> Self {
        Self { on_bad, ..self }
    }

    /// Whether a number may stand for a coordinate.
    pub(super) fn takes<T: Float>(&self, number: T) -> bool {
        self.on_bad == OnBad::Drop || number.finite()
    }

    /// The same line, which is the line with this number.
    pub(super) fn starting_at(self, number: u64) -> Self {
        Self { origin: Origin::Text { line: number, column: 0 }, ..self }
    }

    /// The line up to a comment, which `mark` begins.
    pub(super) fn without_comment(mut self, mark: u8) -> Self {
        if let Some(end) = memchr::memchr(mark, self.bytes) {
            self.bytes = &self.bytes[..end];
        }
        self
    }

    /// The whole line as a word, which it must be.
    pub(super) fn as_word(&self) -> Word<'a> {
        Word { bytes: self.bytes, at: 0 }
    }

    /// What is left of the line.
    pub(super) fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at.min(self.bytes.len())..]
    }

    /// Goes to `at`, a place that [`Word::at`] or [`Self::at`] told.
    pub(super) fn seek(&mut self, at: usize) {
        self.at = at;
    }

    /// The place reached.
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Goes to the next byte that is not blank; whether there is one.
    pub(super) fn skip_blanks(&mut self) -> bool {
        self.skip_while(is_blank);
        self.at < self.bytes.len()
    }

    /// The next word.
    pub(super) fn word(&mut self) -> Option<Word<'a>> {
        self.skip_blanks();
        let at = self.at;
        self.skip_while(|byte| !is_blank(byte));
        (self.at > at).then(|| Word { bytes: &self.bytes[at..self.at], at })
    }

    /// The next word, where each byte that is a mark is a word of its own.
    pub(super) fn part(&mut self, is_mark: impl Fn(u8) -> bool) -> Option<Word<'a>> {
        self.skip_blanks();
        let at = self.at;
        self.skip_while(|byte| !is_blank(byte) && !is_mark(byte));
        if self.at == at && at < self.bytes.len() {
            self.at += 1;
        }
        (self.at > at).then(|| Word { bytes: &self.bytes[at..self.at], at })
    }

    /// Goes to the next byte of which `passed` is not true.
    pub(super) fn skip_while(&mut self, passed: impl Fn(u8) -> bool) {
        while self.bytes.get(self.at).is_some_and(|&byte| passed(byte)) {
            self.at += 1;
        }
    }

    /// The next word, a fault if there is none.
    pub(super) fn need_word(&mut self, expected: &'static str) -> Result<Word<'a>, Fault> {
        self.word().ok_or_else(|| self.short(expected))
    }

    /// The next word as an integer that fits `T`.
    pub(super) fn integer<T: TryFrom<i64>>(&mut self, expected: &'static str) -> Result<T, Fault> {
        if let Some(number) = self.plain(|decimal| T::try_from(decimal.integer()?).ok()) {
            return Ok(number);
        }
        let word = self.need_word(expected)?;
        self.parse_integer(word, expected)
    }

    /// What `convert` makes of the next word, if that is a plain decimal and becomes something; it is passed over then.
    fn plain<T>(&mut self, convert: impl FnOnce(Decimal) -> Option<T>) -> Option<T> {
        self.skip_blanks();
        let (decimal, length) = Decimal::first(self.rest(), true)?;
        let converted = convert(decimal)?;
        self.at += length;
        Some(converted)
    }

    /// A word of this line as an integer that fits `T`.
    pub(super) fn parse_integer<T: TryFrom<i64>>(&self, word: Word<'_>, expected: &'static str) -> Result<T, Fault> {
        parse_integer(word.bytes)
            .and_then(|value| T::try_from(value).ok())
            .ok_or_else(|| self.unexpected(word, expected))
    }

    /// The next word as a finite number.
    pub(super) fn float<T: Float>(&mut self, expected: &'static str) -> Result<T, Fault> {
        if let Some(number) = self.plain(Decimal::float) {
            return Ok(number);
        }
        let word = self.need_word(expected)?;
        self.parse_finite(word, expected)
    }

    /// A word of this line as a finite number.
    pub(super) fn parse_finite<T: Float>(&self, word: Word<'_>, expected: &'static str) -> Result<T, Fault> {
        match parse_number::<T>(word.bytes) {
            Some(value) if self.takes(value) => Ok(value),
            Some(_) => Err(self.fault(word.at, ErrorKind::NotFinite { found: excerpt(word.bytes) })),
            None => Err(self.unexpected(word, expected)),
        }
    }

    /// A fault unless only blanks are left.
    pub(super) fn end(&mut self) -> Result<(), Fault> {
        if self.skip_blanks() { Err(self.trailing("line")) } else { Ok(()) }
    }

    /// The fault of a line on which, or after which, more stands than may.
    pub(super) fn trailing(&mut self, of: &'static str) -> Fault {
        self.skip_blanks();
        let (at, found) = self.word().map_or((self.at, &b""[..]), |word| (word.at, word.bytes));
        self.fault(at, ErrorKind::Trailing { of, found: excerpt(found) })
    }

    /// Where byte `at` of the line stands in the input.
    pub(super) fn position(&self, at: usize) -> Position {
        match self.origin {
            Origin::Byte(first) => Position::Byte(first + at as u64),
            Origin::Text { line, column } => {
                // Joined lines hold line ends.
                let before = &self.bytes[..at.min(self.bytes.len())];
                let line = line + memchr::memchr_iter(b'\n', before).count() as u64;
                let column = memchr::memrchr(b'\n', before).map_or(column + at as u64, |end| (at - end - 1) as u64);
                Position::Text { line, column: column + 1 }
            }
        }
    }

    /// A fault at byte `at` of the line.
    pub(super) fn fault(&self, at: usize, kind: ErrorKind) -> Fault {
        Fault::new(self.position(at), kind)
    }

    /// The fault of a word that is not what it should be.
    pub(super) fn unexpected(&self, word: Word<'_>, expected: impl Into<Cow<'static, str>>) -> Fault {
        self.fault(word.at, ErrorKind::Expected { expected: expected.into(), found: excerpt(word.bytes) })
    }

    /// The fault of a line that ends too early.
    pub(super) fn short(&self, expected: impl Into<Cow<'static, str>>) -> Fault {
        let end = self.bytes.trim_ascii_end().len();
        self.fault(end, ErrorKind::ShortLine { expected: expected.into() })
    }
}

/// Numbers that stand in text as floating point.
pub(super) trait Float: Copy + FromStr {
    fn finite(self) -> bool;
    fn negated(self) -> Self;
    /// `digits / 10^places` if that takes a single rounding.
    fn exact(digits: u64, places: u32) -> Option<Self>;
}

impl Float for f64 {
    fn negated(self) -> Self {
        -self
    }

    fn finite(self) -> bool {
        self.is_finite()
    }

    fn exact(digits: u64, places: u32) -> Option<Self> {
        // Both operands are exact, so the one operation rounds correctly (Clinger 1990).
        const POWERS: [f64; 23] = [
            1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
            1e19, 1e20, 1e21, 1e22,
        ];
        if digits > 1 << 53 {
            return None;
        }
        Some(digits as Self / POWERS.get(places as usize)?)
    }
}

impl Float for f32 {
    fn negated(self) -> Self {
        -self
    }

    fn finite(self) -> bool {
        self.is_finite()
    }

    fn exact(digits: u64, places: u32) -> Option<Self> {
        const POWERS: [f32; 11] = [1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10];
        if digits > 1 << 24 {
            return None;
        }
        Some(digits as Self / POWERS.get(places as usize)?)
    }
}

/// An integer in decimal, with an optional sign.
pub(super) fn parse_integer(word: &[u8]) -> Option<i64> {
    let (negative, digits) = match word {
        [b'-', digits @ ..] => (true, digits),
        _ => (false, word.strip_prefix(b"+").unwrap_or(word)),
    };
    if digits.is_empty() {
        return None;
    }
    let mut value = 0_i64;
    for &byte in digits {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            return None;
        }
        value = value.checked_mul(10)?.checked_sub(i64::from(digit))?;
    }
    if negative { Some(value) } else { value.checked_neg() }
}

/// A floating-point number in decimal, correctly rounded; infinities and NaN are numbers here.
///
/// Short plain decimals, which meshes are made of, take a fast path of one multiplication or division.
pub(super) fn parse_float<T: Float>(word: &[u8]) -> Option<T> {
    if let Some((decimal, length)) = Decimal::first(word, true)
        && length == word.len()
        && let Some(value) = decimal.float()
    {
        return Some(value);
    }
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// A floating-point number as above, NaN as any C library writes it.
pub(super) fn parse_number<T: Float>(word: &[u8]) -> Option<T> {
    let start = word.strip_prefix(b"-").unwrap_or(word);
    let is_nan = start.get(..3).is_some_and(|start| start.eq_ignore_ascii_case(b"nan"));
    parse_float(if is_nan { b"NaN" } else { word })
}

/// A plain decimal, `digits[.digits]` of at most 18 digits, with or without a minus before it: what meshes are made of. It
/// is read in the same pass that finds its end.
#[derive(Clone, Copy)]
pub(super) struct Decimal {
    is_negative: bool,
    digits: u64,
    /// The digits after the point, if there is a point.
    after_point: Option<u32>,
}

impl Decimal {
    /// The decimal that is the first word of `bytes`, and its length; none if that is something else, or goes to the end
    /// and may go on.
    #[inline]
    pub(super) fn first(bytes: &[u8], is_all: bool) -> Option<(Self, usize)> {
        const MOST: usize = 18;
        let is_negative = bytes.first() == Some(&b'-');
        let start = usize::from(is_negative);
        let (mut digits, mut length, mut point) = (0_u64, start, None);
        loop {
            let Some(&byte) = bytes.get(length) else {
                if is_all {
                    break;
                }
                return None;
            };
            let digit = byte.wrapping_sub(b'0');
            if digit <= 9 {
                // Of too many digits nothing is made.
                digits = digits.wrapping_mul(10).wrapping_add(u64::from(digit));
            } else if byte == b'.' && point.is_none() {
                point = Some(length);
            } else if is_blank(byte) {
                break;
            } else {
                return None;
            }
            length += 1;
        }
        let count = length - start - usize::from(point.is_some());
        if count == 0 || count > MOST {
            return None;
        }
        let after_point = point.map(|point| crate::build::narrow(length - point - 1));
        Some((Self { is_negative, digits, after_point }, length))
    }

    /// The number, if it has no point.
    #[inline]
    pub(super) fn integer(self) -> Option<i64> {
        // Below 10^18.
        let number = i64::try_from(self.digits).ok()?;
        self.after_point.is_none().then_some(if self.is_negative { -number } else { number })
    }

    /// The number, if that takes a single rounding, and is not −0.
    #[inline]
    pub(super) fn float<T: Float>(self) -> Option<T> {
        if self.is_negative && self.digits == 0 {
            return None;
        }
        let value = T::exact(self.digits, self.after_point.unwrap_or(0))?;
        Some(if self.is_negative { value.negated() } else { value })
    }
}
