//! What the structures without a number for every simplex are built from: the top simplices of a complex.

use sig_core::{Dim, Index, Relations, VertexId};

use super::Refusal;
use crate::build::narrow;
use crate::soup::{Coordinates, Labels, Scalars, Soup};
use crate::tops::top_simplices;

/// The top simplices of a complex by dimension, each dimension in canonical order, with vertices numbered as there.
#[derive(Clone, PartialEq, Debug)]
pub struct Tops {
    soup: Soup,
}

impl Tops {
    /// The top simplices of a complex, each with its vertices in an order of the orientation that the file has; labels
    /// and coordinates beside them. Cost: a pass over the simplices.
    #[must_use]
    pub fn of(complex: &impl Relations) -> Self {
        let coordinates = Coordinates::of(complex);
        let mut soup = Soup { coordinates, ..Soup::new(Labels::of(complex), true) };
        let (mut vertices, mut word) = (Vec::new(), Vec::new());
        for top in top_simplices(complex) {
            top.oriented_vertices(complex, &mut vertices);
            word.clear();
            word.extend(vertices.iter().map(|vertex| narrow(vertex.index())));
            soup.push(&word);
        }
        Self { soup }
    }

    /// As a list that [`build`](crate::build::build()) takes. Its vertices are numbered as the labels stand, which is their
    /// order in the complex only where they increase.
    #[must_use]
    pub const fn soup(&self) -> &Soup {
        &self.soup
    }

    /// The list without labels and coordinates: built, it is the complex with the vertices in the same order.
    #[must_use]
    pub fn numbered(&self) -> Soup {
        Soup { simplices: self.soup.simplices.clone(), ..Soup::new(Labels::Numbered(self.num_vertices()), true) }
    }

    /// n_0.
    #[must_use]
    pub fn num_vertices(&self) -> usize {
        self.soup.labels.len()
    }

    /// The dimension of the complex; `None` if it is empty.
    #[must_use]
    pub fn dim(&self) -> Option<Dim> {
        self.soup.simplices.iter().rposition(|flat| !flat.is_empty())
    }

    /// The number of top simplices of one dimension.
    #[must_use]
    pub fn count(&self, dim: Dim) -> usize {
        self.of_dim(dim).len() / (dim + 1)
    }

    /// The vertices of all top simplices but those of dimension 0, each as often as it occurs.
    pub(crate) fn num_listed_vertices(&self) -> usize {
        self.soup.simplices.iter().skip(1).map(Vec::len).sum()
    }

    /// The vertices of the top simplices of one dimension, `dim` + 1 each.
    pub(super) fn of_dim(&self, dim: Dim) -> &[u32] {
        self.soup.simplices.get(dim).map_or(&[], Vec::as_slice)
    }

    /// The vertices of the top simplices of one dimension at another width, which holds them.
    pub(super) fn corners<I: Index>(&self, dim: Dim) -> Vec<I> {
        self.of_dim(dim).iter().map(|&vertex| crate::build::index(vertex as usize)).collect()
    }

    /// The place of a vertex in space, if there are three coordinates or less.
    pub(super) fn points(&self) -> Option<impl Fn(u32) -> [f64; 3] + Sync> {
        let Coordinates { dim, values } = self.soup.coordinates.as_ref().filter(|coordinates| coordinates.dim <= 3)?;
        Some(move |vertex: u32| {
            let mut point = [0.0; 3];
            for (axis, value) in point.iter_mut().take(*dim).enumerate() {
                let at = vertex as usize * dim + axis;
                *value = match values {
                    Scalars::F32(values) => values[at].into(),
                    Scalars::F64(values) => values[at],
                };
            }
            point
        })
    }

    /// The labels of some vertices, by increasing vertex, separated by commas; ∅ if there are none.
    pub(crate) fn name(&self, word: &[u32]) -> String {
        if word.is_empty() {
            return "∅".to_owned();
        }
        let mut word = word.to_vec();
        word.sort_unstable();
        let label = |vertex: u32| match &self.soup.labels {
            Labels::Numbered(_) => vertex.to_string(),
            Labels::Integers(labels) => labels[vertex as usize].to_string(),
            Labels::Tokens(labels) => labels[vertex as usize].to_string(),
        };
        word.into_iter().map(label).collect::<Vec<_>>().join(",")
    }

    /// Refuses simplices of dimension more than `most`, naming the first of dimension `most` + 1.
    pub(super) fn check_dim(&self, most: Dim) -> Result<(), Refusal> {
        if self.dim().is_none_or(|dim| dim <= most) {
            return Ok(());
        }
        // The first face of the dimension is on a top simplex of at least that dimension.
        let len = most + 2;
        let firsts = (most + 1..self.soup.simplices.len()).flat_map(|dim| {
            self.of_dim(dim).chunks_exact(dim + 1).map(|top| {
                let mut word = top.to_vec();
                word.sort_unstable();
                word.truncate(len);
                word
            })
        });
        let first = firsts.min().unwrap_or_default();
        Err(Refusal::Dimension { simplex: self.name(&first), dim: most + 1, most })
    }
}

/// Refuses numbers up to `largest` in integers that do not hold them beside the stop code. Tops are 32-bit numbers.
pub(super) fn check_width<I: Index>(largest: usize) -> Result<(), Refusal> {
    let fits = I::from_usize(largest).is_some() && u32::from_usize(largest).is_some();
    let bits = I::WIDTH.bits().min(u32::BITS);
    if fits { Ok(()) } else { Err(Refusal::TooNarrow { largest, bits }) }
}

/// Replaces `vertices` by some, sorted.
pub(super) fn sorted(found: impl Iterator<Item = u32>, vertices: &mut Vec<VertexId>) {
    vertices.clear();
    vertices.extend(found.map(|vertex| VertexId::new(vertex as usize)));
    vertices.sort_unstable();
}
