//! Top simplices in text: the numbers of points and simplices, one point a line, one simplex a line as `k v1 … vk`.
//!
//! The points have as many coordinates as the first of them; vertices are numbered from 0. Comments run from `#` to the
//! end of the line.

use super::error::{ErrorKind, Fault};
use super::intake::{Intake, reserve};
use super::source::Source;
use super::text::Line;
use super::{Format, ReadOptions, ReadReport};
use crate::soup::{Labels, Scalars, Soup};

const COMMENT: Option<u8> = Some(b'#');

/// Reads a vertex number, which is one from 0 to below `vertices`.
pub(super) fn vertex(
    line: &mut Line<'_>,
    vertices: u32,
    expected: &'static str,
    intake: &mut Intake,
) -> Result<u32, Fault> {
    let word = line.need_word(expected)?;
    let index: i64 = line.parse_integer(word, "the number of a vertex")?;
    match u32::try_from(index) {
        Ok(vertex) if vertex < vertices => Ok(vertex),
        _ => intake.missing(line.fault(word.at, ErrorKind::OutOfRange { index, vertices: vertices.into(), first: 0 })),
    }
}

/// Reads one simplex.
fn simplex(mut line: Line<'_>, vertices: u32, word: &mut Vec<u32>, intake: &mut Intake) -> Result<(), Fault> {
    line.skip_blanks();
    let start = line.at();
    let count: u64 = line.integer("the number of vertices of the simplex")?;
    word.clear();
    for _ in 0..count {
        word.push(vertex(&mut line, vertices, "as many vertices of the simplex as its first number says", intake)?);
    }
    line.end()?;
    intake.simplex(word).map_err(|refusal| line.fault(start, refusal.kind(|vertex| vertex.to_string())))
}

/// Reads a list of points and simplices.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    const COUNTS: &str = "the numbers of points (below 2^32) and simplices";
    let mut line = source.need_content(COMMENT, COUNTS)?;
    let vertices: u32 = line.integer(COUNTS)?;
    let simplices: u64 = line.integer(COUNTS)?;
    line.end()?;
    let mut values: Vec<f64> = Vec::with_capacity(reserve(vertices.into()));
    let mut dim = None;
    for _ in 0..vertices {
        let mut line = source.need_content(COMMENT, "as many points as the first line says")?;
        let start = values.len();
        while dim.map_or(line.skip_blanks(), |dim| values.len() - start < dim) {
            values.push(line.float("a coordinate of the point, as many as the first point has")?);
        }
        line.end()?;
        dim.get_or_insert(values.len() - start);
    }
    let mut intake = Intake::new(Format::Tops, options);
    let mut word = Vec::new();
    for _ in 0..simplices {
        let line = source.need_content(COMMENT, "as many simplices as the first line says")?;
        simplex(line, vertices, &mut word, &mut intake)?;
    }
    source.need_end(COMMENT, "file after the last simplex")?;
    Ok(intake.finish(Labels::Numbered(vertices as usize), true, Some((dim.unwrap_or(3), Scalars::F64(values)))))
}
