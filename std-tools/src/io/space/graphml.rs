//! Graphs in GraphML: nodes and edges, whose directions do not count.
//!
//! Data of edges whose key is called `weight` are their weights, 1 where other edges have one. Other data are passed over,
//! nested graphs are parts of the whole. Hyperedges are not read.

use super::super::error::{ErrorKind, Fault};
use super::super::source::{Source, truncated};
use super::super::tags::{self, Tag};
use super::super::words::Words;
use super::Space;
use super::edges::LabelledEdges;

/// Whether a text that begins so is in GraphML.
pub(super) fn is_graphml(head: &[u8]) -> bool {
    head.trim_ascii_start().starts_with(b"<") && memchr::memmem::find(head, b"<graphml").is_some()
}

fn attribute<'t>(tag: &'t Tag, name: &'static str) -> Result<&'t str, Fault> {
    tag.get(name).ok_or_else(|| tag.unsupported(format!("the element {} lacks the attribute {name}", tag.name)))
}

/// Reads a graph.
pub(super) fn read(source: &mut Source<'_>, repeated: &mut usize) -> Result<Space, Fault> {
    tags::first(source, "graphml")?;
    let mut graph = LabelledEdges::default();
    let mut weight_key: Option<Box<str>> = None;
    // The edge at hand, and its weight.
    let mut edge = None;
    loop {
        let end = source.end_of_text();
        let Some(tag) = tags::next(source)? else { return Err(truncated(end, "the tag that ends graphml")) };
        match (&*tag.name, tag.closing) {
            ("graphml", true) => return graph.finish(1.0, repeated),
            ("key", false) if tag.get("attr.name") == Some("weight") && tag.get("for") != Some("node") => {
                weight_key = Some(attribute(&tag, "id")?.into());
            }
            ("node", false) => drop(graph.vertex(attribute(&tag, "id")?.as_bytes(), tag.position)?),
            ("edge", false) => {
                let ends = ["source", "target"].map(|name| attribute(&tag, name));
                let [from, to] = ends;
                let from = graph.vertex(from?.as_bytes(), tag.position)?;
                let to = graph.vertex(to?.as_bytes(), tag.position)?;
                if tag.empty {
                    graph.edge(from, to, None, tag.position)?;
                } else {
                    edge = Some((from, to, None, tag.position));
                }
            }
            ("data", false) if !tag.empty && weight_key.is_some() && tag.get("key") == weight_key.as_deref() => {
                if let Some((.., weight, _)) = &mut edge {
                    let position = source.end_of_text();
                    let value: f64 = Words::before(source, b'<').float("the weight of the edge")?;
                    if value < 0.0 {
                        let expected = super::row::A_DISTANCE.into();
                        let found = value.to_string().into();
                        return Err(Fault::new(position, ErrorKind::Expected { expected, found }));
                    }
                    *weight = Some(value + 0.0);
                }
            }
            ("edge", true) => {
                if let Some((from, to, weight, position)) = edge.take() {
                    graph.edge(from, to, weight, position)?;
                }
            }
            ("hyperedge", false) => return Err(tag.unsupported("hyperedges are not read, but edges")),
            _ => {}
        }
    }
}
