//! What the contraction of one edge changes, found from the stars around it alone.
//!
//! Let b be taken to a. The simplices of the star of b vanish. With A the faces of the images of the top simplices around
//! b, all that changes lies in A: a simplex is new only as an image of one in the star of b; a top simplex appears or
//! stops to be one only within such images (a top simplex of the result is the image of a top simplex, and is the same as
//! before if it does not come from the star of b); so C\*(σ) changes at faces of these only. For σ in A every top
//! simplex around σ, before or after, contains a vertex of A. So the images of the top simplices around these vertices
//! are a small complex in which the star of each σ in A is as in the result: it is built as any other
//! ([`crate::build::build`]), and its C\* at A are those of the result. Least ids stay least, as the canonical order of the
//! small complex is that of the whole.

use std::collections::BTreeSet;

use sig_core::Index;

use super::view::{Place, View};
use crate::build::{BuildError, BuildOptions, Built, SigArrays, VertexOrder, build, narrow};
use crate::soup::{Labels, Soup};

/// The change by one contraction. Vertices and ids of simplices are those before it, unless they are called local.
pub(super) struct Edit {
    /// The vertex that vanishes.
    pub(super) removed: u32,
    /// The vertex onto which it is taken.
    pub(super) kept: u32,
    /// The star of the vertex that vanishes, increasing.
    pub(super) star: Vec<usize>,
    /// The vertices of A, and the one that vanishes: what no other contraction in the same pass may touch.
    pub(super) vertices: BTreeSet<u32>,
    /// The small complex around A, after the contraction.
    pub(super) local: SigArrays<u64>,
    /// The vertices of the small complex by local id.
    names: Vec<u32>,
    /// Which local simplices are in A.
    pub(super) is_changed: Vec<bool>,
    /// Where the local simplices that are in A, or top, stand; `Place::Before(0)` for the others.
    pub(super) places: Vec<Place>,
    /// The parity of the local top simplices, in the order of their ids.
    pub(super) parity: Vec<u8>,
    /// The local top simplices onto which top simplices of both orientations are taken.
    pub(super) conflicting: usize,
    /// For local simplices in A, bounds from above of the filtration value: values of preimages.
    pub(super) filtration: Vec<(usize, f64)>,
}

/// The complex before a contraction, and what is looked up in it for each.
pub(super) struct Before<'a, I> {
    pub(super) view: View<'a, I>,
    /// The top simplices below dimension d, increasing.
    pub(super) low_tops: Vec<usize>,
    pub(super) parity: &'a [u8],
    pub(super) filtration: Option<&'a [f64]>,
}

impl<I: Index> Before<'_, I> {
    /// The parity of a top simplex.
    pub(super) fn is_odd(&self, top: usize) -> bool {
        let arrays = self.view.arrays;
        let start = arrays.first.last().copied().unwrap_or(0);
        let row = match top.checked_sub(start) {
            Some(number) => self.low_tops.len() + number,
            None => self.low_tops.partition_point(|&low| low < top),
        };
        self.parity.get(row / 8).is_some_and(|byte| byte >> (row % 8) & 1 == 1)
    }

    /// The vertices of a top simplex in an order of its orientation.
    fn oriented_word(&self, top: usize) -> Vec<u32> {
        let mut word = self.view.word(top);
        if let ([.., a, b], true) = (word.as_mut_slice(), self.is_odd(top)) {
            std::mem::swap(a, b);
        }
        word
    }

    /// Whether the complex has the edge.
    pub(super) fn has_edge(&self, a: u32, b: u32) -> bool {
        let count = self.view.arrays.ids(0).len();
        let exist = a != b && (a as usize) < count && (b as usize) < count && self.view.arrays.first.len() > 1;
        exist && matches!(self.view.locate(&[a.min(b), a.max(b)]), Place::At(_))
    }

    /// What changes when `removed` is taken to `kept`, an edge of the complex.
    pub(super) fn edit(&self, kept: u32, removed: u32) -> Result<Edit, BuildError> {
        let tops = self.view.tops_of(removed as usize);
        let images: Vec<Vec<u32>> = tops.iter().map(|&top| image(self.oriented_word(top), kept, removed)).collect();
        let mut vertices: BTreeSet<u32> = images.iter().flatten().copied().collect();
        let around: BTreeSet<usize> = vertices.iter().flat_map(|&vertex| self.view.tops_of(vertex as usize)).collect();
        let others = around.iter().map(|&top| self.oriented_word(top)).filter(|word| !word.contains(&removed));
        let words: Vec<Vec<u32>> = images.iter().cloned().chain(others).collect();
        let names: Vec<u32> = words.iter().flatten().copied().collect::<BTreeSet<_>>().into_iter().collect();
        let Built { arrays, parity, report, .. } = build(soup(&words, &names), &LOCAL)?;
        let local = arrays.into_wide();

        let view = View::new(&local);
        let ids = images.iter().filter_map(|image| local_id(&view, &names, image));
        let is_changed = view.closure(ids);
        let place = |id: usize| {
            let is_needed = is_changed[id] || view.list(id).is_empty();
            if is_needed { self.view.locate(&global(&names, view.word(id))) } else { Place::Before(0) }
        };
        let places = (0..local.num_simplices).map(place).collect();
        let star = self.view.star(removed as usize, &tops);
        let filtration = self.filtration_values(&star, kept, removed, &view, &names);
        vertices.insert(removed);
        let conflicting = report.conflicting;
        let parity = parity.unwrap_or_default();
        Ok(Edit { removed, kept, star, vertices, local, names, is_changed, places, parity, conflicting, filtration })
    }

    /// The values of the star of `removed`, by the local ids of the images.
    fn filtration_values(
        &self,
        star: &[usize],
        kept: u32,
        removed: u32,
        local: &View<'_, u64>,
        names: &[u32],
    ) -> Vec<(usize, f64)> {
        let Some(values) = self.filtration else { return Vec::new() };
        let value_of = |&id: &usize| {
            let image = image(self.view.word(id), kept, removed);
            Some((local_id(local, names, &image)?, *values.get(id)?))
        };
        star.iter().filter_map(value_of).collect()
    }
}

impl Edit {
    /// The vertices of a local simplex.
    pub(super) fn word(&self, local: usize) -> Vec<u32> {
        global(&self.names, View::new(&self.local).word(local))
    }
}

/// Nothing to be numbered anew, and not to be asked what memory there is.
const LOCAL: BuildOptions<'_> = BuildOptions {
    order: VertexOrder::Input,
    unused: crate::build::Unused::Keep,
    max_simplices: None,
    max_bytes: Some(u64::MAX),
    progress: None,
};

/// The word of the image in an order of its orientation; increasing if that is a face, which has none.
fn image(mut word: Vec<u32>, kept: u32, removed: u32) -> Vec<u32> {
    if word.contains(&kept) {
        word.retain(|&vertex| vertex != removed);
        word.sort_unstable();
    } else if let Some(vertex) = word.iter_mut().find(|vertex| **vertex == removed) {
        *vertex = kept;
    }
    word
}

/// The soup of words of the given vertices, numbered in their order.
fn soup(words: &[Vec<u32>], names: &[u32]) -> Soup {
    let mut soup = Soup::new(Labels::Numbered(names.len()), false);
    for word in words {
        soup.push(&local_word(names, word));
    }
    soup
}

fn local_word(names: &[u32], word: &[u32]) -> Vec<u32> {
    word.iter().map(|vertex| narrow(names.partition_point(|name| name < vertex))).collect()
}

/// The local id of the simplex of the given vertices, in any order.
fn local_id(view: &View<'_, u64>, names: &[u32], word: &[u32]) -> Option<usize> {
    let mut word = local_word(names, word);
    word.sort_unstable();
    match view.locate(&word) {
        Place::At(id) => Some(id),
        Place::Before(_) => None,
    }
}

fn global(names: &[u32], mut word: Vec<u32>) -> Vec<u32> {
    for vertex in &mut word {
        *vertex = names[*vertex as usize];
    }
    word
}
