//! The nodes and elements of Abaqus' input files (`.inp`): keyword lines that begin with `*`, data lines of numbers between
//! commas.
//!
//! Solids, shells, membranes, beams and trusses are read, by their corners; elements of other types and all other keywords
//! are passed over and reported. Comments begin with `**`. Parts and instances are not told apart: their nodes must have
//! different numbers. What is generated (`*NGEN`, `*ELGEN`, …) or included is not read.

use super::error::{ErrorKind, Fault, Position, excerpt};
use super::report::ReadReport;
use super::shape::Shape;
use super::source::Source;
use super::tagged::TaggedMesh;
use super::text::{Line, Word, parse_integer};
use super::{Format, ReadOptions};
use crate::soup::Soup;

/// Keywords with which a file may begin.
const FIRST: [&[u8]; 5] = [b"*HEADING", b"*NODE", b"*PART", b"*PREPRINT", b"*ELEMENT"];

/// Whether a file that begins so is an Abaqus input file.
pub(super) fn is_input(head: &[u8]) -> bool {
    let lines = head.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let mut lines = lines.filter(|line| !line.is_empty() && !line.starts_with(b"**"));
    let first = lines.next().unwrap_or(&[]);
    FIRST.iter().any(|keyword| {
        first.get(..keyword.len()).is_some_and(|start| start.eq_ignore_ascii_case(keyword))
            && first.get(keyword.len()).is_none_or(|&next| next == b',' || next.is_ascii_whitespace())
    })
}

/// The number that begins with the first of these bytes.
fn leading(text: &str) -> usize {
    let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
    text[..end].parse().unwrap_or(0)
}

/// The shape of an element type.
fn shape(name: &str) -> Option<Shape> {
    let name = name.to_ascii_uppercase();
    let after = |prefixes: &[&str]| prefixes.iter().find_map(|prefix| name.strip_prefix(prefix));
    if let Some(rest) = after(&["AC3D", "DC3D", "C3D"]) {
        return Some(match leading(rest) {
            4 => Shape::simplex(4, 4),
            10 => Shape::simplex(4, 10),
            5 => Shape::pyramid(5),
            13 => Shape::pyramid(13),
            6 => Shape::prism(6),
            15 => Shape::prism(15),
            8 => Shape::hexahedron(8),
            20 => Shape::hexahedron(20),
            27 => Shape::hexahedron(27),
            _ => return None,
        });
    }
    let line = |nodes| Some(Shape::simplex(2, nodes));
    if let Some(rest) = after(&["SC"]) {
        return match leading(rest) {
            6 => Some(Shape::prism(6)),
            8 => Some(Shape::hexahedron(8)),
            _ => None,
        };
    }
    if let Some(rest) = after(&["STRI"]) {
        return Some(Shape::simplex(3, if rest.starts_with('6') { 6 } else { 3 }));
    }
    if let Some(rest) = after(&["T2D", "T3D", "DC1D", "RB2D", "RB3D", "R2D", "CONN2D", "CONN3D"]) {
        return match leading(rest) {
            nodes @ 2..=3 => line(nodes),
            _ => None,
        };
    }
    if let Some(rest) = after(&["PIPE2", "PIPE3", "ELBOW3", "B2", "B3"]) {
        return match leading(rest) {
            1 | 3 => line(2),
            2 => line(3),
            _ => None,
        };
    }
    if matches!(&*name, "SPRINGA" | "DASHPOTA" | "FRAME2D" | "FRAME3D") {
        return line(2);
    }
    let planar = after(&[
        "CPEG", "CPE", "CPS", "CGAX", "CAX", "DC2D", "DCAX", "AC2D", "ACAX", "M3D", "SFM3D", "R3D", "DS", "S",
    ])?;
    // A shell like S4R5 has as many nodes as its first digit says.
    Some(match leading(planar) {
        3 => Shape::simplex(3, 3),
        6 => Shape::simplex(3, 6),
        4 => Shape::quadrangle(4),
        8 => Shape::quadrangle(8),
        9 => Shape::quadrangle(9),
        _ => return None,
    })
}

/// What the data lines after a keyword are.
#[derive(Clone, Copy)]
enum Section {
    Nodes,
    Elements(Shape),
    Other,
}

/// The fields of a line, between commas; blanks around them do not count.
fn field<'l>(line: &mut Line<'l>) -> Option<Word<'l>> {
    if !line.skip_blanks() {
        return None;
    }
    let at = line.at();
    let rest = line.rest();
    let end = memchr::memchr(b',', rest).unwrap_or(rest.len());
    line.seek(at + end + 1);
    Some(Word { bytes: rest[..end].trim_ascii_end(), at })
}

/// A field as the tag of a node.
fn tag(line: &Line<'_>, word: Word<'_>) -> Result<u64, Fault> {
    parse_integer(word.bytes)
        .and_then(|tag| u64::try_from(tag).ok())
        .ok_or_else(|| line.unexpected(word, "the number of a node or an element"))
}

struct Input {
    mesh: TaggedMesh,
    section: Section,
    /// The nodes of the element at hand, which may go on in the next line, and where it begins.
    nodes: Vec<(u64, Position)>,
    begin: Option<Position>,
}

impl Input {
    /// Reads a line that begins with `*`.
    fn keyword(&mut self, mut line: Line<'_>) -> Result<(), Fault> {
        self.need_whole()?;
        let Some(word) = field(&mut line) else { return Ok(()) };
        let name = word.bytes.to_ascii_uppercase();
        self.section = match &*name {
            b"*NODE" => Section::Nodes,
            b"*ELEMENT" => {
                let mut kind = None;
                while let Some(word) = field(&mut line) {
                    let (key, value) = match memchr::memchr(b'=', word.bytes) {
                        Some(at) => (word.bytes[..at].trim_ascii(), word.bytes[at + 1..].trim_ascii()),
                        None => (word.bytes, &b""[..]),
                    };
                    if key.eq_ignore_ascii_case(b"TYPE") {
                        kind = Some(String::from_utf8_lossy(value).into_owned());
                    }
                }
                let kind = kind.ok_or_else(|| line.short("the parameter TYPE="))?;
                match shape(&kind) {
                    Some(shape) => Section::Elements(shape),
                    None => {
                        self.mesh.intake.report.ignored.note(format!("elements of type {kind}").as_bytes());
                        Section::Other
                    }
                }
            }
            b"*HEADING" | b"*PREPRINT" | b"*PART" | b"*END PART" | b"*NSET" | b"*ELSET" => Section::Other,
            _ => {
                self.mesh.intake.report.ignored.note(&name);
                Section::Other
            }
        };
        Ok(())
    }

    fn data(&mut self, mut line: Line<'_>) -> Result<(), Fault> {
        match self.section {
            Section::Other => Ok(()),
            Section::Nodes => {
                let Some(word) = field(&mut line) else { return Ok(()) };
                let position = line.position(word.at);
                let number = tag(&line, word)?;
                let mut point = [0.0; 3];
                for value in &mut point {
                    // A coordinate that is left out is 0.
                    let Some(word) = field(&mut line) else { break };
                    *value = coordinate(&line, word)?;
                }
                self.mesh.node(number, point, position)
            }
            Section::Elements(shape) => self.element(line, shape),
        }
    }

    /// Reads a line of an element, which may be its first.
    fn element(&mut self, mut line: Line<'_>, shape: Shape) -> Result<(), Fault> {
        while let Some(word) = field(&mut line) {
            let position = line.position(word.at);
            let number = tag(&line, word)?;
            if self.begin.is_none() {
                // The number of the element.
                self.begin = Some(position);
                continue;
            }
            if self.nodes.len() == shape.num_nodes {
                // The node that gives the direction of a beam, and the like.
                continue;
            }
            self.nodes.push((number, position));
        }
        if let Some(begin) = self.begin
            && self.nodes.len() == shape.num_nodes
        {
            self.mesh.element(shape, &self.nodes, begin)?;
            self.nodes.clear();
            self.begin = None;
        }
        Ok(())
    }

    /// A fault if an element has begun and not ended.
    fn need_whole(&self) -> Result<(), Fault> {
        let (Some(begin), Section::Elements(shape)) = (self.begin, self.section) else { return Ok(()) };
        let (declared, found) = (shape.num_nodes as u64, self.nodes.len() as u64);
        Err(Fault::new(begin, ErrorKind::WrongCount { what: "nodes of the element", declared, found }))
    }
}

/// A field as a coordinate; the exponent may begin with D.
fn coordinate(line: &Line<'_>, word: Word<'_>) -> Result<f64, Fault> {
    if word.bytes.is_empty() {
        return Ok(0.0);
    }
    let text: Vec<u8> = word.bytes.iter().map(|&byte| if matches!(byte, b'd' | b'D') { b'e' } else { byte }).collect();
    let value =
        super::text::parse_float::<f64>(&text).ok_or_else(|| line.unexpected(word, "a coordinate of the node"))?;
    if line.takes(value) {
        return Ok(value);
    }
    Err(line.fault(word.at, ErrorKind::NotFinite { found: excerpt(word.bytes) }))
}

/// Reads an input file.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let mesh = TaggedMesh::new(Format::Abaqus, options);
    let mut input = Input { mesh, section: Section::Other, nodes: Vec::new(), begin: None };
    let mut any = false;
    while let Some(line) = source.next_content(None)? {
        let text = line.rest().trim_ascii_start();
        any |= text.starts_with(b"*");
        if text.starts_with(b"**") {
            continue;
        }
        if text.starts_with(b"*") {
            input.keyword(line)?;
        } else if any {
            input.data(line)?;
        } else {
            let found = excerpt(text);
            let kind = ErrorKind::Expected { expected: "a keyword, which begins with *".into(), found };
            return Err(line.fault(0, kind));
        }
    }
    input.need_whole()?;
    if !any {
        let expected = "a keyword, which begins with *".into();
        return Err(Fault::new(source.end_of_text(), ErrorKind::Truncated { expected }));
    }
    input.mesh.finish()
}
