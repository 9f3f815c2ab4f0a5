//! Generators of homology, as `sig homology --generators --json` prints them, to be drawn on their complex.

use hashbrown::HashMap;
use serde::Deserialize;
use serde_json::Value;
use sig_core::{Dim, Relations, SimplexId, VertexId};

use super::colour::{SERIES, lit, of_number};
use super::complex::Highlight;
use crate::build::narrow;
use crate::names::vertex_label;

/// Why there is nothing to draw.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GeneratorsError {
    /// It is no JSON, or that of something else.
    #[error("not what sig homology --generators --json prints: {0}")]
    Json(#[from] serde_json::Error),
    /// Homology without generators.
    #[error("there are no generators in it: sig homology writes them with --generators")]
    None,
    /// A cycle has a simplex that is none of the complex.
    #[error("generator {number} of dimension {dim}: {labels} is no simplex of the complex")]
    UnknownSimplex {
        /// The dimension.
        dim: Dim,
        /// The number of the generator among those of the dimension, from 1.
        number: usize,
        /// The labels of the vertices, separated by commas.
        labels: String,
    },
}

#[derive(Deserialize)]
struct Report {
    generators: Option<Vec<Vec<Generator>>>,
}

#[derive(Deserialize)]
struct Generator {
    /// A number, or a string of digits.
    order: Option<Value>,
    /// Coefficients and the labels of simplices.
    cycle: Vec<(Value, Vec<String>)>,
}

/// The cycles in a text, each a highlight in a colour of its own.
///
/// # Errors
/// [`GeneratorsError`].
pub fn read_generators(text: &[u8], complex: &impl Relations) -> Result<Vec<Highlight>, GeneratorsError> {
    let report: Report = serde_json::from_slice(text)?;
    let by_dim = report.generators.ok_or(GeneratorsError::None)?;
    let vertices = (0..complex.num_vertices()).map(VertexId::new);
    let by_label: HashMap<String, VertexId> = vertices.map(|vertex| (vertex_label(complex, vertex), vertex)).collect();
    let find = |labels: &[String]| -> Option<SimplexId> {
        let word: Option<Vec<VertexId>> = labels.iter().map(|label| by_label.get(label).copied()).collect();
        let mut word = word?;
        word.sort_unstable();
        complex.find(&word)
    };
    let mut highlights = Vec::new();
    for (dim, generators) in by_dim.into_iter().enumerate() {
        for (number, Generator { order, cycle }) in (1..).zip(generators) {
            let simplex = |(_, labels): &(Value, Vec<String>)| {
                let missing = || GeneratorsError::UnknownSimplex { dim, number, labels: labels.join(",") };
                find(labels).filter(|_| labels.len() == dim + 1).ok_or_else(missing)
            };
            let simplices = cycle.iter().map(simplex).collect::<Result<Vec<_>, _>>()?;
            let order = order
                .filter(|order| !order.is_null())
                .map(|order| format!(" of order {}", order.to_string().trim_matches('"')));
            let count = simplices.len();
            let what = match dim {
                0 => "vertex",
                1 => "edge",
                2 => "triangle",
                _ => "simplex",
            };
            let name = format!("H{dim}: cycle{}, {count} {}", order.unwrap_or_default(), many(what, count));
            let place = highlights.len();
            let colour = match (place / SERIES.len(), SERIES[place % SERIES.len()]) {
                (0, colour) => colour,
                (1, colour) => lit(colour, 0.55),
                _ => of_number(Some(narrow(place))),
            };
            highlights.push(Highlight { name, simplices, colour });
        }
    }
    Ok(highlights)
}

/// A noun for a number of things.
fn many(noun: &str, count: usize) -> String {
    match (count, noun.strip_suffix("ex")) {
        (1, _) => noun.to_owned(),
        (_, Some(stem)) => format!("{stem}ices"),
        (_, None) => format!("{noun}s"),
    }
}
