//! What a reader says when it cannot go on: the file, the place in it, and what was expected there.
//!
//! Readers make a [`Fault`] (a place and a kind); the registry adds the name of the input and gives a [`ReadError`].

use std::borrow::Cow;
use std::fmt;
use std::io;

use super::Format;
use super::space::SpaceFormat;

/// A place in an input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Position {
    /// The input as a whole.
    Whole,
    /// A place in text: line and column, both from 1, the column in bytes (a byte order mark is not counted).
    Text {
        /// The line, from 1.
        line: u64,
        /// The byte in the line, from 1.
        column: u64,
    },
    /// A byte of a binary part, from 0, counted after decompression.
    Byte(u64),
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole => Ok(()),
            Self::Text { line, column } => write!(f, ":{line}:{column}"),
            Self::Byte(byte) => write!(f, ": byte {byte}"),
        }
    }
}

/// Why an input was refused. Displays as `file:line:column: message`, or `file: byte N: message` in binary parts.
#[derive(Debug, thiserror::Error)]
#[error("{file}{position}: {kind}")]
#[non_exhaustive]
pub struct ReadError {
    /// The name of the input, as the caller gave it.
    pub file: String,
    /// Where in the input.
    pub position: Position,
    /// What is wrong, and what to do about it.
    #[source]
    pub kind: ErrorKind,
    /// The line at that place, if it is text and was still at hand.
    pub line: Option<Box<Excerpt>>,
}

/// A part of a line, as text that shows everything, and how far into it a place is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excerpt {
    /// The number of the line, from 1.
    pub line: u64,
    /// The line, cut where it is long, without control characters.
    pub text: String,
    /// The characters of `text` before the place.
    pub before: usize,
}

impl Excerpt {
    /// What is kept of a line before and after the place.
    const BEFORE: usize = 60;
    const AFTER: usize = 40;

    /// An excerpt of a line around its byte `at`.
    pub(super) fn new(line: u64, bytes: &[u8], at: usize) -> Self {
        let at = at.min(bytes.len());
        let (start, end) = (at.saturating_sub(Self::BEFORE), bytes.len().min(at + Self::AFTER));
        let dots = if start > 0 { "…" } else { "" };
        let shown = |bytes: &[u8]| {
            let text = String::from_utf8_lossy(bytes).replace(['\t', '\r'], " ");
            text.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect::<String>()
        };
        let before = dots.to_owned() + &shown(&bytes[start..at]);
        let dots = if end < bytes.len() { "…" } else { "" };
        let text = format!("{before}{}{dots}", shown(&bytes[at..end]));
        Self { line, text: text.trim_end().into(), before: before.chars().count() }
    }
}

impl fmt::Display for Excerpt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = self.line.to_string();
        let (margin, indent) = (number.len(), self.before);
        write!(f, "  {number} | {}\n  {:margin$} | {:indent$}^", self.text, "", "")
    }
}

/// What is wrong with an input.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The operating system or the decompressor failed.
    #[error("cannot read: {0}")]
    Io(#[source] io::Error),
    /// Neither the content nor the name tells the format.
    #[error("neither the content nor the name tells the format; name it (--format), one of: {}", names())]
    UnknownFormat,
    /// The same, of an input that should hold points, distances or a graph.
    #[error("neither the content nor the name tells the format; name it (--format), one of: {}", space_names())]
    UnknownSpace,
    /// Something else stands where something definite must.
    #[error("expected {expected}, found {found}")]
    Expected {
        /// What must stand here.
        expected: Cow<'static, str>,
        /// What does, cut short.
        found: Box<str>,
    },
    /// The line ends too early.
    #[error("expected {expected}, but the line ends here")]
    ShortLine {
        /// What must stand here.
        expected: Cow<'static, str>,
    },
    /// The input ends too early.
    #[error("expected {expected}, but the file ends here; it seems truncated")]
    Truncated {
        /// What must stand here.
        expected: Cow<'static, str>,
    },
    /// Something follows where nothing may.
    #[error("expected the end of the {of}, found {found}")]
    Trailing {
        /// What should have ended: the line, the file, …
        of: &'static str,
        /// What follows, cut short.
        found: Box<str>,
    },
    /// A number that is NaN, infinite, or too large for its precision.
    #[error("the coordinate {found} is not a finite number")]
    NotFinite {
        /// The number as written.
        found: Box<str>,
    },
    /// A vertex that does not exist.
    #[error("vertex {index} is out of range: there are {vertices} vertices, numbered from {first}")]
    OutOfRange {
        /// The vertex as written.
        index: i64,
        /// How many vertices there are.
        vertices: u64,
        /// The number of the first.
        first: u8,
    },
    /// A node tag that no node bears.
    #[error("there is no node with tag {tag}; the input declares {nodes} nodes")]
    UnknownNode {
        /// The tag as written.
        tag: u64,
        /// How many nodes there are.
        nodes: u64,
    },
    /// Two nodes with one tag.
    #[error("node {tag} is declared more than once")]
    DuplicateNode {
        /// The tag.
        tag: u64,
    },
    /// A cell that repeats a vertex.
    #[error("the {cell} repeats vertex {vertex}; --drop-degenerate drops such cells and counts them")]
    Degenerate {
        /// What repeats it: simplex, polygon, polyhedron, facet.
        cell: &'static str,
        /// The vertex, as the input calls it.
        vertex: Box<str>,
    },
    /// More vertices than a simplex may have.
    #[error("a simplex of {vertices} vertices; at most {} are possible (dimension {})", sig_core::MAX_DIM + 1, sig_core::MAX_DIM)]
    TooManyDimensions {
        /// How many vertices the simplex has.
        vertices: usize,
    },
    /// More vertices than 32-bit numbers can tell apart.
    #[error("more than {} vertices; a soup numbers vertices with 32 bits", u32::MAX)]
    TooManyVertices,
    /// A line longer than the limit.
    #[error("a line of more than {limit} bytes; is this a text file with line ends?")]
    LineTooLong {
        /// The limit.
        limit: usize,
    },
    /// A count that the data contradict.
    #[error("{what}: {declared} declared, {found} found")]
    WrongCount {
        /// What was counted.
        what: &'static str,
        /// The declared number.
        declared: u64,
        /// The number found.
        found: u64,
    },
    /// A rule that the input as a whole keeps is broken here.
    #[error("{0}")]
    Rule(Cow<'static, str>),
    /// A variant of a format that is not read, and what to do instead.
    #[error("{0}")]
    Unsupported(Cow<'static, str>),
}

fn names() -> String {
    Format::ALL.iter().map(|format| format.name()).collect::<Vec<_>>().join(", ")
}

fn space_names() -> String {
    SpaceFormat::ALL.iter().map(|format| format.name()).collect::<Vec<_>>().join(", ")
}

/// A place and what is wrong there; [`ReadError`] without the name of the input.
///
/// Boxed, so that the results of the innermost parsing functions stay small.
#[derive(Debug)]
pub(super) struct Fault(Box<(Position, ErrorKind, Option<Box<Excerpt>>)>);

impl Fault {
    pub(super) fn new(position: Position, kind: ErrorKind) -> Self {
        Self(Box::new((position, kind, None)))
    }

    pub(super) fn position(&self) -> Position {
        self.0.0
    }

    pub(super) fn kind(&self) -> &ErrorKind {
        &self.0.1
    }

    /// The fault with the line in which it is.
    pub(super) fn showing(mut self, line: Option<Excerpt>) -> Self {
        self.0.2 = line.map(Box::new);
        self
    }

    pub(super) fn in_file(self, file: &str) -> ReadError {
        let (position, kind, line) = *self.0;
        ReadError { file: file.to_owned(), position, kind, line }
    }
}

/// The start of some bytes of an input, fit for a message.
pub(super) fn excerpt(bytes: &[u8]) -> Box<str> {
    const LONGEST: usize = 40;
    let cut = &bytes[..bytes.len().min(LONGEST)];
    let dots = if cut.len() < bytes.len() { "…" } else { "" };
    format!("`{}{dots}`", cut.escape_ascii()).into()
}
