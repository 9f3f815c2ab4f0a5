//! Several inputs as one soup.
//!
//! Lists of simplices speak of the same vertices where they use the same labels. Meshes number their vertices each for
//! itself, so they are put beside each other.

use sig_core::Dim;

use super::labels::LabelTable;
use crate::attribute::Attribute;
use crate::soup::{Coordinates, Labels, Scalars, Soup};

/// Why inputs cannot be merged. Inputs are numbered from 1 in the messages.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MergeError {
    /// There is nothing to merge.
    #[error("no input")]
    Empty,
    /// A mesh and a list of simplices.
    #[error(
        "input 1 and input {input} do not mix: one is a mesh with its own vertices, the other a list of simplices by \
         labels; build them apart, or turn the mesh into a list of simplices first"
    )]
    MixedKinds {
        /// The first input of the other kind.
        input: usize,
    },
    /// Coordinates of different dimension.
    #[error("input 1 has points of {first} coordinates, input {input} of {other}; all must have the same number")]
    MixedCoordinates {
        /// The first input that differs.
        input: usize,
        /// The dimension in the first input, 0 if it has no coordinates.
        first: usize,
        /// The dimension in the other.
        other: usize,
    },
    /// A list of simplices that carries coordinates, which merging by label cannot keep.
    #[error("input {input} is a list of simplices with coordinates; only meshes with coordinates can be merged")]
    ListWithCoordinates {
        /// The input.
        input: usize,
    },
    /// A mesh whose vertices are not called by integers, which cannot be shifted.
    #[error("the vertices of the mesh in input {input} are not called by integers, so they cannot be renumbered")]
    TextLabels {
        /// The input.
        input: usize,
    },
    /// More vertices than 32-bit numbers, or labels than 64-bit numbers, can tell apart.
    #[error("with input {input} there are more vertices than can be numbered")]
    TooMany {
        /// The input.
        input: usize,
    },
}

/// How the vertices of a mesh were renamed: the vertex called `from + i` is now called `to + i`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Renumbered {
    /// The number of the input, from 0.
    pub input: usize,
    /// The least label of the mesh before.
    pub from: u64,
    /// The least label of the mesh now.
    pub to: u64,
}

/// What merging did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct MergeReport {
    /// The meshes whose vertices were renamed.
    pub renumbered: Vec<Renumbered>,
    /// The names of the attributes that are left out: of different types in different inputs, or of lists of simplices.
    pub attributes_left_out: Vec<Box<str>>,
}

/// Merges inputs: lists of simplices by label, meshes beside each other with the labels of each past the greatest
/// label before it.
///
/// Takes time and memory linear in the inputs; a single input is handed back as it is.
///
/// # Errors
/// If there is no input, if meshes and lists are mixed, if coordinates differ in dimension, or if there are too many
/// vertices.
pub fn merge(soups: Vec<Soup>) -> Result<(Soup, MergeReport), MergeError> {
    let mut report = MergeReport::default();
    let mut inputs = soups.into_iter().enumerate();
    let (_, mut merged) = inputs.next().ok_or(MergeError::Empty)?;
    if inputs.len() == 0 {
        return Ok((merged, report));
    }
    let mut table = LabelTable::new();
    if !merged.declared {
        // Into the table, so that later inputs find the labels.
        let mut first = std::mem::replace(&mut merged, Soup::new(Labels::Numbered(0), false));
        report.attributes_left_out.extend(first.attributes.drain(..).map(|attribute| attribute.name));
        append_list(&mut merged, &mut table, first, 0)?;
    }
    for (input, mut soup) in inputs {
        if soup.declared != merged.declared {
            return Err(MergeError::MixedKinds { input: input + 1 });
        }
        if merged.declared {
            let coordinates = soup.coordinates.take();
            append_coordinates(&mut merged.coordinates, coordinates, input)?;
            let left_out = append_attributes(&mut merged, &mut soup);
            report.attributes_left_out.extend(left_out);
            report.renumbered.push(append_mesh(&mut merged, soup, input)?);
        } else {
            report.attributes_left_out.extend(soup.attributes.drain(..).map(|attribute| attribute.name));
            append_list(&mut merged, &mut table, soup, input)?;
        }
    }
    if !merged.declared {
        merged.labels = table.into_labels();
    }
    Ok((merged, report))
}

/// Appends the simplices of a list, whose vertices the table knows by label.
fn append_list(merged: &mut Soup, table: &mut LabelTable, soup: Soup, input: usize) -> Result<(), MergeError> {
    if soup.coordinates.is_some() {
        return Err(MergeError::ListWithCoordinates { input: input + 1 });
    }
    let numbers: Option<Vec<u32>> = match soup.labels {
        Labels::Numbered(count) => (0..count as u64).map(|label| table.number_integer(label)).collect(),
        Labels::Integers(labels) => labels.iter().map(|&label| table.number_integer(label)).collect(),
        Labels::Tokens(labels) => labels.iter().map(|label| table.number(label)).collect(),
    };
    let numbers = numbers.ok_or(MergeError::TooMany { input: input + 1 })?;
    append_simplices(merged, &soup.simplices, |vertex| numbers[vertex as usize]);
    Ok(())
}

/// Appends a mesh beside what is there; tells how it was renumbered.
fn append_mesh(merged: &mut Soup, soup: Soup, input: usize) -> Result<Renumbered, MergeError> {
    let too_many = || MergeError::TooMany { input: input + 1 };
    let text = |input| MergeError::TextLabels { input };
    let (_, greatest) = range(&merged.labels).ok_or_else(|| text(1))?;
    let (from, greatest_here) = range(&soup.labels).ok_or_else(|| text(input + 1))?;
    let to = greatest.map_or(Some(0), |greatest| greatest.checked_add(1)).ok_or_else(too_many)?;
    to.checked_add(greatest_here.map_or(0, |greatest| greatest - from)).ok_or_else(too_many)?;
    let shift = u32::try_from(merged.labels.len()).map_err(|_| too_many())?;
    let all = merged.labels.len() + soup.labels.len();
    if u32::try_from(all).is_err() {
        return Err(too_many());
    }
    match (&mut merged.labels, soup.labels) {
        (Labels::Numbered(count), Labels::Numbered(_)) => *count = all,
        (labels, more) => {
            let mut together = into_integers(std::mem::replace(labels, Labels::Numbered(0)));
            together.extend(into_integers(more).into_iter().map(|label| label - from + to));
            *labels = Labels::Integers(together);
        }
    }
    append_simplices(merged, &soup.simplices, |vertex| vertex + shift);
    Ok(Renumbered { input, from, to })
}

/// The least label (0 if there is none) and the greatest; `None` if they are no integers.
fn range(labels: &Labels) -> Option<(u64, Option<u64>)> {
    match labels {
        Labels::Numbered(count) => Some((0, (*count as u64).checked_sub(1))),
        Labels::Integers(labels) => Some((labels.iter().copied().min().unwrap_or(0), labels.iter().copied().max())),
        Labels::Tokens(_) => None,
    }
}

fn into_integers(labels: Labels) -> Vec<u64> {
    match labels {
        Labels::Numbered(count) => (0..count as u64).collect(),
        Labels::Integers(labels) => labels,
        // `range` has refused these.
        Labels::Tokens(_) => Vec::new(),
    }
}

fn append_simplices(merged: &mut Soup, simplices: &[Vec<u32>], number: impl Fn(u32) -> u32) {
    if merged.simplices.len() < simplices.len() {
        merged.simplices.resize_with(simplices.len(), Vec::new);
    }
    for (all, more) in merged.simplices.iter_mut().zip(simplices) {
        all.extend(more.iter().map(|&vertex| number(vertex)));
    }
}

/// Appends the rows of the attributes of `more`, whose simplices will be appended, and rows without a value to those that it
/// does not have. Leaves out those that have another shape there, and gives their names.
fn append_attributes(merged: &mut Soup, more: &mut Soup) -> Vec<Box<str>> {
    let rows = |soup: &Soup, dim: Dim| if dim == 0 { soup.labels.len() } else { soup.of_dim(dim).len() };
    let mut left_out = Vec::new();
    for attribute in std::mem::take(&mut more.attributes) {
        let before = rows(merged, attribute.dim);
        let same = |there: &&mut Attribute| (there.dim, &there.name) == (attribute.dim, &attribute.name);
        match merged.attributes.iter_mut().find(same) {
            None => {
                let (none, its) = (std::iter::repeat_n(None, before), (0..attribute.num_rows()).map(Some));
                merged.attributes.push(attribute.with_rows(none.chain(its)));
            }
            Some(there) if there.components == attribute.components && there.values.is_alike(&attribute.values) => {
                there.values.append(attribute.values);
            }
            Some(there) => left_out.push(there.name.clone()),
        }
    }
    merged.attributes.retain(|attribute| !left_out.contains(&attribute.name));
    let dims: Vec<usize> = merged.attributes.iter().map(|attribute| attribute.dim).collect();
    let all: Vec<usize> = dims.iter().map(|&dim| rows(merged, dim) + rows(more, dim)).collect();
    for (attribute, rows) in merged.attributes.iter_mut().zip(all) {
        attribute.values.fill(rows * attribute.components);
    }
    merged.attributes.sort_by(|a, b| (a.dim, &a.name).cmp(&(b.dim, &b.name)));
    left_out
}

/// Appends coordinates, which must have as many scalars a vertex; the precision is the greater of the two.
fn append_coordinates(
    merged: &mut Option<Coordinates>,
    more: Option<Coordinates>,
    input: usize,
) -> Result<(), MergeError> {
    let dim = |coordinates: &Option<Coordinates>| coordinates.as_ref().map_or(0, |coordinates| coordinates.dim);
    let (first, other) = (dim(merged), dim(&more));
    if first != other {
        return Err(MergeError::MixedCoordinates { input: input + 1, first, other });
    }
    let (Some(merged), Some(more)) = (merged, more) else { return Ok(()) };
    match (&mut merged.values, more.values) {
        (Scalars::F32(all), Scalars::F32(more)) => all.extend(more),
        (Scalars::F64(all), Scalars::F64(more)) => all.extend(more),
        (Scalars::F64(all), Scalars::F32(more)) => all.extend(more.into_iter().map(f64::from)),
        (Scalars::F32(all), Scalars::F64(more)) => {
            merged.values = Scalars::F64(all.iter().copied().map(f64::from).chain(more).collect());
        }
    }
    Ok(())
}
