//! Edge contraction on the arrays of a Simplified Incidence Graph, with C\* updated around the edge only: what sig-2004
//! leaves as future work (section 8).
//!
//! A [`Built`] complex goes in and comes out, equal to what [`build`](crate::build::build()) makes of the images of the top
//! simplices, array by array. To contract the edge {a, b}, *b onto a*, is the simplicial map that takes b to a and leaves the
//! other vertices where they are; the result is its image (simplex-tree-2012, 2.2). It has the homotopy type of the complex
//! where Lk(a) ∩ Lk(b) = Lk(ab), which is a question of its own: [`link_condition`].
//!
//! Two parts, one a file each:
//!
//! 1. `edit`: what changes, and its relations, from the stars around the edge alone (`view` reads them);
//! 2. `renumber` and `apply`: as ids are consecutive and in canonical order, all later ones move. Everything that did not
//!    change is carried over in one pass over each array, none of it is looked at.
//!
//! Edges whose contractions cannot meet share a pass: see [`contract`].

mod apply;
mod edit;
mod link;
mod renumber;
mod view;

use std::collections::BTreeSet;

use sig_core::{Index, VertexId};

use crate::build::{Arrays, BuildError, BuildReport, Built, SigArrays, narrow};
use edit::{Before, Edit};
pub use link::link_condition;
use renumber::Renumbering;
use view::View;

/// An edge to be contracted, and to which end.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Edge {
    /// The vertex that stays, with its label and coordinates.
    pub kept: VertexId,
    /// The vertex that is taken to it, and vanishes.
    pub removed: VertexId,
}

/// Why edges are not contracted.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ContractError {
    /// There is no such edge, or no longer.
    #[error("edge number {index}: the vertices {} and {} are not joined by an edge", edge.kept, edge.removed)]
    NotAnEdge {
        /// Which of the given edges it is, from 0.
        index: usize,
        /// The edge, as it was given.
        edge: Edge,
    },
    /// The simplices around the edge cannot be built: there are too many.
    #[error("around edge number {index}: {error}")]
    Build {
        /// Which of the given edges it is, from 0.
        index: usize,
        /// What is wrong.
        error: BuildError,
    },
}

/// What was done.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct ContractReport {
    /// Edges that were contracted.
    pub contracted: usize,
    /// Edges whose ends had become one before.
    pub merged: usize,
    /// Passes over the arrays: one for each run of edges that cannot meet.
    pub passes: usize,
    /// Simplices that vanished: the stars of the vertices removed.
    pub removed: usize,
    /// Simplices whose relations were found anew.
    pub recomputed: usize,
    /// Simplices in the small complexes that were built for that.
    pub around: usize,
}

/// Contracts edges one after the other.
///
/// Vertices are named by their ids in the complex as it is given; after it is contracted away, a vertex stands for the one
/// onto which it was taken. An edge whose ends have become one is passed over. After each step the complex is that of the
/// images of the top simplices, and
///
/// - ids, boundary, C\*, flags and tree are those of a rebuild with the vertices in the same order;
/// - labels and coordinates are those of the vertices that are left;
/// - a filtration value is the least over the simplices that are taken onto one;
/// - the orientation of a top simplex is that of the one of equal dimension that is taken onto it; increasing if there is
///   none, or if there are some of both orientations, as for simplices that an input repeats;
/// - the report says what a rebuild from the top simplices alone would say, with the conflicts of orientation of the last
///   pass.
///
/// Indices stay 64-bit where they are, even if 32 bits come to be enough.
///
/// Cost: for each edge, building the complex of the top simplices around the closed star of the vertex removed, which does
/// not depend on n; and one pass over all arrays for each run of consecutive edges that cannot meet: no two vertices
/// removed have closed stars with a vertex in common. Memory: one index for each simplex, and the lists twice.
///
/// # Errors
/// [`ContractError`]; the complex is then as the edges before the bad one leave it.
pub fn contract(built: &mut Built, edges: &[Edge]) -> Result<ContractReport, ContractError> {
    let mut report = ContractReport::default();
    // The vertex for which each of the given ones stands.
    let num_vertices = built.labels.len();
    let mut stands_for: Vec<u32> = (0..num_vertices).map(narrow).collect();
    let mut done = 0;
    while done < edges.len() {
        done += match &mut built.arrays {
            Arrays::Narrow(arrays) => {
                let arrays = std::mem::take(arrays);
                run(built, arrays, edges, done, &mut stands_for, &mut report)
            }
            Arrays::Wide(arrays) => {
                let arrays = std::mem::take(arrays);
                run(built, arrays, edges, done, &mut stands_for, &mut report)
            }
        }?;
    }
    Ok(report)
}

/// Contracts the edges from `start` on that can be contracted in one pass, puts the arrays back, and says how many these
/// are.
fn run<I: Index>(
    built: &mut Built,
    arrays: SigArrays<I>,
    edges: &[Edge],
    start: usize,
    stands_for: &mut [u32],
    report: &mut ContractReport,
) -> Result<usize, ContractError>
where
    Arrays: From<SigArrays<I>>,
{
    let view = View::new(&arrays);
    let low_tops = view.low_tops(&built.report.top_simplices);
    let parity = built.parity.as_deref().unwrap_or_default();
    let before = Before { view, low_tops, parity, filtration: built.filtration.as_deref() };
    let (edits, taken, bad) = independent_edits(&before, edges, start, stands_for, report);
    if edits.is_empty() {
        built.arrays = arrays.into();
        return bad.map_or(Ok(taken), Err);
    }
    report.contracted += edits.len();
    report.passes += 1;
    report.removed += edits.iter().map(|edit| edit.star.len()).sum::<usize>();
    report.around += edits.iter().map(|edit| edit.local.num_simplices).sum::<usize>();
    let renumbering = Renumbering::new(&before, &edits);
    report.recomputed += renumbering.changed.len();

    let (parity, top_simplices) = apply::parity(&before, &edits, &renumbering);
    built.arrays = apply::arrays(arrays, &edits, &renumbering);
    // Without orientations before, there are none after.
    built.parity = built.parity.is_some().then_some(parity);
    built.report = BuildReport {
        listed: top_simplices.iter().sum(),
        conflicting: edits.iter().map(|edit| edit.conflicting).sum(),
        top_simplices,
        ..BuildReport::default()
    };
    if let Some(values) = &mut built.filtration {
        apply::filtration(values, &edits, &renumbering);
    }
    let removed: BTreeSet<u32> = edits.iter().map(|edit| edit.removed).collect();
    let removed: Vec<u32> = removed.into_iter().collect();
    built.labels = apply::labels(std::mem::replace(&mut built.labels, crate::soup::Labels::Numbered(0)), &removed);
    if let Some(coordinates) = &mut built.coordinates {
        apply::remove_coordinates(coordinates, &removed);
    }
    rename(stands_for, &edits, &renumbering);
    bad.map_or(Ok(taken), Err)
}

/// The edits of the edges from `start` on up to the first that may meet one before; how many edges these are; and the
/// error, if they end before one that is bad.
fn independent_edits<I: Index>(
    before: &Before<'_, I>,
    edges: &[Edge],
    start: usize,
    stands_for: &[u32],
    report: &mut ContractReport,
) -> (Vec<Edit>, usize, Option<ContractError>) {
    let mut edits: Vec<Edit> = Vec::new();
    let mut touched = BTreeSet::new();
    for (index, &edge) in edges.iter().enumerate().skip(start) {
        let taken = index - start;
        let not_an_edge = ContractError::NotAnEdge { index, edge };
        let ends = [edge.kept, edge.removed].map(|vertex| stands_for.get(vertex.index()).copied());
        let [Some(kept), Some(removed)] = ends else { return (edits, taken, Some(not_an_edge)) };
        if touched.contains(&kept) || touched.contains(&removed) {
            return (edits, taken, None);
        }
        if kept == removed && edge.kept != edge.removed {
            report.merged += 1;
            continue;
        }
        if !before.has_edge(kept, removed) {
            return (edits, taken, Some(not_an_edge));
        }
        let edit = match before.edit(kept, removed) {
            Ok(edit) => edit,
            Err(error) => return (edits, taken, Some(ContractError::Build { index, error })),
        };
        if !touched.is_disjoint(&edit.vertices) {
            return (edits, taken, None);
        }
        touched.extend(edit.vertices.iter().copied());
        edits.push(edit);
    }
    (edits, edges.len() - start, None)
}

/// Tells the vertices as they were given for which vertex each of them stands now.
fn rename<I: Index>(stands_for: &mut [u32], edits: &[Edit], renumbering: &Renumbering<I>) {
    let mut images: Vec<(u32, u32)> = edits.iter().map(|edit| (edit.removed, edit.kept)).collect();
    images.sort_unstable();
    for vertex in stands_for {
        if let Ok(found) = images.binary_search_by_key(vertex, |&(removed, _)| removed) {
            *vertex = images[found].1;
        }
        *vertex = narrow(renumbering.new_ids[*vertex as usize].to_usize());
    }
}
