//! The graph of a complex in the text of GUDHI's `Simplex_tree`: its vertices and edges, whatever else it lists.

use super::super::error::{ErrorKind, Fault, Position};
use super::super::gudhi::each;
use super::super::source::Source;
use super::Space;
use crate::graph::Graph;
use crate::soup::Labels;

/// Reads the vertices and the edges, in any order, with their values as weights; of one that is repeated the least counts.
///
/// A fault is a line that is no simplex, and an edge that lacks a vertex or has a smaller value than one. Simplices of
/// higher dimensions are not kept.
pub(super) fn read(source: &mut Source<'_>) -> Result<Space, Fault> {
    let mut vertices: Vec<(u32, f64)> = Vec::new();
    let (mut pairs, mut weights, mut positions) = (Vec::new(), Vec::new(), Vec::new());
    each(source, &mut |word, value, position| {
        match *word {
            [vertex] => vertices.push((vertex, value)),
            [a, b] => {
                pairs.push((a, b));
                weights.push(value);
                positions.push(position);
            }
            _ => {}
        }
        Ok(())
    })?;
    vertices.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    vertices.dedup_by_key(|&mut (label, _)| label);
    for ((pair, &weight), &position) in pairs.iter_mut().zip(&weights).zip(&positions) {
        let [a, b] = [pair.0, pair.1].map(|label| vertices.binary_search_by_key(&label, |&(label, _)| label));
        let (Ok(a), Ok(b)) = (a, b) else {
            let missing = if a.is_err() { pair.0 } else { pair.1 };
            return Err(rule(position, format!("the vertex {missing} of this edge is not in the input")));
        };
        let most = vertices[a].1.max(vertices[b].1);
        if weight < most {
            return Err(rule(position, format!("the value {weight} is below {most}, that of a vertex of this edge")));
        }
        *pair = (crate::build::narrow(a), crate::build::narrow(b));
    }
    let (labels, values): (Vec<u32>, Vec<f64>) = vertices.into_iter().unzip();
    let unsupported = |error: crate::graph::GraphError| rule(Position::Whole, error.to_string());
    let graph = Graph::from_edges(labels.len(), &pairs, Some(&weights)).map_err(unsupported)?;
    let graph = graph.with_vertex_weights(values).map_err(unsupported)?;
    let labels = if labels.iter().zip(0..).all(|(&label, number)| label == number) {
        Labels::Numbered(labels.len())
    } else {
        Labels::Integers(labels.into_iter().map(u64::from).collect())
    };
    Ok(Space::Graph { graph, labels })
}

fn rule(position: Position, message: String) -> Fault {
    Fault::new(position, ErrorKind::Rule(message.into()))
}
