//! The text of GUDHI's `Simplex_tree`: one simplex a line, `dimension vertex … vertex value`.
//!
//! The vertices are integers in any order; the value is a decimal number or `inf`. Simplices may come in any order.

use std::io::Read;

use sig_core::MAX_DIM;

use super::error::{ErrorKind, Fault, Position, ReadError};
use super::source::Source;
use super::text::{Line, parse_float};

/// Reads filtered simplices, and hands each over with its place: the vertices, increasing, and the value, a number. What
/// the receiver refuses is an error at that place.
///
/// Takes time linear in the input, memory for one line.
///
/// # Errors
/// If the input cannot be read, or a line is not a simplex.
pub(crate) fn read_filtered(
    reader: impl Read,
    name: &str,
    progress: Option<&(dyn Fn(u64) + Sync)>,
    receive: &mut dyn FnMut(&[u32], f64, Position) -> Result<(), String>,
) -> Result<(), ReadError> {
    let run = || {
        let mut source = Source::new(reader, None, progress)?;
        let mut word = Vec::new();
        while let Some(mut line) = source.next_content(None)? {
            line.skip_blanks();
            let position = line.position(line.at());
            let value = simplex(&mut line, &mut word)?;
            receive(&word, value, position).map_err(|refusal| Fault::new(position, ErrorKind::Rule(refusal.into())))?;
        }
        Ok(())
    };
    run().map_err(|fault: Fault| fault.in_file(if name == "-" { "<stdin>" } else { name }))
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
