//! The text of GUDHI's `Simplex_tree`: all simplices, not only the top ones, by filtration value, each after its faces.

use std::io::{self, Write};

use sig_core::complex::columns::{Label, Labels};
use sig_core::{Index, Relations, SimplexId, VertexId};

use crate::io::gudhi::write_simplex;

/// The largest label: GUDHI's vertices are of 32 bits with a sign.
const MOST: u64 = i32::MAX as u64;

/// Whether the vertices keep their labels; else they are called by their numbers.
pub(super) fn keeps_labels(complex: &impl Relations) -> bool {
    match complex.labels() {
        Labels::Numbered => true,
        Labels::Integers(labels) => labels.iter().all(|&label| label <= MOST),
        Labels::Text { .. } => false,
    }
}

pub(super) fn write<V: Relations>(complex: &V, out: &mut dyn Write) -> io::Result<()> {
    let labels = complex.labels();
    let keeps_labels = keeps_labels(complex);
    let values = complex.filtration();
    let label = |vertex: VertexId| match labels.get(vertex) {
        Some(Label::Integer(label)) if keeps_labels => label,
        _ => vertex.index() as u64,
    };
    let mut word = Vec::new();
    let mut line = |simplex: SimplexId| {
        word.clear();
        word.extend(complex.vertices(simplex).map(label));
        word.sort_unstable();
        write_simplex(out, &word, values.and_then(|values| values.get(simplex.index()).copied()).unwrap_or(0.0))
    };
    if values.is_none() {
        return complex.simplices().try_for_each(line);
    }
    let mut order = vec![V::Index::ZERO; complex.num_simplices()];
    complex.filtration_order(&mut order).map_err(io::Error::other)?.try_for_each(&mut line)
}
