//! The nodes and elements of Nastran's bulk data (`.bdf`, `.nas`): cards of fields between commas, or of 8 or 16 columns,
//! which go on in further lines.
//!
//! Solids, shells, beams, bars and rods are read, by their corners; other cards are passed over and reported. The cards
//! before `BEGIN BULK` and after `ENDDATA` are not looked at. Coordinates are taken as they stand, whatever their
//! coordinate system; that a node names one is reported.

use super::error::{ErrorKind, Fault, Position, excerpt};
use super::report::ReadReport;
use super::shape::Shape;
use super::source::Source;
use super::tagged::TaggedMesh;
use super::text::{Line, parse_float, parse_integer};
use super::{Format, ReadOptions};
use crate::soup::Soup;

/// Whether a file that begins so has bulk data.
pub(super) fn is_bulk_data(head: &[u8]) -> bool {
    head.split(|&byte| byte == b'\n').any(|line| is_begin(line.trim_ascii()))
}

fn is_begin(line: &[u8]) -> bool {
    let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    words.next().is_some_and(|word| word.eq_ignore_ascii_case(b"BEGIN"))
        && words.next().is_some_and(|word| word.eq_ignore_ascii_case(b"BULK"))
}

/// The elements: the name of the card, the field of the first node (the number of the element is field 0), and the shape
/// with the most nodes.
const ELEMENTS: &[(&[u8], usize, Shape)] = &[
    (b"CTETRA", 2, Shape::simplex(4, 10)),
    (b"CHEXA", 2, Shape::hexahedron(20)),
    (b"CPENTA", 2, Shape::prism(15)),
    (b"CPYRAM", 2, Shape::pyramid(13)),
    (b"CPYRA", 2, Shape::pyramid(13)),
    (b"CTRIA3", 2, Shape::simplex(3, 3)),
    (b"CTRIAR", 2, Shape::simplex(3, 3)),
    (b"CTRIA6", 2, Shape::simplex(3, 6)),
    (b"CTRAX3", 2, Shape::simplex(3, 3)),
    (b"CQUAD4", 2, Shape::quadrangle(4)),
    (b"CQUADR", 2, Shape::quadrangle(4)),
    (b"CQUAD8", 2, Shape::quadrangle(8)),
    (b"CQUAD", 2, Shape::quadrangle(9)),
    (b"CSHEAR", 2, Shape::quadrangle(4)),
    (b"CBAR", 2, Shape::simplex(2, 2)),
    (b"CBEAM", 2, Shape::simplex(2, 2)),
    (b"CROD", 2, Shape::simplex(2, 2)),
    (b"CTUBE", 2, Shape::simplex(2, 2)),
    (b"CONROD", 1, Shape::simplex(2, 2)),
    (b"PLOTEL", 1, Shape::simplex(2, 2)),
];

/// A card: its name and its fields.
#[derive(Default)]
struct Card {
    name: Vec<u8>,
    text: Vec<u8>,
    /// Where in `text` each field ends, and its place in the input.
    fields: Vec<(usize, Position)>,
    position: Option<Position>,
}

impl Card {
    fn field(&self, number: usize) -> Option<(&[u8], Position)> {
        let &(end, position) = self.fields.get(number)?;
        let start = number.checked_sub(1).map_or(0, |before| self.fields[before].0);
        let text = &self.text[start..end];
        (!text.is_empty()).then_some((text, position))
    }

    fn clear(&mut self) {
        self.name.clear();
        self.text.clear();
        self.fields.clear();
        self.position = None;
    }

    /// Adds the fields of a line, the first of them being the name or the mark of a continuation.
    fn push_line(&mut self, line: &Line<'_>, is_first: bool) {
        let text = line.rest();
        let text = text.strip_suffix(b"\r").unwrap_or(text);
        let mut columns = Vec::new();
        if text.contains(&b',') {
            let mut start = 0;
            for end in memchr::memchr_iter(b',', text).chain([text.len()]) {
                columns.push((start, end));
                start = end + 1;
            }
            // The name, eight fields, and the mark of a continuation, which may be left out.
            columns.truncate(9);
        } else {
            let name = &text[..text.len().min(8)];
            let width = if name.contains(&b'*') { 16 } else { 8 };
            columns.push((0, name.len()));
            columns.extend((8..72).step_by(width).map(|start| (start, (start + width).min(72))));
        }
        for (number, (start, end)) in columns.into_iter().enumerate() {
            let field = text.get(start.min(text.len())..end.min(text.len())).unwrap_or(&[]);
            let blanks = field.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
            if number > 0 {
                self.text.extend(field.trim_ascii());
                self.fields.push((self.text.len(), line.position(start.min(text.len()) + blanks)));
            } else if is_first {
                self.name = field.trim_ascii().trim_ascii_end().to_ascii_uppercase();
                if self.name.last() == Some(&b'*') {
                    self.name.pop();
                }
                self.position = Some(line.position(blanks));
            }
        }
    }
}

/// A number as Nastran writes it: the exponent may lack its E.
fn real(text: &[u8]) -> Option<f64> {
    if let Some(value) = parse_float(text) {
        return Some(value);
    }
    let mut spelled = Vec::with_capacity(text.len() + 1);
    for (at, &byte) in text.iter().enumerate() {
        match byte {
            b'd' | b'D' => spelled.push(b'e'),
            b'+' | b'-' if at > 0 && !matches!(text[at - 1], b'e' | b'E' | b'd' | b'D') => spelled.extend([b'e', byte]),
            _ => spelled.push(byte),
        }
    }
    parse_float(&spelled)
}

fn unexpected(position: Position, expected: &'static str, found: &[u8]) -> Fault {
    Fault::new(position, ErrorKind::Expected { expected: expected.into(), found: excerpt(found) })
}

/// Reads the card at hand.
fn card(card: &Card, mesh: &mut TaggedMesh, nodes: &mut Vec<(u64, Position)>) -> Result<(), Fault> {
    let Some(position) = card.position else { return Ok(()) };
    let tag = |number: usize, expected: &'static str| {
        let (text, at) = card.field(number).ok_or_else(|| unexpected(position, expected, b""))?;
        let tag = parse_integer(text).and_then(|tag| u64::try_from(tag).ok());
        tag.map(|tag| (tag, at)).ok_or_else(|| unexpected(at, expected, text))
    };
    if card.name == b"GRID" {
        let (number, at) = tag(0, "the number of the node")?;
        if card.field(1).is_some_and(|(system, _)| system != b"0") {
            mesh.intake.report.ignored.note(b"coordinate systems of nodes");
        }
        let mut point = [0.0; 3];
        for (axis, value) in point.iter_mut().enumerate() {
            // A coordinate that is left out is 0.
            let Some((text, at)) = card.field(2 + axis) else { continue };
            *value = real(text).ok_or_else(|| unexpected(at, "a coordinate of the node", text))?;
            if !value.is_finite() && !mesh.intake.drops_bad() {
                return Err(Fault::new(at, ErrorKind::NotFinite { found: excerpt(text) }));
            }
        }
        return mesh.node(number, point, at);
    }
    let Some(&(_, first, shape)) = ELEMENTS.iter().find(|(name, ..)| *name == card.name) else {
        mesh.intake.report.ignored.note(&card.name);
        return Ok(());
    };
    tag(0, "the number of the element")?;
    nodes.clear();
    for number in 0..shape.num_nodes {
        // Nodes on edges may be left out.
        if number < shape.num_corners || card.field(first + number).is_some() {
            nodes.push(tag(first + number, "the number of a node, as many as the element has")?);
        }
    }
    mesh.element(shape, nodes, position)
}

/// Reads bulk data.
pub(super) fn read(source: &mut Source<'_>, options: &ReadOptions<'_>) -> Result<(Soup, ReadReport), Fault> {
    let mut mesh = TaggedMesh::new(Format::Nastran, options);
    // What stands before BEGIN BULK is no bulk data; without that line all is.
    let head = source.head()?;
    let mut in_bulk = !is_bulk_data(head);
    let (mut at_hand, mut nodes) = (Card::default(), Vec::new());
    while let Some(line) = source.next_content(Some(b'$'))? {
        let text = line.rest();
        if !in_bulk {
            in_bulk = is_begin(text.trim_ascii());
            continue;
        }
        let continues = matches!(text.first(), Some(b'+' | b'*' | b',' | b' ' | b'\t'));
        if continues && at_hand.position.is_some() {
            at_hand.push_line(&line, false);
            continue;
        }
        card(&at_hand, &mut mesh, &mut nodes)?;
        at_hand.clear();
        at_hand.push_line(&line, true);
        if at_hand.name == b"ENDDATA" {
            at_hand.clear();
            break;
        }
    }
    card(&at_hand, &mut mesh, &mut nodes)?;
    mesh.finish()
}
