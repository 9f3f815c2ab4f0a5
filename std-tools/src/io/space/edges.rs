//! Graphs in text: lists of edges by labels, and Ripser's sparse distance matrices. Fields are separated by blanks,
//! commas or semicolons; comments run from `#` to the end of the line.

use super::super::error::{ErrorKind, Fault, Position};
use super::super::intake::may_have;
use super::super::labels::{LabelTable, canonical};
use super::super::source::Source;
use super::super::text::{Line, Word};
use super::Space;
use super::row::{A_DISTANCE, COMMENT, distance, field};
use crate::graph::Graph;
use crate::soup::Labels;

/// Edges as far as they are read.
#[derive(Default)]
pub(super) struct Edges {
    pairs: Vec<(u32, u32)>,
    weights: Vec<f64>,
    /// Where each is given, for an error that only shows when all are known.
    positions: Vec<Position>,
}

impl Edges {
    pub(super) fn push(&mut self, a: u32, b: u32, weight: f64, position: Position) {
        self.pairs.push((a.min(b), a.max(b)));
        self.weights.push(weight);
        self.positions.push(position);
    }

    /// The graph; `repeated` is told how many edges repeat another. One that gives another weight is a fault.
    pub(super) fn graph(self, vertices: usize, weighted: bool, repeated: &mut usize) -> Result<Graph, Fault> {
        let Self { pairs, weights, positions } = self;
        let mut order: Vec<usize> = (0..pairs.len()).collect();
        order.sort_unstable_by_key(|&edge| (pairs[edge], edge));
        for twins in order.windows(2).filter(|twins| pairs[twins[0]] == pairs[twins[1]]) {
            let (before, after) = (weights[twins[0]], weights[twins[1]]);
            if before != after {
                let message =
                    format!("{before}, the weight of this edge where it was given before, in either direction");
                let found = format!("`{after}`").into();
                return Err(Fault::new(positions[twins[1]], ErrorKind::Expected { expected: message.into(), found }));
            }
            *repeated += 1;
        }
        let weights = weighted.then_some(&weights[..]);
        Graph::from_edges(vertices, &pairs, weights)
            .map_err(|error| Fault::new(Position::Whole, ErrorKind::Unsupported(error.to_string().into())))
    }
}

/// A fault unless the line ends here.
fn end(line: &mut Line<'_>) -> Result<(), Fault> {
    match field(line, false)? {
        None => Ok(()),
        Some(word) => Err(line.unexpected(word, "the end of the line")),
    }
}

/// Reads lines `u v`, `u v weight`, or `u` for a vertex that need not have an edge.
pub(super) fn list(source: &mut Source<'_>, repeated: &mut usize) -> Result<Space, Fault> {
    let (mut table, mut edges) = (LabelTable::new(), Edges::default());
    let mut weighted = None;
    while let Some(mut line) = source.next_content(COMMENT)? {
        let Some(first) = field(&mut line, true)? else { continue };
        let a = vertex(&mut table, &line, first)?;
        let Some(second) = field(&mut line, false)? else { continue };
        let b = vertex(&mut table, &line, second)?;
        if a == b {
            return Err(line.unexpected(second, "another vertex: an edge must not join a vertex to itself"));
        }
        let weight = field(&mut line, false)?;
        match (*weighted.get_or_insert(weight.is_some()), weight) {
            (true, None) => return Err(line.short("the weight of the edge, as other edges have one")),
            (false, Some(word)) => return Err(line.unexpected(word, "no weight, as other edges have none")),
            _ => {}
        }
        let weight = weight.map_or(Ok(0.0), |word| distance(&line, word))?;
        edges.push(a, b, weight, line.position(first.at));
        end(&mut line)?;
    }
    labelled(table, edges, weighted == Some(true), repeated)
}

/// The graph, its vertices in the order of their labels.
fn labelled(table: LabelTable, mut edges: Edges, weighted: bool, repeated: &mut usize) -> Result<Space, Fault> {
    let (numbers, labels) = sorted(table.into_labels());
    for (a, b) in &mut edges.pairs {
        let (x, y) = (numbers[*a as usize], numbers[*b as usize]);
        (*a, *b) = (x.min(y), x.max(y));
    }
    let graph = edges.graph(labels.len(), weighted, repeated)?;
    Ok(Space::Graph { graph, labels })
}

/// The edges of a graph whose vertices have names, of which some may have weights.
pub(super) struct LabelledEdges {
    table: LabelTable,
    edges: Edges,
    /// The edges without weights, by number.
    unweighted: Vec<usize>,
}

impl Default for LabelledEdges {
    fn default() -> Self {
        Self { table: LabelTable::new(), edges: Edges::default(), unweighted: Vec::new() }
    }
}

impl LabelledEdges {
    /// The number of the vertex with a name.
    pub(super) fn vertex(&mut self, name: &[u8], position: Position) -> Result<u32, Fault> {
        let number = match (canonical(name), std::str::from_utf8(name)) {
            (Some(integer), _) => self.table.number_integer(integer),
            (None, Ok(label)) if !label.is_empty() && !label.contains(char::is_control) => self.table.number(label),
            _ => {
                let expected = "the name of a vertex in UTF-8, without control characters".into();
                let found = super::super::error::excerpt(name);
                return Err(Fault::new(position, ErrorKind::Expected { expected, found }));
            }
        };
        number.ok_or_else(|| Fault::new(position, ErrorKind::TooManyVertices))
    }

    /// Adds an edge.
    pub(super) fn edge(&mut self, a: u32, b: u32, weight: Option<f64>, position: Position) -> Result<(), Fault> {
        if a == b {
            let message = "this edge joins a vertex to itself, which edges of a complex do not";
            return Err(Fault::new(position, ErrorKind::Rule(message.into())));
        }
        if weight.is_none() {
            self.unweighted.push(self.edges.pairs.len());
        }
        self.edges.push(a, b, weight.unwrap_or(0.0), position);
        Ok(())
    }

    /// The graph; edges without a weight have the weight `other` if there are edges with one.
    pub(super) fn finish(mut self, other: f64, repeated: &mut usize) -> Result<Space, Fault> {
        let weighted = self.unweighted.len() < self.edges.pairs.len();
        for &edge in self.unweighted.iter().filter(|_| weighted) {
            self.edges.weights[edge] = other;
        }
        labelled(self.table, self.edges, weighted, repeated)
    }
}

fn vertex(table: &mut LabelTable, line: &Line<'_>, word: Word<'_>) -> Result<u32, Fault> {
    if word.bytes.starts_with(b"\"") {
        return Err(
            line.unexpected(word, "a vertex label whose quotes stand around all of it; blanks and commas part labels")
        );
    }
    let number = match (canonical(word.bytes), std::str::from_utf8(word.bytes)) {
        (Some(integer), _) => table.number_integer(integer),
        (None, Ok(label)) if !label.is_empty() && !label.contains(char::is_control) => table.number(label),
        _ => return Err(line.unexpected(word, "a vertex label in UTF-8, without control characters")),
    };
    number.ok_or_else(|| line.fault(word.at, ErrorKind::TooManyVertices))
}

/// The labels in order, integers by value and others bytewise, and where each went.
fn sorted(labels: Labels) -> (Vec<u32>, Labels) {
    let mut order: Vec<u32> = (0..crate::build::narrow(labels.len())).collect();
    let labels = match labels {
        Labels::Numbered(count) => Labels::Numbered(count),
        Labels::Integers(labels) => {
            order.sort_unstable_by_key(|&old| labels[old as usize]);
            let sorted: Vec<u64> = order.iter().map(|&old| labels[old as usize]).collect();
            if sorted.iter().zip(0..).all(|(&label, number)| label == number) {
                Labels::Numbered(sorted.len())
            } else {
                Labels::Integers(sorted)
            }
        }
        Labels::Tokens(mut labels) => {
            order.sort_unstable_by(|&a, &b| labels[a as usize].as_bytes().cmp(labels[b as usize].as_bytes()));
            Labels::Tokens(order.iter().map(|&old| std::mem::take(&mut labels[old as usize])).collect())
        }
    };
    let mut numbers = vec![0; order.len()];
    for (&old, new) in order.iter().zip(0..) {
        numbers[old as usize] = new;
    }
    (numbers, labels)
}

/// Reads lines `i j distance`, points numbered from 0; those up to the largest number are points.
pub(super) fn sparse(source: &mut Source<'_>, repeated: &mut usize) -> Result<Space, Fault> {
    let (mut edges, mut entries) = (Edges::default(), 0);
    // The number of points, and where the last of them is named.
    let (mut points, mut last) = (0, Position::Whole);
    while let Some(mut line) = source.next_content(COMMENT)? {
        let (i, first) = point(&mut line, true)?;
        let (j, second) = point(&mut line, false)?;
        let word = field(&mut line, false)?.ok_or_else(|| line.short(A_DISTANCE))?;
        let value = distance(&line, word)?;
        if i != j {
            edges.push(i, j, value, line.position(word.at));
        } else if value != 0.0 {
            return Err(line.unexpected(word, "0, the distance of a point and itself"));
        }
        if i.max(j) as usize >= points {
            points = i.max(j) as usize + 1;
            last = line.position(if i > j { first } else { second });
        }
        entries += 1;
        end(&mut line)?;
    }
    check_points(points, entries, last)?;
    Ok(Space::Graph { graph: edges.graph(points, true, repeated)?, labels: Labels::Numbered(points) })
}

/// A fault, of the largest number of a point, if there are far more points than entries.
fn check_points(points: usize, entries: usize, last: Position) -> Result<(), Fault> {
    if may_have(points, entries) {
        return Ok(());
    }
    let message = format!(
        "{points} points, numbered from 0, but only {entries} entries; if these are labels and not numbers, --format edges"
    );
    Err(Fault::new(last, ErrorKind::Unsupported(message.into())))
}

/// The number of a point, and where in the line it stands.
fn point(line: &mut Line<'_>, first: bool) -> Result<(u32, usize), Fault> {
    const EXPECTED: &str = "the number of a point, from 0 and below 4294967294";
    let word = field(line, first)?.ok_or_else(|| line.short(EXPECTED))?;
    let number: u32 = line.parse_integer(word, EXPECTED)?;
    if number >= u32::MAX - 1 {
        return Err(line.unexpected(word, EXPECTED));
    }
    Ok((number, word.at))
}
