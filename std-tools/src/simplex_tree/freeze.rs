//! Freezing: the tree in level order.

use super::SimplexTree;
use super::arena::NONE;
use super::node::Place;
use crate::build::narrow;
use crate::frozen::{FrozenTree, LastVertices};
use crate::soup::Labels;

impl SimplexTree {
    /// The complex in flat arrays, vertices numbered by increasing label; with filtration values if the tree has them.
    ///
    /// Cost: O(1) for each simplex, O(log `n_0`) where labels are much larger than there are vertices. Beside the result it
    /// needs 4 bytes for each set of siblings of two dimensions.
    #[must_use]
    pub fn freeze(&self) -> FrozenTree {
        let vertices: Vec<u32> = self.tops.labels().collect();
        let counts = self.counts();
        let first: Vec<usize> =
            counts.iter().scan(0, |next, &count| Some(std::mem::replace(next, *next + count))).collect();
        let num_simplices = self.num_simplices();
        let mut frozen = FrozenTree {
            child_offsets: Vec::with_capacity(first.last().map_or(0, |&last| last + 1)),
            last_vertices: if vertices.len() <= LastVertices::MOST_BITS16 {
                LastVertices::Bits16(Vec::with_capacity(num_simplices))
            } else {
                LastVertices::Bits32(Vec::with_capacity(num_simplices))
            },
            filtration: self.has_filtration().then(|| Vec::with_capacity(num_simplices)),
            num_simplices,
            first,
            ..FrozenTree::default()
        };
        self.freeze_levels(&vertices, &mut frozen);
        frozen.labels = if vertices.iter().copied().eq(0..narrow(vertices.len())) {
            Labels::Numbered(vertices.len())
        } else {
            Labels::Integers(vertices.into_iter().map(u64::from).collect())
        };
        frozen
    }

    fn freeze_levels(&self, vertices: &[u32], frozen: &mut FrozenTree) {
        let ranks = Ranks::new(vertices);
        let mut next_id = frozen.first.get(1).copied().unwrap_or(0);
        let mut offset = |frozen: &mut FrozenTree, child: u32| {
            frozen.child_offsets.push(narrow(next_id));
            next_id += self.arena.labels(child).len();
        };
        // The sets of children of one level, in order; the last level has none and no offsets.
        let mut sets = Vec::new();
        let is_flat = frozen.first.len() == 1;
        for (rank, &label) in vertices.iter().enumerate() {
            let place = Place::top(label);
            push_vertex(frozen, rank);
            if let Some(values) = &mut frozen.filtration {
                values.push(self.value_at(place));
            }
            if !is_flat {
                let child = self.child_at(place);
                offset(frozen, child);
                sets.extend((child != NONE).then_some(child));
            }
        }
        for dim in 1..frozen.first.len() {
            let is_last = dim + 1 == frozen.first.len();
            let mut below = Vec::new();
            for &set in &sets {
                for (index, label) in self.arena.labels(set).enumerate() {
                    push_vertex(frozen, ranks.of(label));
                    if let Some(values) = &mut frozen.filtration {
                        values.push(self.arena.value(set, index));
                    }
                    if !is_last {
                        let child = self.arena.child(set, index);
                        offset(frozen, child);
                        below.extend((child != NONE).then_some(child));
                    }
                }
            }
            sets = below;
        }
        if !vertices.is_empty() {
            frozen.child_offsets.push(narrow(frozen.num_simplices));
        }
    }
}

fn push_vertex(frozen: &mut FrozenTree, vertex: usize) {
    match &mut frozen.last_vertices {
        // There are no more vertices than the width holds.
        LastVertices::Bits16(vertices) => vertices.push(u16::try_from(vertex).unwrap_or(u16::MAX)),
        LastVertices::Bits32(vertices) => vertices.push(narrow(vertex)),
    }
}

/// The number of each vertex, from its label.
enum Ranks<'a> {
    /// By label.
    Table(Vec<u32>),
    /// The labels, increasing.
    Sorted(&'a [u32]),
}

impl<'a> Ranks<'a> {
    fn new(labels: &'a [u32]) -> Self {
        match labels.last() {
            Some(&last) if (last as usize) < 4 * labels.len() + 1024 => {
                let mut table = vec![0; last as usize + 1];
                labels.iter().enumerate().for_each(|(rank, &label)| table[label as usize] = narrow(rank));
                Self::Table(table)
            }
            _ => Self::Sorted(labels),
        }
    }

    #[inline]
    fn of(&self, label: u32) -> usize {
        match self {
            Self::Table(table) => table[label as usize] as usize,
            Self::Sorted(labels) => labels.partition_point(|&other| other < label),
        }
    }
}
