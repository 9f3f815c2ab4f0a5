//! OFF, the Object File Format of Geomview: `OFF`, counts, one vertex a line, one face a line.
//!
//! Read with colours (`COFF`), normals (`NOFF`), texture coordinates (`STOFF`), homogeneous coordinates (`4OFF`) and
//! points of any dimension (`nOFF`); a colour of 3 or 4 numbers after the coordinates is passed over even where the
//! keyword does not announce it, and so is whatever follows the vertices of a face. Faces of 1, 2, 3, n vertices are
//! points, edges, triangles, polygons. Comments run from `#` to the end of the line. Binary OFF is not read.

use super::error::{ErrorKind, Fault};
use super::intake::{Intake, reserve};
use super::source::Source;
use super::text::Line;
use super::{Format, ReadOptions, ReadReport};
use crate::soup::{Labels, Scalars, Soup};

/// What the keyword says about a vertex line.
#[derive(Clone, Copy, Default)]
struct Layout {
    /// Colours, normals or texture coordinates follow the coordinates.
    extras: bool,
    /// A homogeneous coordinate follows the coordinates.
    homogeneous: bool,
    /// The dimension is given before the counts.
    dimension_given: bool,
}

/// The layout that a keyword stands for: `[ST][C][N][4][n]OFF`.
fn layout(keyword: &[u8]) -> Option<Layout> {
    let mut prefix = keyword.strip_suffix(b"OFF")?;
    let mut layout = Layout::default();
    for extra in [&b"ST"[..], b"C", b"N"] {
        if let Some(rest) = prefix.strip_prefix(extra) {
            layout.extras = true;
            prefix = rest;
        }
    }
    if let Some(rest) = prefix.strip_prefix(b"4") {
        layout.homogeneous = true;
        prefix = rest;
    }
    if let Some(rest) = prefix.strip_prefix(b"n") {
        layout.dimension_given = true;
        prefix = rest;
    }
    prefix.is_empty().then_some(layout)
}

/// Whether a file that starts with this word says that it is OFF.
pub(super) fn is_keyword(word: &[u8]) -> bool {
    layout(word).is_some()
}

/// What begins a comment.
const COMMENT: Option<u8> = Some(b'#');

struct Header {
    dim: usize,
    layout: Layout,
    vertices: u32,
    faces: u64,
}

/// Reads the keyword, the dimension if it is given, and the counts, on one line or several.
fn header(source: &mut Source<'_>) -> Result<Header, Fault> {
    const COUNTS: &str = "the numbers of vertices (below 2^32), faces and edges";
    let mut line = source.need_content(COMMENT, "the keyword OFF")?;
    let first = line.need_word("the keyword OFF")?;
    let mut found = Layout::default();
    if let Some(known) = layout(first.bytes) {
        found = known;
    } else if first.bytes[0].is_ascii_digit() {
        // A file without keyword; it was called OFF by its name or by the user.
        line.seek(first.at);
    } else {
        return Err(line.unexpected(first, "the keyword OFF"));
    }
    if line.clone().word().is_some_and(|word| word.bytes == b"BINARY") {
        line.skip_blanks();
        let advice = "binary OFF is not read; save it as text, or as binary PLY";
        return Err(line.fault(line.at(), ErrorKind::Unsupported(advice.into())));
    }
    let mut dim = 3;
    if found.dimension_given {
        if !line.skip_blanks() {
            line = source.need_content(COMMENT, "the dimension of the points")?;
        }
        let expected = "the dimension of the points, from 1 to 65535";
        let word = line.need_word(expected)?;
        dim = line.parse_integer::<u16>(word, expected)?.into();
        if dim == 0 {
            return Err(line.unexpected(word, expected));
        }
    }
    if !line.skip_blanks() {
        line = source.need_content(COMMENT, COUNTS)?;
    }
    let vertices = line.integer(COUNTS)?;
    let faces = line.integer(COUNTS)?;
    // The number of edges is often missing, and never needed.
    if line.skip_blanks() {
        line.integer::<u64>("the number of edges")?;
    }
    line.end()?;
    Ok(Header { dim, layout: found, vertices, faces })
}

/// Reads one vertex line.
fn vertex(mut line: Line<'_>, header: &Header, values: &mut Vec<f64>) -> Result<(), Fault> {
    for _ in 0..header.dim {
        values.push(line.float("a coordinate of the vertex")?);
    }
    if header.layout.homogeneous {
        let at = line.at();
        let weight: f64 = line.float("the homogeneous coordinate of the vertex")?;
        let start = values.len() - header.dim;
        for value in &mut values[start..] {
            *value /= weight;
            if !value.is_finite() {
                let advice = "a vertex at infinity, by its homogeneous coordinate; only finite points are read";
                return Err(line.fault(at, ErrorKind::Unsupported(advice.into())));
            }
        }
    }
    if line.skip_blanks() {
        // Many programs append colours without saying so in the keyword: 3 or 4 numbers.
        let start = line.clone();
        let mut extras = 0;
        while line.skip_blanks() {
            line.float::<f64>("a number (a colour or a normal)")?;
            extras += 1;
        }
        if !header.layout.extras && !(3..=4).contains(&extras) {
            return start.clone().end();
        }
    }
    Ok(())
}

/// Reads one face line; the colour that may follow is not looked at.
fn face(mut line: Line<'_>, vertices: u32, word: &mut Vec<u32>, intake: &mut Intake) -> Result<(), Fault> {
    line.skip_blanks();
    let start = line.at();
    let count: u64 = line.integer("the number of vertices of the face")?;
    if count == 0 {
        line.seek(start);
        let zero = line.need_word("")?;
        return Err(line.unexpected(zero, "a face of at least one vertex"));
    }
    word.clear();
    for _ in 0..count {
        let number = line.need_word("as many vertices of the face as its first number says")?;
        let index: i64 = line.parse_integer(number, "the number of a vertex")?;
        match u32::try_from(index) {
            Ok(vertex) if vertex < vertices => word.push(vertex),
            _ => {
                let kind = ErrorKind::OutOfRange { index, vertices: vertices.into(), first: 0 };
                word.push(intake.missing(line.fault(number.at, kind))?);
            }
        }
    }
    intake.polygon(word, u64::from).map_err(|refusal| line.fault(start, refusal.kind(|vertex| vertex.to_string())))
}

/// Reads an OFF file.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let header = header(source)?;
    let mut values = Vec::with_capacity(reserve(header.vertices.into()));
    for _ in 0..header.vertices {
        let line = source.need_content(COMMENT, "as many vertices as the header says")?;
        vertex(line, &header, &mut values)?;
    }
    let mut intake = Intake::new(Format::Off, options);
    let mut word = Vec::new();
    for _ in 0..header.faces {
        let line = source.need_content(COMMENT, "as many faces as the header says")?;
        face(line, header.vertices, &mut word, &mut intake)?;
    }
    source.need_end(COMMENT, "file after the last face")?;
    Ok(intake.finish(Labels::Numbered(header.vertices as usize), true, Some((header.dim, Scalars::F64(values)))))
}
