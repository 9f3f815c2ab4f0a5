//! STL, in text and binary: triangles by the coordinates of their corners.
//!
//! Corners with equal coordinates (bit for bit, −0 being +0) are one vertex; vertices are numbered by first
//! appearance. Normals, names and attributes are passed over.

use hashbrown::HashMap;

use super::error::{ErrorKind, Fault, Position};
use super::intake::Intake;
use super::source::Source;
use super::text::{Line, Word};
use super::{Format, ReadOptions, ReadReport};
use crate::soup::{Labels, Scalars, Soup};

/// The bytes of a binary file before its facets: 80 of any content, and the number of facets.
const HEADER: usize = 84;
/// The bytes of a facet: normal, three corners, attribute.
const FACET: usize = 50;

/// Whether this is a binary file, by its size: `84 + 50 n`, where `n` stands at byte 80.
pub(super) fn is_binary(head: &[u8], length: Option<u64>) -> bool {
    let Some(&[a, b, c, d]) = head.get(80..HEADER) else { return false };
    let facets = u64::from(u32::from_le_bytes([a, b, c, d]));
    length == Some(HEADER as u64 + FACET as u64 * facets)
}

/// Whether this is a text file: a line `solid`, then a facet or the end.
pub(super) fn is_text(head: &[u8]) -> bool {
    let mut lines = head.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii_start).filter(|line| !line.is_empty());
    lines.next().is_some_and(|line| keyword_is(line, b"solid"))
        && lines.next().is_some_and(|line| keyword_is(line, b"facet") || keyword_is(line, b"endsolid"))
}

/// Whether a line begins with this keyword, in upper or lower case.
fn keyword_is(line: &[u8], keyword: &[u8]) -> bool {
    line.get(..keyword.len()).is_some_and(|start| start.eq_ignore_ascii_case(keyword))
        && line.get(keyword.len()).is_none_or(u8::is_ascii_whitespace)
}

/// Corners welded into vertices.
struct Weld {
    numbers: HashMap<[u32; 3], u32>,
    values: Vec<f32>,
    welded: usize,
    /// Whether each corner is a vertex of its own.
    apart: bool,
}

impl Weld {
    /// The vertex at these finite coordinates.
    fn vertex(&mut self, corner: [f32; 3]) -> Result<u32, ErrorKind> {
        let next = u32::try_from(self.values.len() / 3).ok().filter(|&next| next < u32::MAX);
        let next = next.ok_or(ErrorKind::TooManyVertices)?;
        // −0 + 0 is +0; every other number stays what it is.
        let corner = corner.map(|value| value + 0.0);
        if self.apart {
            self.values.extend(corner);
            return Ok(next);
        }
        let number = *self.numbers.entry(corner.map(f32::to_bits)).or_insert(next);
        if number == next {
            self.values.extend(corner);
        } else {
            self.welded += 1;
        }
        Ok(number)
    }
}

/// An STL file as far as it is read.
struct Stl {
    weld: Weld,
    intake: Intake,
}

impl Stl {
    /// Adds a facet whose three corners are known.
    fn facet(&mut self, corners: [u32; 3]) -> Result<(), ErrorKind> {
        self.intake.simplex(&corners).map_err(|refusal| {
            refusal.kind(|vertex| {
                let at = 3 * vertex as usize;
                format!("({})", self.weld.values[at..at + 3].iter().map(f32::to_string).collect::<Vec<_>>().join(" "))
            })
        })
    }

    fn finish(mut self) -> (Soup, ReadReport) {
        self.intake.report.welded = self.weld.welded;
        let labels = Labels::Numbered(self.weld.values.len() / 3);
        self.intake.finish(labels, true, Some((3, Scalars::F32(self.weld.values))))
    }

    /// Reads the facets of a binary file.
    fn binary(&mut self, source: &mut Source<'_>) -> Result<(), Fault> {
        let header = source.take(HEADER, "84 bytes of header")?;
        let facets = u32::from_le_bytes([header[80], header[81], header[82], header[83]]);
        for _ in 0..facets {
            let (position, start) = (source.byte(), source.offset());
            let record = source.take(FACET, "as many facets as the header says")?;
            let mut values = [0.0; 9];
            for (number, (value, bytes)) in (0..).zip(values.iter_mut().zip(record[12..48].chunks_exact(4))) {
                *value = f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]);
                if !value.is_finite() && !self.intake.drops_bad() {
                    let position = Position::Byte(start + 12 + 4 * number);
                    return Err(Fault::new(position, ErrorKind::NotFinite { found: value.to_string().into() }));
                }
            }
            let mut corners = [0; 3];
            for (vertex, corner) in corners.iter_mut().zip(values.chunks_exact(3)) {
                let corner = [corner[0], corner[1], corner[2]];
                *vertex = self.weld.vertex(corner).map_err(|kind| Fault::new(position, kind))?;
            }
            self.facet(corners).map_err(|kind| Fault::new(position, kind))?;
        }
        source.need_end_of_bytes("file after the last facet")
    }

    /// Reads the solids of a text file, one after the other.
    fn text(&mut self, source: &mut Source<'_>) -> Result<(), Fault> {
        keyword(&mut source.need_content(None, "solid")?, "solid")?;
        self.solid(source)?;
        while let Some(mut line) = source.next_content(None)? {
            if !keyword_is(line.rest().trim_ascii_start(), b"solid") {
                return Err(line.trailing("file after endsolid"));
            }
            self.solid(source)?;
        }
        Ok(())
    }

    /// Reads one solid after its first line.
    fn solid(&mut self, source: &mut Source<'_>) -> Result<(), Fault> {
        loop {
            let mut line = source.need_content(None, "a facet or endsolid")?;
            let word = line.need_word("a facet or endsolid")?;
            if word.bytes.eq_ignore_ascii_case(b"endsolid") {
                return Ok(());
            }
            if !word.bytes.eq_ignore_ascii_case(b"facet") {
                return Err(line.unexpected(word, "a facet or endsolid"));
            }
            let position = line.position(word.at);
            let corners = self.corners(source)?;
            self.facet(corners).map_err(|kind| Fault::new(position, kind))?;
        }
    }

    /// Reads a facet after its first line.
    fn corners(&mut self, source: &mut Source<'_>) -> Result<[u32; 3], Fault> {
        keyword(&mut source.need_content(None, "outer loop")?, "outer")?;
        let mut corners = [0; 3];
        for vertex in &mut corners {
            let mut line = source.need_content(None, "the three corners of the facet")?;
            let word = keyword(&mut line, "vertex")?;
            let mut corner = [0.0; 3];
            for value in &mut corner {
                *value = line.float("a coordinate of the corner")?;
            }
            line.end()?;
            *vertex = self.weld.vertex(corner).map_err(|kind| line.fault(word.at, kind))?;
        }
        keyword(&mut source.need_content(None, "endloop")?, "endloop")?;
        keyword(&mut source.need_content(None, "endfacet")?, "endfacet")?;
        Ok(corners)
    }
}

/// Reads the keyword of a line; what follows it is the caller's.
fn keyword<'l>(line: &mut Line<'l>, expected: &'static str) -> Result<Word<'l>, Fault> {
    let word = line.need_word(expected)?;
    if word.bytes.eq_ignore_ascii_case(expected.as_bytes()) { Ok(word) } else { Err(line.unexpected(word, expected)) }
}

/// Reads an STL file.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let apart = options.weld == Some(super::Weld::None);
    let weld = Weld { numbers: HashMap::default(), values: Vec::new(), welded: 0, apart };
    let mut stl = Stl { weld, intake: Intake::new(Format::Stl, options) };
    let length = source.whole_length()?;
    let head = source.head()?;
    // A binary header may begin with `solid` too, so the size has the first word, and text must go on as text.
    let starts_as_text = keyword_is(head.trim_ascii_start(), b"solid");
    if is_binary(head, length) || !(is_text(head) || starts_as_text && !head.contains(&0)) {
        stl.binary(source)?;
    } else {
        stl.text(source)?;
    }
    Ok(stl.finish())
}
