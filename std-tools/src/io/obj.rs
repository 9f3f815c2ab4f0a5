//! Wavefront OBJ: `v` vertices, `f` faces, `l` polylines, `p` points, one statement a line.
//!
//! Vertices are numbered from 1, negative numbers count back from the last vertex. Texture coordinates, normals,
//! groups, materials and free-form geometry are passed over.

use super::error::{ErrorKind, Fault, Position};
use super::intake::Intake;
use super::source::Source;
use super::text::{Line, Word};
use super::{Format, ReadOptions, ReadReport};
use crate::soup::{Labels, Scalars, Soup};

/// The statements of the format that say nothing about the complex.
const PASSED_OVER: &[&[u8]] = &[
    b"vt",
    b"vn",
    b"g",
    b"o",
    b"s",
    b"mg",
    b"usemtl",
    b"mtllib",
    b"maplib",
    b"usemap",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"shadow_obj",
    b"trace_obj",
    b"call",
    b"csh",
];

/// Whether a line that starts with this word may be a statement of an OBJ file.
pub(super) fn is_keyword(word: &[u8]) -> bool {
    matches!(word, b"v" | b"f" | b"l" | b"p") || PASSED_OVER.contains(&word)
}

/// An OBJ file as far as it is read.
struct Obj {
    values: Vec<f64>,
    vertices: u32,
    intake: Intake,
    /// The greatest vertex number used before its vertex was there, and where.
    ahead: Option<(u32, Position)>,
    /// Vertex numbers (from 0) of the statement at hand.
    word: Vec<u32>,
}

impl Obj {
    /// Reads `x y z`, and passes over a weight or a colour.
    fn vertex(&mut self, mut line: Line<'_>) -> Result<(), Fault> {
        if self.vertices == u32::MAX {
            return Err(line.fault(0, ErrorKind::TooManyVertices));
        }
        for _ in 0..3 {
            self.values.push(line.float("a coordinate of the vertex")?);
        }
        let mut extras = 0;
        while line.skip_blanks() {
            if extras == 4 {
                return Err(line.trailing("line"));
            }
            line.float::<f64>("a weight or a colour")?;
            extras += 1;
        }
        self.vertices += 1;
        Ok(())
    }

    /// The vertex number, from 0, in `v`, `v/vt`, `v//vn` or `v/vt/vn`.
    fn reference(&mut self, word: Word<'_>, line: &Line<'_>) -> Result<u32, Fault> {
        const EXPECTED: &str = "a vertex number, as in 7, 7/8, 7//9 or 7/8/9";
        let end = memchr::memchr(b'/', word.bytes).unwrap_or(word.bytes.len());
        let index: i64 = line.parse_integer(Word { bytes: &word.bytes[..end], at: word.at }, EXPECTED)?;
        if end < word.bytes.len() && !word.bytes[end..].iter().all(|byte| matches!(byte, b'/' | b'-' | b'0'..=b'9')) {
            return Err(line.unexpected(word, EXPECTED));
        }
        let vertex = if index < 0 { i64::from(self.vertices) + index } else { index - 1 };
        match u32::try_from(vertex) {
            Ok(vertex) if vertex < self.vertices => Ok(vertex),
            // A later line may still bring the vertex.
            Ok(vertex) if index > 0 && vertex < u32::MAX => {
                if self.ahead.is_none_or(|(greatest, _)| vertex > greatest) {
                    self.ahead = Some((vertex, line.position(word.at)));
                }
                Ok(vertex)
            }
            _ => self.intake.missing(line.fault(word.at, out_of_range(index, self.vertices))),
        }
    }

    /// Reads the references of a statement into `self.word`, at least `least` of them.
    fn references(&mut self, line: &mut Line<'_>, least: usize, expected: &'static str) -> Result<(), Fault> {
        self.word.clear();
        while let Some(word) = line.word() {
            let vertex = self.reference(word, line)?;
            self.word.push(vertex);
        }
        if self.word.len() < least { Err(line.short(expected)) } else { Ok(()) }
    }

    /// Reads one statement.
    fn statement(&mut self, mut line: Line<'_>) -> Result<(), Fault> {
        let Some(keyword) = line.word() else { return Ok(()) };
        let added = match keyword.bytes {
            b"v" => return self.vertex(line),
            b"f" | b"fo" => {
                self.references(&mut line, 3, "at least three vertices of the face")?;
                self.intake.polygon(&self.word, u64::from)
            }
            b"l" => {
                self.references(&mut line, 2, "at least two vertices of the line")?;
                self.word.windows(2).try_for_each(|edge| self.intake.simplex(edge))
            }
            b"p" => {
                self.references(&mut line, 1, "at least one point")?;
                self.word.chunks(1).try_for_each(|point| self.intake.simplex(point))
            }
            known if PASSED_OVER.contains(&known) => Ok(()),
            unknown => {
                self.intake.report.ignored.note(unknown);
                Ok(())
            }
        };
        added.map_err(|refusal| line.fault(keyword.at, refusal.kind(|vertex| (u64::from(vertex) + 1).to_string())))
    }
}

fn out_of_range(index: i64, vertices: u32) -> ErrorKind {
    ErrorKind::OutOfRange { index, vertices: vertices.into(), first: 1 }
}

/// Reads an OBJ file.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let intake = Intake::new(Format::Obj, options);
    let mut obj = Obj { values: Vec::new(), vertices: 0, intake, ahead: None, word: Vec::new() };
    while let Some(line) = source.next_joined_line()? {
        obj.statement(line.without_comment(b'#'))?;
    }
    if let Some((vertex, position)) = obj.ahead
        && vertex >= obj.vertices
        && !obj.intake.drops_bad()
    {
        return Err(Fault::new(position, out_of_range(i64::from(vertex) + 1, obj.vertices)));
    }
    let labels = Labels::Integers((1..=u64::from(obj.vertices)).collect());
    Ok(obj.intake.finish(labels, true, Some((3, Scalars::F64(obj.values)))))
}
