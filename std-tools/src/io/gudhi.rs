//! The text of GUDHI's `Simplex_tree`: one simplex a line, `dimension vertex … vertex value`.
//!
//! The vertices are integers in any order; the value is a decimal number or `inf`. Simplices may come in any order.

use std::fmt::Display;
use std::io::{self, Read, Write};

use sig_core::MAX_DIM;

use super::error::{ErrorKind, Fault, Position, ReadError};
use super::source::Source;
use super::text::{Line, parse_float};

/// Takes a simplex: its vertices, increasing, its value, a number, and its place; or refuses it with a message.
pub(crate) type Receiver<'a> = dyn FnMut(&[u32], f64, Position) -> Result<(), String> + 'a;

/// Reads filtered simplices, and hands each over. What the receiver refuses is an error at that place.
///
/// Takes time linear in the input, memory for one line.
///
/// # Errors
/// If the input cannot be read, or a line is not a simplex.
pub(crate) fn read_filtered(
    reader: impl Read,
    name: &str,
    progress: Option<&(dyn Fn(u64) + Sync)>,
    receive: &mut Receiver<'_>,
) -> Result<(), ReadError> {
    let run = || Source::new(reader, None, progress)?.reading(|source| each(source, receive));
    run().map_err(|fault: Fault| fault.in_file(super::displayed(name)))
}

/// The same of a source.
pub(super) fn each(source: &mut Source<'_>, receive: &mut Receiver<'_>) -> Result<(), Fault> {
    let mut word = Vec::new();
    while let Some(mut line) = source.next_content(None)? {
        line.skip_blanks();
        let position = line.position(line.at());
        let value = simplex(&mut line, &mut word)?;
        receive(&word, value, position).map_err(|refusal| Fault::new(position, ErrorKind::Rule(refusal.into())))?;
    }
    Ok(())
}

/// The dimensions of the simplices in the first lines of a text, of which that is all or not; `None` if a line is no simplex.
pub(super) fn dimensions(head: &[u8], is_all: bool) -> Option<Vec<usize>> {
    let dim = |line: Vec<&[u8]>| {
        let (value, integers) = line.split_last()?;
        let mut integers = integers.iter().map(|word| std::str::from_utf8(word).ok()?.parse::<u32>().ok());
        let dim = integers.next()?? as usize;
        parse_float::<f64>(value)?;
        (line.len() == dim.checked_add(3)? && integers.all(|vertex| vertex.is_some())).then_some(dim)
    };
    lines(head, is_all).map(dim).collect()
}

/// Whether a text that could be a list of simplices, of which these are the first lines, can only be GUDHI's: as a list it
/// would name a vertex twice, or call one by a fraction.
pub(super) fn is_no_list(head: &[u8], is_all: bool) -> bool {
    let is_none = |line: Vec<&[u8]>| {
        let is_fraction = |word: &[u8]| word.contains(&b'.') || word.contains(&b'e');
        line.iter().enumerate().any(|(at, word)| is_fraction(word) || line[..at].contains(word))
    };
    dimensions(head, is_all).is_some_and(|dims| dims.contains(&0)) && lines(head, is_all).any(is_none)
}

/// The words of the lines that are whole.
fn lines(head: &[u8], is_all: bool) -> impl Iterator<Item = Vec<&[u8]>> {
    let end = if is_all { head.len() } else { head.iter().rposition(|&byte| byte == b'\n').unwrap_or(head.len()) };
    head[..end]
        .split(|&byte| byte == b'\n')
        .map(|line| line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect())
        .filter(|words: &Vec<&[u8]>| !words.is_empty())
}

/// Writes a simplex as its line. Values are written so that reading gives the same number.
pub(crate) fn write_simplex<L: Display>(out: &mut (impl Write + ?Sized), word: &[L], value: f64) -> io::Result<()> {
    write!(out, "{}", word.len().saturating_sub(1))?;
    for label in word {
        write!(out, " {label}")?;
    }
    // Plain where that is short.
    if value == 0.0 || (1e-5..1e16).contains(&value.abs()) || value.is_infinite() {
        writeln!(out, " {value}")
    } else {
        writeln!(out, " {value:e}")
    }
}

/// Reads the vertices of a line into `word`, and returns the value.
fn simplex(line: &mut Line<'_>, word: &mut Vec<u32>) -> Result<f64, Fault> {
    let first = line.need_word("the dimension of a simplex")?;
    let dim: u32 = line.parse_integer(first, "the dimension of a simplex")?;
    if dim as usize > MAX_DIM {
        let vertices = (dim as usize).saturating_add(1);
        return Err(line.fault(first.at, ErrorKind::TooManyDimensions { vertices }));
    }
    word.clear();
    for _ in 0..=dim {
        let vertex = line.need_word("a vertex")?;
        let label: u32 = line.parse_integer(vertex, "a vertex: an integer from 0 to 4294967294")?;
        if label == u32::MAX {
            return Err(line.unexpected(vertex, "a vertex: an integer from 0 to 4294967294"));
        }
        if word.contains(&label) {
            let vertex = label.to_string().into();
            return Err(line.fault(first.at, ErrorKind::Degenerate { cell: "simplex", vertex }));
        }
        word.push(label);
    }
    word.sort_unstable();
    let number = line.need_word("the filtration value")?;
    let value = parse_float::<f64>(number.bytes).filter(|value| !value.is_nan());
    let value = value.ok_or_else(|| line.unexpected(number, "the filtration value, a number"))?;
    line.end()?;
    Ok(value)
}
