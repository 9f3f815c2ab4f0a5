//! Thawing: flat arrays become a tree that changes. What a tree has no place for, texts and large numbers as labels and
//! coordinates, waits in [`Vertices`] for the tree to be frozen again.

use sig_core::{Dim, MAX_DIM, Relations, SimplexId};

use super::rebuild::{Growth, Member};
use super::{SimplexTree, ThawError};
use crate::frozen::FrozenTree;
use crate::soup::{Coordinates, Labels, Scalars};

/// What is known of the vertices of a complex that was thawed, beside their labels in the tree.
///
/// Where the complex calls its vertices by integers below 2³² − 1 that increase with their numbers, these are the labels
/// in the tree; else the labels in the tree are the numbers of the vertices, and their names are here.
#[derive(Clone, PartialEq, Debug)]
pub struct Vertices {
    /// What the complex called its vertices, by number.
    names: Labels,
    coordinates: Option<Coordinates>,
    /// The label in the tree, by number; the numbers themselves if there are none.
    labels: Option<Vec<u32>>,
}

impl Vertices {
    fn new(names: Labels, coordinates: Option<Coordinates>) -> Self {
        let labels = match &names {
            Labels::Integers(names) if names.is_sorted_by(|a, b| a < b) => {
                let label = |&name: &u64| u32::try_from(name).ok().filter(|&name| name < u32::MAX);
                names.iter().map(label).collect()
            }
            _ => None,
        };
        Self { names, coordinates, labels }
    }

    /// Nothing but the labels of the tree itself.
    #[must_use]
    pub const fn of_labels() -> Self {
        Self { names: Labels::Numbered(0), coordinates: None, labels: None }
    }

    fn label(&self, number: usize) -> u32 {
        match &self.labels {
            Some(labels) => labels.get(number).copied().unwrap_or(u32::MAX),
            None => u32::try_from(number).unwrap_or(u32::MAX),
        }
    }

    fn number(&self, label: u32) -> Option<usize> {
        match &self.labels {
            Some(labels) => labels.binary_search(&label).ok(),
            None => Some(label as usize),
        }
    }

    /// What the complex called the vertex with this label in the tree.
    #[must_use]
    pub fn name(&self, label: u32) -> String {
        match (&self.names, self.number(label)) {
            (Labels::Tokens(names), Some(number)) => names.get(number).map(ToString::to_string),
            (Labels::Integers(names), Some(number)) => names.get(number).map(ToString::to_string),
            _ => None,
        }
        .unwrap_or_else(|| label.to_string())
    }

    /// The label in the tree of the vertex that the complex called so; the tree may not have it. Cost: one pass over the
    /// names.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<u32> {
        let number = match &self.names {
            Labels::Numbered(_) => name.parse().ok()?,
            Labels::Integers(names) => {
                let name: u64 = name.parse().ok()?;
                names.iter().position(|&other| other == name)?
            }
            Labels::Tokens(names) => names.iter().position(|other| &**other == name)?,
        };
        Some(self.label(number)).filter(|&label| label != u32::MAX)
    }

    /// Gives a frozen tree of these vertices, or some of them, their names and coordinates back.
    pub fn restore(&self, frozen: &mut FrozenTree) {
        let numbers: Option<Vec<usize>> = match &frozen.labels {
            Labels::Numbered(count) => (0..*count).map(|label| self.number(u32::try_from(label).ok()?)).collect(),
            Labels::Integers(labels) => labels.iter().map(|&label| self.number(u32::try_from(label).ok()?)).collect(),
            Labels::Tokens(_) => None,
        };
        // A vertex that these know nothing of was inserted since, and has no coordinates.
        let Some(numbers) = numbers else { return };
        if let Some(names) = select(&self.names, &numbers) {
            frozen.labels = names;
        }
        frozen.coordinates = self.coordinates.as_ref().and_then(|all| select_coordinates(all, &numbers));
    }
}

fn select(names: &Labels, numbers: &[usize]) -> Option<Labels> {
    match names {
        Labels::Numbered(_) => None,
        Labels::Integers(names) => {
            numbers.iter().map(|&number| names.get(number).copied()).collect::<Option<_>>().map(Labels::Integers)
        }
        Labels::Tokens(names) => {
            numbers.iter().map(|&number| names.get(number).cloned()).collect::<Option<_>>().map(Labels::Tokens)
        }
    }
}

fn select_coordinates(all: &Coordinates, numbers: &[usize]) -> Option<Coordinates> {
    fn rows<T: Copy>(values: &[T], dim: usize, numbers: &[usize]) -> Option<Vec<T>> {
        let rows: Option<Vec<&[T]>> = numbers.iter().map(|row| values.get(row * dim..(row + 1) * dim)).collect();
        rows.map(|rows| rows.concat())
    }
    let values = match &all.values {
        Scalars::F32(values) => Scalars::F32(rows(values, all.dim, numbers)?),
        Scalars::F64(values) => Scalars::F64(rows(values, all.dim, numbers)?),
    };
    Some(Coordinates { dim: all.dim, values })
}

/// Level arrays, as far as thawing reads them.
struct Levels<C, L, V> {
    num_simplices: usize,
    num_vertices: usize,
    /// The ids of the children of a simplex.
    children: C,
    /// The number of the last vertex of a simplex.
    last_vertex: L,
    /// The filtration value of a simplex.
    value: V,
}

impl<C, L, V> Levels<C, L, V>
where
    C: Fn(usize) -> std::ops::Range<usize>,
    L: Fn(usize) -> Option<usize>,
    V: Fn(usize) -> f64,
{
    /// Grows the tree; whatever the arrays hold, it gets no more simplices than they say.
    fn thaw(&self, filtered: bool, vertices: &Vertices) -> Result<SimplexTree, ThawError> {
        let mut tree = SimplexTree::with_layout(filtered, false);
        let label = |id: usize| (self.last_vertex)(id).map_or(u32::MAX, |number| vertices.label(number));
        let value = |id: usize| Some((self.value)(id) + 0.0).filter(|value| !value.is_nan());
        let mut left = self.num_simplices;
        let children = |id: usize, dim: Dim, members: &mut Vec<Member<usize>>| {
            let mut last = label(id);
            if dim > MAX_DIM && !(self.children)(id).is_empty() {
                return Err(ThawError::Damaged(id));
            }
            for child in (self.children)(id) {
                let child_label = label(child);
                left = left.checked_sub(1).ok_or(ThawError::Damaged(child))?;
                if child_label <= last || child_label == u32::MAX {
                    return Err(ThawError::Damaged(child));
                }
                last = child_label;
                members.push((child_label, value(child).ok_or(ThawError::Damaged(child))?, child));
            }
            Ok(())
        };
        let mut growth = Growth { tree: &mut tree, children, pool: Vec::new() };
        for vertex in 0..self.num_vertices {
            let value = value(vertex).ok_or(ThawError::Damaged(vertex))?;
            if label(vertex) == u32::MAX || (vertex > 0 && label(vertex) <= label(vertex - 1)) {
                return Err(ThawError::Damaged(vertex));
            }
            growth.vertex(label(vertex), value, vertex)?;
        }
        if tree.num_simplices() == self.num_simplices { Ok(tree) } else { Err(ThawError::Damaged(self.num_simplices)) }
    }
}

impl SimplexTree {
    /// The tree of a complex in flat arrays, with filtration values if it has them, and what else is known of the vertices.
    /// Frozen and [`restored`](Vertices::restore) it is the same again.
    ///
    /// Cost: O(1) for each simplex.
    ///
    /// # Errors
    /// [`ThawError`]: if the arrays are not those of a complex, as far as it looks at them.
    pub fn thaw(frozen: &FrozenTree) -> Result<(Self, Vertices), ThawError> {
        let vertices = Vertices::new(frozen.labels.clone(), frozen.coordinates.clone());
        let filtration = frozen.filtration.as_deref();
        let levels = Levels {
            num_simplices: frozen.num_simplices,
            num_vertices: frozen.num_vertices(),
            children: |id| frozen.children(id),
            last_vertex: |id| (id < frozen.last_vertices.len()).then(|| frozen.last_vertices.at(id) as usize),
            value: |id| filtration.map_or(0.0, |values| values.get(id).copied().unwrap_or(f64::NAN)),
        };
        Ok((levels.thaw(filtration.is_some(), &vertices)?, vertices))
    }

    /// The tree of a complex in a buffer or a mapped file; see [`thaw`](Self::thaw).
    ///
    /// Cost: O(1) for each simplex if the file has the tree's sections.
    ///
    /// # Errors
    /// [`ThawError`]: if the file is damaged, as far as this looks at it.
    pub fn thaw_complex(complex: &impl Relations) -> Result<(Self, Vertices), ThawError> {
        let vertices = Vertices::new(Labels::of(complex), Coordinates::of(complex));
        let filtration = complex.filtration();
        let levels = Levels {
            num_simplices: complex.num_simplices(),
            num_vertices: complex.num_vertices(),
            children: |id| {
                let mut children = complex.children(SimplexId::new(id)).map(SimplexId::index);
                let len = children.len();
                children.next().map_or(0..0, |first| first..first + len)
            },
            last_vertex: |id| complex.last_vertex(SimplexId::new(id)).map(sig_core::VertexId::index),
            value: |id| filtration.map_or(0.0, |values| values.get(id).copied().unwrap_or(f64::NAN)),
        };
        Ok((levels.thaw(filtration.is_some(), &vertices)?, vertices))
    }
}
