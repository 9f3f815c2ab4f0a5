//! One top simplex a line, by the labels of its vertices: holds every complex, and nothing else.

use std::io::{self, Write};

use sig_core::complex::columns::{Label, Labels};
use sig_core::{Relations, VertexId};

use super::ExportError;
use crate::tops::top_simplices;

/// Checks that each label is read back as it is.
pub(super) fn check_labels(complex: &impl Relations) -> Result<(), ExportError> {
    let labels = complex.labels();
    if !matches!(labels, Labels::Text { .. }) {
        return Ok(());
    }
    let is_separator =
        |c: char| c.is_ascii_whitespace() || c.is_ascii_control() || matches!(c, ',' | ';' | '#' | '[' | ']');
    for vertex in (0..complex.num_vertices()).map(VertexId::new) {
        match labels.get(vertex) {
            Some(Label::Text(label)) if !label.is_empty() && !label.contains(is_separator) => {}
            label => return Err(ExportError::Label { label: label.map_or(String::new(), |label| label.to_string()) }),
        }
    }
    Ok(())
}

pub(super) fn write(complex: &impl Relations, out: &mut dyn Write) -> io::Result<()> {
    let labels = complex.labels();
    let mut vertices = Vec::new();
    for top in top_simplices(complex) {
        top.oriented_vertices(complex, &mut vertices);
        for (position, &vertex) in vertices.iter().enumerate() {
            if position > 0 {
                out.write_all(b" ")?;
            }
            if let Some(label) = labels.get(vertex) {
                write!(out, "{label}")?;
            }
        }
        writeln!(out)?;
    }
    Ok(())
}
