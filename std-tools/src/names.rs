//! Simplices by the labels that the user's data give to vertices, and back.

use sig_core::complex::columns::Labels;
use sig_core::{Relations, SimplexId, VertexId};

/// Why labels are not those of a simplex.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FindError {
    /// No vertex has this label.
    #[error("there is no vertex '{label}'")]
    UnknownVertex {
        /// The label.
        label: String,
    },
    /// A label stands twice.
    #[error("vertex '{label}' is named twice")]
    RepeatedVertex {
        /// The label.
        label: String,
    },
    /// The vertices exist, but do not span a simplex.
    #[error("the vertices {labels} do not span a simplex")]
    UnknownSimplex {
        /// The labels, separated by commas.
        labels: String,
    },
}

/// The label of a vertex; `#` and its number if the file has none that can be read.
#[must_use]
pub fn vertex_label(complex: &impl Relations, vertex: VertexId) -> String {
    label_text(&complex.labels(), vertex)
}

fn label_text(labels: &Labels<'_>, vertex: VertexId) -> String {
    labels.get(vertex).map_or_else(|| format!("#{vertex}"), |label| label.to_string())
}

/// The labels of the vertices of a simplex, by increasing vertex.
#[must_use]
pub fn simplex_labels(complex: &impl Relations, simplex: SimplexId) -> Vec<String> {
    // Finding the labels walks the section table: once for them all.
    let labels = complex.labels();
    complex.vertices(simplex).map(|vertex| label_text(&labels, vertex)).collect()
}

/// The labels of the vertices of a simplex, separated by commas.
#[must_use]
pub fn simplex_name(complex: &impl Relations, simplex: SimplexId) -> String {
    simplex_labels(complex, simplex).join(",")
}

/// The vertex with a label.
///
/// Cost: O(1) where vertices are called by their numbers; else one pass over the labels.
#[must_use]
pub fn find_vertex(complex: &impl Relations, label: &str) -> Option<VertexId> {
    let vertices = || (0..complex.num_vertices()).map(VertexId::new);
    match complex.labels() {
        Labels::Numbered => {
            let vertex = label.parse().ok().map(VertexId::new)?;
            (vertex.index() < complex.num_vertices()).then_some(vertex)
        }
        Labels::Integers(labels) => {
            let label: u64 = label.parse().ok()?;
            labels.iter().position(|&other| other == label).map(VertexId::new)
        }
        labels @ Labels::Text { .. } => {
            let label = sig_core::complex::columns::Label::Text(label);
            vertices().find(|&vertex| labels.get(vertex) == Some(label))
        }
    }
}

/// The simplex whose vertices have the given labels, in any order.
///
/// # Errors
/// [`FindError`], naming the label or labels that are to blame.
pub fn find_simplex(complex: &impl Relations, labels: &[&str]) -> Result<SimplexId, FindError> {
    let mut vertices = Vec::with_capacity(labels.len());
    for &label in labels {
        let unknown = || FindError::UnknownVertex { label: label.to_owned() };
        let vertex = find_vertex(complex, label).ok_or_else(unknown)?;
        if vertices.contains(&vertex) {
            return Err(FindError::RepeatedVertex { label: label.to_owned() });
        }
        vertices.push(vertex);
    }
    vertices.sort_unstable();
    complex.find(&vertices).ok_or_else(|| FindError::UnknownSimplex { labels: labels.join(",") })
}

#[cfg(test)]
mod tests {
    use sig_core::Complex;

    use super::*;
    use crate::build::{BuildOptions, build};
    use crate::soup::{Labels, Soup};
    use crate::store::{AlignedBytes, EncodeOptions, Encoding};

    fn file(labels: Labels) -> AlignedBytes {
        let mut soup = Soup::new(labels, false);
        soup.push(&[0, 1, 2]);
        soup.push(&[2, 3]);
        let built = build(soup, &BuildOptions::default()).unwrap();
        Encoding::new(&built, &EncodeOptions::default()).unwrap().to_bytes().unwrap()
    }

    #[test]
    fn simplices_are_found_by_labels_in_any_order() {
        let labels = [
            (Labels::Numbered(4), ["0", "1", "2", "3"]),
            (Labels::Integers(vec![70, 5, 60, 1]), ["70", "5", "60", "1"]),
            (Labels::Tokens(vec!["b".into(), "A".into(), "x-1".into(), "7".into()]), ["b", "A", "x-1", "7"]),
        ];
        for (labels, [a, b, c, d]) in labels {
            let file = file(labels);
            let complex = Complex::<u16>::from_bytes(&file).unwrap();
            for order in [[a, b, c], [c, a, b], [b, a, c]] {
                let triangle = find_simplex(&complex, &order).unwrap();
                assert_eq!(complex.dim_of(triangle), Some(2));
                let mut names = simplex_labels(&complex, triangle);
                names.sort();
                let mut expected = order.to_vec();
                expected.sort_unstable();
                assert_eq!(names, expected);
            }
            assert!(find_simplex(&complex, &[d, c]).is_ok());
            assert_eq!(find_simplex(&complex, &[a, d]), Err(FindError::UnknownSimplex { labels: [a, d].join(",") }));
            assert_eq!(find_simplex(&complex, &[a, a]), Err(FindError::RepeatedVertex { label: a.to_owned() }));
            for unknown in ["", "4", "-1", "99999999999999999999", "é"] {
                let error = FindError::UnknownVertex { label: unknown.to_owned() };
                assert_eq!(find_simplex(&complex, &[a, unknown]), Err(error));
            }
        }
    }
}
